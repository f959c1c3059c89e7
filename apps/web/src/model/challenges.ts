// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Answer } from '../core/types';
import { Role, type Cell } from './cell';
import type { EditedRobot } from './edited_robot';
import { textOf } from './surroundings';
import { t } from '../texts';

/** Puzzles: a robot to begin with, and what has to be true of it in the end. The core judges. */

export interface Challenge {
  id: string;
  title: string;
  text: string;
  modules: readonly Cell[];
  /** Further members of the structure's file. */
  more?: object;
  /** Cells that a module is to be in. */
  reach?: readonly Cell[];
  /** Most modules that may come to those of the beginning, all of which stay. */
  budget?: number;
  /** Most modules in all, of which those of `reach` stay. */
  most?: number;
  /** The largest load ratio that is allowed, if it is below 1. */
  ratio?: number;
  /** Each state on the way is to hold, too. */
  isAlwaysSafe?: boolean;
}

/** The cells of a straight line, both ends included. */
function line(a: Cell, b: Cell): Cell[] {
  const count = Math.max(...a.map((value, k) => Math.abs(b[k] - value)));
  return Array.from({ length: count + 1 }, (_, i) => a.map((value, k) => value + Math.sign(b[k] - value) * i) as unknown as Cell);
}

const box = ([i, j, k]: Cell): Cell[] =>
  Array.from({ length: i * j * k }, (_, n) => [n % i, Math.floor(n / i) % j, Math.floor(n / i / j)]);

const crane = (height: number, arm: number): Cell[] => [
  ...box([3, 3, 1]), ...line([1, 1, 1], [1, 1, height]), ...line([2, 1, height], [1 + arm, 1, height]),
];
const piers = (span: number): Cell[] => [...line([0, 0, 0], [0, 0, 3]), ...line([span + 1, 0, 0], [span + 1, 0, 3])];
const wall = { support_z: null, obstacles: [{ from: [-1, -3, -6], to: [-1, 3, 6], hold: 'bonded' }] };
const table = { modules: box([5, 5, 3]), reach: box([5, 5, 1]).map(([x, y]): Cell => [x, y, 2]) };
/** Gravity on a slope of 15 degrees. */
const slope = { gravity_m_s2: [2.53901466, 0, -9.47573286] };

export const CHALLENGES: readonly Challenge[] = [
  {
    id: 'reach', title: 'Reach out', modules: crane(4, 2), reach: [[5, 1, 4]], budget: 2,
    text: 'Let the arm reach the marked cell. The ghost has the colour of what comes of it; one module further it would break.',
  },
  {
    id: 'stand', title: 'Make it stand', modules: [...line([0, 0, 0], [0, 0, 3]), [1, 0, 3], [2, 0, 3]], budget: 1,
    text: 'It falls over the edge of its only foot. One module makes it stand.',
  },
  {
    id: 'prop', title: 'Prop it', modules: [...crane(3, 6)], budget: 3,
    text: 'The arm is too long for its first connection. Hold it from below.',
  },
  {
    id: 'slope', title: 'On a slope', modules: line([0, 0, 0], [0, 0, 3]), more: slope, budget: 1,
    text: 'The ground is steep, and the tower falls down the slope. Where does one module help?',
  },
  {
    id: 'balance', title: 'Balance', modules: line([0, 0, 0], [0, 0, 2]), reach: [[4, 0, 2], [-4, 0, 2]], budget: 8, isAlwaysSafe: true,
    text: 'Two long arms on one foot. Attach the modules in an order in which it never falls.',
  },
  {
    id: 'shelf', title: 'A shelf', modules: [[0, 0, 0]], more: wall, reach: [[5, 0, 0]], budget: 8,
    text: 'From a wall to the marked cell. A straight row breaks by a hair: it needs a bracket.',
  },
  {
    id: 'bridge', title: 'A bridge', modules: piers(14), reach: line([1, 0, 3], [14, 0, 3]), budget: 14,
    text: 'From pier to pier. It holds once it is closed, but not before.',
  },
  {
    id: 'ease', title: 'An easier bridge', modules: piers(14), reach: line([1, 0, 3], [14, 0, 3]), budget: 16, ratio: 0.5,
    text: 'The same bridge, loaded to half its strength at most. Two modules more must do.',
  },
  {
    id: 'load', title: 'A heavy load', modules: crane(5, 3), more: { loads: [{ cell: [4, 1, 5], force_n: [0, 0, -2] }] }, budget: 5,
    text: 'A load of 2 N hangs at the tip and breaks the arm. Five modules carry it to the ground.',
  },
  {
    id: 'table', title: 'A light table', ...table, most: 31,
    text: 'Take away what it does not need below its top: 31 modules are enough.',
  },
  {
    id: 'mushroom', title: 'A mushroom', ...table, most: 27,
    text: 'And with 27 in all?',
  },
  {
    id: 'catoms', title: 'Spheres on a wall', modules: [[0, 0, 0]], reach: [[5, 0, 0]], budget: 7,
    more: { lattice: 'face-centred', support_z: null, obstacles: [{ from: [-1, -2, -3], to: [-1, 3, 3], hold: 'bonded' }] },
    text: 'Catoms touch twelve neighbours. A row of six breaks; which other rows help it?',
  },
];

export const fileOf = ({ title, modules, more }: Challenge): string =>
  JSON.stringify({ format: 'holdfast-structure', version: 2, name: title, modules, ...more });

export interface Condition {
  text: string;
  isMet: boolean;
}

/** A challenge that was begun, and what was there then. */
export class Attempt {
  private readonly cells: readonly Cell[];
  private readonly settings: string;
  private wasUnsafe = false;

  constructor(
    readonly challenge: Challenge,
    begun: EditedRobot,
  ) {
    this.cells = Array.from({ length: begun.count }, (_, slot) => begun.cellAt(slot));
    this.settings = settingsOf(begun);
  }

  /** What has to be true, and whether it is, of the robot and the answer to it. */
  conditions(robot: EditedRobot, answer: Answer | undefined): Condition[] {
    const { reach = [], budget, most, ratio, isAlwaysSafe } = this.challenge;
    const isSafe = answer?.verdict === 'safe';
    this.wasUnsafe ||= answer !== undefined && !isSafe && robot.count !== this.cells.length;
    const more = robot.count - this.cells.length;
    const reached = reach.filter((cell) => robot.has(cell)).length;
    const isWhole = budget === undefined || this.cells.every((cell) => robot.has(cell));
    return [
      ...(reach.length > 0 ? [{ text: reach.length === 1 ? t('the marked cell is reached') : t('{0} of {1} marked cells are reached', reached, reach.length), isMet: reached === reach.length }] : []),
      ...(budget === undefined ? [] : [{ text: t('{0} of at most {1} modules attached, none taken away', Math.max(more, 0), budget), isMet: more <= budget && isWhole }]),
      ...(most === undefined ? [] : [{ text: t('{0} of at most {1} modules', robot.count, most), isMet: robot.count <= most }]),
      { text: t('it holds'), isMet: isSafe },
      ...(ratio === undefined ? [] : [{ text: t('loaded to {0} % at most', Math.round(100 * ratio)), isMet: isSafe && (answer.load_ratio_max ?? 0) <= ratio }]),
      ...(isAlwaysSafe ? [{ text: t('it held on the way'), isMet: !this.wasUnsafe }] : []),
      ...(settingsOf(robot) === this.settings ? [] : [{ text: t('material, ground and loads are as they were, and no new module is fixed or planned'), isMet: false }]),
    ];
  }
}

/** All but where modules are. */
function settingsOf(robot: EditedRobot): string {
  const roles = Array.from({ length: robot.count }, (_, slot) => robot.roleAt(slot)).filter((role) => role !== Role.kExisting);
  return JSON.stringify([robot.lattice.name, robot.supportZ, [...robot.material], textOf(robot.surroundings), roles]);
}
