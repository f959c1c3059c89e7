// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Robot, TABLE_I } from '../model/robot';
import type { App } from './app';
import { byId, make, tell } from './dom';

/** The numbers that mechanics depend on, in the order of model::Material. */
const FIELDS: readonly [label: string, unit: string][] = [
  ['Elastic modulus E', 'MPa'],
  ['Pitch L', 'mm'],
  ['Width of a face a', 'mm'],
  ['Section A', 'mm²'],
  ['Moment Ix', 'mm⁴'],
  ['Moment Iy', 'mm⁴'],
  ['Torsion J', 'mm⁴'],
  ['Poisson’s ratio', ''],
  ['Mass of a module', 'kg'],
  ['Gravity', 'm/s²'],
  ['Strength, vertical', 'N'],
  ['Strength, lateral', 'N'],
  ['Contact gamma', ''],
];

export function showMaterial(app: App): void {
  const { robot } = app;
  const rows = FIELDS.map(([label, unit], i) => {
    const input = make('input', { type: 'text', inputMode: 'decimal', value: shown(robot.material[i]) });
    input.onchange = () => change(app, input, (copy, value) => {
      copy.material = copy.material.slice();
      copy.material[i] = value;
    });
    return make('label', { className: 'row' }, label, make('span', { className: 'field' }, input, unit));
  });
  const level = make('input', { type: 'text', inputMode: 'numeric', value: String(robot.supportZ) });
  level.onchange = () => change(app, level, (copy, value) => (copy.supportZ = Math.round(value)));
  const reset = make('button', { type: 'button', textContent: 'Blinky Blocks (Table I)' });
  reset.onclick = () => change(app, level, (copy) => (copy.material = TABLE_I));
  byId('material').replaceChildren(
    ...rows,
    make('label', { className: 'row' }, 'Ground at z', make('span', { className: 'field' }, level)),
    reset,
  );
}

const shown = (value: number) => String(Number(value.toPrecision(8)));

function change(app: App, input: HTMLInputElement, apply: (copy: Robot, value: number) => void): void {
  const value = Number(input.value.trim().replace(',', '.'));
  if (input.value.trim() === '' || !Number.isFinite(value)) {
    tell(`“${input.value}” is no number`, true);
    showMaterial(app);
    return;
  }
  const { robot } = app;
  const copy = Robot.from(robot.toData().data.modules);
  Object.assign(copy, { name: robot.name, supportZ: robot.supportZ, material: robot.material, base: robot.base });
  apply(copy, value);
  app.history.replace('changing the material', copy);
}
