// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Ray } from 'three';
import { DIRECTIONS, type Cell } from '../model/cell';
import type { EditedRobot } from '../model/edited_robot';

/** Where a ray meets the robot or the ground. */
export interface Hit {
  cell: Cell;
  /** The face that was met, as in base::Direction; a ground cell is met from above. */
  face: number;
  isGround: boolean;
  /** Where on the face, from its middle, in cells. */
  offset: Cell;
}

/** Walks through the lattice from cell to cell [Amanatides 1987]: the robot's size costs nothing. */
export function pick(robot: EditedRobot, ray: Ray): Hit | undefined {
  const bounds = robot.bounds();
  return (bounds && walk(robot, ray, bounds.low, bounds.high)) ?? pickGround(robot, ray);
}

function walk(robot: EditedRobot, ray: Ray, low: Cell, high: Cell): Hit | undefined {
  const origin = ray.origin.toArray();
  const direction = ray.direction.toArray();
  let enter = 0;
  let leave = Infinity;
  let axis = 0;
  for (let k = 0; k < 3; ++k) {
    const a = (low[k] - 0.5 - origin[k]) / direction[k];
    const b = (high[k] + 0.5 - origin[k]) / direction[k];
    if (Math.min(a, b) > enter) {
      enter = Math.min(a, b);
      axis = k;
    }
    leave = Math.min(leave, Math.max(a, b));
  }
  const cell = origin.map((value, k) => {
    const at = Math.round(value + direction[k] * (enter + 1e-9));
    return Math.min(Math.max(at, low[k]), high[k]);
  }) as [number, number, number];
  const step = direction.map(Math.sign);
  for (let at = enter; at <= leave + 1e-9; ) {
    if (robot.has(cell)) {
      const face = 2 * axis + (step[axis] > 0 ? 1 : 0);
      const offset = origin.map((value, k) => value + direction[k] * at - cell[k]);
      return { cell, face, isGround: false, offset: offset as unknown as Cell };
    }
    const next = cell.map((value, k) =>
      direction[k] === 0 ? Infinity : (value + step[k] / 2 - origin[k]) / direction[k],
    );
    axis = next.indexOf(Math.min(...next));
    at = next[axis];
    cell[axis] += step[axis];
  }
  return undefined;
}

function pickGround(robot: EditedRobot, ray: Ray): Hit | undefined {
  const distance = (robot.supportZ - 0.5 - ray.origin.z) / ray.direction.z;
  if (!(distance > 0) || distance > 2000) {
    return undefined;
  }
  const x = ray.origin.x + ray.direction.x * distance;
  const y = ray.origin.y + ray.direction.y * distance;
  const cell: Cell = [Math.round(x), Math.round(y), robot.supportZ];
  return { cell, face: 4, isGround: true, offset: [x - cell[0], y - cell[1], -0.5] };
}

/** The neighbour whose seam is near the point on the face, if there is one. */
export function nearSeam(robot: EditedRobot, hit: Hit): number | undefined {
  const SEAM = 0.3;
  let best: number | undefined;
  let reach = SEAM;
  DIRECTIONS.forEach((direction, i) => {
    const along = direction[0] * hit.offset[0] + direction[1] * hit.offset[1] + direction[2] * hit.offset[2];
    const next: Cell = [
      hit.cell[0] + direction[0],
      hit.cell[1] + direction[1],
      hit.cell[2] + direction[2],
    ];
    if (i !== hit.face && along > reach && robot.has(next)) {
      reach = along;
      best = i;
    }
  });
  return best;
}

/** How many cells from `cell` along a direction the ray comes closest, 0 at least. */
export function alongAxis(cell: Cell, face: number, ray: Ray): number {
  const axis = DIRECTIONS[face];
  const d = ray.direction;
  const toStart = [ray.origin.x - cell[0], ray.origin.y - cell[1], ray.origin.z - cell[2]];
  const dot = d.x * axis[0] + d.y * axis[1] + d.z * axis[2];
  const a = toStart[0] * axis[0] + toStart[1] * axis[1] + toStart[2] * axis[2];
  const b = toStart[0] * d.x + toStart[1] * d.y + toStart[2] * d.z;
  const denominator = 1 - dot * dot;
  return denominator < 1e-6 ? 0 : Math.max(0, (a - dot * b) / denominator);
}
