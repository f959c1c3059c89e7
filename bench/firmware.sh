#!/usr/bin/env bash
# firmware.sh HOLDFAST [BOARD]   every scenario as firmware on emulated modules: the table of the
# README, or with v1 on the lines of Blinky Blocks 1. Seconds are simulated, from the plan (or the
# start) to the last module's verdict. Beside them what version 1 takes with the published method:
# iterations x 110.5 ms [Piranda 2021].
set -euo pipefail
holdfast=$1
python3 - "$holdfast" "${2:-v2}" <<'PYTHON'
import json, pathlib, subprocess, sys

# Preset iterations of the published experiments, by the scenario's structure.
PUBLISHED_S = {'angle_breaks_a': 1658, 'angle_breaks_b': 1658, 'angle_breaks_c': 1658,
               'arm_breaks_a': 663, 'arm_breaks_b': 552, 'arm_breaks_c': 663, 'arm_tips_a': 552,
               'arm_tips_b': 884, 'arm_tips_c': 1658, 'bush_tips_a': 1326, 'bush_tips_b': 1326,
               'bush_tips_c': 1658, 'crane_breaks_a': 1658, 'crane_breaks_b': 1658,
               'crane_breaks_c': 1658, 'crane_tips_a': 2100, 'crane_tips_b': 2100,
               'crane_tips_c': 2100, 'scary_tips_a': 884, 'scary_tips_b': 884,
               'scary_tips_c': 884}
print('| scenario | modules | verdict | firmware: s | longest step: ms | mean step: cycles '
      '| stack: bytes | same bits | published: s |')
print('|---|---|---|---|---|---|---|---|---|')
image = None
for path in sorted(pathlib.Path('scenarios').glob('*.json')):
    run = subprocess.run([sys.argv[1], 'emulate', str(path), '--board', sys.argv[2], '--quiet',
                          '--json', '-'],
                         capture_output=True, text=True, check=False)
    report = json.loads(run.stdout)
    image, robot = report['firmware'], report['distributed']
    ratio = robot['load_ratio_max']
    verdict = robot['verdict'] + (f' {ratio:.4f}' if ratio is not None else '')
    modules = len(json.loads(path.read_text())['modules'])
    print(f'| {path.stem} | {modules} | {verdict} | {image["verdict_after_s"]:.2f} '
          f'| {image["step_cycles_max"] / 48e3:.1f} | {image["step_cycles_mean"]:,} '
          f'| {image["stack_bytes_max"]:,} | {"yes" if image["steps_unlike_host"] == 0 else "NO"} '
          f'| {PUBLISHED_S.get(path.stem, 0):,} |', flush=True)
print(f'\nimage: {image["flash_bytes"]:,} bytes of flash, {image["ram_bytes"]:,} of RAM without '
      f'the stack, {image["agent_bytes"]:,} of them the agent')
PYTHON
