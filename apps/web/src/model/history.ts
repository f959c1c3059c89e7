// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Kind, Cell } from '../core/types';
import { Robot, type CellChange } from './robot';

/** What can be undone: changed cells, or another robot in place of this one. */
type Step = { label: string } & (
  | { changes: CellChange[] }
  | { before: Robot; after: Robot }
);

/** The robot on the page and everything that was done to it. Tells its listener of every change. */
export class History {
  private done: Step[] = [];
  private undone: Step[] = [];

  constructor(
    public robot: Robot,
    private readonly changed: (isAnother: boolean) => void,
  ) {}

  /** Sets cells to a kind, or empties them; what is so already is left out. */
  edit(label: string, cells: readonly Cell[], after: Kind | undefined): boolean {
    const changes = cells
      .map((cell) => ({ cell, before: this.robot.kind(cell), after }))
      .filter(({ before }) => before !== after);
    if (changes.length > 0) {
      this.do({ label, changes });
    }
    return changes.length > 0;
  }

  /** Puts another robot in place of this one; the empty page at the beginning is not kept. */
  replace(label: string, after: Robot): void {
    const step = { label, before: this.robot, after };
    if (this.robot.count === 0 && !this.canUndo && !this.canRedo) {
      this.apply(step, true);
    } else {
      this.do(step);
    }
  }

  /** The label of what was undone. */
  undo(): string | undefined {
    const step = this.done.pop();
    if (step) {
      this.undone.push(step);
      this.apply(step, false);
    }
    return step?.label;
  }

  redo(): string | undefined {
    const step = this.undone.pop();
    if (step) {
      this.done.push(step);
      this.apply(step, true);
    }
    return step?.label;
  }

  get canUndo(): boolean {
    return this.done.length > 0;
  }

  get canRedo(): boolean {
    return this.undone.length > 0;
  }

  /** Something was changed that no file holds: cells, not only another robot in place of this one. */
  get isEdited(): boolean {
    return this.done.some((step) => 'changes' in step);
  }

  private do(step: Step): void {
    this.done.push(step);
    this.undone = [];
    this.apply(step, true);
  }

  private apply(step: Step, isForward: boolean): void {
    const isAnother = 'before' in step;
    if (isAnother) {
      this.robot = isForward ? step.after : step.before;
    } else {
      for (const { cell, before, after } of step.changes) {
        this.robot.set(cell, isForward ? after : before);
      }
    }
    this.changed(isAnother);
  }
}
