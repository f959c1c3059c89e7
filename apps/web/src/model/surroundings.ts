// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { cellText, equal, type Cell } from './cell';
import type { LatticeName } from './lattice';
import { bodyWithout, togetherMoved } from './together';
import { digits, t } from '../texts';

/**
 * What a structure says beyond cells and material: supports, gravity, loads, what single modules have of
 * their own. Members are those of version 2 of the JSON format, whatever the page does not know of them
 * included. Nothing here is ever changed: an edit makes another object.
 */

export type Vector = readonly [x: number, y: number, z: number];

export type Hold = 'contact' | 'bonded';

export const HOLDS = ['contact', 'bonded'] as const;

export interface Obstacle {
  from?: Cell;
  to?: Cell;
  cells?: readonly Cell[];
  hold?: Hold;
  friction?: number;
}

export interface Load {
  cell: Cell;
  force_n?: Vector;
  torque_nmm?: Vector;
}

/** What a module has of its own; more members may stand here. */
export interface OwnModule {
  cell: Cell;
  mass_kg?: number;
  kind?: string;
}

export type Pair = readonly [Cell, Cell];

/** A single connection with limits of its own; more members may stand here. */
export interface OwnConnection {
  between: Pair;
}

/** Cells of a rigid piece: one by one, a box, or what the page does not know. */
export type BodyPart = Cell | { from?: Cell; to?: Cell };

/** A step of a sequence; only what the page itself writes is named. */
export interface StepEntry {
  attach?: readonly Cell[];
  detach?: readonly Cell[];
}

export interface Surroundings {
  lattice?: LatticeName;
  /** Null: there is no floor. */
  support_z?: number | null;
  floor?: { friction?: number };
  gravity_m_s2?: Vector;
  obstacles?: readonly Obstacle[];
  loads?: readonly Load[];
  /** Only modules that have something of their own. */
  modules?: readonly OwnModule[];
  /** Neighbours that are not joined. */
  open?: readonly Pair[];
  connections?: readonly OwnConnection[];
  bodies?: readonly (readonly BodyPart[])[];
  steps?: readonly StepEntry[];
  /** Which neighbours are connected: all but the open ones, or those alone that `connections` lists. */
  joined?: 'all' | 'listed';
  /**
   * Where somebody states that the elastic modulus is what it is by default; any other is stated anyway. Lengths of
   * modules along x, y and z where they differ: their ratios, as the least is the pitch of the robot's material.
   */
  material?: { elastic_modulus_mpa?: number; pitch_mm?: Vector };
}

export const NO_SURROUNDINGS: Surroundings = {};

/** How an obstacle holds, as the file's reader understands it. */
export const holdOf = ({ hold }: Obstacle): Hold => hold ?? 'contact';

/** Without members that are undefined or an empty list, so that nothing to say is `{}`. */
export function tidied(surroundings: Surroundings): Surroundings {
  const isSaid = (value: unknown) => value !== undefined && !(Array.isArray(value) && value.length === 0);
  return Object.fromEntries(Object.entries(surroundings).filter(([, value]) => isSaid(value)));
}

/** What a file has besides: its first members, and the level of its floor, which is the robot's. */
export function withoutHead(surroundings: Surroundings): Surroundings {
  const head = ['format', 'version', 'name', 'description'];
  const isOwn = ([key, value]: [string, unknown]) => !head.includes(key) && !(key === 'support_z' && value !== null);
  return tidied(Object.fromEntries(Object.entries(surroundings).filter(isOwn)));
}

/** As a file of the JSON format. */
export const textOf = (surroundings: Surroundings) =>
  JSON.stringify({ format: 'holdfast-structure', version: 2, modules: [], ...surroundings });

const isInBox = ({ from, to }: Obstacle, cell: Cell) =>
  from !== undefined && to !== undefined && cell.every((value, k) => value >= from[k] && value <= to[k]);

/** Finds obstacles by their cells: boxes one after the other, listed cells in constant time. */
export class ObstacleIndex {
  private readonly boxes: number[] = [];
  private readonly listed = new Map<string, number>();

  constructor(readonly obstacles: readonly Obstacle[]) {
    obstacles.forEach(({ cells }, i) => {
      if (cells) {
        cells.forEach((cell) => this.listed.has(String(cell)) || this.listed.set(String(cell), i));
      } else {
        this.boxes.push(i);
      }
    });
  }

  /** The index of the obstacle in a cell. */
  find(cell: Cell): number | undefined {
    if (this.obstacles.length === 0) {
      return undefined;
    }
    return this.boxes.find((i) => isInBox(this.obstacles[i], cell)) ?? this.listed.get(String(cell));
  }

  has(cell: Cell): boolean {
    return this.find(cell) !== undefined;
  }
}

/** With obstacles in cells, behind the others: in the last list that holds alike, else in a new one. */
export function withObstacles(
  obstacles: readonly Obstacle[],
  cells: readonly Cell[],
  hold: Hold,
  friction: number | undefined,
): Obstacle[] {
  const list = [...obstacles];
  const alike = (one: Obstacle) => one.cells && holdOf(one) === hold && one.friction === friction;
  const last = list.filter(alike).at(-1);
  if (last) {
    list[list.indexOf(last)] = { ...last, cells: [...last.cells!, ...cells] };
  } else if (cells.length > 0) {
    list.push({ cells: [...cells], hold, ...(friction === undefined ? {} : { friction }) });
  }
  return list;
}

/** Without an obstacle in a cell: a box falls into the boxes around it. */
export function withoutObstacle(obstacles: readonly Obstacle[], cell: Cell): Obstacle[] {
  return obstacles.flatMap((obstacle) => {
    if (obstacle.cells) {
      const cells = obstacle.cells.filter((one) => !equal(one, cell));
      return cells.length === 0 ? [] : cells.length === obstacle.cells.length ? [obstacle] : [{ ...obstacle, cells }];
    }
    return isInBox(obstacle, cell) ? boxesAround(obstacle, cell) : [obstacle];
  });
}

/** The box without one of its cells, as up to six boxes. */
function boxesAround(box: Obstacle, cell: Cell): Obstacle[] {
  const [low, high] = [[...box.from!], [...box.to!]];
  const parts: Obstacle[] = [];
  for (const axis of [2, 1, 0]) {
    const add = (first: number, last: number) => {
      if (first <= last) {
        const part = (corner: number[], value: number) =>
          corner.map((old, k) => (k === axis ? value : old)) as unknown as Cell;
        const [from, to] = [part(low, first), part(high, last)];
        parts.push({ ...box, from, to });
      }
    };
    add(low[axis], cell[axis] - 1);
    add(cell[axis] + 1, high[axis]);
    low[axis] = high[axis] = cell[axis];
  }
  return parts;
}

const others = <Entry extends { cell: Cell }>(list: readonly Entry[] | undefined, cells: ReadonlySet<string>) =>
  (list ?? []).filter(({ cell }) => !cells.has(String(cell)));

/** What no module is there for any more goes with it. */
export function withoutModules(surroundings: Surroundings, cells: readonly Cell[]): Surroundings {
  const { loads, modules, open, connections, bodies } = surroundings;
  if (![loads, modules, open, connections, bodies].some((list) => list?.length)) {
    return surroundings;
  }
  const gone = new Set(cells.map(String));
  return tidied({
    ...surroundings,
    loads: others(loads, gone),
    modules: others(modules, gone),
    open: open?.filter((pair) => !pair.some((cell) => gone.has(String(cell)))),
    connections: connections?.filter(({ between }) => !between.some((cell) => gone.has(String(cell)))),
    bodies: bodies?.flatMap((body) => bodyWithout(body, gone)),
  });
}

/** What modules have of their own goes with them to other cells, or is there twice if they are copied. */
export function withOwnMoved(surroundings: Surroundings, cells: readonly Cell[], to: readonly Cell[], isCopied: boolean): Surroundings {
  const targets = new Map(cells.map((cell, i) => [String(cell), to[i]]));
  const left = new Set(isCopied ? [] : targets.keys());
  const moved = <Entry extends { cell: Cell }>(list: readonly Entry[] = []) => [
    ...others(list, left),
    ...list.filter(({ cell }) => targets.has(String(cell))).map((entry) => ({ ...entry, cell: targets.get(String(entry.cell))! })),
  ];
  const together = togetherMoved(surroundings, targets, isCopied);
  return tidied({ ...surroundings, ...together, loads: moved(surroundings.loads), modules: moved(surroundings.modules) });
}

/** What a load tool puts on a module. */
export interface Burden {
  /** Undefined: that of its kind or of the material. */
  mass?: number;
  force: Vector;
  torque: Vector;
}

const isZero = (vector: Vector) => vector.every((value) => value === 0);

export const isNothing = ({ mass, force, torque }: Burden) =>
  mass === undefined && isZero(force) && isZero(torque);

/** With the same mass and load on all of these modules, whatever they had. */
export function withBurden(surroundings: Surroundings, cells: readonly Cell[], burden: Burden): Surroundings {
  const touched = new Set(cells.map(String));
  const { mass, force, torque } = burden;
  const loads = others(surroundings.loads, touched);
  if (!isZero(force) || !isZero(torque)) {
    const members = { ...(isZero(force) ? {} : { force_n: force }), ...(isZero(torque) ? {} : { torque_nmm: torque }) };
    loads.push(...cells.map((cell) => ({ cell, ...members })));
  }
  const modules = others(surroundings.modules, touched);
  const own = new Map((surroundings.modules ?? []).map((one) => [String(one.cell), one]));
  for (const cell of cells) {
    const { mass_kg: _, ...rest } = own.get(String(cell)) ?? { cell };
    if (mass !== undefined) {
      modules.push({ ...rest, cell, mass_kg: mass });
    } else if (Object.keys(rest).length > 1) {
      modules.push({ ...rest, cell });
    }
  }
  return tidied({ ...surroundings, loads, modules });
}

/** What is put on a module, to be shown. */
export interface OwnLoads {
  loads: ReadonlyMap<string, Load>;
  modules: ReadonlyMap<string, OwnModule>;
}

export function ownLoads({ loads, modules }: Surroundings): OwnLoads {
  return {
    loads: new Map((loads ?? []).map((load) => [String(load.cell), load])),
    modules: new Map((modules ?? []).map((own) => [String(own.cell), own])),
  };
}

/** Gravity as a slope: how steep in degrees, where downhill is in degrees from +x to +y, how strong. */
export interface Slope {
  angle: number;
  downhill: number;
  strength: number;
}

const DEGREE = Math.PI / 180;

/** No digits that are rounding. */
const rounded = (value: number) => Number(value.toPrecision(12)) + 0;

export const isStraightDown = ([x, y, z]: Vector) => x === 0 && y === 0 && z < 0;

export function gravityOf({ angle, downhill, strength }: Slope): Vector {
  if (angle === 0) {
    return [0, 0, -strength];
  }
  const level = strength * Math.sin(angle * DEGREE);
  const parts = [level * Math.cos(downhill * DEGREE), level * Math.sin(downhill * DEGREE), -strength * Math.cos(angle * DEGREE)];
  return parts.map((value) => (Math.abs(value) < 1e-12 * strength ? 0 : rounded(value))) as unknown as Vector;
}

export function slopeOf([x, y, z]: Vector): Slope {
  const level = Math.hypot(x, y);
  return {
    angle: rounded(Math.atan2(level, -z) / DEGREE),
    downhill: level === 0 ? 0 : rounded(Math.atan2(y, x) / DEGREE),
    strength: Math.hypot(level, z),
  };
}

/** For who listens. */
export const obstacleText = (cell: Cell, { hold, friction }: Obstacle) =>
  `${cellText(cell)}, ${t('obstacle, {0}', t(hold ?? 'contact'))}${
    friction === undefined ? '' : `, ${t('friction {0}', digits(String(friction)))}`
  }`;
