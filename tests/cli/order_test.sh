#!/usr/bin/env bash
# order_test.sh PROGRAM   holdfast order: what it says of a start; and, where it finds none, that
# what there is is left, whether time runs out or somebody interrupts it, every state safe.
set -euo pipefail
program=$1
# shellcheck source=tests/cli/expect.sh
. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"

# expect_part FILE MODULES SHARE   some safe steps of a robot that begins with so many modules and
# ends with fewer (SHARE below) or more (SHARE above) of them
expect_part() {
  "$program" steps "$1" -q || fault "not safe: $1"
  python3 - "$@" <<'PYTHON' || fault "$1 is no part of an order"
import json, sys
document = json.load(open(sys.argv[1]))
steps = document['steps']
begin = len(document['modules'])
end = begin + sum(len(step.get('attach', [])) - len(step.get('detach', [])) for step in steps)
assert steps and begin == int(sys.argv[2]), (begin, len(steps))
assert 0 < end < 640 and (end < begin) == (sys.argv[3] == 'below'), end
PYTHON
}

structure() { printf '{"format": "holdfast-structure", "version": 1, %s}' "$2" >"$1"; }

# Of the start only modules count, and it says so.
structure tower.json '"modules": [[0,0,0], [0,0,1], [0,0,2]]'
structure other.json '"modules": [[0,0,0]], "support_z": -1, "oops": 1'
structure planned.json '"modules": [[0,0,0]], "planned": [[0,0,1]]'
expect_exit 65 order tower.json --from other.json
expect_exit 0 order tower.json --from other.json --allow-unknown
expect_line err "other.json: note: /oops: the key 'oops' is unknown"
only_cells="note: only its cells are taken, all else is the target's"
expect_line err "other.json: $only_cells, which differs in support_z"
printf '{"format": "holdfast-structure", "version": 2, %s}' \
  '"modules": [[0,0,0]], "floor": {"friction": 0.5}' >smooth.json
expect_exit 0 order tower.json --from smooth.json
expect_line err "smooth.json: $only_cells, which differs in floor"
# A load of zero is none.
printf '{"format": "holdfast-structure", "version": 2, %s}' \
  '"modules": [[0,0,0]], "loads": [{"cell": [0,0,0], "force_n": [0,0,0]}]' >idle.json
expect_exit 0 order tower.json --from idle.json
! grep -q 'which differs' err || fault 'a load of zero differs from none'
expect_exit 65 order tower.json --from planned.json
expect_line err 'planned.json: it has planned modules or steps'

# No order of it is known, and no proof that there is none.
"$program" generate portal 24 -o portal.json
for patience in 1 5 20; do # A slow machine has nothing yet after a short while.
  expect_exit 2 order portal.json --seconds "$patience" -o part.json --json report.json
  [ ! -f part.json ] || break
done
expect_part part.json 1 above
expect_line out '^  as far as   [0-9]+ of 640 modules, by [0-9]+ steps, every state on the way'
expect_line report.json '"result": "not-found"'

expect_exit 2 order portal.json --seconds 0 -o nothing.json --certificate nothing.txt
expect_line err 'nothing.json: note: not written, as there are no steps'
expect_line err 'nothing.txt: note: not written, as it is not proved that there is no order'

for signal in INT TERM; do
  for patience in 4 15 60; do
    code=0
    rm -f left.json
    "$program" order portal.json --reverse -o left.json -q &
    process=$!
    sleep "$patience"
    kill -s "$signal" "$process"
    wait "$process" || code=$?
    [ "$code" -eq 2 ] || fault "exit $code of a search that was interrupted by SIG$signal"
    [ ! -f left.json ] || break
  done
  expect_part left.json 640 below
done

# Several at a time: the steps are marked, and the program judges every part of each.
"$program" generate ball 5 -o ball.json
expect_exit 0 order ball.json --parallel 4 -o several.json --json several_report.json
grep -q '"any_order": true' several.json || fault 'no step is marked'
expect_exit 0 steps several.json
python3 - <<'PYTHON' || fault 'no schedule of four at a time'
import json
steps = json.load(open('several.json'))['steps']
report = json.load(open('several_report.json'))
assert max(len(step['attach']) for step in steps) == 4
assert report['steps'] == len(steps) >= report['parallel']['steps_least']
PYTHON
expect_exit 0 order ball.json --parallel all --reverse -o back.json
expect_exit 0 steps back.json
# A step of which one part topples: together they stand.
printf '{"format": "holdfast-structure", "version": 2, "modules": %s, "steps": [%s]}' \
  '[[0,0,0], [0,0,1], [1,0,1]]' '{"attach": [[2,0,1], [-1,0,1]], "any_order": true}' >parts.json
expect_exit 1 steps parts.json
expect_line out 'that is when of 2 modules in any order one alone is there: .2,0,1.'
sed -i 's/true/false/' parts.json
expect_exit 0 steps parts.json
sed -i 's/"any_order": false/"detach": [[1,0,1]], "any_order": true/' parts.json
expect_exit 65 steps parts.json
expect_line err 'only a step that attaches, or only detaches, is done in any order'
expect_exit 64 order ball.json --parallel 0
expect_exit 64 order ball.json --parallel some
expect_exit 64 order ball.json --parallel 2 --group 2
expect_exit 64 order ball.json --parallel 2 --strength-needed
expect_exit 65 order ball.json --parallel 2 --lose-one

# Steps as lines: standard output has nothing else, and they are the order.
expect_exit 0 order ball.json --parallel 4 --stream --json streamed.json
python3 - <<'PYTHON' || fault 'lines are not the order'
import json
lines = [json.loads(line) for line in open('out')]
report = json.load(open('streamed.json'))
assert lines[0]['start'] == report['start']
assert [line['attach'] for line in lines[1:-1]] == [step['attach'] for step in report['way'][1:]]
assert lines[-1]['result'] == 'found' and lines[-1]['steps'] == len(lines) - 2
PYTHON
expect_exit 2 order portal.json --seconds 0 --stream
python3 -c 'import json; line, = open("out"); line = json.loads(line); line.pop("seconds")
assert line == {"result": "not-found", "steps": 0, "reason": "time"}, line' || fault 'no steps'
for clash in '--json -' '-o -' '--csv -' '--certificate -' '--strength-needed'; do
  # shellcheck disable=SC2086
  expect_exit 64 order ball.json --stream $clash
done

# A plan that is gone on with.
expect_exit 0 order ball.json -o plan.json
expect_exit 0 order ball.json --continue plan.json --at 12 -o rest.json --json rest_report.json
expect_line rest_report.json '"kept": 30'
python3 -c 'import json; r = json.load(open("rest_report.json"))
assert r["load_ratio_max"] <= r["load_ratio_bound"]' || fault 'a state exceeds the bound of all'
expect_exit 0 steps rest.json
# As it is: the module of the sixth step is missing after ten.
python3 - <<'PYTHON'
import json
plan = json.load(open('plan.json'))
steps = [step['attach'][0] for step in plan.pop('steps')]
plan['modules'] += steps[:5] + steps[6:10]
json.dump(plan, open('now.json', 'w'))
plan['modules'].append([50, 0, 0])
json.dump(plan, open('far.json', 'w'))
PYTHON
expect_exit 0 order now.json --continue plan.json -o rest.json --stream
expect_exit 0 steps rest.json
expect_exit 65 order ball.json --continue plan.json --at 43
expect_line err 'plan.json: it has 42 steps, of which 43 cannot be done'
expect_exit 65 order tower.json --continue plan.json --at 1
expect_line err 'plan.json: it is a plan of another robot: they differ in '
cp ball.json idle_plan.json
expect_exit 65 order ball.json --continue idle_plan.json
expect_line err 'idle_plan.json: it has no steps; expected a plan'
expect_exit 65 order far.json --continue plan.json
expect_exit 65 order now.json --continue plan.json --reverse
expect_line err 'it attaches modules, which --reverse cannot go on with'
expect_exit 64 order ball.json --at 3
expect_exit 64 order ball.json --continue plan.json --from now.json
expect_exit 64 order ball.json --continue plan.json -o plan.json
expect_exit 0 order ball.json --reverse -o apart.json
expect_exit 0 order ball.json --continue apart.json --at 7 -o left.json
expect_exit 0 steps left.json

# Modules that no step touches: there at first, and left in the end.
structure pair.json '"modules": [[0,0,0], [0,0,1]]'
expect_exit 0 order tower.json --keep pair.json --json kept_report.json
expect_line kept_report.json '"start": \[\[0,0,0\], ?\[0,0,1\]\]'
expect_exit 0 order tower.json --reverse --keep 0,0,0:0,0,1 -o down.json
expect_exit 0 steps down.json
! grep -q '"detach": \[\[0,0,[01]\]\]' down.json || fault 'a kept module is detached'
expect_exit 65 order tower.json --keep 0,0,3
expect_line err 'tower.json: the cell .0,0,3. is to be kept, but no module is there'
structure foot.json '"modules": [[0,0,0]]'
expect_exit 65 order tower.json --from foot.json --keep 0,0,1
expect_line err 'foot.json: the module .0,0,1. is to be kept, and is not in the start'
expect_exit 65 order tower.json --keep 0,0,2
expect_line err 'the start is what is fixed and what is to be kept: give one that holds it'
expect_exit 65 order now.json --continue plan.json --keep 50,0,0
expect_exit 0 order ball.json --continue apart.json --at 7 --keep 0,0,0:1,0,0 -o left.json
expect_exit 0 steps left.json
python3 - <<'PYTHON' || fault 'a kept module is taken away'
import json
gone = [cell for step in json.load(open('left.json'))['steps'] for cell in step['detach']]
assert gone and not any(cell in gone for cell in ([0, 0, 0], [1, 0, 0])), gone
PYTHON

# In pieces: an arch that holds from both feet only.
cat >small_arch.json <<'JSON'
{"format": "holdfast-structure", "version": 2, "name": "small arch", "support_z": 0,
 "material": {"strength_lateral_n": 0.8},
 "modules": [[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2], [2, 0, 2], [3, 0, 2], [4, 0, 2],
             [4, 0, 1], [4, 0, 0]]}
JSON
expect_exit 0 check small_arch.json
expect_exit 1 order small_arch.json --help-seconds 0 --certificate none.json
expect_line out 'NONE        there is no safe order that keeps the robot in one piece'
! grep -q -- '--pieces' out || fault 'what nobody has sought is recommended'
expect_exit 1 order small_arch.json --json apart_report.json
expect_line out '^  suggestion  in several pieces there is an order: seek it with --pieces$'
expect_line apart_report.json '"pieces": true'
expect_exit 0 order small_arch.json --pieces -o from_both.json --json from_both_report.json
grep -q '"apart": true' from_both.json || fault 'no step is marked'
expect_exit 0 steps from_both.json
sed 's/, "apart": true//' from_both.json >lone.json
expect_exit 65 steps lone.json
expect_line err 'is not next to the robot, directly or through other new modules'
expect_exit 0 order small_arch.json --pieces --reverse -o down.json
expect_exit 0 steps down.json
sed -i 's/"strength_lateral_n": 0.8/"strength_lateral_n": 0.3/' small_arch.json
expect_exit 1 order small_arch.json --pieces --help-seconds 0 --certificate no_pieces.json
expect_exit 0 steps no_pieces.json --verify
expect_line out 'in one piece or in several'
expect_exit 64 order small_arch.json --pieces --group 2
expect_exit 64 order small_arch.json --pieces --parallel 2
expect_exit 64 order small_arch.json --pieces --continue from_both.json

[ "$faults" -eq 0 ] || exit 1
echo "order: all as expected"
