// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

/** What the page and the core exchange. Lengths in mm, forces in N, torques in N mm. */

import type { Cell } from '../model/cell';
import type { LatticeTable } from '../model/lattice';
import type { StageName } from '../model/sequence';

export type Point = [x: number, y: number];

export type Verdict = 'safe' | 'overload' | 'unstable' | 'undecided';

export type Point3 = [x: number, y: number, z: number];

/** How a rigid body begins to fall: velocity of the centre of mass and angular velocity, in mm and rad. */
export interface FallMotion {
  text: string;
  velocity: Point3;
  angular: Point3;
}

/** With supports anywhere: are there contact forces that hold it? */
export interface RigidAnswer {
  answer: 'holds' | 'nothing to spare' | 'falls' | 'undecided';
  friction_needed: number | null;
  tilt_margin_deg: number | null;
  motion: FallMotion | null;
}

export interface Stability {
  /** What decides. */
  rule: 'held' | 'polygon' | 'contact-forces';
  /** Null: it is not certain. */
  stable: boolean | null;
  margin_mm: number | null;
  edge: [Point, Point] | null;
  centre_of_mass: Point3;
  polygon: Point[];
  rigid: RigidAnswer;
}

/** The largest factor of all loads that any forces could balance, and how the robot collapses beyond it. */
export interface LimitLoad {
  /** Null: whatever the factor of all loads, some forces balance them. */
  factor: number | null;
  /** Connections that give way, as two cells, null for a support; fastest first. */
  yields: { a: Cell | null; b: Cell | null; limit: string }[];
  /** By module in the program's order: velocity and angular velocity, the largest of 1 mm; may be empty. */
  velocities: number[][];
}

export interface Answer {
  verdict: Verdict;
  reasons: string[];
  stability: Stability;
  load_ratio_max: number | null;
  worst: number | null;
  weight_factor: number | null;
  contact_model: string;
  solves: number;
  /** Whether linear theory suffices, in words. */
  second_order: string | null;
  /** Half the width of all facets. */
  facet_half_mm: number;
  has_loads: boolean;
  seconds: number;
  /** Indices of two modules and a direction for each connection. */
  connections: Int32Array;
  broken: Int32Array;
  /** Load ratio, axial force, bending torque, shear force, torsion torque for each connection. */
  loads: Float64Array;
  /** Module, direction, whether it is bonded, and ContactState::code() or -1, of each facet that touches something. */
  facets: Int32Array;
  /** Index of the limit that each connection's load ratio is of; empty where all of them open. */
  limits: Int32Array;
  /** With what force a facet presses, the force along it on its module, the friction or -1. */
  facetForces: Float64Array;
  /** Three lengths and three angles for each module; empty if not known. */
  displacements: Float64Array;
}

export const LOAD_FIELDS = 5;
export const MOTION_FIELDS = 6;
export const FACET_INTEGERS = 4;
export const FACET_FIELDS = 5;

/** One of several that a user may choose. */
export interface Choice {
  value: number;
  text: string;
}

/** What the page learns from the core instead of repeating it; asked when the page is built. */
export interface Vocabulary {
  /** The numbers that mechanics depend on and what they may be; `table_i` is that of Table I of [Piranda 2021]. */
  material: { key: string; label: string; unit: string; table_i: number; lowest: number; highest: number }[];
  /** Of the robot's own computation, in their order. */
  phases: string[];
  methods: Choice[];
  links: Choice[];
  /** Which limit of a connection may be reached. */
  limits: string[];
  lattices: LatticeTable[];
  /** Of names of files that are read. */
  endings: string[];
}

export interface OpenedDocument {
  name: string;
  description: string;
  support_z: number;
  later_steps: number;
  /** JSON of what it says beyond cells and material. */
  more: string;
  /** The whole as JSON, of a format that is not written; else ''. */
  base: string;
  warnings: string[];
  modules: Int32Array;
  material: Float64Array;
}

/** What would come of one more module. */
export interface Trial {
  /** Null where no module can be. */
  verdict: Verdict | null;
  ratio: number;
  marginMm: number;
  /** Why what would be left is no robot. */
  refusal?: string;
}

/** What is said of a stage of a step; as holdfast steps --json. */
export interface StageReport {
  verdict: Verdict;
  reasons: string[];
  load_ratio_max: number | null;
  margin_mm: number | null;
  at: [Cell, Cell] | null;
  /** In the shift, if something moves: where it is at its worst. */
  waypoint?: number;
}

/** Single changes of one kind; those with which the robot is safe, best first. */
export interface RemedyList {
  safe: { cell: Cell; load_ratio_max: number | null; margin_mm: number | null }[];
  tried: number;
  untried: number;
}

export type RemedyKind = 'module' | 'prop' | 'fixing' | 'removal';

/** Why the worst connection carries what it carries, and what would make a robot hold that does not. */
export interface Why {
  /** Sentences; '' where there is nothing to say. */
  why: string;
  remedies?: Record<RemedyKind, RemedyList> & { strength_factor: number | null };
  /** Modules that the worst connection alone holds, in the order of the request. */
  hanging: Int32Array;
}

/** How sure it is that every connection holds where strengths scatter. */
export interface Sureness {
  holds: number | null;
  fails: number | null;
  text: string;
}

/** What follows from the loss of a connection, a module or a foot. */
export interface LossAnswer {
  a?: Cell;
  b?: Cell;
  module?: Cell;
  foot?: Cell;
  verdict: Verdict;
  load_ratio_max: number | null;
  fallen: number;
}

export interface Losses {
  lose_one: { holds_all: boolean; losses: number; fatal: LossAnswer[]; undecided: LossAnswer[] };
  text: string;
}

/** What follows the break, and how the pieces fall, which is an illustration. */
export interface Breaking {
  cascade: {
    outcome: 'holds' | 'stands' | 'falls' | 'undecided';
    rounds: { broken: { a: Cell; b: Cell; load_ratio: number }[]; fallen: Cell[] }[];
    standing: Cell[];
  };
  text: string;
  /** When each round begins. */
  round_s: number[];
  frame_s: number;
  /** The body of each module, -1 if it stands. */
  bodies: Int32Array;
  /** Centres of mass of the bodies before they fall, mm. */
  centres: Float64Array;
  /** For each frame and body: how far it has moved, mm, and the quaternion (w, x, y, z) of its turn. */
  poses: Float64Array;
}

/** An answer of the deformed shape; `factor`: of the loads that were asked for, those that it rests on. */
export type DeformedAnswer = Answer & { factor: number | null };

export interface StageId {
  step: number;
  stage: StageName;
}

export interface StepsReport {
  verdict: Verdict;
  first_unsafe: StageId | null;
  first_undecided: StageId | null;
  load_ratio_max: number | null;
  margin_min_mm: number | null;
  steps: { where: string; stages: Record<StageName, StageReport> }[];
  seconds: number;
}

/** What came of a search for an order; `structure` is a file, '' unless one was found. */
export interface FoundOrder {
  outcome: 'found' | 'none' | 'not-found';
  text: string;
  structure: string;
}

export interface JudgedSteps {
  report: StepsReport;
  /** What each step does. */
  texts: string[];
  /** For Sequence. */
  transitions: Int32Array;
}

/** Loads in a stage: those of its modules that are in their places. */
export interface StageLoads {
  /** Of each piece. */
  stabilities: Stability[];
  contact_model: string;
  /** x, y, z of each module. */
  cells: Int32Array;
  /** As in Answer. */
  connections: Int32Array;
  broken: Int32Array;
  loads: Float64Array;
}

export const enum Output {
  kJson,
  kXml,
  kSvg,
  kReportJson,
  kReportText,
}

export interface SimulationChoice {
  /** Values of the vocabulary's methods and links. */
  method: number;
  link: number;
  seed: number;
  lossPerMille: number;
}

export const enum LogEvent {
  kPacket,
  kLost,
  kPhase,
  kVerdict,
  kOrder,
}

export interface Trace {
  verdict: Verdict;
  reason: string;
  load_ratio_max: number | null;
  method: string;
  rounds: number;
  simulated_s: number | null;
  messages: number;
  bytes: number;
  iterations: number;
  all_modules_agree: boolean;
  root: number;
  is_complete: boolean;
  ticks_per_second: number;
  /** What the root can order, by wire::Operation. */
  orders: { text: string; is_iteration: boolean }[];
  /** LogEvent and three integers for each event. */
  events: Int32Array;
  /** Begin and duration in ticks for each event. */
  times: Float64Array;
}

export interface Failure {
  message: string;
  where: string;
}

/** An error that the user can do something about; its message is meant for them. */
export class CoreError extends Error {}
