// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Finding } from '../core/judge';
import { widen, type Box, type EditedRobot } from '../model/edited_robot';
import type { Place } from '../model/lattice';
import { byId } from './dom';

/** What the picture may be of, and how much of it there is. */

/** In pixels of the canvas; where there is little room the verdict and the tools stand beside it. */
export function coveredParts(): { top: number; bottom: number } {
  const height = (part: HTMLElement) => (getComputedStyle(part).position === 'absolute' ? part.offsetHeight : 0);
  return { top: height(byId('verdict').parentElement!), bottom: height(byId('toolbar')) };
}

/** What the picture and the panel are of: the robot that is built, a stage of its steps, its deformed shape. */
export type Mode = 'build' | 'stage' | 'deformed';

/** What is shown in place of the robot that is built: a moment of a sequence, or of the robot under load. */
export interface Exhibit {
  mode: Exclude<Mode, 'build'>;
  robot: EditedRobot;
  finding: Finding;
  /** Of all moments of the sequence. */
  bounds?: Readonly<Box>;
  /** How much displacements are magnified. */
  exaggeration?: number;
}

/** Of modules, and of obstacles as far from them as they are large; further ones would hide the robot. */
export function boundsOf(robot: EditedRobot): Box | undefined {
  const own = robot.bounds();
  if (!own) {
    return undefined;
  }
  const reach = Math.max(4, ...own.high.map((high, k) => high - own.low[k]));
  const box: Box = { low: [...own.low], high: [...own.high] };
  const near = (place: Place) =>
    place.map((value, k) => Math.min(Math.max(value, own.low[k] - reach), own.high[k] + reach)) as unknown as Place;
  for (const { from, to, cells } of robot.obstacles.obstacles) {
    (cells ?? [from!, to!]).forEach((cell) => widen(box, near(robot.lattice.place(cell))));
  }
  return box;
}
