#!/usr/bin/env bash
# strengths_test.sh PROGRAM REPOSITORY   scatter in files, safety factors, plans, weak connectors,
# fits.
set -euo pipefail
program=$1
repository=$2
# shellcheck source=tests/cli/expect.sh
. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"

scenarios=$repository/scenarios
safe=$scenarios/arm_breaks_a.json
unstable=$scenarios/arm_tips_c.json

# What a file states is the answer without options; options override it.
python3 - "$safe" <<'END'
import json
import sys
robot = json.load(open(sys.argv[1]))
robot['version'] = 2
robot['material'] = {'strength_cv': 0.2}
json.dump(robot, open('stated.json', 'w'))
robot['material'] = {'strength_cv': 0.2, 'strength_distribution': 'weibull', 'mass_cv': 0.03}
robot['kinds'] = {'old': {'strength_cv': 0.4, 'mass_cv': 0.1}}
robot['modules'][0] = {'cell': robot['modules'][0], 'kind': 'old'}
json.dump(robot, open('kinds.json', 'w'))
for name, value in (('high', 3), ('zero', 0), ('negative', -0.1), ('text', '10%')):
    robot['material'] = {'strength_cv': value}
    json.dump(robot, open(f'{name}.json', 'w'))
robot['material'] = {}
robot['kinds'] = {}
robot['modules'][0] = robot['modules'][0]['cell']
robot['connections'] = [{'between': [[3, 1, 2], [2, 1, 2]], 'strength_cv': 0.3}]
json.dump(robot, open('one.json', 'w'))
robot['connections'][0]['strength_distribution'] = 'weibull'
json.dump(robot, open('one_weibull.json', 'w'))
for name, share in (('half', 0.5), ('most', 0.8)):
    robot['connections'] = [{'between': [[2, 1, 2], [3, 1, 2]], 'strength_n': 14.97 * share}]
    json.dump(robot, open(f'{name}.json', 'w'))
END
probability() {
  python3 -c 'import json, sys
print(json.load(open(sys.argv[1]))["reliability"]["probability_holds"])' "$1"
}
expect_exit 0 check "$safe" --scatter 20% --json sure.json
expect_exit 0 check stated.json --json stated_report.json
expect_exit 0 check "$safe" --set material.strength_cv=0.2 --json set.json
[ "$(probability stated_report.json)" = "$(probability sure.json)" ] ||
  fault 'strength_cv of a file'
[ "$(probability set.json)" = "$(probability sure.json)" ] || fault 'strength_cv by --set'
expect_exit 0 check stated.json --scatter 10%
expect_line out 'strengths \+-10 %'
expect_exit 0 convert kinds.json again.json
expect_exit 0 convert kinds.json kinds.xml
for file in kinds.json again.json kinds.xml; do
  expect_exit 0 check "$file"
  expect_line out 'strengths up to \+-40 %, weibull, masses up to \+-10 %'
done
# One connection scatters: the probability is its own, of lognormal and of Weibull strengths;
# options override it.
expect_exit 0 convert one.json one.xml
for file in one.json one.xml one_weibull.json; do
  expect_exit 0 check "$file" --json one_report.json
  python3 - one_report.json "$file" <<'END' || fault "strength_cv of one connection in $file"
import json
import math
import sys
report = json.load(open(sys.argv[1]))
ratio = next(c['load_ratio'] for c in report['connections']
             if sorted([c['a'], c['b']]) == [[2, 1, 2], [3, 1, 2]])
if 'weibull' in sys.argv[2]:
    low, high = 1.0, 20.0  # The exponent of which the cv is 0.3.
    for _ in range(200):
        k = (low + high) / 2
        cv = math.sqrt(math.gamma(1 + 2 / k) / math.gamma(1 + 1 / k)**2 - 1)
        low, high = (k, high) if cv > 0.3 else (low, k)
    fails = -math.expm1(-(ratio * math.gamma(1 + 1 / k))**k)
else:
    spread = math.sqrt(math.log(1 + 0.3**2))
    fails = math.erfc(-(math.log(ratio) + spread**2 / 2) / spread / math.sqrt(2)) / 2
found = report['reliability']
assert abs(found['probability_fails'] / fails - 1) < 1e-6, (found, fails)
assert found['strength_cv'] == 0.3 and found['likeliest'][0]['share'] > 0.999
END
done
expect_exit 0 check one.json --scatter 20% --json one_report.json
[ "$(probability one_report.json)" = "$(probability sure.json)" ] || fault 'options override'
for bad in high zero negative text; do
  expect_exit 65 check "$bad.json"
  expect_line err 'strength_cv'
done
expect_usage 'strength_cv: expected a standard deviation over mean from 0.0001 to 1' \
  check "$safe" --set strength_cv=10
for bad in 31% 300% 0% -1%; do
  expect_usage '^holdfast check: --scatter-mass: expected a percentage from 0.01% to 30%, such as' \
    check "$safe" --scatter-mass "$bad"
done
expect_exit 65 check "$safe" --probability 0.9
expect_line err 'nothing is known to scatter, expected --scatter, --scatter-common,'

# A safety factor: 0.64 of the strength, so 1.5 holds and 1.6 does not.
expect_exit 0 check "$safe" --safety-factor 1.5
expect_line out '^  load ratio   0[.]9603'
expect_exit 1 check "$safe" --margin 1.6
expect_usage '^holdfast check: --safety-factor' check "$safe" --safety-factor 0.5
expect_exit 0 next "$safe" --safety-factor 1.2

# The file states it: every command that reads it divides, an option replaces it, copies keep it.
python3 - "$safe" factor.json <<'END'
import json
import sys
structure = json.load(open(sys.argv[1]))
structure.pop('known_answer', None)
json.dump({**structure, 'version': 2, 'safety_factor': 1.6}, open(sys.argv[2], 'w'))
END
expect_exit 0 convert factor.json copy.json
expect_exit 0 convert copy.json copy.xml
expect_exit 0 convert copy.xml copy.holdfast
expect_exit 0 convert copy.holdfast again.json
for file in factor.json copy.json copy.xml copy.holdfast again.json; do
  expect_exit 1 check "$file"
  expect_line out '^  note +strengths are divided by 1.6, the safety factor, and load ratios'
  expect_exit 0 check "$file" --safety-factor 1.5
  expect_line err 'divided by 1.5, the safety factor in place of the file.s 1.6,'
  expect_exit 0 check "$file" --safety-factor 1
  expect_line err 'the safety factor is set to 1 in place of the file.s 1.6 by an option'
done
answer_of() { # the exit status, and the lines that say how loaded and how sure it is
  local code=0
  "$program" "$@" >out 2>err </dev/null || code=$?
  echo "$code"
  grep -E 'load ratio|reliability| mm  [(]' out || true
}
for command in 'check --scatter 10%' next steps 'order --help-seconds 0' simulate; do
  # shellcheck disable=SC2086  # Words of a command.
  [ "$(answer_of $command "$safe" --safety-factor 1.6)" = "$(answer_of $command factor.json)" ] ||
    fault "$command differs where the file states the safety factor"
  # shellcheck disable=SC2086
  [ "$(answer_of $command "$safe")" != "$(answer_of $command factor.json)" ] ||
    fault "$command knows no safety factor"
done
python3 - "$scenarios"/plan/around_arm_{from,to}.json <<'END'
import json
import sys
for path, name, factor in zip(sys.argv[1:], ('from', 'to'), (1000, 999)):
    json.dump({**json.load(open(path)), 'version': 2, 'safety_factor': factor},
              open(f'{name}.json', 'w'))
END
expect_exit 65 move from.json "$scenarios/plan/around_arm_to.json" --seconds 20
expect_line err 'the robot is overload before any step'
expect_exit 65 move "$scenarios/plan/around_arm_from.json" to.json --seconds 20
expect_line err 'the robot is overload before any step'
expect_exit 65 move from.json to.json
expect_line err 'the safety factor of the robot is 1000 and that of the target 999, expected one'
expect_exit 0 generate crane 6 -o arm.json
expect_exit 0 order arm.json --strength-needed
expect_line out '^  strength    an order needs'
expect_exit 0 order arm.json --strength-needed --json needed.json
python3 - needed.json <<'END' || fault 'the least strength is not that of the bottleneck'
import json
import sys
report = json.load(open(sys.argv[1]))
needed = report['strength_needed']
assert needed['is_certain'], needed
assert needed['none'] < needed['enough'] <= needed['none'] * 1.0002, needed
assert abs(needed['enough'] - report['load_ratio_max']) < 1e-4, (needed, report['load_ratio_max'])
END
enough=$(python3 -c 'import json
print(json.load(open("needed.json"))["strength_needed"]["enough"])')
expect_exit 0 order arm.json --safety-factor "$(python3 -c "print(0.999 / $enough)")"
expect_exit 1 order arm.json --safety-factor "$(python3 -c "print(1.001 / $enough)")" \
  --help-seconds 0 --certificate none.json
expect_exit 0 steps none.json --verify

# Plans: the stage with the least probability is the last one, with all modules.
expect_exit 0 order arm.json --scatter 10% --probability 0.5
expect_line out '^  reliability every stage holds with probability'
expect_exit 0 order arm.json -o plan.json
expect_exit 0 steps plan.json --scatter 40% --json steps.json
expect_exit 0 check arm.json --scatter 40% --json whole.json
python3 - steps.json whole.json <<'END' || fault 'the least probability of a plan'
import json
import sys
steps, whole = (json.load(open(name)) for name in sys.argv[1:])
found = steps['reliability']
assert abs(found['probability_min'] - whole['reliability']['probability_holds']) < 1e-9, found
END
expect_exit 1 steps plan.json --scatter 60% --probability 0.999999
expect_line out 'below 0[.]999999 from step'
expect_exit 1 steps plan.json --lose-one
expect_line out '^  lose one    step [0-9]+, [a-z]+: without .* it does not hold$'
expect_exit 65 steps plan.json --probability 0.9

# The robot knows a weakened connector as check does one in the file.
expect_exit 1 check half.json
expect_exit 1 simulate "$safe" --weaken 2,1,2:+x=0.5
expect_exit 1 simulate half.json
expect_exit 0 check most.json
expect_exit 0 simulate "$safe" --weaken 2,1,2:+x=0.8
for bad in 2,1,2 2,1,2:+x 2,1,2:+x=0 2,1,2:+x=2 2,1,2:x=0.5 2,1,2:+x=half; do
  expect_usage '^holdfast simulate: --weaken: expected X,Y,Z:FACE=SHARE' \
    simulate "$safe" --weaken "$bad"
done
expect_exit 65 simulate "$safe" --weaken 9,9,9:+x=0.5
expect_line err '\(9,9,9\): expected a module, found none'
expect_exit 65 simulate "$safe" --weaken 4,1,2:-z=0.5
expect_line err 'expected a connection on that side, found none'

# Experiments.
experiments() {
  printf '{"format": "holdfast-experiments", "version": 1, "experiments": [%s]}' "$1" \
    >experiments.json
}
expect_exit 0 fit "$repository/examples/experiments/paper_and_hanging.json"
expect_line out '^  vertical    1[0-9.]+ N, 95 %: '
expect_line out '^  build next  crane '
expect_exit 0 fit "$repository/examples/experiments/paper_six_tests.json" --svg fit.svg
cmp fit.svg "$repository/docs/fit_paper.svg" || fault 'docs/fit_paper.svg is another'
experiments '{"pull": "vertical", "held_n": 5}, {"pull": "vertical", "held_n": 7}'
expect_exit 0 fit experiments.json
expect_line out '^  vertical    no value, 95 %: [0-9.]+ N or more$'
experiments '{"pull": "vertical", "broke_n": 9.9}, {"pull": "vertical", "broke_n": 10},
  {"pull": "vertical", "broke_n": 10.1}, {"pull": "vertical", "broke_n": 10.05},
  {"pull": "vertical", "broke_n": 9.95}, {"pull": "vertical", "broke_n": 10.02},
  {"structure": "'"$safe"'", "outcome": "broke", "where": [[[1,1,0], [2,1,0]]]}'
expect_exit 1 fit experiments.json
expect_line out '^  contradicts '
for bad in '{"pull": "vertical", "broke_n": 0}' '{"pull": "vertical", "broke_n": -3}' \
  '{"pull": "sideways", "broke_n": 3}' '{"pull": "vertical"}' '{"structure": "none.json"}' \
  '{"chain": "lateral", "held": 5, "broke": 5}' '{"chain": "lateral", "held": -5}' '' \
  '{"structure": "missing.json", "outcome": "held"}' \
  "{\"structure\": \"$unstable\", \"outcome\": \"held\"}" \
  "{\"structure\": \"$safe\", \"outcome\": \"broke\", \"where\": [[[0,0,0], [9,9,9]]]}"; do
  experiments "$bad"
  expect_exit 65 fit experiments.json
done

# A place of `next` is safe if a check of the robot with it says so.
python3 - "$program" "$scenarios/crane_breaks_a.json" <<'END' || fault 'places of next'
import json
import subprocess
import sys
program, crane = sys.argv[1:]
block = {'format': 'holdfast-structure', 'version': 2,
         'modules': [[x, y, z] for x in range(3) for y in range(3) for z in range(2)]}
json.dump(block, open('block.json', 'w'))


def run(*arguments):
    done = subprocess.run([program, *arguments, '--quiet', '--json', '-'], text=True,
                          stdout=subprocess.PIPE, check=False)
    return done.returncode, json.loads(done.stdout)


counts = {'safe': 0, 'unsafe': 0}
for file, options in ((crane, ['--scatter', '10%', '--probability', '0.9']),
                      ('block.json', ['--lose-one']), (crane, ['--lose-one'])):
    code, places = run('next', file, *options)
    assert code == (0 if places['counts']['safe'] else 1), code
    robot = json.load(open(file))
    for place in places['candidates'][::3]:
        grown = dict(robot, planned=robot.get('planned', []) + [place['cell']])
        json.dump(grown, open('grown.json', 'w'))
        code, report = run('check', 'grown.json', *options)
        assert (code == 0) == (place['verdict'] == 'safe'), (place, code)
        counts['safe' if code == 0 else 'unsafe'] += 1
        if report['verdict'] == 'safe' and '--scatter' in options:
            expected = report['reliability']['probability_holds']
            assert abs(place['probability_holds'] - expected) < 1e-9, (place, expected)
        if report['verdict'] == 'safe' and report.get('lose_one', {}).get('fatal'):
            assert place['reason'] == 'lose_one' and place['fatal'], place
assert min(counts.values()) > 5, counts
END
expect_exit 64 next "$safe" --lose modules
expect_exit 65 next "$safe" --probability 0.9
expect_line err 'nothing is known to scatter'
expect_exit 0 next "$safe" --scatter 10% --probability 0.5 --limit 2
expect_line out 'judged [0-9]+ of 37 places; the rest is open'
[ "$faults" -eq 0 ] || exit 1
echo "strengths: all as expected"
