// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Ray } from 'three';
import type { Cell } from '../model/cell';
import type { Box, EditedRobot } from '../model/edited_robot';
import { DISC_HALF, dot, minus, type Lattice, type Place } from '../model/lattice';
import { obstacleBox } from './obstacles';
import { cutsAway, type Section } from './section';

/** Where a ray meets the robot, an obstacle or the ground. */
export interface Hit {
  cell: Cell;
  /** The direction of the face that was met; a ground cell is met from above. */
  face: number;
  what: 'module' | 'obstacle' | 'ground';
  /** Where on the face, from the cell's node, in pitches. */
  offset: Place;
}

/**
 * Walks through the lattice from cell to cell, as [Amanatides 1987] in cubes: the robot's size costs nothing.
 * Modules that a section cuts away are met by nothing.
 */
export function pick(robot: EditedRobot, ray: Ray, section?: Section): Hit | undefined {
  const box = boxOf(robot);
  return (box && walk(robot, ray, box, section)) ?? pickGround(robot, ray);
}

/** Around everything that can be met. */
function boxOf(robot: EditedRobot): Box | undefined {
  const bounds = robot.bounds();
  if (robot.obstacles.obstacles.length === 0) {
    return bounds;
  }
  const box: Box = bounds
    ? { low: [...bounds.low], high: [...bounds.high] }
    : { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
  obstacleBox(robot, box);
  return box.low[0] <= box.high[0] ? box : undefined;
}

const pointAt = (ray: Ray, distance: number): Place => [
  ray.origin.x + ray.direction.x * distance,
  ray.origin.y + ray.direction.y * distance,
  ray.origin.z + ray.direction.z * distance,
];

/** Where a ray is inside of a box around nodes, with a cell of room on every side. */
function passage(ray: Ray, { low, high }: Box, stretch: Place): [enter: number, leave: number] {
  const ROOM = Math.max(...stretch);
  const [origin, direction] = [ray.origin.toArray(), ray.direction.toArray()];
  let [enter, leave] = [0, Infinity];
  for (let k = 0; k < 3; ++k) {
    const a = (low[k] - ROOM - origin[k]) / direction[k];
    const b = (high[k] + ROOM - origin[k]) / direction[k];
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return [enter, leave];
}

function walk(robot: EditedRobot, ray: Ray, box: Box, section?: Section): Hit | undefined {
  const { lattice } = robot;
  const { walls } = lattice;
  const sight = ray.direction.toArray() as unknown as Place;
  const [enter, leave] = passage(ray, box, lattice.stretch);
  if (!(enter <= leave)) {
    return undefined;
  }
  const slopes = walls.map(({ normal }) => dot(normal, sight));
  let axial = lattice.nearestAxial(pointAt(ray, enter));
  // Where the walk begins there is no module, unless the eye is among them.
  let face = lattice.directionOf(minus([0, 0, 0], sight));
  for (let at = enter; at <= leave; ) {
    const node = lattice.placeOfAxial(axial);
    const hit = cutsAway(section, node) ? undefined : meet(robot, lattice.cell(axial), node, ray, at, face);
    if (hit) {
      return hit;
    }
    const start = minus(node, pointAt(ray, 0));
    let next = Infinity;
    let through = 0;
    for (let wall = 0; wall < walls.length; ++wall) {
      const distance = (walls[wall].reach + dot(walls[wall].normal, start)) / slopes[wall];
      if (slopes[wall] > 1e-12 && distance < next) {
        next = distance;
        through = wall;
      }
    }
    at = next;
    face = through ^ 1;
    const { step } = walls[through];
    axial = [axial[0] + step[0], axial[1] + step[1], axial[2] + step[2]];
  }
  return undefined;
}

/** What of a cell a ray meets that comes in through a face. */
function meet(robot: EditedRobot, cell: Cell, node: Place, ray: Ray, at: number, face: number): Hit | undefined {
  const isModule = robot.has(cell);
  if (!isModule && !robot.obstacles.has(cell)) {
    return undefined;
  }
  const { lattice } = robot;
  const isRound = isModule && (lattice.shape === 'sphere' || lattice.shape === 'disc');
  const distance = isRound ? roundDistance(lattice, node, ray) : at;
  if (distance === undefined) {
    return undefined;
  }
  const offset = minus(pointAt(ray, distance), node);
  const isFacet = face < lattice.directionCount && !isRound;
  return {
    cell,
    face: isFacet ? face : lattice.directionOf(offset),
    what: isModule ? 'module' : 'obstacle',
    offset,
  };
}

/** To a ball, or to a disc that stands across y; undefined if the ray misses it. */
function roundDistance(lattice: Lattice, node: Place, ray: Ray): number | undefined {
  const toOrigin = minus(pointAt(ray, 0), node);
  const sight = ray.direction.toArray() as unknown as Place;
  const flat = ([x, y, z]: Place): Place => (lattice.shape === 'disc' ? [x, 0, z] : [x, y, z]);
  const [a, b] = [dot(flat(sight), flat(sight)), dot(flat(sight), flat(toOrigin))];
  const root = b * b - a * (dot(flat(toOrigin), flat(toOrigin)) - 0.25);
  if (root < 0) {
    return undefined;
  }
  let [enter, leave] = [(-b - Math.sqrt(root)) / a, (-b + Math.sqrt(root)) / a];
  if (lattice.shape === 'disc') {
    const ends = [-DISC_HALF, DISC_HALF].map((y) => (y - toOrigin[1]) / sight[1]);
    enter = Math.max(enter, Math.min(...ends));
    leave = Math.min(leave, Math.max(...ends));
  }
  return enter <= leave ? enter : undefined;
}

/** Where there is no floor, its plane is there for the first module and for obstacles. */
function pickGround(robot: EditedRobot, ray: Ray): Hit | undefined {
  const distance = (robot.floorHeight - ray.origin.z) / ray.direction.z;
  if (!(distance > 0) || distance > 2000) {
    return undefined;
  }
  const { lattice } = robot;
  const point = pointAt(ray, distance);
  const cell = lattice.nearestInLayer(point, robot.supportZ);
  const face = lattice.directionOf([0, 0, 1]);
  return { cell, face, what: 'ground', offset: minus(point, lattice.place(cell)) };
}

/** The neighbour whose seam is near the point that was met, if there is one. */
export function nearSeam(robot: EditedRobot, hit: Hit): number | undefined {
  const { lattice } = robot;
  const isRound = lattice.shape === 'sphere';
  let best: number | undefined;
  let reach = isRound ? 0.42 : 0.3;
  for (let i = 0; i < lattice.directionCount; ++i) {
    const along = dot(lattice.units[i], hit.offset);
    const isSeen = i !== hit.face || isRound || lattice.shape === 'disc';
    if (isSeen && along > reach && robot.has(lattice.neighbour(hit.cell, i))) {
      reach = along;
      best = i;
    }
  }
  return best;
}

/** How many cells from a node along a direction the ray comes closest, 0 at least. */
export function alongAxis(node: Place, axis: Place, ray: Ray): number {
  const d = ray.direction;
  const toStart = [ray.origin.x - node[0], ray.origin.y - node[1], ray.origin.z - node[2]];
  const dot = d.x * axis[0] + d.y * axis[1] + d.z * axis[2];
  const a = toStart[0] * axis[0] + toStart[1] * axis[1] + toStart[2] * axis[2];
  const b = toStart[0] * d.x + toStart[1] * d.y + toStart[2] * d.z;
  const denominator = 1 - dot * dot;
  return denominator < 1e-6 ? 0 : Math.max(0, (a - dot * b) / denominator);
}
