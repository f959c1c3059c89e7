// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Role, plus, type Cell } from './cell';
import { EditedRobot, widen, type Box } from './edited_robot';
import type { Place } from './lattice';

/** What the steps of a sequence do, and the robot at any moment of it. */

/** By plan::Stage. */
export const STAGES = ['release', 'shift', 'connect'] as const;

export type StageName = (typeof STAGES)[number];

/** Modules that go together. */
interface Group {
  from: Cell[];
  to: Cell[];
  /** Twice the way that they have gone, axial, by waypoint. */
  way: Cell[];
}

export interface Transition {
  attach: Cell[];
  detach: Cell[];
  groups: Group[];
}

/** From the numbers of core/sequence_view.hpp. */
export function readTransitions(numbers: Int32Array): Transition[] {
  let at = 0;
  const cells = (count: number): Cell[] =>
    Array.from({ length: count }, () => [numbers[at++], numbers[at++], numbers[at++]] as const);
  const group = (): Group => {
    const [modules, waypoints] = [numbers[at++], numbers[at++]];
    return { from: cells(modules), to: cells(modules), way: cells(waypoints) };
  };
  const transitions: Transition[] = [];
  while (at < numbers.length) {
    const [attached, detached, groups] = [numbers[at++], numbers[at++], numbers[at++]];
    const [attach, detach] = [cells(attached), cells(detached)];
    transitions.push({ attach, detach, groups: Array.from({ length: groups }, group) });
  }
  return transitions;
}

/** A robot some of whose modules are on their way, off their cells; they are in the last slots. */
export class StageRobot extends EditedRobot {
  /** Axial, by slot. */
  private readonly offsets = new Map<number, Cell>();

  override placeAt(slot: number): Place {
    const offset = this.offsets?.get(slot);
    return offset ? this.lattice.placeOfAxial(plus(this.lattice.axial(this.cellAt(slot)), offset)) : super.placeAt(slot);
  }

  override isHidden(slot: number): boolean {
    return this.offsets.size === 0 && super.isHidden(slot);
  }

  /** Adds a module off its cell. */
  setOnWay(cell: Cell, offset: Cell): void {
    this.set(cell, Role.kExisting);
    this.offsets.set(this.slot(cell)!, offset);
  }
}

/** Half of the doubled way at a moment, which need not be a waypoint; who has arrived waits. */
function offsetAt({ way }: Group, waypoint: number): Cell {
  const last = way.length - 1;
  const before = Math.min(Math.floor(waypoint), last);
  const [a, b] = [way[before], way[Math.min(before + 1, last)]];
  const share = waypoint - Math.floor(waypoint);
  const between = (k: 0 | 1 | 2) => (a[k] + (b[k] - a[k]) * share) / 2;
  return [between(0), between(1), between(2)];
}

export class Sequence {
  readonly transitions: readonly Transition[];
  /** Before the step `next`. */
  private robot: EditedRobot;
  private next = 0;

  /** The robot's existing and fixed modules are there at first. */
  constructor(
    private readonly start: EditedRobot,
    numbers: Int32Array,
  ) {
    this.transitions = readTransitions(numbers);
    this.robot = start.withoutPlanned();
  }

  get stepCount(): number {
    return this.transitions.length;
  }

  /** Of the longest way of a step; 0 if nothing moves. */
  waypointCount(step: number): number {
    return Math.max(0, ...this.transitions[step].groups.map(({ way }) => way.length));
  }

  /** Of all modules in all stages, those on their way too. */
  bounds(): Box | undefined {
    const { lattice } = this.start;
    const ways = ({ from, way }: Group) =>
      way.flatMap((offset) => from.map((cell) => plus(lattice.axial(cell), offset.map((twice) => twice / 2) as unknown as Cell)));
    const places = this.transitions.flatMap(({ attach, groups }) => [
      ...[...attach, ...groups.flatMap(({ to }) => to)].map((cell) => lattice.place(cell)),
      ...groups.flatMap(ways).map((place) => lattice.placeOfAxial(place)),
    ]);
    const begin = this.start.withoutPlanned().bounds();
    const box = begin ?? (places[0] && { low: [...places[0]], high: [...places[0]] });
    places.forEach((place) => widen(box as Box, place));
    return box as Box | undefined;
  }

  /** In a stage of a step; `waypoint` counts in the shift alone. */
  robotAt(step: number, stage: StageName, waypoint: number): StageRobot {
    this.goTo(stage === 'connect' ? step + 1 : step);
    const { groups, detach } = this.transitions[step];
    const isShift = stage === 'shift';
    const absent = new Set((isShift ? [...detach, ...groups.flatMap(({ from }) => from)] : []).map(String));
    const robot = new StageRobot(this.start.lattice);
    robot.takeSettings(this.robot);
    for (let slot = 0; slot < this.robot.count; ++slot) {
      const cell = this.robot.cellAt(slot);
      if (!absent.has(String(cell))) {
        robot.set(cell, this.robot.roleAt(slot));
      }
    }
    for (const group of isShift ? groups : []) {
      group.from.forEach((cell) => robot.setOnWay(cell, offsetAt(group, waypoint)));
    }
    return robot;
  }

  private goTo(step: number): void {
    if (step < this.next) {
      this.robot = this.start.withoutPlanned();
      this.next = 0;
    }
    for (; this.next < step; ++this.next) {
      const { attach, detach, groups } = this.transitions[this.next];
      [...detach, ...groups.flatMap(({ from }) => from)].forEach((cell) => this.robot.set(cell, undefined));
      [...groups.flatMap(({ to }) => to), ...attach].forEach((cell) => this.robot.set(cell, Role.kExisting));
    }
  }
}
