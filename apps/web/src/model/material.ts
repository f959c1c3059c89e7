// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import VOCABULARY from 'virtual:vocabulary';

/** The numbers that mechanics depend on; a material has them in this order. */
export const PARAMETERS = VOCABULARY.material;

/** Table I of [Piranda 2021], Blinky Blocks. */
export const TABLE_I = Float64Array.from(PARAMETERS, ({ table_i }) => table_i);

const indexOf = (wanted: string) => PARAMETERS.findIndex(({ key }) => key === wanted);
const [PITCH, GRAVITY] = ['pitch_mm', 'gravity_m_s2'].map(indexOf);

export const pitchMm = (material: Float64Array) => material[PITCH];
/** m/s^2 */
export const gravityMagnitude = (material: Float64Array) => material[GRAVITY];
export const withGravity = (material: Float64Array, magnitude: number) =>
  material.map((old, k) => (k === GRAVITY ? magnitude : old));
export const GRAVITY_RANGE = PARAMETERS[GRAVITY];
/** Gravity has a form of its own, for its direction too. */
export const isGravity = (parameter: number) => parameter === GRAVITY;
