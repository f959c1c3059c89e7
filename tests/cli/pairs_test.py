#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Asks of small robots with every two features at once the same question in two ways.

Features: friction, open pairs, connections with their own law, bodies, a pitch by direction. Each
answer of --lose-one, --scatter, --limit, --cascade, --deformed, next, order, steps and simulate is
compared with that of check for a file that says the same, and with that of the mirrored and the
turned robot. Usage: pairs_test.py HOLDFAST
"""
import copy
import itertools
import json
import os
import subprocess
import sys
import tempfile

SHAPES = {
    "portal": [[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2], [2, 0, 2], [2, 0, 1], [2, 0, 0],
               [1, 0, 1]],
    "ledge": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1], [3, 0, 1]],
}
FEATURES = {
    "friction": {"floor": {"friction": 0.04}},
    "open": {"open": [[[0, 0, 1], [1, 0, 1]], [[1, 0, 1], [2, 0, 1]]]},
    "connections": {"connections": [{"between": [[2, 0, 0], [2, 0, 1]], "strength_n": 2.5}]},
    "bodies": {"bodies": [[[1, 0, 2], [2, 0, 2]], [[1, 0, 0], [2, 0, 0]]]},
    "pitch": {"material": {"pitch_mm": [25, 30, 11]}},
}
faults = []


def ask(robot, command, *options):
    """Returns a report, or {"verdict": "refused"} and why."""
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(robot, file)
        file.flush()
        run = subprocess.run(
            [sys.argv[1], command, file.name, *options, "--json", "-", "-q"],
            capture_output=True, text=True, check=False,
        )
    report = json.loads(run.stdout) if run.stdout.strip() else {"error": run.stderr}
    if run.returncode > 2 or "error" in report:
        return {"verdict": "refused", "error": report.get("error")}
    return report


def only(robot, cells):
    """The robot without the modules that are not among these cells, and what names them."""
    part = copy.deepcopy(robot)
    part["modules"] = [m for m in robot["modules"] if m in cells]
    for key in ("open", "bodies", "connections"):
        pairs = robot.get(key, [])
        kept = [p for p in pairs if all(c in cells for c in (p["between"] if key[0] == "c" else p))]
        part.pop(key, None)
        if kept:
            part[key] = copy.deepcopy(kept)
    return part


def with_open(robot, a, b):
    """The robot with one connection less."""
    part = copy.deepcopy(robot)
    part["open"] = part.get("open", []) + [[a, b]]
    laws = [c for c in part.pop("connections", []) if c["between"] not in ([a, b], [b, a])]
    return {**part, **({"connections": laws} if laws else {})}


def expect(name, is_true, *what):
    if not is_true:
        faults.append(name)
        print(name, *what)


def ratio(report):
    return (report.get("overload") or {}).get("load_ratio_max") or 0


def in_bodies(robot):
    return [cell for body in robot.get("bodies", []) for cell in body]


def try_losses(name, robot):
    """What is called fatal fails as a file, and nothing else does."""
    report = ask(robot, "check", "--lose-one")
    if report["verdict"] != "safe":
        return
    found = report["lose_one"]
    bad = [e.get("module") or [e["a"], e["b"]] for e in found["fatal"] + found["undecided"]
           if "module" in e or "a" in e]
    for cell in robot["modules"]:
        if cell not in in_bodies(robot):
            part = only(robot, [m for m in robot["modules"] if m != cell])
            verdict = ask(part, "check")["verdict"]
            expect(name, (verdict == "safe") == (cell not in bad), "without", cell, verdict)
    for one in report["connections"]:
        pair = [one["a"], one["b"]]
        if not any(pair[0] in body and pair[1] in body for body in robot.get("bodies", [])):
            verdict = ask(with_open(robot, *pair), "check")["verdict"]
            expect(name, (verdict == "safe") == (pair not in bad), "cut", pair, verdict)


def try_strengths(name, robot):
    """Hardly any scatter changes nothing; twice the weight halves the limit load."""
    base = ask(robot, "check")
    report = ask(robot, "check", "--scatter", "0.01%")
    found = report.get("reliability")
    holds = base["verdict"] == "safe"
    expect(name, found or not holds, "no probability", report)
    if found and holds == (ratio(base) < 1) and abs(ratio(base) - 1) > 0.01:
        expect(name, (found["probability_holds"] > 0.5) == holds, "scatter", found)
    limits = [ask({**robot, "gravity_m_s2": [0, 0, g]}, "check", "--limit")["limit_load_factor"]
              for g in (-9.80665, -19.6133)]
    expect(name, (limits[0] is None) == (limits[1] is None), "limit", limits)
    if limits[0] is not None:
        expect(name, abs(limits[0] / limits[1] - 2) < 1e-3, "limit", limits)
        expect(name, not holds or limits[0] > 1 - 1e-6, "limit of a safe robot", limits)


def try_shapes(name, robot):
    """Of stiff modules the deformed shape is the shape, or it is undecided."""
    stiff = copy.deepcopy(robot)
    stiff.setdefault("material", {})["elastic_modulus_mpa"] = 1e7
    plain, deformed = ask(stiff, "check"), ask(stiff, "check", "--deformed")
    expect(name, deformed["verdict"] in (plain["verdict"], "undecided"), "deformed", deformed)
    heavy = {**robot, "gravity_m_s2": [0, 0, -9.80665 * 20]}
    fall = ask(heavy, "check", "--cascade")["cascade"]
    rest = only(heavy, fall["standing"])
    for pair in (e for one in fall["rounds"] for e in one.get("broken", [])):
        if pair["a"] in rest["modules"] and pair["b"] in rest["modules"]:
            rest = with_open(rest, pair["a"], pair["b"])
    if fall["outcome"] in ("settles", "holds") and rest["modules"]:
        expect(name, ask(rest, "check")["verdict"] == "safe", "what stands", fall["outcome"])


def try_plans(name, robot):
    """Places, orders and steps, each state as a file of its own."""
    for place in ask(robot, "next", "--limit", "0", "--exact")["candidates"][::5]:
        verdict = ask({**robot, "planned": [place["cell"]]}, "check")["verdict"]
        expect(name, verdict == place["verdict"], "place", place, verdict)
    for cell in robot["modules"]:
        part = only(robot, [m for m in robot["modules"] if m != cell])
        verdict = ask(part, "check")["verdict"]
        report = ask({**robot, "steps": [{"detach": [cell]}]}, "steps", "--exact")
        if cell not in in_bodies(robot) and verdict != "refused":
            found = report["steps"][0]["stages"]["connect"]["verdict"]
            expect(name, found == verdict, "detach", cell, found, verdict)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "order.json")
        ask(robot, "order", "--seconds", "5", "-o", path)
        if not os.path.exists(path):
            return
        with open(path, encoding="utf-8") as file:
            plan = json.load(file)
    cells = list(plan["modules"])
    for step in plan["steps"]:
        cells += step["attach"]
        verdict = ask(only(robot, cells), "check")["verdict"]
        expect(name, verdict == "safe", "order", step, verdict)


def turned(robot, turn):
    """The robot with all cells turned so; the pitch along x and y stays with its axis."""
    def walk(value):
        is_cell = isinstance(value, list) and len(value) == 3 and isinstance(value[0], int)
        if is_cell:
            return turn(value)
        if isinstance(value, list):
            return [walk(one) for one in value]
        return {k: walk(v) for k, v in value.items()} if isinstance(value, dict) else value

    other = {k: v if k == "material" else walk(v) for k, v in robot.items()}
    if "material" in robot and turn([1, 0, 0])[0] == 0:
        x, y, z = robot["material"]["pitch_mm"]
        other["material"] = {"pitch_mm": [y, x, z]}
    return other


def try_other_views(name, robot):
    """Mirrored and turned it is the same robot; modules say what check says, or why not."""
    base = ask(robot, "check")
    for turn in (lambda c: [-c[0], c[1], c[2]], lambda c: [-c[1], c[0], c[2]]):
        other = ask(turned(robot, turn), "check")
        expect(name, other["verdict"] == base["verdict"], "turned", other["verdict"])
        expect(name, abs(ratio(other) - ratio(base)) < 1e-5, "turned", ratio(other), ratio(base))
    own = ask(robot, "simulate")["verdict"]
    expect(name, own in (base["verdict"], "undecided", "refused"), "simulate", own)
    if "material" not in robot and "floor" not in robot:
        expect(name, own == base["verdict"], "simulate", own)


def main():
    count = 0
    for shape, cells in SHAPES.items():
        for names in itertools.combinations(FEATURES, 2):
            robot = {"format": "holdfast-structure", "version": 2, "modules": cells}
            for feature in names:
                robot.update(copy.deepcopy(FEATURES[feature]))
            robot = only(robot, cells)
            name = " + ".join((shape, *names))
            if ask(robot, "check")["verdict"] == "refused":
                expect(name, False, ask(robot, "check"))
                continue
            for attempt in (try_losses, try_strengths, try_shapes, try_plans, try_other_views):
                attempt(name, robot)
            count += 1
    print(f"{count} robots, {len(faults)} faults")
    return 1 if faults or count != 20 else 0


if __name__ == "__main__":
    sys.exit(main())
