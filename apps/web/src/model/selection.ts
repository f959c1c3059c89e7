// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { cellText, equal, plus, type Cell } from './cell';
import type { EditedRobot } from './edited_robot';
import { minus, type Lattice, type Place } from './lattice';
import { withOwnMoved } from './surroundings';
import type { Workbench } from './workbench';
import { t } from '../texts';

/** No more cells than this are filled at once. */
export const FILL_MAX = 10_000;

/** A linear map of the global frame. */
type Turn = (vector: Place) => Place;

const rotation = (axis: 'y' | 'z', degrees: number): Turn => {
  const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
  return axis === 'z' ? ([x, y, z]) => [c * x - s * y, s * x + c * y, z] : ([x, y, z]) => [c * x + s * z, y, c * z - s * x];
};

const TURNS = [rotation('z', 90), rotation('z', 60), rotation('y', 60)];

const MIRRORS: Record<'x' | 'y', Turn> = { x: ([x, y, z]) => [-x, y, z], y: ([x, y, z]) => [x, -y, z] };

const distance = (a: Place, b: Place) => Math.hypot(...minus(a, b));

/** Whether it takes the lattice to itself: every direction of a neighbour to another one. */
const fits = ({ units, directionCount }: Lattice, turn: Turn) =>
  units.slice(0, directionCount).every((unit) => units.some((other) => distance(turn(unit), other) < 1e-9));

/** Cells turned about the node of the first of them, by a map that fits the lattice. */
function turned({ unstretched: lattice }: Lattice, cells: readonly Cell[], turn: Turn): Cell[] {
  const centre = lattice.place(cells[0]);
  return cells.map((cell) => {
    const [x, y, z] = turn(minus(lattice.place(cell), centre));
    return lattice.cell(lattice.nearestAxial([x + centre[0], y + centre[1], z + centre[2]]));
  });
}

/** Cells so many steps away in a direction of the lattice. */
const shifted = (lattice: Lattice, cells: readonly Cell[], direction: number, count: number): Cell[] => {
  const step = lattice.walls[direction].step.map((value) => count * value) as unknown as Cell;
  return cells.map((cell) => lattice.cell(plus(lattice.axial(cell), step)));
};

/** The smallest and the largest of each coordinate. */
const corners = (cells: readonly Cell[]) =>
  [Math.min, Math.max].map((most) => [0, 1, 2].map((k) => cells.reduce((best, cell) => most(best, cell[k]), cells[0][k])));

const allOf = (robot: EditedRobot): Cell[] => Array.from({ length: robot.count }, (_, slot) => robot.cellAt(slot));

/** Modules that the next change is about: chosen in order, moved, copied, turned as one, each in one undoable step. */
export class Selection {
  cells: readonly Cell[] = [];
  /** Called after every choice, and where modules that were chosen are gone. */
  readonly listeners: (() => void)[] = [];

  constructor(private readonly bench: Workbench) {}

  /** Only those of them that are modules. */
  set(cells: readonly Cell[]): void {
    const { robot } = this.bench;
    const chosen = new Map(cells.filter((cell) => robot.has(cell)).map((cell) => [String(cell), cell]));
    this.cells = [...chosen.values()];
    this.listeners.forEach((tell) => tell());
  }

  /** Chooses those that are not chosen; lets go of the others. */
  toggle(cells: readonly Cell[]): void {
    const isIn = (list: readonly Cell[], cell: Cell) => list.some((other) => equal(other, cell));
    const kept = this.cells.filter((cell) => !isIn(cells, cell));
    this.set([...kept, ...cells.filter((cell) => !isIn(this.cells, cell))]);
  }

  /** False if nothing was chosen. */
  clear(): boolean {
    const { length } = this.cells;
    if (length > 0) {
      this.set([]);
    }
    return length > 0;
  }

  /** After a change of the robot. */
  follow(): void {
    if (!this.cells.every((cell) => this.bench.robot.has(cell))) {
      this.set(this.cells);
    }
  }

  all(): void {
    this.set(allOf(this.bench.robot));
  }

  /** All modules as high as those that are chosen. */
  layer(): void {
    const heights = new Set(this.cells.map((cell) => cell[2]));
    this.set([...this.cells, ...allOf(this.bench.robot).filter((cell) => heights.has(cell[2]))]);
  }

  /** All modules between those that are chosen, in cells. */
  box(ends: readonly Cell[] = this.cells): void {
    if (ends.length > 0) {
      const [low, high] = corners(ends);
      const isIn = (cell: Cell) => cell.every((value, k) => low[k] <= value && value <= high[k]);
      this.set([...ends, ...allOf(this.bench.robot).filter(isIn)]);
    }
  }

  /** All modules of the same roles that are connected with those that are chosen. */
  connected(): void {
    const { robot } = this.bench;
    const found = new Map(this.cells.map((cell) => [String(cell), cell]));
    for (const cell of found.values()) {
      for (const other of robot.lattice.neighbours(cell)) {
        if (robot.has(other) && robot.role(other) === robot.role(cell)) {
          found.set(String(other), found.get(String(other)) ?? other);
        }
      }
    }
    this.set([...found.values()]);
  }

  remove(): void {
    if (this.cells.length > 0) {
      this.bench.remove(this.cells);
    }
  }

  /** Puts the load of the tool on all of them. */
  load(): void {
    if (this.isReady()) {
      this.bench.load(this.cells);
    }
  }

  /** One cell on. */
  move(direction: number): void {
    if (this.isReady()) {
      const { lattice } = this.bench.robot;
      this.put(t('moving {0}', this.cells.length), shifted(lattice, this.cells, direction, 1), false);
    }
  }

  /** The same modules again, beside these. The copy is chosen then. */
  copy(direction: number): void {
    if (!this.isReady()) {
      return;
    }
    const { lattice } = this.bench.robot;
    const own = new Set(this.cells.map(String));
    let count = 1;
    let to = shifted(lattice, this.cells, direction, count);
    while (to.some((cell) => own.has(String(cell)))) {
      to = shifted(lattice, this.cells, direction, ++count);
    }
    this.put(t('copying {0}', this.cells.length), to, true);
  }

  /** By the least angle that the lattice has, about the module that was chosen first. */
  turn(): void {
    if (this.isReady()) {
      const { lattice } = this.bench.robot;
      this.put(t('turning {0}', this.cells.length), turned(lattice, this.cells, TURNS.find((turn) => fits(lattice, turn))!), false);
    }
  }

  /** Across the module that was chosen first. */
  mirror(axis: 'x' | 'y'): void {
    if (this.isReady()) {
      this.put(t('mirroring {0}', this.cells.length), turned(this.bench.robot.lattice, this.cells, MIRRORS[axis]), false);
    }
  }

  /** Modules of the role that is chosen in every free cell between these. */
  fill(): void {
    if (!this.isReady()) {
      return;
    }
    const [low, high] = corners(this.cells);
    const counts = high.map((value, k) => value - low[k] + 1);
    const count = counts[0] * counts[1] * counts[2];
    if (count > FILL_MAX) {
      this.bench.refuse(t('There are {0} cells between these modules; at most {1} are filled at once.', count, FILL_MAX));
      return;
    }
    const { robot, role } = this.bench;
    const between = Array.from({ length: count }, (_, i): Cell => {
      const [x, y] = [i % counts[0], Math.floor(i / counts[0]) % counts[1]];
      return [low[0] + x, low[1] + y, low[2] + Math.floor(i / counts[0] / counts[1])];
    });
    const free = between.filter((cell) => robot.isFree(cell));
    this.bench.edit(t('filling {0}', free.length), free, role);
    this.set(between);
  }

  private isReady(): boolean {
    return this.cells.length > 0 && !this.bench.refusesNow();
  }

  /** Modules, with all they have of their own, in other cells: all of them or none. */
  private put(label: string, to: readonly Cell[], isCopied: boolean): void {
    const { cells } = this;
    const { robot } = this.bench;
    const own = new Set(isCopied ? [] : cells.map(String));
    const taken = to.find((cell) => !own.has(String(cell)) && !robot.isFree(cell));
    if (taken) {
      this.bench.refuse(t('There is no room at {0}.', cellText(taken)));
      return;
    }
    const targets = new Set(to.map(String));
    const left = isCopied ? [] : cells.filter((cell) => !targets.has(String(cell)));
    const wanted = [
      ...left.map((cell) => ({ cell, role: undefined })),
      ...to.map((cell, i) => ({ cell, role: robot.role(cells[i]) })),
    ];
    if (this.bench.change(label, wanted, withOwnMoved(robot.surroundings, cells, to, isCopied))) {
      this.bench.history.noteChosen(to);
      this.set(to);
    }
  }
}
