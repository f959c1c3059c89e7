// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Role, cellText, type Cell } from './cell';
import { CUBIC, type Lattice, type Place } from './lattice';
import { TABLE_I, gravityMagnitude, pitchMm, withGravity } from './material';
import {
  NO_SURROUNDINGS, ObstacleIndex, isStraightDown, ownLoads, textOf, withoutModules, type OwnLoads,
  type Surroundings, type Vector,
} from './surroundings';
import { t } from '../texts';

/** Cells are counted from a robot's first one and stay within this distance of it. */
const REACH = 100_000;
const SPAN = 2 * REACH;

/** Between the keys of cells that are an axial step apart. */
const strideOf = ([i, j, k]: Cell) => (i * SPAN + j) * SPAN + k;

/** What a robot has beside its cells and its name, and what the answer depends on. */
export interface Settings {
  /** Void without a floor. */
  supportZ: number;
  material: Float64Array;
  surroundings: Surroundings;
}

/** Modules as the core sees them: x, y, z and role of each; existing ones come first. */
export interface RobotData {
  modules: Int32Array;
  supportZ: number;
  material: Float64Array;
  /** Surroundings as JSON, with the lattice; '' for cubes on a floor under their own weight. */
  more: string;
}

/** Smallest and largest coordinates of nodes, in pitches. */
export interface Box {
  low: [number, number, number];
  high: [number, number, number];
}

const isAtBorder = ({ low, high }: Box, place: Place) =>
  place.some((value, k) => value === low[k] || value === high[k]);

export function widen({ low, high }: Box, place: Place): void {
  for (let k = 0; k < 3; ++k) {
    low[k] = Math.min(low[k], place[k]);
    high[k] = Math.max(high[k], place[k]);
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
  /** Axial. */
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
  private more = NO_SURROUNDINGS;
  private index?: ObstacleIndex;
  private own?: OwnLoads;
  /** Between the keys of a module and of those that hide it. */
  private readonly coverStrides: readonly number[];
  /** The text of the file that it began with, for what the page does not show. */
  base = '';
  /** How many steps that file has behind the planned modules, beside those of its surroundings. */
  laterSteps = 0;

  constructor(readonly lattice: Lattice = CUBIC) {
    this.coverStrides = lattice.coverSteps.map(strideOf);
  }

  get pitchMm(): number {
    return pitchMm(this.material);
  }

  get surroundings(): Surroundings {
    return this.more;
  }

  set surroundings(surroundings: Surroundings) {
    this.more = surroundings;
    this.index = this.own = undefined;
  }

  get hasFloor(): boolean {
    return this.more.support_z !== null;
  }

  /** m/s^2 */
  get gravity(): Vector {
    return this.more.gravity_m_s2 ?? [0, 0, -gravityMagnitude(this.material)];
  }

  get obstacles(): ObstacleIndex {
    return (this.index ??= new ObstacleIndex(this.more.obstacles ?? []));
  }

  /** By the text of a cell. */
  get ownLoads(): OwnLoads {
    return (this.own ??= ownLoads(this.more));
  }

  /** The height of the floor, in pitches. */
  get floorHeight(): number {
    return this.supportZ * this.lattice.layerHeight - this.lattice.halves[this.lattice.down];
  }

  static from(modules: Int32Array, lattice = CUBIC): EditedRobot {
    const robot = new EditedRobot(lattice);
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

  /** The same cells, and all else, in another lattice. */
  inLattice(lattice: Lattice): EditedRobot {
    const robot = EditedRobot.from(this.toModules(), lattice);
    robot.takeSettings(this);
    const { material, ...others } = this.surroundings;
    const { pitch_mm: _, ...stated } = material ?? {};
    robot.surroundings = Object.keys(stated).length > 0 ? { ...others, material: stated } : others;
    const { name, base, laterSteps } = this;
    return Object.assign(robot, { name, base, laterSteps, isEdited: true });
  }

  /** What is there before the first step. */
  withoutPlanned(): EditedRobot {
    const robot = new EditedRobot(this.lattice);
    robot.takeSettings(this);
    for (let slot = 0; slot < this.count; ++slot) {
      if (this.roleAt(slot) !== Role.kPlanned) {
        robot.set(this.cellAt(slot), this.roleAt(slot));
      }
    }
    return robot;
  }

  takeSettings({ supportZ, material, surroundings }: Settings): void {
    Object.assign(this, { supportZ, material, surroundings });
  }

  cellAt(slot: number): Cell {
    return [this.data[4 * slot], this.data[4 * slot + 1], this.data[4 * slot + 2]];
  }

  roleAt(slot: number): Role {
    return this.data[4 * slot + 3];
  }

  /** Where its node is. */
  placeAt(slot: number): Place {
    return this.lattice.place(this.cellAt(slot));
  }

  /** A module with all neighbours, which nobody sees. */
  isHidden(slot: number): boolean {
    const key = this.key(this.cellAt(slot))!;
    return this.coverStrides.length > 0 && this.coverStrides.every((stride) => this.slots.has(key + stride));
  }

  /** Neither a module nor an obstacle is there, nor the floor. */
  isFree(cell: Cell): boolean {
    return !this.has(cell) && !this.obstacles.has(cell) && !(this.hasFloor && cell[2] < this.supportZ);
  }

  set(cell: Cell, role: Role | undefined): void {
    this.origin ??= this.lattice.axial(cell);
    const key = this.key(cell);
    if (key === undefined) {
      throw new RangeError(t('{0} is more than {1} cells from the first module', cellText(cell), REACH));
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
        widen(this.box, this.lattice.place(cell));
      }
    }
  }

  /** Free cells at its faces. */
  freePlaces(): Cell[] {
    const places = new Map<number, Cell>();
    for (let slot = 0; slot < this.count; ++slot) {
      for (const place of this.lattice.neighbours(this.cellAt(slot))) {
        const key = this.key(place);
        if (key !== undefined && this.isFree(place)) {
          places.set(key, place);
        }
      }
    }
    return [...places.values()];
  }

  /** For the core, with the slot of each of its modules: existing ones come first. Most calls need no steps. */
  toData(hasSteps = false): { data: RobotData; slots: Int32Array } {
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
    const { supportZ } = this;
    return { data: { modules, supportZ, material: this.wholeMaterial, more: this.moreText(hasSteps) }, slots };
  }

  /** For the core, as the robot would be without some of its modules. */
  dataWithout(cells: readonly Cell[]): RobotData {
    const { data } = this.toData();
    const gone = new Set(cells.map(String));
    const rows = Array.from({ length: this.count }, (_, i) => data.modules.subarray(4 * i, 4 * i + 4));
    const left = rows.filter((row) => !gone.has(String([...row.subarray(0, 3)])));
    return { ...data, modules: Int32Array.from(left.flatMap((row) => [...row])), more: this.moreText(false, withoutModules(this.more, cells)) };
  }

  /** x, y, z and role of each module, in the order of its slots. */
  toModules(): Int32Array {
    return this.data.slice(0, 4 * this.count);
  }

  /** Of all nodes; undefined if there is none. Kept, and found again only after a removal there. */
  bounds(): Readonly<Box> | undefined {
    if (!this.box && this.count > 0) {
      const first = this.placeAt(0);
      this.box = { low: [...first], high: [...first] };
      for (let slot = 1; slot < this.count; ++slot) {
        widen(this.box, this.placeAt(slot));
      }
    }
    return this.box;
  }

  /** Cubes on a floor without slip under their own weight. */
  get isPlain(): boolean {
    return this.lattice === CUBIC && Object.keys(this.more).every((key) => key === 'steps' || key === 'material');
  }

  /** Gravity straight down is a number of the material, for the core as in files. */
  private get wholeMaterial(): Float64Array {
    return isStraightDown(this.gravity) ? withGravity(this.material, -this.gravity[2]) : this.material;
  }

  private moreText(hasSteps: boolean, more = this.more): string {
    const { steps, gravity_m_s2, ...rest } = more;
    const gravity = gravity_m_s2 === undefined || isStraightDown(gravity_m_s2) ? {} : { gravity_m_s2 };
    const isPlain = this.isPlain && rest.material === undefined && (!hasSteps || steps === undefined);
    return isPlain
      ? ''
      : textOf({ ...rest, ...gravity, ...(hasSteps && steps !== undefined ? { steps } : {}), lattice: this.lattice.name });
  }

  private key(cell: Cell): number | undefined {
    const [i, j, k] = this.lattice.axial(cell);
    const [oi, oj, ok] = this.origin ?? [i, j, k];
    const dx = i - oi + REACH;
    const dy = j - oj + REACH;
    const dz = k - ok + REACH;
    // One cell is left free on every side, so that strides stay in the lattice.
    const isNear = Math.min(dx, dy, dz) > 0 && Math.max(dx, dy, dz) < SPAN - 1;
    return isNear ? (dx * SPAN + dy) * SPAN + dz : undefined;
  }

  private drop(key: number, slot: number | undefined): void {
    if (slot === undefined) {
      return;
    }
    this.slots.delete(key);
    if (this.box && isAtBorder(this.box, this.placeAt(slot))) {
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
