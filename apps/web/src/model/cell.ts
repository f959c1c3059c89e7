// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

/** Cells of the lattice, and what a module in one of them is. */

/** As Role in holdfast/trial.hpp. */
export const enum Role {
  kExisting,
  kPlanned,
  kFixed,
}

/** By Role. */
export const ROLE_NAMES = ['existing', 'planned', 'fixed'] as const;

export type Cell = readonly [x: number, y: number, z: number];

export const plus = (a: Cell, b: Cell): Cell => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const equal = (a: Cell, b: Cell) => a[0] === b[0] && a[1] === b[1] && a[2] === b[2];
export const cellText = (cell: Cell) => `(${cell.join(',')})`;
