// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Cell, Role } from './cell';
import { EditedRobot, type CellChange, type Settings } from './edited_robot';
import { withoutModules, type Surroundings } from './surroundings';
import { withJoined } from './together';

/** What was selected before a step and, if it selected something itself, after it. */
interface Choice {
  before: readonly Cell[];
  after?: readonly Cell[];
}

/** What can be undone: changed cells with what goes with them, changed settings, or another robot in place of this one. */
type Step = { label: string; chosen?: Choice } & (
  | { what: 'cells' | 'settings'; changes: CellChange[]; before: Settings; after: Settings }
  | { what: 'robot'; before: EditedRobot; after: EditedRobot }
);

export type Change = Step['what'];

/** What a cell is to have in it; undefined: nothing. */
export interface Wanted {
  cell: Cell;
  role: Role | undefined;
}

const isSame = (a: unknown, b: unknown) => a === b || JSON.stringify(a) === JSON.stringify(b);

/** The robot on the page and everything that was done to it. Tells its listener of every change. */
export class History {
  private done: Step[] = [];
  private undone: Step[] = [];
  /** Whether the last change took one back. */
  isUndoing = false;

  /** `changed` hears what is to be selected again, if that is known; `chosen` says what is selected. */
  constructor(
    public robot: EditedRobot,
    private readonly changed: (what: Change, chosen?: readonly Cell[]) => void,
    private readonly chosen: () => readonly Cell[],
  ) {}

  /** The step that was just done has selected these. */
  noteChosen(cells: readonly Cell[]): void {
    const step = this.done.at(-1);
    if (step?.chosen) {
      step.chosen.after = cells;
    }
  }

  /**
   * Sets cells each to a role, or empties them, and settings, all in one step; what is so already is left out.
   * What a removed module had of its own goes with it.
   */
  edit(label: string, wanted: readonly Wanted[], settings: Partial<Settings> = {}): boolean {
    const changes = wanted
      .map(({ cell, role }) => ({ cell, before: this.robot.role(cell), after: role }))
      .filter(({ before, after }) => before !== after);
    const { supportZ, material, surroundings } = this.robot;
    const before = { supportZ, material, surroundings };
    const after = { ...before, ...settings };
    const emptied = changes.filter((change) => change.after === undefined);
    if (emptied.length > 0) {
      after.surroundings = withoutModules(after.surroundings, emptied.map(({ cell }) => cell));
    }
    if (after.surroundings.joined === 'listed') {
      after.surroundings = this.withJoined(after.surroundings, changes, settings.surroundings !== undefined);
    }
    const isOther = (Object.keys(before) as (keyof Settings)[]).some((key) => !isSame(before[key], after[key]));
    if (changes.length > 0 || isOther) {
      this.do({ label, what: changes.length > 0 ? 'cells' : 'settings', changes, before, after });
    }
    return changes.length > 0 || isOther;
  }

  /** Where a file lists what is joined a module that comes is joined to all its neighbours, as the ghost was. */
  private withJoined(surroundings: Surroundings, changes: readonly CellChange[], areTheirsNamed: boolean): Surroundings {
    const added = changes.filter(({ before }) => before === undefined).map(({ cell }) => cell);
    const roles = new Map(changes.map(({ cell, after }) => [String(cell), after]));
    const has = (cell: Cell) => (roles.has(String(cell)) ? roles.get(String(cell)) !== undefined : this.robot.has(cell));
    return withJoined(surroundings, added, this.robot.lattice, has, areTheirsNamed);
  }

  /** Gives the robot another material, another ground, other surroundings. */
  configure(label: string, settings: Partial<Settings>): void {
    this.edit(label, [], settings);
  }

  /** Puts another robot in place of this one; the empty page at the beginning is not kept. */
  replace(label: string, after: EditedRobot): void {
    const step: Step = { label, what: 'robot', before: this.robot, after };
    if (this.robot.count === 0 && !this.canUndo && !this.canRedo) {
      this.apply(step, true);
      this.isUndoing = false;
      this.changed('robot');
    } else {
      this.do(step);
    }
  }

  /** The label of what was undone. */
  undo(): string | undefined {
    return this.move(this.done, this.undone, false);
  }

  redo(): string | undefined {
    return this.move(this.undone, this.done, true);
  }

  get canUndo(): boolean {
    return this.done.length > 0;
  }

  get canRedo(): boolean {
    return this.undone.length > 0;
  }

  private move(from: Step[], to: Step[], isForward: boolean): string | undefined {
    const step = from.at(-1);
    if (step) {
      this.apply(step, isForward);
      from.pop();
      to.push(step);
      this.isUndoing = !isForward;
      this.changed(step.what, isForward ? step.chosen?.after : step.chosen?.before);
    }
    return step?.label;
  }

  /** What cannot be applied was never done: it throws, and nothing has changed. */
  private do(step: Step): void {
    const before = this.chosen();
    this.apply(step, true);
    this.done.push({ ...step, chosen: { before } });
    this.undone = [];
    this.isUndoing = false;
    this.changed(step.what);
  }

  private apply(step: Step, isForward: boolean): void {
    if (step.what === 'robot') {
      this.robot = isForward ? step.after : step.before;
      return;
    }
    this.setCells(step.changes, isForward);
    const settings = isForward ? step.after : step.before;
    for (const key of Object.keys(settings) as (keyof Settings)[]) {
      if (this.robot[key] !== settings[key]) {
        Object.assign(this.robot, { [key]: settings[key] });
      }
    }
    this.robot.isEdited = true;
  }

  /** All cells or none. */
  private setCells(changes: readonly CellChange[], isForward: boolean): void {
    let count = 0;
    try {
      for (const { cell, before, after } of changes) {
        this.robot.set(cell, isForward ? after : before);
        ++count;
      }
    } catch (error) {
      for (const { cell, before, after } of changes.slice(0, count).reverse()) {
        this.robot.set(cell, isForward ? before : after);
      }
      throw error;
    }
  }
}
