// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Place } from '../model/lattice';

/** A plane across an axis, in front of which nothing is shown: what is nearer to the eye is cut away. */
export interface Section {
  axis: 0 | 1 | 2;
  /** 1: places beyond the plane are in front of it; -1: those before it. */
  sense: 1 | -1;
  /** Where the plane is along the axis, in pitches. */
  at: number;
}

const ROUNDING = 1e-6;

/** How far in front of the plane a place is; below 0: behind it. */
const before = ({ axis, sense, at }: Section, place: Place) => sense * (place[axis] - at);

export const cutsAway = (section: Section | undefined, place: Place): boolean =>
  section !== undefined && before(section, place) > ROUNDING;

/** Modules next to the plane, which those in front of them would hide, are seen. */
export const opens = (section: Section | undefined, place: Place): boolean =>
  section !== undefined && before(section, place) > -1 - ROUNDING;
