// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { TABLE_I, type Settings } from '../model/robot';
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

const LEVEL = FIELDS.length;

/** Makes the form once; what it shows follows the robot, and the focus stays where it is. */
export function makeMaterial(app: App): void {
  const field = (label: string, unit: string, settings: (value: number) => Partial<Settings>) => {
    const input = make('input', { type: 'text', inputMode: 'decimal' });
    input.onchange = () => change(app, input.value, settings);
    return make('label', { className: 'row' }, label, make('span', { className: 'field' }, input, unit));
  };
  const rows = FIELDS.map(([label, unit], i) =>
    field(label, unit, (value) => ({ material: app.robot.material.map((old, k) => (k === i ? value : old)) })),
  );
  const level = field('Ground at z', '', (value) => ({ supportZ: Math.round(value) }));
  const reset = make('button', { type: 'button', textContent: 'Blinky Blocks (Table I)' });
  reset.onclick = () => app.history.configure('changing the material', { material: TABLE_I });
  byId('material').replaceChildren(...rows, level, reset);
  app.robotListeners.push((what) => what !== 'cells' && showMaterial(app));
}

function showMaterial({ robot }: App): void {
  byId('material').querySelectorAll('input').forEach((input, i) => {
    input.value = i === LEVEL ? String(robot.supportZ) : shown(robot.material[i]);
  });
}

const shown = (value: number) => String(Number(value.toPrecision(8)));

function change(app: App, text: string, settings: (value: number) => Partial<Settings>): void {
  const value = Number(text.trim().replace(',', '.'));
  if (text.trim() === '' || !Number.isFinite(value)) {
    tell(`“${text}” is no number`, true);
    showMaterial(app);
  } else {
    app.history.configure('changing the material', settings(value));
  }
}
