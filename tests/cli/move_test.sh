#!/usr/bin/env bash
# move_test.sh PROGRAM REPOSITORY   holdfast move as its users run it: answers, files, interrupts,
# bad input.
set -euo pipefail
program=$1
scenarios=$2/scenarios/plan
# shellcheck source=tests/cli/expect.sh
. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"

# expect_refusal CODE TEXT ARGUMENTS...   one clear line that says TEXT
expect_refusal() {
  local text=$2
  expect_exit "$1" move "${@:3}"
  [ "$(wc -l <err)" -eq 1 ] || fault "not one line: ${*:3}: $(head -c 600 err)"
  grep -Eq -- "$text" err || fault "'$text' is not said: $(cat err)"
}

# shape FILE CELLS   a structure of these cells on a floor
shape() { printf '{"format": "holdfast-structure", "version": 1, "modules": [%s]}' "$2" >"$1"; }

from=$scenarios/around_arm_from.json
to=$scenarios/around_arm_to.json
plane=--within=-9,0,-9:9,0,9

# A plan, which holdfast steps finds safe; and the shorter one of geometry alone, which is not.
expect_exit 0 move "$from" "$to" "$plane" -o safe.json --json report.json
expect_line out '^FOUND +9 steps, and no plan has fewer$'
expect_line report.json '"certificate": null'
expect_exit 0 steps safe.json
expect_exit 0 move "$from" "$to" "$plane" --geometry-only -o short.json
expect_line out '^FOUND +8 steps'
expect_line out '4 of them not safe'
expect_exit 1 steps short.json
expect_exit 64 steps short.json --vtk short.vtu
expect_line err 'short.vtu: .* expected a name that ends with .pvd'

# A row cannot go on in its own layer: proved, and proved again.
shape row.json '[0,0,0],[1,0,0],[2,0,0]'
shape next.json '[1,0,0],[2,0,0],[3,0,0]'
shape tower.json '[0,0,0],[0,0,1],[0,0,2]'
layer=--within=0,0,0:3,0,0
expect_exit 1 move row.json next.json $layer --json none.json
expect_line out '^NONE'
expect_line none.json '"reason": "exhausted"'
expect_exit 0 move row.json next.json $layer --verify none.json
expect_line out '^PROVED +no safe moves lead there: [0-9]+ shapes? (that can|from which)'
expect_line out '^  robot +row, 3 modules$'
expect_line out '^  to +next, 3 modules$'
expect_line out '^  steps +1 module at a time, along its neighbours, within \(0,0,0\) to \(3,0,0\)$'
sed 's/"exhausted"/"tired"/' none.json >tired.json
expect_refusal 65 'expected target or exhausted' row.json next.json $layer --verify tired.json
sed 's/"end": "[a-z]*"/"end": "middle"/' none.json >middle.json
expect_refusal 65 'expected start or target' row.json next.json $layer --verify middle.json
echo old >kept.json
expect_exit 1 move row.json next.json $layer -o kept.json
expect_line err 'kept.json: note: not written, as there are no moves'
expect_line kept.json '^old$'
expect_refusal 65 'across the border' row.json next.json --verify none.json
expect_refusal 65 'a report with a certificate' "$from" "$to" --verify report.json

# Steps as lines: standard output has nothing else, and they are those of the plan.
expect_exit 0 move "$from" "$to" "$plane" --stream -o streamed.json
python3 - <<'PYTHON' || fault 'lines are not the plan'
import json
lines = [json.loads(line) for line in open('out')]
steps = [step['move'][0] for step in json.load(open('streamed.json'))['steps']]
assert [(line['from'], line['to']) for line in lines[:-1]] == [(s['from'], s['to']) for s in steps]
assert lines[-1]['result'] == 'found' and lines[-1]['steps'] == len(steps) == 9
PYTHON
expect_exit 1 move row.json next.json $layer --stream
python3 -c 'import json; line, = open("out"); assert json.loads(line)["result"] == "none"' ||
  fault 'lines where there is no plan'
expect_exit 64 move "$from" "$to" --stream --json -
expect_exit 64 move "$from" "$to" --stream --geometry-only

# Modules that stay, as cells, in a box or in a file; cells that nobody enters or sweeps.
shape bend.json '[0,0,0],[1,0,0],[1,0,1]'
shape foot.json '[0,0,0],[1,0,0]'
expect_exit 0 move row.json bend.json --keep foot.json --avoid 2,0,1 -o around.json
expect_line out '^FOUND +2 steps'
expect_exit 0 steps around.json
! grep -q '"to": \[2,0,1\]' around.json || fault 'a module goes where none may'
expect_exit 0 move row.json bend.json --keep 1,0,0:0,9,0
expect_line out '^FOUND +1 step,'
barred='--keep 0,0,0 --keep 1,0,0 --avoid 2,0,1 --within 0,0,0:3,0,3'
# shellcheck disable=SC2086
expect_exit 1 move row.json bend.json $barred --json barred.json
# shellcheck disable=SC2086
expect_exit 0 move row.json bend.json $barred --verify barred.json
expect_line out 'within .* to \(3,0,3\), 2 modules kept, 1 cell avoided$'
expect_refusal 65 'of start and target the wrong one' row.json bend.json --verify barred.json
expect_refusal 65 '.2,0,0. is to be kept, and the target' row.json bend.json --keep 2,0,0
expect_refusal 65 'the cell .1,0,1. is to be kept, but no module' row.json bend.json --keep 1,0,1
expect_refusal 65 'the box from .* is to be kept, but no' row.json bend.json --keep 5,5,5:6,6,6
expect_refusal 65 '^holdfast: no.json: no such file' row.json bend.json --keep no.json
expect_refusal 65 '.1,0,1. is to be avoided, but the target' row.json bend.json --avoid 0,0,1:2,0,1
expect_refusal 65 '.2,0,0. is to be avoided, but the robot' row.json bend.json --avoid 2,0,0
expect_exit 64 move row.json bend.json --keep 0:0
expect_exit 64 move - bend.json --keep - <foot.json
expect_exit 64 move row.json bend.json --avoid foot.json
expect_exit 64 move row.json bend.json --avoid 0,0,0:999,999,1
expect_exit 64 move row.json bend.json --keep foot.json -o foot.json

# A plan that is gone on with, after some of its steps, from elsewhere, and under other rules.
expect_exit 0 move "$from" --continue safe.json --at 3 "$plane" -o rest.json --json rest_report.json
expect_line out '^  kept +the last 6 steps of the plan, after 0 new$'
expect_line rest_report.json '"kept": 6'
expect_exit 0 steps rest.json
python3 - <<'PYTHON' || fault 'other steps are left'
import json
plan, rest = (json.load(open(name)) for name in ('safe.json', 'rest.json'))
assert rest['steps'] == plan['steps'][3:]
modules = plan['modules'] = [module if isinstance(module, dict) else {'cell': module}
                             for module in plan['modules']]
for step in plan.pop('steps')[:4]:
    move, = step['move']
    moved, = (module for module in modules if module['cell'] == move['from'])
    moved['cell'] = move['to']
for name, cell in (('there', move['to']), ('back', move['from'])):
    moved['cell'] = cell
    json.dump(plan, open(f'{name}.json', 'w'))
PYTHON
expect_exit 0 move there.json --continue safe.json "$plane"
expect_line out '^  kept +the last 5 steps of the plan, after 0 new$'
expect_exit 0 move back.json --continue safe.json "$plane" --stream -o rest.json
[ "$(wc -l <out)" -eq 7 ] || fault 'not as many lines as steps, and the result'
expect_exit 0 steps rest.json
expect_refusal 65 'safe.json: it has 9 steps, of which' "$from" --continue safe.json --at 10
expect_refusal 65 'safe.json: it is a plan of another robot' row.json --continue safe.json
expect_refusal 65 'row.json: it has no steps' next.json --continue row.json
expect_exit 64 move "$from" "$to" --continue safe.json
expect_exit 64 move "$from" --continue safe.json --geometry-only
expect_exit 64 move "$from" "$to" --at 2
expect_exit 64 move "$from" --continue safe.json -o safe.json

# Nothing to do: the file is FROM, without steps.
expect_exit 0 move row.json row.json -o same.json
expect_exit 0 check same.json

# Time that is over at once, and an interrupt: what there is so far is left.
expect_exit 2 move row.json tower.json --seconds 0
expect_line out '^NOT FOUND'
# slab X   two rows of twenty cells, the first at x = X
slab() { for i in $(seq 0 19); do printf '[%d,%d,0],[%d,%d,0],' "$1" "$i" $(($1 + 1)) "$i"; done; }
shape here.json "$(slab 0)[0,20,0]"
shape far.json "$(slab 100)[100,20,0]"
for patience in 3 15 60; do  # A slow machine has nothing yet after a short while.
  "$program" move here.json far.json -o part.json -q &
  process=$!
  sleep "$patience"
  kill -INT "$process"
  code=0
  wait "$process" || code=$?
  [ "$code" -eq 2 ] || fault "exit $code of an interrupted search"
  [ ! -f part.json ] || break
done
expect_exit 0 steps part.json

# Bad input.
shape less.json '[0,0,0],[1,0,0]'
shape parts.json '[0,0,0],[1,0,0],[5,0,0]'
shape tips.json '[0,0,0],[0,0,1],[1,0,1],[2,0,1]'
shape four.json '[0,0,0],[1,0,0],[2,0,0],[3,0,0]'
expect_refusal 65 'has 3 modules and its target 2' row.json less.json
expect_refusal 65 'the target: ' row.json parts.json
expect_refusal 65 'the robot is unstable before any step' tips.json four.json
expect_refusal 65 'missing.json' row.json missing.json
shape planned.json '[0,0,0],[1,0,0]], "planned": [[2,0,0]'
expect_refusal 65 '^holdfast: planned.json: /planned: the robot has planned' planned.json next.json
expect_refusal 65 '^holdfast: planned.json: /planned: the target has planned' row.json planned.json
expect_exit 1 move four.json tips.json
expect_line out 'the target itself is not safe: unstable'
expect_exit 64 move row.json tower.json --seconds -1
expect_exit 64 move row.json tower.json --seconds never
expect_exit 64 move row.json tower.json --seconds nan
expect_exit 64 move row.json tower.json --seed -1
expect_exit 64 move row.json tower.json --seed 18446744073709551616
expect_exit 64 move row.json tower.json --within 1,2,3
expect_exit 64 move row.json tower.json -o row.json

[ "$faults" -eq 0 ] || exit 1
echo "move: all as expected"
