// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import VOCABULARY from 'virtual:vocabulary';

/** The numbers that mechanics depend on; a material has them in this order. */
export const PARAMETERS = VOCABULARY.material;

/** Table I of [Piranda 2021], Blinky Blocks. */
export const TABLE_I = Float64Array.from(PARAMETERS, ({ table_i }) => table_i);

const indexOf = (wanted: string) => PARAMETERS.findIndex(({ key }) => key === wanted);
const [PITCH, MASS, GRAVITY] = ['pitch_mm', 'mass_kg', 'gravity_m_s2'].map(indexOf);

export const pitchMm = (material: Float64Array) => material[PITCH];
export const massKg = (material: Float64Array) => material[MASS];
/** m/s^2 */
export const gravityMagnitude = (material: Float64Array) => material[GRAVITY];
