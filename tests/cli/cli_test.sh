#!/usr/bin/env bash
# cli_test.sh PROGRAM REPOSITORY   runs the program as its users do: exit codes, outputs, bad input.
set -euo pipefail
program=$1
repository=$2
# shellcheck source=tests/cli/expect.sh
. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"

# expect_refusal TEXT FILE   exit 65 and one clear line that names the file and says TEXT
expect_refusal() {
  expect_exit 65 check "$2"
  [ "$(wc -l <err)" -eq 1 ] || fault "$2: not one line: $(head -c 600 err)"
  [ "$(wc -c <err)" -lt 500 ] || fault "$2: a line of $(wc -c <err) bytes"
  grep -Fq "holdfast: $2: " err || fault "the file is not named: $(cat err)"
  grep -Eq -- "$1" err || fault "$2: '$1' is not said: $(cat err)"
}

scenarios=$repository/scenarios
safe=$scenarios/arm_breaks_a.json
overload=$scenarios/arm_breaks_b.json
unstable=$scenarios/arm_tips_c.json

# Verdicts and exit codes.
expect_exit 0 check "$safe"
expect_line out "^SAFE +arm_breaks_a$"
expect_line out 'load ratio +0\.6402 +\(2,1,2\)-\(3,1,2\)'
expect_exit 1 check "$overload"
expect_line out '^OVERLOAD'
expect_line out '\(2,1,2\)-\(3,1,2\), is loaded to 120\.04 % of its strength'
expect_exit 1 check "$unstable"
expect_line out '^UNSTABLE'
expect_line out '8\.00 mm beyond it'
expect_exit 0 check --quiet "$safe"
[ -s out ] && fault "--quiet prints: $(cat out)"
expect_exit 1 check "$safe" "$overload" "$unstable"
expect_line out '^3 files: 1 safe, 1 overload, 1 unstable, 0 undecided, 0 not readable$'
"$program" check - <"$safe" >out || fault "standard input is not read"

# Where the next module may go: 0 if a place is safe, 1 if none is.
expect_exit 0 next "$safe" --json next.json --svg next.svg --limit 3
expect_line out '^arm_breaks_a: 11 modules, 37 places for the next: 36 safe'
expect_line next.json '"candidates"'
# A bar of five on a post of three breaks and does not topple.
printf '{"format": "holdfast-structure", "version": 2, "modules": [[0,0,0], [1,0,0], [2,0,0],
  [0,0,1], [0,0,2], [1,0,2], [2,0,2], [3,0,2], [4,0,2], [5,0,2]]}' >crane.json
expect_exit 1 check crane.json --remedies
expect_line out '^  would hold  with one more module at \(2,0,1\): load ratio 0[.]3601; 2 of'
expect_line out '^              with a prop in \(4,0,1\), below a module: load ratio 0'
expect_line out '^              with connections 1[.]2[0-9] times as strong$'
expect_exit 1 check crane.json --remedies --json crane_report.json
expect_line crane_report.json '"remedies"'
expect_refusal '/format: expected a structure, found a report' crane_report.json
expect_exit 1 check crane.json crane.json --remedies
[ "$(grep -c '^  would hold  ' out)" -eq 2 ] || fault "not the remedies of both: $(cat out)"
expect_exit 0 check "$safe" --remedies
if grep -q 'would hold' out; then fault 'remedies for a structure that is safe'; fi
expect_line next.svg 'place for the next module'
expect_exit 0 next "$safe" --json - --quiet
expect_line out '"seconds"'
expect_exit 0 generate arm 29 -o long.json
expect_exit 1 next long.json --quiet
expect_exit 64 next "$safe" --json same --svg same
expect_exit 64 chekc "$safe"
expect_line err "no command 'chekc'; did you mean 'check'"
expect_exit 64 new arch 20
expect_line err "no command 'new'; did you mean 'generate'"
expect_exit 64 check "$safe" --png arm.png
expect_line err "no option '--png'; --svg FILE[.]png writes one$"
expect_exit 64 check "$safe" --json ''
expect_line err '^holdfast check: --json: the value is empty$'
expect_exit 65 next missing.json

# Proofs: arm_breaks_b carries 1.200397996 (tests/reference), arm_breaks_a 0.6402122645.
checker=$(dirname "$program")/holdfast-checker
for built in "$program" "$checker"; do
  # What debuggers read may say where the sources are, nothing else may.
  grep -aq '[.]debug_line' "$built" || ! grep -aq "$repository/" "$built" ||
    fault "$built knows the folder that it was built in"
done
expect_exit 0 check --prove "$safe"
expect_line out '^SAFE'
expect_line out 'proof +the .* ratio lies between 0\.64021226[0-9]* and 0\.64021226[0-9]*;'
expect_exit 1 check "$overload" --certificate proof.txt --json proof.json
expect_line proof.json '"proved": true'
code=0
"$checker" proof.txt >out || code=$?
[ "$code" -eq 1 ] || fault "the checker does not prove an overload: $code $(cat out)"
expect_line out '^  verdict +OVERLOAD: a connection breaks$'
expect_line out "one solution of the paper's contact law, which may have others"
expect_line out '^PROVED .* between 1\.2003979959[0-9]* and 1\.2003979959[0-9]*$'
expect_line out '^  contact +regularised; 14 connections, 3 facets on the ground$'
expect_line out '^  robot +arm_breaks_b, 13 modules'
# The robot is told by what sha256sum makes of the certificate's own lines.
own_digest() {
  { sed -n '/^pitch_mm/,/^support_z/p' "$1"
    awk '/^existing/ { kind = "existing"; next } /^planned/ { kind = "planned"; next }
         /^fields/ { exit } kind { print $1, $2, $3, $4, kind }' "$1" | LC_ALL=C sort
  } | sha256sum | cut -d' ' -f1
}
expect_line out "^  digest +$(own_digest proof.txt)\$"
expect_line proof.json "\"digest\": \"$(own_digest proof.txt)\""
sed 's/^3 1 0 ground pressed 00$/3 1 0 ground open 00/' proof.txt >forged.txt
code=0
"$checker" forged.txt >out 2>err || code=$?
[ "$code" -eq 65 ] || fault "the checker takes a changed certificate: $code $(cat out err)"
code=0
"$checker" "$safe" >out 2>err || code=$?
[ "$code" -eq 65 ] || fault "the checker takes a structure: $code"
for arguments in '64 --verison' '65 .' '65 missing.txt'; do
  code=0
  "$checker" "${arguments#* }" >out 2>err || code=$?
  [ "$code" -eq "${arguments% *}" ] || fault "holdfast-checker $arguments: exit $code"
  expect_line err "^holdfast-checker: (there is no option '--verison'|[.]: expected a certificate,|\
missing.txt: cannot be read: No such file)"
done
[ "$("$checker" --version)" = "$("$program" --version | sed s/holdfast/holdfast-checker/)" ] ||
  fault "the checker is of another version: $("$checker" --version)"
expect_exit 0 check "$safe" --certificate safe_proof.txt
"$checker" safe_proof.txt >out || fault "the checker does not prove what is safe: $(cat out)"
expect_line out '^  verdict +SAFE: no connection breaks, and the robot stands$'
expect_exit 0 check "$unstable" --bonded --certificate bonded_proof.txt
"$checker" bonded_proof.txt >out || fault "the checker does not prove a bonded robot: $(cat out)"
expect_line out 'neither lift nor tilt: it topples if it only rests on them'
expect_exit 1 check "$unstable" --certificate none.txt
expect_line err 'no certificate: the robot topples'
grep -q older err && fault "an older file where there is none"
[ -e none.txt ] && fault "a certificate of a robot that topples"
expect_exit 1 check "$unstable" --certificate proof.txt
expect_line err 'proof.txt: no certificate: .*; what stands in this file is older'
expect_exit 64 check "$safe" "$overload" --certificate both.txt

# The robot's own verdict.
expect_exit 0 simulate "$safe"
expect_line out "^SAFE +arm_breaks_a$"
expect_line out 'robot +safe, load ratio 0\.640[0-9] +\(2,1,2\)-\(3,1,2\); all modules agree'
expect_line out 'memory +[0-9]+ bytes in each module'
expect_exit 1 simulate "$overload" --link unit --seed 7 --loss 0.1 --json simulated.json \
  --svg own.svg
expect_line simulated.json '"all_modules_agree": true'
# Modules refuse to call safe a soft pole, which stands by linear theory.
python3 -c 'import json; print(json.dumps({"format": "holdfast-structure", "version": 2,
  "material": {"elastic_modulus_mpa": 2}, "modules": [[0, 0, z] for z in range(30)],
  "steps": [{"attach": [[0, 0, 30]]}]}))' >pole.json
expect_exit 2 simulate pole.json
expect_line out '^UNDECIDED'
expect_line out "the robot's own verdict: bending may matter"
expect_line out 'robot +undecided'
for mode in --next --steps --stages; do
  expect_exit 2 simulate pole.json $mode
  expect_line out 'undecided'
done
expect_line own.svg '</svg>'
expect_exit 1 simulate "$unstable" --link v2 --quiet
[ -s out ] && fault "--quiet prints: $(cat out)"
expect_exit 2 simulate "$safe" --kill 2,1,1@0.5
expect_line out 'does not answer'
expect_exit 2 simulate "$safe" --cut 2,1,1:+z@0.5
expect_exit 0 simulate "$safe" --link unit --story story.txt
expect_line story.txt 'knows the verdict: safe'
expect_exit 0 simulate "$safe" --link unit --trace trace.json
python3 -c 'import json; assert len(json.load(open("trace.json"))["traceEvents"]) > 100' ||
  fault "the trace is not complete JSON"
expect_exit 64 simulate "$safe" --kill 9,9,9@0
expect_line err '9,9,9@0: no module is in \(9,9,9\), expected the cell of an existing module'
# Cells as reports and documents write them.
for cell in 2,1,1 '(2,1,1)' '(2, 1, 1)'; do
  "$program" simulate "$safe" --link unit --detach "$cell@900" >"cell$cell" || true
  cmp -s cell2,1,1 "cell$cell" || fault "another answer for $cell: $(cat "cell$cell")"
done
expect_exit 64 simulate "$safe" --detach '(2,1,1@9'
expect_line err 'expected X,Y,Z@TIME, as in'
expect_exit 64 simulate "$safe" --cut 2,1,1:up@9
expect_line err 'FACE one of [+]x, -x'
# Step by step: its planned module comes, the next one is planned, and withdrawn.
expect_exit 0 simulate "$safe" --attach 6,1,2@10 --json steps.json
python3 - <<'PYTHON' || fault "the report of an attached module is wrong"
import json
report = json.load(open('steps.json'))
assert report['modules']['existing'] == 11 and report['modules']['planned'] == 0
assert report['distributed']['verdict'] == report['verdict'] == 'safe'
assert abs(report['distributed']['load_ratio_max'] - 0.6402) < 1e-3
PYTHON
expect_exit 1 simulate "$safe" --attach 6,1,2@10 --plan 7,1,2@20
expect_line out 'robot +overload, load ratio 1\.000[0-9] .*all modules agree'
expect_exit 0 simulate "$safe" --attach 6,1,2@10 --plan 7,1,2@20 --withdraw 7,1,2@30 \
  --story told.txt
expect_line told.txt 'is told that a plan is withdrawn: \(7,1,2\)'
expect_exit 0 simulate "$safe" --withdraw all@9
expect_line out 'exact +safe, load ratio 0\.3601'
expect_line out 'robot +safe, load ratio 0\.360[0-9]'
# One plan, whether it is told once or six times, and whether its cell is free or not.
expect_exit 0 simulate "$safe" --link unit --plan 6,1,2@0 --plan 6,1,2@0 --plan 6,1,2@1 \
  --plan 6,1,2@900 --plan 6,1,2@901 --plan 6,1,2@902 --plan 5,1,2@903
expect_line out 'robot +safe, load ratio 0\.640'
expect_exit 64 simulate "$safe" --plan 7,1,2
expect_line err 'expected X,Y,Z@TIME, as in'
expect_exit 64 simulate "$safe" --withdraw none@1
expect_line err 'or all@TIME'
expect_exit 65 simulate "$safe" --attach 5,1,2@1
expect_line err 'one is there'
expect_exit 65 simulate "$safe" --plan 9,9,9@1
expect_line err 'is not next to the robot'
expect_exit 64 simulate "$safe" --loss 1.5
expect_exit 0 simulate "$safe" --next --link unit --json faces.json --svg faces.svg
expect_line faces.json '"undecided": 0'
expect_exit 64 simulate "$safe" --next --kill 2,1,1@0.5
expect_exit 64 simulate "$safe" --next --steps
expect_exit 64 simulate "$safe" --next --stages
expect_exit 64 simulate "$safe" --steps --stages
expect_exit 64 simulate "$safe" --method magic
expect_exit 0 simulate "$safe" --method fronts --link unit
[ ! -s err ] || fault "fronts of cubes: $(cat err)"
expect_exit 1 simulate "$repository/examples/catoms_hang.json" --method fronts --link unit
[ ! -s err ] || fault "fronts of catoms: $(cat err)"
expect_exit 65 simulate nowhere.json

# Outputs.
expect_exit 1 check "$overload" --json report.json --svg picture.svg --vtk loads.vtu
expect_line report.json '"verdict": "overload"'
expect_line picture.svg '</svg>'
expect_line loads.vtu '</VTKFile>'
expect_exit 1 check "$safe" "$overload" --json -
python3 - <<'PYTHON' || fault "the list of reports is wrong"
import json
reports = json.load(open('out'))
assert [r['verdict'] for r in reports] == ['safe', 'overload']
report = reports[1]
assert report['modules']['existing'] == 11 and report['modules']['planned'] == 2
assert report['stability']['simplified']['stable'] and report['stability']['model']['settled']
assert abs(report['stability']['simplified']['margin_mm'] - 10.769231) < 1e-5
assert report['overload']['at'] == [[2, 1, 2], [3, 1, 2]]
assert abs(report['overload']['load_ratio_max'] - 1.2004) < 1e-4
assert report['overload']['broken'] == [[[2, 1, 2], [3, 1, 2]]]
assert {'a', 'b', 'load_ratio', 'axial_n', 'bending_nmm'} <= set(report['connections'][0])
assert report['contact_model'] == 'regularised' and report['solver']['iterations'] >= 1
assert report['solver']['seconds'] > 0 and report['reasons']
PYTHON

# A choice of connections, and a table of them.
expect_exit 1 check "$overload" --connections 3 --json three.json --csv three.csv
expect_exit 1 check "$overload" --connections broken --json broken.json --csv all.csv --quiet
expect_exit 1 simulate "$overload" --link unit --connections broken --json simulated.json
expect_exit 64 check "$overload" --connections few
expect_line err 'all, broken or a count'
expect_exit 64 check "$overload" --json same.out --csv same.out
expect_exit 64 check "$safe" "$overload" --csv table.csv
expect_exit 0 check "$safe" --csv zeros.csv
expect_line zeros.csv ',0,'
! grep -Eq '(^|,)-0(,|$)' zeros.csv || fault "a zero with a sign in a table"
python3 - <<'PYTHON' || fault "the choice of connections is wrong"
import csv, json
three = json.load(open('three.json'))
broken = json.load(open('broken.json'))
assert len(three['connections']) == 3 and three['reason_codes'] == ['connections_break']
assert broken['connections'] == three['connections'][:1]
assert json.load(open('simulated.json'))['connections'] == broken['connections']
rows = list(csv.DictReader(open('three.csv')))
assert [float(r['load_ratio']) for r in rows] == [c['load_ratio'] for c in three['connections']]
assert [r['breaks'] for r in rows] == ['1', '0', '0'] and rows[0]['direction'] == '+x'
assert [int(rows[0][key]) for key in ('ax', 'ay', 'az')] == [2, 1, 2]
PYTHON

# The README's picture is what the README's command makes.
cmp -s picture.svg "$repository/docs/arm_breaks_b.svg" ||
  fault "docs/arm_breaks_b.svg is out of date"
expect_exit 1 check "$repository/examples/catoms_hang.json" --svg catoms.svg --vtk catoms.vtu
cmp -s catoms.svg "$repository/docs/catoms_hang.svg" ||
  fault "docs/catoms_hang.svg is out of date"
expect_line catoms.vtu '</VTKFile>'

# Conversion there and back keeps everything.
expect_exit 0 convert "$overload" there.xml
expect_exit 0 convert there.xml back.json
expect_exit 0 convert "$overload" direct.json
cmp -s back.json direct.json || fault "conversion to XML and back changes the structure"
expect_exit 1 check there.xml
expect_exit 64 convert "$overload" there.txt

# Version 2 is converted there and back; of a plan of steps the robot before them is checked.
printf '%s' '{"format": "holdfast-structure", "version": 2, "modules": [[0,0,0]],' \
  '"obstacles": [{"cells": [[1,0,0]]}, {"from": [-1,0,0], "to": [-1,2,0], "hold": "bonded"}],' \
  '"loads": [{"cell": [0,0,0], "force_n": [0,0,-1]}]}' >wall.json
expect_exit 0 convert wall.json wall.xml
expect_line wall.xml '<obstacle position="2,0,0" */>'
expect_exit 0 convert wall.xml wall_back.json
expect_exit 0 convert wall.json wall_again.json
cmp -s wall_back.json wall_again.json || fault "conversion to XML and back changes obstacles"
printf '%s' '{"format": "holdfast-structure", "version": 2, "modules": [[0,0,0]],' \
  '"steps": [{"attach": [[1,0,0]]}]}' >plan.json
expect_exit 0 check plan.json
expect_line err 'plan.json: note: 1 step is read; the robot before it is judged'
printf '%s' '{"format": "holdfast-structure", "version": 2, "modules": [[0,0,0]],' \
  '"obstacles": [{"from": [-1000,0,2], "to": [1000,100,2]}]}' >ceiling.json
expect_exit 0 convert ceiling.json ceiling.xml
expect_line err 'of 1 large obstacle VisibleSim is shown the first corner only'

# VisibleSim does not say which modules its files are for.
printf '%s' '<world><blockList><block position="0,0,0" orientation="1"/>' \
  '<block position="0,0,1" orientation="2"/></blockList></world>' >catoms.xml
expect_exit 0 convert catoms.xml catoms.json
expect_line err 'note: .* orientation'
expect_exit 0 convert --lattice catoms3D catoms.xml catoms.json
expect_line catoms.json '"lattice": "face-centred"'
expect_exit 0 simulate --link unit catoms.xml
expect_exit 1 simulate --link unit --lattice catoms3D catoms.xml
expect_exit 65 simulate --next --lattice hexagonal catoms.json
# Said of a file whether an image of the firmware is there or not.
expect_exit 65 emulate --lattice hexagonal --image missing.elf catoms.json
expect_line err "/lattice: the lattice is 'face-centred' here"
expect_exit 64 simulate --lattice fcc catoms.xml
expect_exit 64 convert --lattice fcc catoms.xml catoms.json
expect_line err 'expected cubic, face-centred'
expect_exit 64 check --lattice datoms catoms.xml
expect_line err 'skewed'
expect_exit 65 check --lattice hexagonal catoms.json
expect_line err "/lattice: the lattice is 'face-centred' here"

# Robots that have been built.
expect_exit 0 robots
expect_line out '^rofi .* 110$'
expect_exit 0 robots rofi
expect_line out 'shear_strength_n +50  project page: '
expect_exit 0 robots --json robots.json
expect_line robots.json '"certainty": "not found"'

# A report says its robot and what was asked: not what is the default anyway, nor where it goes.
expect_exit 0 check "$safe" --json head.json -q --set mass_kg=0.05 --set friction=0.4 \
  --connections all --bonded
python3 - "$safe" <<'END' || fault "the head of a report: $(head -n 20 head.json)"
import json, sys
report = json.load(open('head.json'))
assert report['robot'] == {'file': sys.argv[1], 'modules': 11}, report['robot']
assert report['options'] == {'set': ['mass_kg=0.05', 'friction=0.4'], 'bonded': True}, report
END
expect_exit 64 robots roffi
expect_line err 'unknown robot'
expect_exit 0 check --robot rofi "$safe"
expect_exit 64 check --robot roffi "$safe"
expect_line err "unknown robot 'roffi'; did you mean 'rofi'\\?"
expect_exit 64 robots blinky
expect_line err "did you mean 'blinky-blocks'"
expect_exit 65 check --robot smores-ep wall.json
expect_line err 'of the robot smores-ep no mass_kg is published'

# A number out of range is told with its place.
printf '{"format": "holdfast-structure", "version": 1, "modules": [{"cell": [0,0,0]}],
  "material": {"mass_kg": 0}}' >weightless.json
expect_exit 65 check weightless.json
expect_line err 'weightless.json: /material/mass_kg: mass_kg is 0, expected 1e-12 to '

# The rigid body and the model differ, and the report says so.
printf '{"format": "holdfast-structure", "version": 2, "support_z": null, "modules": [[0,0,0]],
  "obstacles": [{"cells": [[-1,0,0], [1,0,0]]}]}' >slot.json
expect_exit 1 check slot.json
expect_line out 'stability +unstable: as a rigid body it holds.*; the elastic model says un'

# Named structures, large ones, bonded supports.
expect_exit 0 generate cube 3
expect_line out '"cube 3"'
expect_exit 0 generate shell 20 -o shell.json
expect_exit 0 check shell.json
expect_line out '^SAFE +shell 20$'
expect_line out 'iterations of multigrid'
expect_exit 0 generate portal 40 -o portal.xml
expect_exit 1 check --bonded --threads 2 portal.xml
expect_line out 'bonded on request'
expect_exit 0 generate bridge 200 -o bridge.json
expect_exit 1 check bridge.json
expect_line out '^UNSTABLE'
expect_line out 'not computed, as the robot topples'
expect_exit 0 generate cube 32 -o cube.json
expect_exit 2 check --memory 0.01 cube.json
expect_line out 'too many for the solver'
expect_exit 64 generate castle 3
expect_line err 'arm, cube, tower'
expect_exit 64 generate arm 3
expect_line err '6 or more'
expect_exit 64 generate cube 1000000
expect_exit 0 generate --help
expect_line out 'scaffold'

# Wrong usage: what is wrong, and where help is; slips are seen.
expect_exit 64
expect_line err '^Usage: holdfast '
expect_usage "^holdfast: there is no command 'chek'; did you mean 'check'\?\$" chek
expect_usage "^holdfast: there is no command 'x'; there are help, check, steps, " x
expect_usage "^holdfast: there is no command 'ordr'; did you mean 'order'" help ordr
expect_usage "^holdfast check: FILE is required\$" check
expect_usage "^Try 'holdfast check --help'\.\$" check
expect_usage "^holdfast check: there is no option '--jsn'; did you mean '--json'\?\$" \
  check a --jsn b
expect_usage "^holdfast check: there is no option '--x'\$" check a --x=1
expect_usage "^holdfast: there is no option '--versoin'; did you mean '--version'" --versoin
for command in move next order steps; do
  expect_usage "^holdfast $command: $command cannot take --deformed: it judges states by linear" \
    "$command" a --deformed
done
expect_usage "^holdfast next: the argument 'b' is one too many, expected FILE\$" next a b
expect_usage "^holdfast move: the argument 'c' is one too many, expected FROM and TO\$" move a b c
expect_usage "^holdfast check: there is no option '--hlep'; did you mean '--help'" check --hlep
expect_usage "^holdfast check: '--json' stands before the command, options stand behind it\$" \
  --json - check a
expect_usage "^holdfast check: --svg: expected a value, found the option --json\$" \
  check a --svg --json -
expect_usage "^holdfast check: --json is given 2 times, expected once\$" check a --json b --json c
expect_usage "^holdfast check: --limit-seconds requires --limit\$" check a --limit-seconds 5
expect_usage "^holdfast generate: SIZE: expected a whole number, such as 20, found '1e3'\$" \
  generate arm 1e3
expect_usage "^holdfast: there is no command 'arm.json'; 'holdfast check arm.json' judges" arm.json
expect_usage "^holdfast help: the argument 'a' is one too many, expected COMMAND\$" help check a
expect_usage "^holdfast check: --json has no value, expected FILE\$" check a --json
expect_usage "^holdfast check: --memory: expected a number from 0.01 to 1024, found 0\$" \
  check a --memory 0
expect_usage "^holdfast check: --threads: expected a whole number from 0 to 64, found two\$" \
  check a --threads two
expect_usage "--link: expected v1, v2, catoms or unit, found 'v3'" simulate a --link v3
expect_usage "--reach: expected free, line or surface, found 'srface'; did you mean 'surface'" \
  order a --reach srface
expect_usage '^holdfast steps: --.* and --.* exclude each other$' steps a --verify --json b
expect_exit 64 check "$safe" "$overload" --svg picture.svg
expect_exit 0 --help
expect_line out '^  check  '
cp out help.txt
expect_exit 0 help
cmp -s out help.txt || fault "holdfast help is not holdfast --help"
for command in check steps next order move simulate emulate convert fit generate robots view; do
  expect_exit 0 "$command" --help
  expect_line out "^Usage: holdfast $command "
  expect_line out "^  holdfast $command "
  for code in ' 0' 64 65 70; do
    sed -n '/^Exit status:/,$p' out | grep -q "^  $code  " ||
      fault "$command --help does not say $code"
  done
  [ "$(wc -L <out)" -le 80 ] || fault "$command --help: a line of $(wc -L <out) columns"
  cp out help.txt
  expect_exit 0 help "$command"
  cmp -s out help.txt || fault "holdfast help $command is not holdfast $command --help"
done
expect_exit 0 -V
expect_line out "^holdfast [0-9]+\.[0-9]+\.[0-9]+$"
expect_exit 0 --version
expect_line out "^holdfast [0-9]+\.[0-9]+\.[0-9]+$"

# Bad input: one line each, exit 65, and the good files beside it are still checked.
json() { printf '{"format": "holdfast-structure", "version": 1, %s}' "$1"; }
expect_refusal 'no such file' missing.json
mkdir folder
expect_refusal 'folder' folder
: >empty.json
expect_refusal 'empty' empty.json
printf '   \n' >blank.xml
expect_refusal 'empty' blank.xml
head -c 1000000 /dev/urandom >noise
expect_refusal '.' noise
json '"modules": [[0,0,0],[0,0,0]]' >double.json
expect_refusal 'the cell \(0,0,0\) is listed twice' double.json
json '"modules": [[0,0,0]], "planned": [[0,0,0]]' >occupied.json
expect_refusal 'planned cell \(0,0,0\) is occupied' occupied.json
json '"modules": [[0,0,0]], "planned": [[5,0,0]]' >loose.json
expect_refusal '\(5,0,0\) is not next to the robot' loose.json
json '"modules": [[0,0,0],[2,0,0]]' >apart.json
expect_refusal 'not connected' apart.json
json '"modules": [[0,0,3],[0,0,4]]' >floating.json
expect_refusal 'lowest module is \(0,0,3\)' floating.json
json '"modules": [[0,0,99999999999999]]' >far.json
expect_refusal '99999999999999' far.json
json '"modules": [[0,0,0]], "material": {"mass_kg": -1}' >negative.json
expect_refusal 'mass_kg' negative.json
json '"modules": []' >none.json
expect_refusal 'module' none.json
printf '{"format": "holdfast-structure", "version": 1}' >sections.json
expect_refusal 'modules' sections.json
head -c 1000000 /dev/zero | tr '\0' '[' >deep.json
expect_refusal 'brackets|nest|deep|array' deep.json
{ printf '<world>'; for _ in $(seq 1000); do printf '<a>%.0s' $(seq 100); done; } >deep.xml
expect_refusal '.' deep.xml
printf '<parameters/>\n<<<<<<< HEAD\n<world/>\n' >conflict.xml
expect_refusal 'line 2.*merge-conflict' conflict.xml
printf '<world gridSize="2,2,2"><blockList><block position="0"/></blockList></world>' >short.xml
expect_refusal 'position' short.xml
expect_exit 65 check "$safe" missing.json "$overload"
expect_line out '1 safe, 1 overload, 0 unstable, 0 undecided, 1 not readable'
expect_exit 65 check "$safe" --json /nowhere/report.json
expect_line err 'cannot be written'

# Names that look like known ones are errors in both formats, and the known name is said; notes go
# to standard error with several files and with --quiet, too.
json '"modules": [[0,0,0],[0,0,1]], "planed": [[0,0,2]]' >slip.json
expect_refusal "/planed: the key 'planed' is unknown: did you mean 'planned'\?" slip.json
json '"modules": [[0,0,0]], "materal": {"mass_kg": 5}' >slip.json
expect_refusal "did you mean 'material'\?" slip.json
json '"modules": [{"cell": [0,0,0], "fixd": true}]' >slip.json
expect_refusal "/modules/0/fixd: .*did you mean 'fixed'\?" slip.json
json '"modules": [[0,0,0]], "material": {"mass": 5}' >slip.json
expect_refusal "did you mean 'mass_kg'\?" slip.json
xml() { printf '<parameters %s/><world gridSize="2,2,2">%s</world>' "$1" "$2"; }
xml 'global_mass="0.1"' '<blockList><block position="0,0,0"/></blockList>' >slip.xml
expect_refusal "'global_mass' is unknown: did you mean 'globalMass'\?" slip.xml
xml '' '<blockList><block position="0,0,0" fixd="true"/></blockList>' >slip.xml
expect_refusal "'fixd' is unknown: did you mean 'fixed'\?" slip.xml
xml '' '<blockList><block position="0,0,0"/></blockList><targetslist/>' >slip.xml
expect_refusal "did you mean 'targetList'\?" slip.xml
json '"modules": [[0,0,0]], "colour_scheme": 3' >noted.json
xml '' '<blockList><block position="0,0,0" isWall="true"/></blockList>' >noted.xml
expect_refusal "/colour_scheme: the key 'colour_scheme' is unknown, expected " noted.json
json '"modules": [[0,0,0]], "x-colour_scheme": 3' >free.json
expect_exit 0 check --quiet free.json
expect_exit 0 check --quiet --allow-unknown noted.json noted.xml
expect_line err "^holdfast: noted.json: note: /colour_scheme: .*is unknown and ignored$"
expect_line err "^holdfast: noted.xml: note: .*'isWall' is unknown and kept$"
expect_exit 65 check slip.xml "$safe"
expect_exit 0 simulate --quiet --allow-unknown noted.json
expect_line err "note: .*'colour_scheme'"
# Once, where both outputs go to one place; on standard error and in the report, where they do not.
json '"modules": [[0,0,0]], "colour_scheme": 3, "planned": [[0,0,1]]' >noted_steps.json
for words in 'check --allow-unknown noted.json' 'simulate --allow-unknown noted.json' \
  'simulate --allow-unknown --steps noted_steps.json' \
  'simulate --allow-unknown --stages noted_steps.json'; do
  # shellcheck disable=SC2086
  "$program" $words >both 2>&1 </dev/null
  [ "$(grep -c colour_scheme both)" -eq 1 ] || fault "not one note: $words: $(cat both)"
  # shellcheck disable=SC2086
  expect_exit 0 $words
  expect_line err "note: .*'colour_scheme'"
  expect_line out "  note  .*'colour_scheme'"
done
# Stages behind pieces are not judged, and say why.
printf '{"format": "holdfast-structure", "version": 2, "modules": [[0,0,0], [1,0,0], [2,0,0]],
  "steps": [{"detach": [[1,0,0]]}]}' >split.json
expect_exit 2 simulate --stages split.json
expect_line out '0 shift .* undecided  *-  the robot would be in pieces$'
expect_line out '0 connect .* undecided  *-  not judged: the robot would be in pieces$'
# Nothing happens to a module that has been taken off.
json '"modules": [[0,0,0], [1,0,0]]' >pair.json
expect_exit 0 simulate pair.json --detach 1,0,0@0.1 --kill 1,0,0@5
expect_line out 'note  .*\(1,0,0\) was not there when it was to fall silent: nothing came of that$'
expect_exit 0 convert --allow-unknown noted.json noted_again.xml
expect_line err "note: .*'colour_scheme'"

# No output overwrites an input or another output, however they are spelt.
cp "$safe" in.json
cp "$safe" kept.json
ln -s in.json link.json
ln in.json hard.json
for other in in.json ./in.json "$work/in.json" link.json hard.json; do
  expect_exit 64 check in.json --json "$other"
  expect_line err 'would overwrite the input'
  expect_exit 64 check "$other" --svg in.json
  expect_exit 64 check in.json --certificate "$other"
done
expect_exit 64 convert in.json in.json
expect_exit 64 simulate in.json --story link.json
expect_exit 64 view in.json --no-open --out ./in.json
expect_exit 64 emulate in.json --json in.json
code=0
# shellcheck disable=SC2094  # The program has to refuse it.
"$program" check - --json in.json <in.json >out 2>err || code=$?
[ "$code" -eq 64 ] || fault "standard input is overwritten: exit $code"
expect_exit 64 check "$safe" --json twice --svg ./twice
expect_line err '--json twice and --svg ./twice are one file'
expect_exit 64 simulate "$safe" --json - --story -
code=0
# shellcheck disable=SC2094  # The program has to refuse it.
"$program" check "$safe" --json shared.txt >shared.txt 2>err || code=$?
[ "$code" -eq 64 ] || fault "standard output and --json share a file: exit $code"
cmp -s in.json kept.json || fault "an input has changed"
expect_exit 0 check "$safe" --json /dev/null --svg /dev/null

# Standard output is one output's or the text's: with every option that its help says writes a file.
for command in check steps simulate emulate next order move; do
  case $command in
    steps) arguments="$repository/scenarios/plan/walk_over_beam.json" ;;
    order) arguments="$repository/scenarios/plan/counterweight.json" ;;
    move) arguments="$overload $overload" ;;
    *) arguments=$overload ;;
  esac
  options=$("$program" "$command" --help |
    sed -nE 's/^  (-o, )?(--(json|csv|svg|vtk|html|certificate|trace|story|output)) FILE.*/\2/p')
  [ -n "$options" ] || fault "$command: its help names no output"
  for option in $options; do
    # shellcheck disable=SC2086
    "$program" $command $arguments $option - >out 2>err || true
    if grep -qE '^(OVERLOAD|SAFE|UNSTABLE|UNDECIDED|FOUND|NONE) ' out; then
      fault "$command $option -: the text is on standard output, too"
    fi
  done
done
# What is written as one format is not named as another.
for arguments in "check $safe --svg a.jpg" "check $safe --vtk a.vtk" "check $safe --html a.PDF" \
  "check $safe --json a.xml" "next $safe --svg a.json" \
  "order $repository/scenarios/plan/counterweight.json -o a.svg"; do
  # shellcheck disable=SC2086
  expect_exit 64 $arguments
  expect_line err 'what is written is '
done
# An ending that tells nothing is refused where it is to tell the format, whatever its letters.
for arguments in "check $safe --svg a.picture" "generate cube 2 -o a.xyzzy" \
  "order $repository/scenarios/plan/counterweight.json -o a.xyzzy"; do
  # shellcheck disable=SC2086
  expect_exit 64 $arguments
  expect_line err 'what is written is .*, whose files end in .* or '
done
[ ! -e a.xyzzy ] || fault "a file of no known format was written"
expect_exit 0 generate cube 2 -o a.XML
grep -q '<world' a.XML || fault "a file that ends in .XML is not XML"
expect_exit 0 convert a.XML a.JSON
grep -q '"holdfast-structure"' a.JSON || fault "a file that ends in .JSON is not JSON"
expect_exit 0 check "$safe" --svg plain --json report.txt

# Figures: PNG and PDF where librsvg is there, else a word about it; options of the picture.
code=0
"$program" check "$safe" -q --svg a.png --size 640 2>err || code=$?
if [ "$code" -eq 0 ]; then
  [ "$(head -c 20 a.png | tail -c 4 | od -An -tx1)" = " 00 00 02 80" ] ||
    fault "a.png is not 640 wide"
  expect_exit 0 next "$safe" -q --svg a.PDF --view 20,30 --no-legend --limit 3
  [ "$(head -c 5 a.PDF)" = "%PDF-" ] || fault "a.PDF is no PDF"
else
  [ "$code" -eq 64 ] || fault "--svg a.png: exit $code"
  expect_line err 'without librsvg|take librsvg'
fi
expect_exit 0 check "$safe" -q --svg front.svg --view front --title "My arm" --grey --size 500x300
expect_line front.svg 'width="500" height="300"'
expect_line front.svg '<desc>Front view of a modular robot'
expect_line front.svg '>My arm</text>'
expect_exit 0 check "$safe" -q --svg angles.svg --view -60,30
expect_line angles.svg 'View from azimuth -60 and elevation 30 degrees'
expect_exit 0 steps "$repository/scenarios/plan/walk_over_beam.json" -q --svg walk.svg --title Walk
expect_line walk.svg '>Walk: 6 steps, safe<'
expect_exit 64 steps "$repository/scenarios/plan/walk_over_beam.json" --svg walk.svg --view top
expect_line err '^holdfast steps: --view and --no-legend require --step or --strip'
walk=$repository/scenarios/plan/walk_over_beam.json
expect_exit 0 steps "$walk" -q --svg strip.svg --strip --view front
[ "$(grep -c 'class="frame"' strip.svg)" -eq 7 ] || fault "a film strip of the start and 6 steps"
expect_exit 0 steps "$walk" -q --svg step.svg --step 2 --no-legend
grep -q '>walk over a beam, after step 2<' step.svg || fault "the robot after step 2"
expect_exit 0 steps "$walk" -q --svg step.svg --step start
expect_exit 65 steps "$walk" -q --svg step.svg --step 6
expect_line err 'expected a step from 0 to 5, or start; found 6$'
expect_exit 64 steps "$walk" --svg step.svg --step -1
expect_line err 'expected a step from 0, or start'
expect_exit 64 steps "$walk" --strip
expect_line err '^holdfast steps: --strip requires --svg$'
expect_exit 64 steps "$walk" --svg step.svg --strip --step 1
expect_exit 64 check "$safe" --view front
expect_line err '^holdfast check: --view requires --svg$'
expect_exit 64 check "$safe" --svg a.svg --view frond
expect_line err 'expected iso, front, side, top, or azimuth and elevation'
expect_exit 64 check "$safe" --svg a.svg --size 5
expect_line err "of 16 to 20000 pixels; found '5'$"
expect_exit 64 generate cuble 3
expect_line err "no family 'cuble'; did you mean 'cube'.$"
expect_exit 64 check "$safe" --lattice catoms3d
expect_line err "the lattice 'catoms3d' is unknown; did you mean 'catoms3D'.$"
expect_exit 64 generate cube 3 -o a.png
expect_line err 'whose files end in .json, .xml or .holdfast$'
printf '{"format": "holdfast-structure", "version": 1, "moduls": [[0,0,0]]}' >slip.json
expect_exit 65 check slip.json
expect_line err "key \"modules\" is missing, .* found 'moduls', did you mean 'modules'.$"
expect_exit 64 check "$safe" --vtk a.pvd
expect_line err "what is written is VTK's XML format, whose files end in .vtu"

# Whoever finds modules that are not connected says which lattice connects them.
printf '%s' '{"format": "holdfast-structure", "version": 1,
  "modules": [[2,2,0], [1,1,1]]' | tee catoms_alone.json >catoms_and_one.json
echo '}' >>catoms_alone.json
echo ', "planned": [[2,2,2]]}' >>catoms_and_one.json
for arguments in "check catoms_and_one.json" "steps catoms_and_one.json" "next catoms_alone.json" \
  "simulate catoms_alone.json" "order catoms_and_one.json" "view catoms_alone.json" \
  "move catoms_alone.json catoms_alone.json"; do
  # shellcheck disable=SC2086
  expect_exit 65 $arguments
  expect_line err 'not connected: .*; the lattice is cubic, in face-centred it is connected'
done

# Two cubes that share an edge may be prisms, unless somebody says that they are two pieces.
json '"modules": [[0,1,0],[1,0,0]]' >edge.json
expect_exit 65 check edge.json
expect_line err 'it is connected: --lattice hexanodes; if it is in pieces: --lattice cubic$'
expect_exit 0 check edge.json --lattice cubic
expect_line out '^  pieces      safe'

# Pieces that stand are judged one by one, by check alone and by what knows of pieces.
json '"modules": [[0,0,0],[0,0,1],[5,0,0],[5,0,1],[6,0,1],[7,0,1]]' >pieces.json
expect_exit 1 check pieces.json --json pieces_report.json --csv pieces.csv --svg pieces.svg
expect_line out '^  pieces      unstable  .* margin -10.00 mm  4 modules with \(5,0,0\)$'
expect_line out '^              safe      .* 2 modules with \(0,0,0\)$'
for option in --prove --limit --deformed --remedies --lose-one --cascade '--scatter 10%'; do
  # shellcheck disable=SC2086
  expect_exit 65 check pieces.json $option
  expect_line err 'the robot is in 2 pieces, and .* is for robots of one'
done
for arguments in "next pieces.json" "order pieces.json" "simulate pieces.json" "view pieces.json" \
  "move pieces.json pieces.json"; do
  # shellcheck disable=SC2086
  expect_exit 65 $arguments
  expect_line err 'not connected: 2 of 6 modules .* piece, 4 with \(5,0,0\): 2 with \(0,0,0\)'
done
json '"modules": [[0,0,0],[0,0,1],[5,0,1],[6,0,1]]' >hovering.json
expect_refusal 'not connected: nothing holds 1 of its 2 pieces: 2 with \(5,0,1\)' hovering.json

# A list of cells is a robot, to every command; its lowest layer stands, or the one that is said.
printf 'x,y,z\n0,0,5\n0,0,6\n1,0,6\n' >list.csv
for command in check next simulate order; do
  case $command in
    simulate) expect_exit 0 simulate list.csv --link unit ;;
    *) expect_exit 0 "$command" list.csv ;;
  esac
  expect_line err 'note: read as list of cells: 3 modules; not read: other columns'
  expect_line err 'the lowest layer, z = 5, rests on it'
done
expect_exit 65 check list.csv --support-z 0
expect_line err 'nothing holds the robot: .* z = 0 .*--support-z lowest'
expect_exit 0 check list.csv --support-z lowest
expect_line err 'the support level is set to z = 5 by an option'
expect_exit 64 check list.csv --support-z floor
expect_line err 'expected lowest or an integer'
expect_exit 0 convert list.csv list.json
expect_exit 0 check list.json
expect_line out '^  modules +3 existing, 0 planned; 1 supported'
expect_exit 65 check "$repository/examples/formats/block.stl"
expect_line err 'a mesh needs the edge of a module in its own unit: --pitch'
expect_exit 0 check "$repository/examples/formats/block.stl" --pitch 40
expect_line out '^  modules +12 existing'
expect_exit 0 help convert
expect_line out 'MagicaVoxel \(\.vox\)'

# A target that overlaps the robot is where it is to go.
goal=$repository/examples/formats/goal_shape.xml
expect_exit 0 check "$goal"
expect_line err 'is taken for a shape to reach'
expect_exit 0 move "$goal" -o moves.xml
expect_line out '^FOUND +4 steps'
expect_exit 0 steps moves.xml
expect_exit 65 move list.csv
expect_line err "the structure has no goal shape"
expect_exit 0 order list.csv -o order.xml
expect_line order.xml '<cell position='
expect_exit 0 steps order.xml

# A full disk and a closed output are errors of every command.
for arguments in "check $safe" "check $safe --json -" "simulate $safe --link unit" \
  "simulate $safe --link unit --story -" "generate cube 3" "generate cube 30" "--help"; do
  for closed in '>/dev/full' '>&-'; do
    code=0
    eval "\"$program\" $arguments $closed 2>err" || code=$?
    [ "$code" -eq 65 ] ||
      fault "exit $code with $closed: $arguments: $(cat err)"
    expect_line err 'cannot be written'
  done
done
for arguments in "check $safe --json" "check $safe --csv" "check $safe --svg" "check $safe --vtk" \
  "convert $safe" "simulate $safe --link unit --trace" "simulate $safe --link unit --story" \
  "generate cube 3 -o"; do
  case $arguments in
    convert*) ln -sf /dev/full full.json && full=full.json ;;
    *) full=/dev/full ;;
  esac
  # shellcheck disable=SC2086
  expect_exit 65 $arguments "$full"
  expect_line err 'cannot be written: No space left on device'
done
expect_exit 0 check --quiet "$safe" --json /dev/stdout
expect_line out '"verdict": "safe"'
code=0
"$program" check --quiet "$safe" >&- 2>err || code=$?
[ "$code" -eq 0 ] || fault "exit $code though nothing was to be written"

# What is replaced keeps its rights and its links; nothing is left behind, a signal included.
mkdir tidy
echo old >tidy/report.json
chmod 600 tidy/report.json
ln -s report.json tidy/link.json
echo precious >victim
ln -s ../victim tidy/report.json.part
expect_exit 0 check "$safe" --json tidy/link.json
[ -L tidy/link.json ] || fault "a link was replaced"
grep -q '"verdict": "safe"' tidy/report.json || fault "what the link leads to was not replaced"
[ "$(stat -c %a tidy/report.json)" = 600 ] || fault "rights: $(stat -c %a tidy/report.json)"
[ "$(cat victim)" = precious ] || fault "a link beside the output was followed"
[ "$(find tidy | wc -l)" -eq 4 ] || fault "left behind: $(find tidy)"
"$program" generate cube 12 -o slow.json
for signal in TERM INT HUP; do
  python3 - "$program" "$signal" <<'PYTHON' || fault "SIG$signal: $(find tidy)"
import os, signal, subprocess, sys, time
program, name = sys.argv[1:]
process = subprocess.Popen([program, 'simulate', 'slow.json', '--story', 'tidy/story.txt'],
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
def unfinished():
    return [file for file in os.listdir('tidy') if file.startswith('.holdfast-')]
while not unfinished() and process.poll() is None:
    time.sleep(0.01)
assert unfinished()
process.send_signal(getattr(signal, 'SIG' + name))
assert process.wait() == -getattr(signal, 'SIG' + name)
assert not unfinished() and not os.path.exists('tidy/story.txt')
PYTHON
done

# Cells below 0 are moved for VisibleSim, which is said, and come back.
json '"modules": [[-3,-2,-1],[-3,-2,0]], "planned": [[-4,-2,0]], "support_z": -1' >below.json
expect_exit 0 convert below.json below.xml
expect_line err 'moved by \(4,2,1\)'
expect_line below.xml 'position="1,0,0"'
grep -q 'position="[^"]*-' below.xml && fault "a negative cell: $(cat below.xml)"
expect_exit 0 convert below.xml below_again.json
expect_exit 0 convert below.json below_direct.json
cmp -s below_again.json below_direct.json || fault "a moved structure does not come back"
json '"modules": [[-1000000,0,0],[1,0,0]]' >wide.json
expect_exit 65 convert wide.json wide.xml
expect_line err "VisibleSim's grid, which goes from 0 to 1000000"

# Sizes and streams that are none.
expect_exit 64 generate cube -5
expect_line err "'-5'|-5"
expect_exit 64 generate cube 100000
expect_refusal 'zero byte' /dev/zero
printf '\377\376{\000' >utf16.json
expect_refusal 'found UTF-16: save it as UTF-8' utf16.json
python3 -c 'import socket; socket.socket(socket.AF_UNIX).bind("socket.json")'
expect_refusal 'cannot be read: No such device or address' socket.json
json '"name": "two\\nlines", "modules": [[0,0,0]]' >lines.json
expect_exit 0 check lines.json --svg lines.svg
expect_line out '^SAFE +two\\nlines$'
cp lines.json "$(printf 'a\nb.json')"
expect_exit 0 check "$safe" "$(printf 'a\nb.json')"
[ "$(wc -l <out)" -eq 3 ] || fault "a name of two lines: $(cat out)"
expect_exit 65 check "$(printf 'c\nd.json')"
[ "$(wc -l <err)" -eq 1 ] || fault "a name of two lines: $(cat err)"

# Little memory: an answer, or one clear line and 70; never an abort. Sanitizers need all there is.
"$program" generate cube 60 -o big.json
if (ulimit -v 400000 && "$program" --version) >/dev/null 2>&1; then
  for limit in 30000 45000 60000 80000 100000 130000 170000 220000 300000 400000; do
    for arguments in "check big.json --threads 4" "convert big.json small.xml" \
      "generate cube 100"; do
      code=0
      # shellcheck disable=SC2086
      (ulimit -v "$limit" && exec "$program" $arguments) >out 2>err || code=$?
      case $code in
        0 | 2) ;;
        70) expect_line err '^holdfast: out of memory: ' ;;
        127) ;;  # Not even the program's own libraries fit.
        *) fault "exit $code with $limit KiB: $arguments: $(head -c 300 err)" ;;
      esac
    done
  done
else
  echo 'not checked: little memory, as this build needs more address space than a limit leaves'
fi

# Loads that are rounding are not told as loads; a load below 1 does not read as 1.
expect_exit 0 generate tower 200 -o tower.json
expect_exit 0 check tower.json
expect_line out 'no connection is known to be in tension'
grep -q 'breaks at' out && fault "a weight that breaks nothing: $(cat out)"
json '"modules": [[0,0,0],[0,0,1],[1,0,1]], "material": {"facet_mm": 50}' >facet.json
code=0
"$program" check --quiet facet.json 2>err || code=$?
expect_line err 'note: facets of 50 mm are wider than the pitch of 40 mm'

# The page: without a built one the error says how to get it; with one the structure is in it.
mkdir bin
cp "$program" bin/holdfast
program=$work/bin/holdfast
expect_exit 65 view "$safe" --no-open
expect_line err "the page is not built: looked for $work/bin/holdfast.html, "
expect_line err "'./dev page' builds it"
expect_exit 65 check "$safe" --html page.html
expect_line err 'the page is not built'
[ -e page.html ] && fault "a page without a page"
echo '<p>no page of ours</p>' >bin/holdfast.html
expect_exit 65 view "$safe" --no-open
expect_line err "no page of holdfast's"
grep -F -e '<title>' -e holdfast-start -e 'puts the report here' "$repository/apps/web/index.html" \
  >bin/holdfast.html
expect_exit 0 view "$safe" --no-open --out page.html
expect_line out '^page.html$'
expect_line page.html '<title>arm_breaks_a - holdfast</title>'
expect_line page.html 'id="holdfast-start">\{"structure":.*holdfast-structure.*</script>'
json '"name": "</script><b>", "modules": [[0,0,0]]' >tag.json
expect_exit 0 view tag.json --no-open --out page.html
expect_line page.html '<title>&lt;/script>&lt;b> - holdfast</title>'
[ "$(grep -c '</script' page.html)" -eq 1 ] || fault "a name ends the script: $(cat page.html)"
expect_exit 1 check "$overload" --html page.html
expect_line page.html 'is loaded to 120\.04 % of its strength'
expect_exit 64 check "$safe" "$overload" --html page.html
expect_exit 0 view "$safe" --out -
expect_line out '<title>arm_breaks_a - holdfast</title>'
[ "$(head -n 1 out)" != "-" ] || fault "the page's name stands before it"
[ ! -e ./- ] || fault "a file called -"
expect_exit 65 view missing.json --no-open
expect_exit 65 view "$safe" --no-open --out /nowhere/page.html

# Sequences of steps: exit codes, keys that other tools rely on, what cannot be done.
expect_exit 0 steps "$walk" --json steps.json --svg steps.svg --html steps.html --vtk steps.pvd
expect_line out '^SAFE +walk over a beam$'
expect_line out '6 of 6 steps safe in all stages; largest load ratio 0\.7500, smallest margin \+12'
expect_line steps.json '"first_unsafe": null'
python3 - <<'END' || fault "the report of steps is not as documented"
import json
report = json.load(open('steps.json'))
assert report['seconds'] >= 0 and len(report['steps']) == 6
for step in report['steps']:
    assert list(step['stages']) == ['release', 'shift', 'connect']
    assert all(stage['verdict'] == 'safe' for stage in step['stages'].values())
END
expect_line steps.svg '^</svg>$'
expect_line steps.html '^</html>$'
expect_line steps.pvd 'timestep="6" part="0" file="steps_6\.vtu"'
expect_exit 64 steps "$walk" --json steps_1.vtu --vtk steps.pvd # Of the series' files.
expect_exit 64 steps "$walk" --vtk -
[ -s steps_0.vtu ] || fault "no .vtu file of the start"
expect_exit 0 steps "$walk" --quiet
[ -s out ] && fault "--quiet prints: $(cat out)"
plan() {
  printf '{"format": "holdfast-structure", "version": 2, "modules": %s, "steps": %s}' "$1" "$2"
}
plan '[[0,0,0],[0,0,1],[1,0,1]]' '[{"attach": [[2,0,1]]}, {"attach": [[3,0,1]]}]' >tips.json
expect_exit 1 steps tips.json --json -
expect_line out '"step": 0,'
expect_line out '"stage": "connect"'
expect_exit 1 steps tips.json --until-unsafe
expect_line out 'first unsafe: step 0 \(/steps/0\), connect'
plan '[[0,0,0],[0,0,1]]' '[{"move": [{"from": [5,0,0], "to": [6,0,0]}]}]' >empty.json
expect_exit 65 steps empty.json
expect_line err '^holdfast: empty.json: /steps/0: step 0, release: no module can move from \(5'
[ "$(wc -l <err)" -eq 1 ] || fault "not one line: $(cat err)"
json '"modules": [[0,0,0]]' >still.json
expect_exit 65 steps still.json
expect_line err 'the structure has no steps'
expect_exit 0 steps "$safe"
expect_exit 0 check "$walk"
expect_line err 'note: 6 steps are read; the robot before them is judged, holdfast steps judges all'
expect_exit 64 steps "$walk" --svg "$walk"

[ "$faults" -eq 0 ] || exit 1
echo "cli: all as expected"
