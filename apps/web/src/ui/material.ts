// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Settings } from '../model/edited_robot';
import { PARAMETERS, TABLE_I, isGravity } from '../model/material';
import type { Workbench } from '../model/workbench';
import { byId, make, tell } from './dom';

/** Indices of the parameters that have a field here. */
const SHOWN = [...PARAMETERS.keys()].filter((i) => !isGravity(i));

/** Makes the form once; what it shows follows the robot, and the focus stays where it is. */
export function makeMaterial(bench: Workbench): void {
  const field = (label: string, unit: string, settings: (value: number) => Partial<Settings>) => {
    const input = make('input', { type: 'text', inputMode: 'decimal' });
    input.onchange = () => change(bench, input.value, settings);
    return make('label', { className: 'row' }, label, make('span', { className: 'field' }, input, unit));
  };
  const rows = SHOWN.map((i) =>
    field(PARAMETERS[i].label, PARAMETERS[i].unit, (value) => ({
      material: bench.robot.material.map((old, k) => (k === i ? value : old)),
    })),
  );
  const level = field('Ground at z', '', (value) => ({ supportZ: Math.round(value) }));
  const reset = make('button', { type: 'button', textContent: 'Blinky Blocks (Table I)' });
  reset.onclick = () => bench.history.configure('changing the material', { material: TABLE_I });
  byId('material').replaceChildren(...rows, level, reset);
  bench.robotListeners.push((what) => what !== 'cells' && showMaterial(bench));
}

function showMaterial({ robot }: Workbench): void {
  byId('material').querySelectorAll('input').forEach((input, i) => {
    input.value = i === SHOWN.length ? String(robot.supportZ) : shown(robot.material[SHOWN[i]]);
  });
}

const shown = (value: number) => String(Number(value.toPrecision(8)));

function change(bench: Workbench, text: string, settings: (value: number) => Partial<Settings>): void {
  const value = Number(text.trim().replace(',', '.'));
  if (text.trim() === '' || !Number.isFinite(value)) {
    tell(`“${text}” is no number`, true);
    showMaterial(bench);
  } else {
    bench.history.configure('changing the material', settings(value));
  }
}
