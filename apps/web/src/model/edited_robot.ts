// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { DIRECTIONS, Role, cellText, plus, type Cell } from './cell';
import { TABLE_I, pitchMm } from './material';

/** Cells are counted from a robot's first one and stay within this distance of it. */
const REACH = 100_000;
const SPAN = 2 * REACH;
/** Between the keys of neighbours. */
const STRIDES = [1, SPAN, SPAN * SPAN];

/** What a robot has beside its cells and its name, and what the answer depends on. */
export interface Settings {
  supportZ: number;
  material: Float64Array;
}

/** Modules as the core sees them: x, y, z and role of each; existing ones come first. */
export interface RobotData extends Settings {
  modules: Int32Array;
}

/** Smallest and largest cell, coordinate by coordinate. */
export interface Box {
  low: [number, number, number];
  high: [number, number, number];
}

const isAtBorder = ({ low, high }: Box, cell: Cell) =>
  cell.some((value, k) => value === low[k] || value === high[k]);

function widen({ low, high }: Box, cell: Cell): void {
  for (let k = 0; k < 3; ++k) {
    low[k] = Math.min(low[k], cell[k]);
    high[k] = Math.max(high[k], cell[k]);
  }
}

const randomId = () => Array.from(crypto.getRandomValues(new Uint32Array(3)), (value) => value.toString(36)).join('');

/** One cell before and after; undefined where no module is. */
export interface CellChange {
  cell: Cell;
  before: Role | undefined;
  after: Role | undefined;
}

/**
 * The robot that is being edited: modules in slots without gaps, found by their cell in constant
 * time. It may be anything that cells can be; whether it is a robot is for the core to say.
 */
export class EditedRobot {
  private slots = new Map<number, number>();
  /** x, y, z and role of each slot. */
  private data = new Int32Array(64);
  private origin?: Cell;
  /** Undefined if there is no module, or if it has to be found again. */
  private box?: Box;
  /** Under which it is kept in the browser. */
  id = randomId();
  /** Something of it is in no file and no link. */
  isEdited = false;
  count = 0;
  name = '';
  supportZ = 0;
  material: Float64Array = TABLE_I;
  /** The text of the file that it began with, for what the page does not show. */
  base = '';

  get pitchMm(): number {
    return pitchMm(this.material);
  }

  static from(modules: Int32Array): EditedRobot {
    const robot = new EditedRobot();
    for (let i = 0; i < modules.length; i += 4) {
      robot.set([modules[i], modules[i + 1], modules[i + 2]], modules[i + 3] as Role);
    }
    return robot;
  }

  slot(cell: Cell): number | undefined {
    const key = this.key(cell);
    return key === undefined ? undefined : this.slots.get(key);
  }

  role(cell: Cell): Role | undefined {
    const slot = this.slot(cell);
    return slot === undefined ? undefined : (this.data[4 * slot + 3] as Role);
  }

  has(cell: Cell): boolean {
    return this.slot(cell) !== undefined;
  }

  cellAt(slot: number): Cell {
    return [this.data[4 * slot], this.data[4 * slot + 1], this.data[4 * slot + 2]];
  }

  roleAt(slot: number): Role {
    return this.data[4 * slot + 3];
  }

  /** A module with six neighbours, which nobody sees. */
  isHidden(slot: number): boolean {
    const key = this.key(this.cellAt(slot))!;
    return STRIDES.every((stride) => this.slots.has(key + stride) && this.slots.has(key - stride));
  }

  set(cell: Cell, role: Role | undefined): void {
    this.origin ??= cell;
    const key = this.key(cell);
    if (key === undefined) {
      throw new RangeError(`${cellText(cell)} is more than ${REACH} cells from the first module`);
    }
    const slot = this.slots.get(key);
    if (role === undefined) {
      this.drop(key, slot);
    } else if (slot !== undefined) {
      this.data[4 * slot + 3] = role;
    } else {
      this.slots.set(key, this.count);
      this.write(this.count++, cell, role);
      if (this.box) {
        widen(this.box, cell);
      }
    }
  }

  /** Free cells at its faces, on the support level or above. */
  freePlaces(): Cell[] {
    const places = new Map<number, Cell>();
    for (let slot = 0; slot < this.count; ++slot) {
      const cell = this.cellAt(slot);
      for (const direction of DIRECTIONS) {
        const place = plus(cell, direction);
        const key = this.key(place);
        if (key !== undefined && place[2] >= this.supportZ && !this.slots.has(key)) {
          places.set(key, place);
        }
      }
    }
    return [...places.values()];
  }

  /** Of the centre of mass above the ground, in cells. */
  massHeight(): number {
    let sum = 0;
    for (let slot = 0; slot < this.count; ++slot) {
      sum += this.data[4 * slot + 2];
    }
    return sum / Math.max(this.count, 1) - this.supportZ + 0.5;
  }

  /** For the core, with the slot of each of its modules: existing ones come first. */
  toData(): { data: RobotData; slots: Int32Array } {
    const slots = new Int32Array(this.count);
    let next = 0;
    for (const isPlanned of [false, true]) {
      for (let slot = 0; slot < this.count; ++slot) {
        if ((this.roleAt(slot) === Role.kPlanned) === isPlanned) {
          slots[next++] = slot;
        }
      }
    }
    const modules = new Int32Array(4 * this.count);
    slots.forEach((slot, i) => {
      for (let k = 0; k < 4; ++k) {
        modules[4 * i + k] = this.data[4 * slot + k];
      }
    });
    return { data: { modules, supportZ: this.supportZ, material: this.material }, slots };
  }

  /** x, y, z and role of each module, in the order of its slots. */
  toModules(): Int32Array {
    return this.data.slice(0, 4 * this.count);
  }

  /** Smallest and largest cell; undefined if there is none. Kept, and found again only after a removal there. */
  bounds(): Readonly<Box> | undefined {
    if (!this.box && this.count > 0) {
      const first = this.cellAt(0);
      this.box = { low: [...first], high: [...first] };
      for (let slot = 1; slot < this.count; ++slot) {
        widen(this.box, this.cellAt(slot));
      }
    }
    return this.box;
  }

  private key([x, y, z]: Cell): number | undefined {
    const [ox, oy, oz] = this.origin ?? [x, y, z];
    const dx = x - ox + REACH;
    const dy = y - oy + REACH;
    const dz = z - oz + REACH;
    // One cell is left free on every side, so that strides stay in the lattice.
    const isNear = Math.min(dx, dy, dz) > 0 && Math.max(dx, dy, dz) < SPAN - 1;
    return isNear ? (dx * SPAN + dy) * SPAN + dz : undefined;
  }

  private drop(key: number, slot: number | undefined): void {
    if (slot === undefined) {
      return;
    }
    this.slots.delete(key);
    if (this.box && isAtBorder(this.box, this.cellAt(slot))) {
      this.box = undefined;
    }
    const last = --this.count;
    if (slot !== last) {
      const cell = this.cellAt(last);
      this.write(slot, cell, this.roleAt(last));
      this.slots.set(this.key(cell)!, slot);
    }
  }

  private write(slot: number, cell: Cell, role: Role): void {
    if (4 * slot + 4 > this.data.length) {
      const larger = new Int32Array(2 * this.data.length);
      larger.set(this.data);
      this.data = larger;
    }
    this.data[4 * slot] = cell[0];
    this.data[4 * slot + 1] = cell[1];
    this.data[4 * slot + 2] = cell[2];
    this.data[4 * slot + 3] = role;
  }
}
