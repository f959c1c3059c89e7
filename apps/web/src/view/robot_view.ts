// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import {
  BoxGeometry, type BufferGeometry, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, TorusGeometry, Vector3,
} from 'three';
import { mergeGeometries } from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import { LOAD_FIELDS, MOTION_FIELDS, type Answer } from '../core/types';
import { Role, type Cell } from '../model/cell';
import type { EditedRobot } from '../model/edited_robot';
import { CUBIC, type Lattice, type Place } from '../model/lattice';
import {
  FIXED, NEUTRAL, UNKNOWN, UNSTABLE, brokenColour, loadColour, loadStep, mix, stepColours, type Rgb, type ScaleName, type Subject,
} from './colours';
import { Bars, type Bar } from './bars';
import { ModuleMesh, Pattern } from './modules';
import { cellEdges } from './polyhedron';
import { cutsAway, opens, type Section } from './section';
import type { Stage } from './stage';

/** An answer and the slots that its modules had when it was asked for. */
export interface Judged {
  answer: Answer;
  slots: Int32Array;
}

/** What a face of a free place shows. */
export const enum FaceCode {
  kNone,
  kSafe,
  kOverload,
  kUnstable,
  kUndecided,
  kWaiting,
}

/** In cells. */
const CURSOR_SIZE = 1.07;
const WHITE: Rgb = [255, 255, 255];
/** From node to node, in lengths of a bar. */
const WHOLE_BAR = 1 / 0.75;
/** Of ribbons, in radii of a bar: nothing flows, and most. */
const RIBBON_WIDTHS = [0.35, 3.2] as const;
/** Of bars beside a ribbon. */
const THIN = 0.4;
const FACE_BASE = 8;
/** Codes of so many faces stand in one number. */
const FACES_PER_NUMBER = 6;
const FACE_WEIGHTS = Array.from({ length: FACES_PER_NUMBER }, (_, side) => FACE_BASE ** side);

/** The two numbers of a module's faces, from the code of each direction. */
function packed(lattice: Lattice, codeOf: (direction: number) => FaceCode): [number, number] {
  const numbers: [number, number] = [0, 0];
  for (let side = 0; side < lattice.directionCount; ++side) {
    numbers[Math.floor(side / FACES_PER_NUMBER)] += codeOf(side) * FACE_BASE ** (side % FACES_PER_NUMBER);
  }
  return numbers;
}

/** What the robot cannot do without: connections by index, modules by slot. */
export interface Losses {
  connections: ReadonlySet<number>;
  modules: ReadonlySet<number>;
}

/** The load of each module: the largest ratio of its connections, and whether one breaks. */
export interface ModuleLoads {
  ratio: Float64Array;
  isBroken: Uint8Array;
}

export function moduleLoads(judged: Judged): ModuleLoads {
  const { answer, slots } = judged;
  const ratio = new Float64Array(slots.length).fill(Number.NEGATIVE_INFINITY);
  const isBroken = new Uint8Array(slots.length);
  for (let i = 0; 3 * i < answer.connections.length; ++i) {
    for (const end of [answer.connections[3 * i], answer.connections[3 * i + 1]]) {
      const slot = slots[end];
      const value = answer.loads[LOAD_FIELDS * i];
      ratio[slot] = Number.isNaN(value) ? value : Math.max(ratio[slot], value);
    }
  }
  for (const i of answer.broken) {
    isBroken[slots[answer.connections[3 * i]]] = 1;
    isBroken[slots[answer.connections[3 * i + 1]]] = 1;
  }
  return { ratio, isBroken };
}

/** What flows along a way: connections by index, and the field of their loads that gives the width. */
export interface Flow {
  connections: readonly number[];
  field: number;
}

/** Draws the robot: modules with what is known of them, ghosts, the cursor, the worst connection. */
export class RobotView {
  private readonly modules = new ModuleMesh();
  private readonly ghosts = new ModuleMesh(0.72);
  private readonly bars = new Bars();
  /** Loads are shown inside the robot too. */
  private isXray = false;
  private shownFlow?: Flow;
  /** What is in front of it is not shown. */
  section?: Section;
  private lattice = CUBIC;
  private readonly cursor = new LineSegments(
    cellEdges(CUBIC, CURSOR_SIZE),
    new LineBasicMaterial({ depthTest: false, transparent: true }),
  );
  private readonly collar = new Mesh(collarGeometry(CUBIC), new MeshBasicMaterial());
  /** Slots that are drawn; hidden modules are not. */
  private drawn = new Int32Array(0);
  /** Where in `drawn` each slot is; -1: nowhere. */
  private instances = new Int32Array(0);
  private robot?: EditedRobot;
  private judged?: Judged;
  private loads?: ModuleLoads;
  private hasFaces = false;
  private mechanism?: Float64Array;
  scale: ScaleName = 'paper';
  /** Where the loads are shown. */
  subject: Subject = 'connections';
  /** Colours of modules that have their own, by slot; the trace player's. Until another robot is shown. */
  paintOver?: (slot: number) => Rgb | undefined;
  /** Slots of modules that give way while a collapse is shown, in place of all other colours. */
  private yielding?: ReadonlySet<number>;
  private pointed: readonly number[] = [];
  /** In place of loads. */
  losses?: Losses;
  /** Slots that stand out; undefined: all are alike. */
  private lit?: ReadonlySet<number>;
  private selected: ReadonlySet<number> = new Set();

  constructor(private readonly stage: Stage) {
    this.cursor.renderOrder = 5;
    this.cursor.visible = false;
    this.collar.visible = false;
    stage.robot.add(this.modules.mesh, this.ghosts.mesh, this.collar, this.bars.group);
    stage.scene.add(this.cursor);
    this.ghosts.mesh.renderOrder = 2;
    this.ghosts.update(0);
  }

  /** Another shape; colours follow with paint(). `isApart`: modules that others hide may come to be seen. */
  show(robot: EditedRobot, judged: Judged | undefined, isApart = false): void {
    this.setLattice(robot.lattice);
    this.robot = robot;
    this.judged = judged;
    this.loads = judged?.answer.has_loads ? moduleLoads(judged) : undefined;
    const drawn: number[] = [];
    for (let slot = 0; slot < robot.count; ++slot) {
      const isSeen = isApart || this.isXray || this.shownFlow || !robot.isHidden(slot) || opens(this.section, robot.placeAt(slot));
      if (isSeen && !cutsAway(this.section, robot.placeAt(slot))) {
        drawn.push(slot);
      }
    }
    this.drawn = Int32Array.from(drawn);
    this.instances = new Int32Array(robot.count).fill(-1);
    drawn.forEach((slot, i) => (this.instances[slot] = i));
    this.modules.reserve(drawn.length);
    drawn.forEach((slot, i) => this.modules.places.set(robot.placeAt(slot), 3 * i));
    this.modules.faces.fill(0, 0, 2 * drawn.length);
    this.hasFaces = false;
    this.placeMotions();
    this.modules.update(drawn.length, 'place', 'faces', 'motion', 'turn');
    this.paint();
  }

  /** Colours and patterns of all modules. */
  paint(): void {
    const { robot, judged, loads } = this;
    if (!robot) {
      return;
    }
    const isUnstable = judged?.answer.verdict === 'unstable';
    this.drawn.forEach((slot, i) => {
      const role = robot.roleAt(slot);
      const isBroken = !isUnstable && loads?.isBroken[slot] === 1;
      const own = this.ownColour(slot);
      const colour = own ?? this.lossColour(slot) ?? this.colour(role, loads?.ratio[slot], isBroken, isUnstable);
      const isPlanned = role === Role.kPlanned;
      const tint = isPlanned && !own ? mix(colour, WHITE, 0.38) : colour;
      this.modules.tints.set(this.lit && !this.lit.has(slot) ? mix(tint, UNKNOWN, 0.75) : tint, 3 * i);
      this.modules.patterns[i] =
        (isPlanned ? Pattern.kPlanned : 0) +
        (role === Role.kFixed ? Pattern.kFixed : 0) +
        (this.selected.has(slot) ? Pattern.kSelected : 0) +
        (isBroken && !own && this.subject === 'modules' && !this.losses ? Pattern.kBroken : 0);
    });
    this.paintSeams();
    this.pointed.forEach((slot) => this.mark(slot, Pattern.kPointed));
    this.modules.update(this.drawn.length, 'tint', 'pattern', 'seams');
    this.markWorst();
    this.placeBars();
    this.stage.draw();
  }

  /** Modules that one sees through, with a bar for each connection in the colour of its load, from the next show() on. */
  set xray(isXray: boolean) {
    this.isXray = isXray;
    this.modules.isSheer = isXray || this.shownFlow !== undefined;
  }

  get xray(): boolean {
    return this.isXray;
  }

  /** Ribbons along a way, through sheer modules from the next show() on; other connections are thin. */
  set flow(flow: Flow | undefined) {
    this.shownFlow = flow;
    this.modules.isSheer = this.isXray || flow !== undefined;
    this.placeBars();
  }

  get areBarsShown(): boolean {
    return this.bars.group.visible;
  }

  /** Nothing where modules are elsewhere, or the loads are not known or not what is shown. */
  private placeBars(): void {
    const answer = this.judged?.answer;
    const isShown = (this.isXray || this.shownFlow !== undefined) && answer !== undefined && !this.mechanism && !this.hasOwnColours && !this.losses;
    this.bars.group.visible = isShown;
    if (!isShown) {
      return;
    }
    const colours = stepColours(this.scale);
    const isBroken = new Set(answer.broken);
    const areLoaded = answer.has_loads && answer.verdict !== 'unstable';
    const ribbons = this.ribbonWidths(answer);
    const bars: Bar[] = [];
    for (let i = 0; 3 * i < answer.connections.length; ++i) {
      const [a, b, direction] = answer.connections.subarray(3 * i, 3 * i + 3);
      if (this.instances[this.judged!.slots[a]] >= 0 && this.instances[this.judged!.slots[b]] >= 0) {
        const breaks = areLoaded && isBroken.has(i);
        const step = areLoaded ? loadStep(answer.loads[LOAD_FIELDS * i], breaks) : 0;
        bars.push({
          middle: this.connectionPoint(i),
          direction: new Vector3().fromArray(this.lattice.units[direction]),
          colour: step > 0 ? colours[step - 1] : UNKNOWN,
          width: ribbons.get(i) ?? (this.shownFlow ? THIN : breaks ? 2 : 1),
          length: ribbons.has(i) ? WHOLE_BAR : 1,
        });
      }
    }
    this.bars.show(bars);
  }

  /** By connection of the way that is shown. */
  private ribbonWidths({ loads }: Answer): Map<number, number> {
    const { connections, field } = this.shownFlow ?? { connections: [], field: 0 };
    const sizes = connections.map((i) => Math.abs(loads[LOAD_FIELDS * i + field]));
    const most = Math.max(...sizes, Number.MIN_VALUE);
    const [least, whole] = RIBBON_WIDTHS;
    return new Map(connections.map((i, k) => [i, least + (whole - least) * (sizes[k] / most)]));
  }

  /** The step of every connection's load, on both of its modules. */
  private paintSeams(): void {
    const { seams } = this.modules;
    seams.fill(0, 0, 2 * this.drawn.length);
    const answer = this.judged?.answer;
    if ((this.subject !== 'connections' && !this.losses) || this.hasOwnColours || !answer?.has_loads || answer.verdict === 'unstable') {
      return;
    }
    const { connections, loads, broken } = answer;
    const isBroken = new Uint8Array(connections.length / 3);
    broken.forEach((i) => (isBroken[i] = 1));
    const add = (module: number, direction: number, step: number) => {
      const at = this.instances[this.judged!.slots[module]];
      if (at >= 0) {
        seams[2 * at + (direction < FACES_PER_NUMBER ? 0 : 1)] += step * FACE_WEIGHTS[direction % FACES_PER_NUMBER];
      }
    };
    for (let i = 0; i < isBroken.length; ++i) {
      const isFatal = this.losses?.connections.has(i);
      const step = isFatal === undefined ? loadStep(loads[LOAD_FIELDS * i], isBroken[i] === 1) : loadStep(isFatal ? 1 : 0, isFatal);
      add(connections[3 * i], connections[3 * i + 2], step);
      add(connections[3 * i + 1], connections[3 * i + 2] ^ 1, step);
    }
  }

  /** Colours tell something else than loads now. */
  get hasOwnColours(): boolean {
    return this.paintOver !== undefined || this.yielding !== undefined;
  }

  private lossColour(slot: number): Rgb | undefined {
    return this.losses && (this.losses.modules.has(slot) ? brokenColour(this.scale) : NEUTRAL);
  }

  /** Frames around modules, by slot. */
  select(slots: ReadonlySet<number>): void {
    const isSame = slots.size === this.selected.size && [...slots].every((slot) => this.selected.has(slot));
    this.selected = slots;
    if (!isSame) {
      this.paint();
    }
  }

  /** Lets modules stand out, by slot. */
  light(slots: ReadonlySet<number> | undefined): void {
    if (slots !== this.lit) {
      this.lit = slots;
      this.paint();
    }
  }

  private ownColour(slot: number): Rgb | undefined {
    if (this.yielding) {
      return this.yielding.has(slot) ? brokenColour(this.scale) : undefined;
    }
    return this.paintOver?.(slot);
  }

  /** Rims around some modules, and around no others; costs what they are, not what the robot is. */
  point(slots: readonly number[]): void {
    const change = (slot: number, by: number) => {
      this.mark(slot, by);
      if (this.instances[slot] >= 0) {
        this.modules.updateAt(this.instances[slot], 'pattern');
      }
    };
    const isSame = slots.length === this.pointed.length && slots.every((slot, i) => slot === this.pointed[i]);
    if (!isSame) {
      this.pointed.forEach((slot) => change(slot, -Pattern.kPointed));
      slots.forEach((slot) => change(slot, Pattern.kPointed));
      this.pointed = [...slots];
      this.stage.draw();
    }
  }

  /** What would come of a module at each free place. */
  showFaces(codeOf: ((place: Cell) => FaceCode) | undefined): void {
    const { robot } = this;
    if (!robot || (!codeOf && !this.hasFaces)) {
      return;
    }
    this.hasFaces = codeOf !== undefined;
    this.drawn.forEach((slot, i) => {
      const cell = robot.cellAt(slot);
      const code = (side: number) => {
        const place = robot.lattice.neighbour(cell, side);
        return !codeOf || robot.has(place) ? FaceCode.kNone : codeOf(place);
      };
      this.modules.faces.set(codeOf ? packed(robot.lattice, code) : [0, 0], 2 * i);
    });
    this.modules.update(this.drawn.length, 'faces');
    this.stage.draw();
  }

  /** Modules that are about to be attached, in the colour of what comes of it; all faces have its mark. */
  showGhosts(cells: readonly Cell[], role: Role, colour: Rgb, code: FaceCode): void {
    const pattern = { [Role.kExisting]: 0, [Role.kPlanned]: Pattern.kPlanned, [Role.kFixed]: Pattern.kFixed }[role];
    const faces = packed(this.lattice, () => code);
    this.ghosts.reserve(cells.length);
    cells.forEach((cell, i) => {
      this.ghosts.places.set(this.lattice.place(cell), 3 * i);
      this.ghosts.tints.set(colour, 3 * i);
      this.ghosts.patterns[i] = pattern;
      this.ghosts.faces.set(faces, 2 * i);
    });
    this.ghosts.update(cells.length, 'place', 'tint', 'pattern', 'faces');
    this.stage.draw();
  }

  showCursor(cell: Cell | undefined): void {
    this.cursor.visible = cell !== undefined;
    this.cursor.position.fromArray(this.lattice.place(cell ?? [0, 0, 0]));
    this.stage.draw();
  }

  /** How much displacements are magnified. */
  set exaggeration(factor: number) {
    this.modules.exaggeration = factor;
    this.markWorst();
    this.placeBars();
    this.stage.draw();
  }

  get exaggeration(): number {
    return this.modules.exaggeration;
  }

  setTheme(ink: Rgb, codes: Rgb[], steps: Rgb[]): void {
    const unit = (colour: Rgb) => colour.map((value) => value / 255);
    for (const mesh of [this.modules, this.ghosts]) {
      mesh.setColours(unit(ink), codes.flatMap(unit), steps.flatMap(unit));
    }
    const [red, green, blue] = unit(ink);
    this.cursor.material.color.setRGB(red, green, blue, 'srgb');
    this.collar.material.color.setRGB(red, green, blue, 'srgb');
  }

  /** The middle of a connection as it is drawn. */
  connectionPoint(index: number): Vector3 {
    const { answer, slots } = this.judged!;
    const ends = [answer.connections[3 * index], answer.connections[3 * index + 1]];
    const points = ends.map((end) => this.drawnPlace(slots[end], end));
    return points[0].add(points[1]).multiplyScalar(0.5);
  }

  /** The connection whose collar is shown; undefined if none is. */
  get worst(): number | undefined {
    const answer = this.judged?.answer;
    return answer && answer.verdict !== 'unstable' && !this.losses ? (answer.worst ?? undefined) : undefined;
  }

  /** A connection of a part that is cut away. */
  isCutAway(index: number): boolean {
    return cutsAway(this.section, this.connectionPoint(index).toArray());
  }

  private setLattice(lattice: Lattice): void {
    if (lattice === this.lattice) {
      return;
    }
    this.lattice = lattice;
    this.modules.setLattice(lattice);
    this.ghosts.setLattice(lattice);
    this.ghosts.update(0);
    this.cursor.geometry.dispose();
    this.cursor.geometry = cellEdges(lattice, CURSOR_SIZE);
    this.collar.geometry.dispose();
    this.collar.geometry = collarGeometry(lattice);
  }

  private mark(slot: number, by: number): void {
    const at = this.instances[slot] ?? -1;
    if (at >= 0) {
      this.modules.patterns[at] += by;
    }
  }

  private colour(role: Role, ratio: number | undefined, isBroken: boolean, isUnstable: boolean, subject = this.subject): Rgb {
    if (isUnstable) {
      return UNSTABLE;
    }
    if (role === Role.kFixed) {
      return FIXED;
    }
    if (ratio === undefined || Number.isNaN(ratio)) {
      return UNKNOWN;
    }
    if (subject === 'connections') {
      return NEUTRAL;
    }
    return isBroken ? brokenColour(this.scale) : loadColour(this.scale, ratio);
  }

  /** What of the robot is seen, each module in the colour of its largest load. */
  solids(): { slot: number; place: Place; colour: Rgb }[] {
    const { robot, loads, judged } = this;
    const isUnstable = judged?.answer.verdict === 'unstable';
    return Array.from(robot ? this.drawn : [], (slot) => {
      const isBroken = !isUnstable && loads?.isBroken[slot] === 1;
      const colour = this.ownColour(slot) ?? this.colour(robot!.roleAt(slot), loads?.ratio[slot], isBroken, isUnstable, 'modules');
      return { slot, place: robot!.placeAt(slot), colour };
    });
  }

  /** Velocities of a collapse in place of displacements, six for each slot, and modules that give way. */
  showMechanism(mechanism: Float64Array | undefined, yielding: readonly number[]): void {
    this.mechanism = mechanism;
    this.yielding = mechanism && new Set(yielding);
    this.placeMotions();
    this.modules.update(this.drawn.length, 'motion', 'turn');
    this.paint();
  }

  /** Modules elsewhere, in the colours that they have: six numbers for each slot, as displacements are; undefined: by these. */
  pose(motions: Float64Array | undefined): void {
    this.mechanism = motions;
    this.placeMotions();
    this.modules.update(this.drawn.length, 'motion', 'turn');
    this.placeBars();
    this.stage.draw();
  }

  /** Displacements in cells. */
  private placeMotions(): void {
    const { motions, turns } = this.modules;
    if (this.mechanism) {
      const { mechanism } = this;
      this.drawn.forEach((slot, i) => this.setMotion(i, mechanism, MOTION_FIELDS * slot));
      return;
    }
    const displacements = this.judged?.answer.displacements;
    if (!displacements?.length || this.judged?.answer.verdict === 'unstable') {
      motions.fill(0, 0, 3 * this.drawn.length);
      turns.fill(0, 0, 3 * this.drawn.length);
      return;
    }
    const moduleOf = new Int32Array(this.judged!.slots.length);
    this.judged!.slots.forEach((slot, module) => (moduleOf[slot] = module));
    this.drawn.forEach((slot, i) => this.setMotion(i, displacements, MOTION_FIELDS * moduleOf[slot]));
  }

  private setMotion(instance: number, numbers: Float64Array, at: number): void {
    const pitch = this.robot!.pitchMm;
    for (let k = 0; k < 3; ++k) {
      this.modules.motions[3 * instance + k] = numbers[at + k] / pitch;
      this.modules.turns[3 * instance + k] = numbers[at + 3 + k];
    }
  }

  private drawnPlace(slot: number, module: number): Vector3 {
    const place = new Vector3().fromArray(this.robot!.placeAt(slot));
    const { displacements } = this.judged!.answer;
    const factor = this.exaggeration / this.robot!.pitchMm;
    return displacements.length > 0
      ? place.addScaledVector(new Vector3().fromArray(displacements, MOTION_FIELDS * module), factor)
      : place;
  }

  private markWorst(): void {
    const { worst } = this;
    this.collar.visible = worst !== undefined && !this.hasOwnColours && !this.isCutAway(worst);
    if (worst !== undefined) {
      const direction = this.lattice.units[this.judged!.answer.connections[3 * worst + 2]];
      this.collar.position.copy(this.connectionPoint(worst));
      this.collar.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), new Vector3().fromArray(direction));
    }
  }
}

/** Around the face between two modules, which lies in the plane z = 0: four bars, or a ring. */
function collarGeometry({ shape }: Lattice): BufferGeometry {
  if (shape !== 'cube') {
    return new TorusGeometry(shape === 'prism' ? 0.62 : 0.3, 0.05, 8, 32);
  }
  const bars = [-1, 1].flatMap((side) => {
    const along = new BoxGeometry(1.12, 0.05, 0.05);
    const across = new BoxGeometry(0.05, 1.12, 0.05);
    return [along.translate(0, 0.535 * side, 0), across.translate(0.535 * side, 0, 0)];
  });
  return mergeGeometries(bars);
}
