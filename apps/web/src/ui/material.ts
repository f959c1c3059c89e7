// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { PARAMETERS, TABLE_I, isGravity } from '../model/material';
import type { Workbench } from '../model/workbench';
import { byId, make } from './dom';
import { addNumber } from './field';
import { t, word } from '../texts';

/** As the coordinates of cells. */
const LEVEL_MOST = 1e6;
const NEEDED = t('A number is needed here.');

/** Makes the form once; what it shows follows the robot, and the focus stays where it is. */
export function makeMaterial(bench: Workbench): void {
  const place = byId('material');
  const change = (settings: Parameters<Workbench['history']['configure']>[1]) =>
    bench.history.configure(t('changing the material'), settings);
  const shows = PARAMETERS.flatMap((parameter, i) =>
    isGravity(i)
      ? []
      : addNumber(place, {
          ...parameter,
          label: word(parameter.label),
          digits: 8,
          get: () => bench.robot.material[i],
          set: (value) =>
            value === undefined ? NEEDED : change({ material: bench.robot.material.map((old, k) => (k === i ? value : old)) }),
        }),
  );
  const level = addNumber(place, {
    label: t('Ground at z'),
    unit: '',
    lowest: -LEVEL_MOST,
    highest: LEVEL_MOST,
    isWhole: true,
    digits: 10,
    get: () => bench.robot.supportZ,
    set: (value) => (value === undefined ? NEEDED : change({ supportZ: value })),
  });
  const reset = make('button', { type: 'button', textContent: t('Blinky Blocks (Table I)') });
  reset.onclick = () => change({ material: TABLE_I });
  place.append(reset);
  bench.robotListeners.push((what) => what !== 'cells' && [...shows, level].forEach((show) => show()));
}
