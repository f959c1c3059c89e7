// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import VOCABULARY from 'virtual:vocabulary';
import { plus, type Cell } from './cell';

/** Lattices as the core has them (holdfast/base/lattice.hpp), and what modules of each look like. */

export type LatticeName = 'cubic' | 'face-centred' | 'hexagonal' | 'hexagonal-prism';

/** A point or a vector of the global frame, in pitches, the least of them where they differ by direction. */
export type Place = readonly [x: number, y: number, z: number];

export type Shape = 'cube' | 'sphere' | 'disc' | 'prism';

/** A lattice as a table, the same numbers as those of base::Lattice. */
export interface LatticeTable {
  name: LatticeName;
  /** To the neighbours, axial, by direction; the opposite of direction d is d ^ 1. */
  steps: Cell[];
  /** Of the axial coordinates, in pitches. */
  basis: [Place, Place, Place];
  shear: [number, number];
  /** The direction straight down; that of no neighbour where it is the number of directions. */
  down: number;
}

const LOOKS: Record<LatticeName, { shape: Shape; title: string }> = {
  cubic: { shape: 'cube', title: 'Cubes' },
  'face-centred': { shape: 'sphere', title: 'Spheres, 3D catoms' },
  hexagonal: { shape: 'disc', title: 'Discs, 2D catoms' },
  'hexagonal-prism': { shape: 'prism', title: 'Hexagonal prisms' },
};

/** Half the length of a disc along y. */
export const DISC_HALF = 0.25;

export const dot = (a: Place, b: Place) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const minus = (a: Place, b: Place): Place => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];

/** A wall of the space that is nearer to a node than to any other: halfway to another node. */
interface Wall {
  /** Axial, to that node. */
  step: Cell;
  /** To that node. */
  normal: Place;
  /** What the scalar product with `normal` is on the wall: half the square of its length. */
  reach: number;
}

const UNSTRETCHED: Place = [1, 1, 1];

export class Lattice {
  readonly name: LatticeName;
  readonly title: string;
  readonly shape: Shape;
  readonly down: number;
  /** Through the facet of each direction, of length one, straight down included. */
  readonly units: readonly Place[];
  /** From the node to that facet. */
  readonly halves: readonly number[];
  /** By direction; more where modules of one layer stand beside another layer without touching it. */
  readonly walls: readonly Wall[];
  /** Axial steps to all cells that have to be taken for a module to be out of sight; none: it never is. */
  readonly coverSteps: readonly Cell[];
  /** Names of the directions, straight down included. */
  readonly sides: readonly string[];

  private readonly basis: [Place, Place, Place];

  /** `stretch`: by how much longer modules are along each axis than along the shortest. */
  constructor(
    private readonly table: LatticeTable,
    readonly stretch: Place = UNSTRETCHED,
  ) {
    const { name, steps, down } = table;
    this.basis = table.basis.map((vector) => vector.map((value, k) => value * stretch[k])) as unknown as [Place, Place, Place];
    this.name = name;
    this.title = LOOKS[name].title;
    this.shape = LOOKS[name].shape;
    this.down = down;
    const ways = steps.map((step) => this.placeOfAxial(step));
    const lengths = ways.map((way) => Math.hypot(...way));
    const units = ways.map((way, i) => (isOne(lengths[i]) ? way : (way.map((value) => value / lengths[i]) as unknown as Place)));
    this.units = down < steps.length ? units : [...units, [0, 0, -1]];
    this.halves = this.units.map((_, i) => (i >= steps.length || isOne(lengths[i]) ? 0.5 : lengths[i] / 2));
    const layers: Cell[] = this.shape === 'disc' ? [[0, 1, 0], [0, -1, 0]] : [];
    this.walls = [...steps, ...layers].map((step) => {
      const normal = this.placeOfAxial(step);
      const square = dot(normal, normal);
      return { step, normal, reach: isOne(square) ? 0.5 : square / 2 };
    });
    this.coverSteps = coverSteps(this, steps);
    this.sides = this.units.map(sideName);
  }

  get directionCount(): number {
    return this.table.steps.length;
  }

  /** Between two layers of cells, in pitches. */
  get layerHeight(): number {
    return this.basis[2][2];
  }

  /** The same lattice, with modules that are as long as wide. */
  get unstretched(): Lattice {
    return latticeOf(this.name)!;
  }

  /** The same lattice, with modules that are so long along x, y and z. */
  of(pitches: Place | undefined): Lattice {
    if (!pitches) {
      return this;
    }
    const least = Math.min(...pitches);
    const key = `${this.name} ${pitches.map((pitch) => pitch / least)}`;
    const found = STRETCHED.get(key) ?? new Lattice(this.table, pitches.map((pitch) => pitch / least) as unknown as Place);
    STRETCHED.set(key, found);
    return found;
  }

  axial([x, y, z]: Cell): Cell {
    const { shear } = this.table;
    return [x - shear[0] * (z >> 1), y - shear[1] * (z >> 1), z];
  }

  cell([i, j, k]: Cell): Cell {
    const { shear } = this.table;
    return [i + shear[0] * (k >> 1), j + shear[1] * (k >> 1), k];
  }

  neighbour(cell: Cell, direction: number): Cell {
    return this.cell(plus(this.axial(cell), this.walls[direction].step));
  }

  neighbours(cell: Cell): Cell[] {
    return this.table.steps.map((_, direction) => this.neighbour(cell, direction));
  }

  /** Where the node of a cell is. */
  place(cell: Cell): Place {
    return this.placeOfAxial(this.axial(cell));
  }

  placeOfAxial([i, j, k]: Cell): Place {
    const [a, b, c] = this.basis;
    return [i * a[0] + j * b[0] + k * c[0], i * a[1] + j * b[1] + k * c[1], i * a[2] + j * b[2] + k * c[2]];
  }

  /** The axial coordinates of the node that is nearest to a point. */
  nearestAxial([x, y, z]: Place): Cell {
    const [a, b, c] = this.basis;
    const k = z / c[2];
    const j = (y - k * c[1]) / b[1];
    const i = (x - j * b[0] - k * c[0]) / a[0];
    let axial: Cell = [Math.round(i), Math.round(j), Math.round(k)];
    for (let wall; (wall = this.wallBefore(axial, [x, y, z])); ) {
      axial = plus(axial, wall.step);
    }
    return axial;
  }

  /** The cell of the layer z that is nearest to a point. */
  nearestInLayer([x, y]: Place, z: number): Cell {
    const height = z * this.layerHeight;
    const axial = this.nearestAxial([x, y, height]);
    if (axial[2] === z) {
      return this.cell(axial);
    }
    // Above a gap of that layer the nearest node of all may be in another one.
    const near = this.walls.map(({ step }) => plus(axial, step)).filter((one) => one[2] === z);
    const distance = (one: Cell) => {
      const [px, py] = this.placeOfAxial(one);
      return Math.hypot(px - x, py - y);
    };
    return this.cell(near.reduce((best, one) => (distance(one) < distance(best) ? one : best)));
  }

  /** The direction of a neighbour that points most along a vector. */
  directionOf(vector: Place): number {
    let best = 0;
    for (let direction = 1; direction < this.directionCount; ++direction) {
      if (dot(this.units[direction], vector) > dot(this.units[best], vector)) {
        best = direction;
      }
    }
    return best;
  }

  private wallBefore(axial: Cell, place: Place): Wall | undefined {
    const offset = minus(place, this.placeOfAxial(axial));
    return this.walls.find(({ normal, reach }) => dot(normal, offset) > reach + 1e-9);
  }
}

/** A length that is one but for rounding, as all are where nothing is stretched. */
const isOne = (length: number) => Math.abs(length - 1) < 1e-9;

/** Those that were asked for, so that equal ones are one object. */
const STRETCHED = new Map<string, Lattice>();

/** Cubes and prisms are hidden by their neighbours; spheres leave gaps, behind which the next ones have to be. */
function coverSteps(lattice: Lattice, steps: readonly Cell[]): Cell[] {
  if (lattice.shape === 'disc') {
    return [];
  }
  const seconds = new Map<string, Cell>();
  if (lattice.shape === 'sphere') {
    for (const step of steps.flatMap((a) => steps.map((b) => plus(a, b)))) {
      const place = lattice.placeOfAxial(step);
      if (Math.abs(dot(place, place) - 2) < 1e-9) {
        seconds.set(String(step), step);
      }
    }
  }
  return [...steps, ...seconds.values()];
}

/** "+x", "−x+y+z": the signs of a vector's coordinates. */
function sideName(vector: Place): string {
  return vector
    .map((value, i) => (Math.abs(value) < 1e-9 ? '' : `${value < 0 ? '−' : '+'}${'xyz'[i]}`))
    .join('');
}

export const LATTICES: readonly Lattice[] = VOCABULARY.lattices.map((table) => new Lattice(table));

export const CUBIC = LATTICES[0];

/** Undefined for a name that is none. */
export const latticeOf = (name: string): Lattice | undefined => LATTICES.find((one) => one.name === name);
