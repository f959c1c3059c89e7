#!/usr/bin/env bash
# failures_test.sh PROGRAM REPOSITORY   how sure a structure holds, and what follows from losses.
set -euo pipefail
program=$1
repository=$2
# shellcheck source=tests/cli/expect.sh
. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"

scenarios=$repository/scenarios
safe=$scenarios/arm_breaks_a.json
overload=$scenarios/arm_breaks_b.json
unstable=$scenarios/arm_tips_c.json

# The probability is the product over the connections of the same report.
expect_exit 0 check "$safe" --scatter 20% --json sure.json
expect_line out '^  reliability holds with probability 0[.][0-9]+ \(strengths \+-20 %\)'
expect_line out '; \(2,1,2\)-\(3,1,2\) is the likeliest to fail, in [0-9]+ % of the cases$'
python3 - sure.json <<'END' || fault 'the probability is not the product'
import json
import math
import sys
report = json.load(open(sys.argv[1]))
variance = math.log(1 + 0.2 ** 2)
holds = 1
for connection in report['connections']:
    if connection['load_ratio'] > 1e-9:
        z = (math.log(connection['load_ratio']) + variance / 2) / math.sqrt(variance)
        holds *= 1 - 0.5 * math.erfc(-z / math.sqrt(2))
found = report['reliability']
assert abs(found['probability_holds'] - holds) < 1e-12, (found['probability_holds'], holds)
assert found['strength_factor_99'] < found['strength_factor_999']
END
expect_exit 1 check "$overload" --scatter 10%
expect_exit 1 check "$unstable" --scatter 10%
expect_line out '^  reliability not known'
expect_exit 0 check "$safe" --scatter 10% --probability 0.5
expect_exit 1 check "$safe" --scatter 20% --probability 0.999999
expect_exit 0 check "$safe" --scatter 5% --scatter-common 5% --scatter-law weibull
expect_line out 'each, \+-5 % together, weibull'

# Faults, each in one line.
for bad in 10 -5% 0 0% 300% x% % nan% inf% '10 percent'; do
  expect_usage '^holdfast check: --scatter: expected a percentage from 0.01% to 100%, such as' \
    check "$safe" --scatter "$bad"
done
expect_usage '^holdfast check: --scatter-law: expected lognormal, normal or weibull; found' \
  check a --scatter 5% --scatter-law cauchy
expect_usage '^holdfast check: --lose: expected connections, modules or feet; found' \
  check a --lose-one --lose legs
expect_usage '^holdfast check: --lose requires --lose-one$' check a --lose feet

# What the arm cannot do without.
expect_exit 1 check "$safe" --lose-one --lose connections
expect_line out '^  lose one    [0-9]+ of [0-9]+ single losses bring it down$'
expect_line out '^              without \(2,1,2\)-\(3,1,2\): [0-9]+ modules? falls?$'
expect_exit 0 generate cube 3 -o cube.json
expect_exit 0 check cube.json --lose-one
expect_line out '^  lose one    safe whatever is lost: each of 90 connections, modules and feet$'
expect_exit 2 check cube.json --lose-one --lose-seconds 0
expect_exit 1 check "$unstable" --lose-one
expect_line out '^  lose one    not tried'

# Tables and pictures have the loss of each connection, module and facet, as the report has it.
expect_exit 1 check "$safe" --lose-one --scatter 30% --csv loss.csv --vtk loss.vtu --json loss.json
python3 - <<'END' || fault 'losses in tables and pictures'
import csv
import json
import math
import re
import struct
import zlib

report = json.load(open('loss.json'))
rows = list(csv.DictReader(open('loss.csv')))
lost = report['lose_one']
fatal = {(tuple(x['a']), tuple(x['b'])): x for x in lost['fatal'] if 'a' in x}
shares = {(tuple(x['a']), tuple(x['b'])): x['share'] for x in report['reliability']['likeliest']}
assert len(rows) == len(report['connections'])
for row in rows:
    pair = tuple(tuple(int(row[end + axis]) for axis in 'xyz') for end in 'ab')
    assert (row['loss_outcome'] == '3') == (pair in fatal) and row['loss_outcome'] in '13', row
    if pair in fatal and fatal[pair]['verdict'] == 'overload':
        assert float(row['loss_load_ratio']) == fatal[pair]['load_ratio_max'], row
    if pair in shares:
        assert float(row['fail_share']) == shares[pair], row
assert len(fatal) > 1 and len(shares) > 1

data = open('loss.vtu', 'rb').read()
head, body = data.split(b'<AppendedData encoding="raw">\n_', 1)


def field(name):
    offset = int(re.search(b'Name="' + name + b'"[^>]*offset="([0-9]+)"', head)[1])
    count = struct.unpack_from('<Q', body, offset)[0]
    sizes = struct.unpack_from(f'<{count}Q', body, offset + 24)
    at, raw = offset + 24 + 8 * count, b''
    for size in sizes:
        raw += zlib.decompress(body[at:at + size])
        at += size
    return struct.unpack(f'<{len(raw) // 8}d', raw)


modules, facets = report['modules'], len(report['contacts']) if 'contacts' in report else None
outcome, share, ratio = field(b'loss_outcome'), field(b'fail_share'), field(b'loss_load_ratio')
count = modules if isinstance(modules, int) else modules['existing'] + modules['planned']
of_connections = outcome[count:count + len(rows)]
assert [float(row['loss_outcome']) for row in rows] == list(of_connections)
for row, got, bound in zip(rows, share[count:], ratio[count:]):
    for wanted, found in ((float(row['fail_share']), got), (float(row['loss_load_ratio']), bound)):
        assert math.isclose(0 if math.isnan(wanted) else wanted, found, rel_tol=1e-8)
kinds = {'module': outcome[:count].count(3), 'foot': outcome[count + len(rows):].count(3)}
for kind, found in kinds.items():
    assert found == sum(kind in x for x in lost['fatal']), (kind, found)
assert outcome[:count].count(0) == 0
END

# What follows the break: an arm held at one end, of which five modules are too many.
cat >arm.json <<'END'
{"format": "holdfast-structure", "version": 1, "support_z": -1,
 "modules": [{"cell": [0, 0, 0], "fixed": true}, [1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0],
             [5, 0, 0]]}
END
expect_exit 1 check arm.json --cascade --svg arm.svg --json arm_report.json
expect_line out '^  cascade     breaks in 1 round; 5 of 6 modules fall$'
expect_line out '^              1: \(0,0,0\)-\(1,0,0\) at 1\.00.* breaks; 5 modules fall$'
expect_line arm.svg 'falls after the break'
expect_line arm_report.json '"outcome": ?"stands"'
# How they fall, as a series: rigid, down to the floor at -60 mm; what is fixed stays.
expect_exit 1 check arm.json --cascade --vtk fall.pvd
expect_line fall.pvd 'timestep="0" part="0" file="fall_0\.vtu"'
python3 - <<'END' || fault "fall.pvd"
import glob, re, struct, zlib


def numbers(data, name, letter):
    begin = data.index(b'encoding="raw">\n_') + len(b'encoding="raw">\n_')
    offset = int(re.search(rb'Name="' + name + rb'"[^>]*offset="(\d+)"', data)[1])
    here = data[begin + offset:]
    blocks, = struct.unpack('<Q', here[:8])
    sizes = struct.unpack(f'<{blocks}Q', here[24:24 + 8 * blocks])
    raw, at = b'', 24 + 8 * blocks
    for size in sizes:
        raw += zlib.decompress(here[at:at + size])
        at += size
    return struct.unpack(f'<{len(raw) // struct.calcsize(letter)}{letter}', raw)


def corners(frame):
    data = open(f'fall_{frame}.vtu', 'rb').read()
    rest, move = numbers(data, b'Points', 'd'), numbers(data, b'displacement_mm', 'd')
    sums = [a + b for a, b in zip(rest, move)]
    return [sums[3 * i:3 * i + 3] for i in range(8 * 6)], data


def distances(points):
    return [sum((a - b) ** 2 for a, b in zip(p, q)) ** 0.5 for p in points[8:] for q in points[8:]]


count = len(glob.glob('fall_*.vtu'))
assert 20 < count == open('fall.pvd').read().count('<DataSet')
start, data = corners(0)
assert numbers(data, b'body', 'd')[:6] == (-1, 0, 0, 0, 0, 0)
assert numbers(data, b'broken', 'B').count(1) == 1
for frame in range(count):
    points, _ = corners(frame)
    assert points[:8] == start[:8]
    assert max(abs(a - b) for a, b in zip(distances(points), distances(start))) < 1e-3
    assert min(p[2] for p in points) > -60.5
# In the air it has fallen by g t^2 / 2.
time = 3 * 0.016
fallen = start[8][2] - corners(3)[0][8][2]
assert abs(fallen - 9810 * time ** 2 / 2) < 1, fallen
assert min(p[2] for p in points) < -59
END
expect_exit 65 check cube.json --cascade --vtk none.pvd
expect_line err 'no module falls, so there is no fall to be written'
expect_exit 64 check arm.json --cascade --vtk fall.pvd --json fall_1.vtu
expect_exit 0 check cube.json --cascade
expect_line out '^  cascade     nothing breaks and nothing falls$'
expect_exit 1 check arm.json --cascade --deformed
expect_line out '^  cascade     breaks in 1 round; 5 of 6 modules fall$'

# And after each loss: without its third connection the arm loses three modules, and holds.
expect_exit 1 check arm.json --set strength_vertical_n=1e4 --set strength_lateral_n=1e4 \
  --lose-one --lose connections --cascade --json losses.json
expect_line out 'without \(2,0,0\)-\(3,0,0\): 3 modules fall; in all 3 modules fall in 1 round$'
expect_line losses.json '"outcome": ?"stands"'

# A column that buckles, and what is behind: on both sides it holds, at once or not at all.
cat >column.json <<'END'
{"format": "holdfast-structure", "version": 1, "support_z": -1,
 "material": {"elastic_modulus_mpa": 0.12},
 "modules": [{"cell": [0, 0, 0], "fixed": true}, [0, 0, 1], [0, 0, 2], [0, 0, 3], [0, 0, 4],
             [0, 0, 5]]}
END
expect_exit 0 check column.json --deformed --follow --vtk path.pvd --json followed.json
expect_line out 'behind it, one way: holds at 2\.0000 times these loads, moved by 237 mm'
expect_line out 'behind it, the other way: holds at 2\.0000 times'
expect_line followed.json '"end": ?"up_to"'
expect_line path.pvd 'timestep="20" part="0" file="path_20\.vtu"'
expect_exit 1 check column.json --deformed --set elastic_modulus_mpa=0.09 --cascade
expect_line out '^  cascade     undecided after 0 rounds: no module falls by then$'
expect_usage '^holdfast check: --follow requires --deformed$' check a --follow
expect_exit 64 check column.json --deformed --vtk path.pvd --json path_1.vtu
expect_exit 64 check column.json --deformed --vtk -.pvd --csv ./-_3.vtu

[ "$faults" -eq 0 ] || exit 1
echo "failures: all as expected"
