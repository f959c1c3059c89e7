// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Role, type Cell } from './cell';
import { EditedRobot } from './edited_robot';
import type { StepEntry } from './surroundings';

/** Cells of existing and fixed modules, by their text. */
function cellsOf(robot: EditedRobot): Map<string, Cell> {
  const cells = new Map<string, Cell>();
  for (let slot = 0; slot < robot.count; ++slot) {
    if (robot.roleAt(slot) !== Role.kPlanned) {
      cells.set(String(robot.cellAt(slot)), robot.cellAt(slot));
    }
  }
  return cells;
}

const isSame = (a: readonly Cell[] = [], b: readonly Cell[] = []) =>
  a.length === b.length && new Set([...a, ...b].map(String)).size === a.length;

/** Makes a step of every change of a robot's modules; what is undone is no step. */
export class Recorder {
  /** As it was when the recording began. */
  readonly start: EditedRobot;
  readonly steps: StepEntry[] = [];
  private cells: Map<string, Cell>;

  constructor(robot: EditedRobot) {
    this.start = robot.withoutPlanned();
    this.cells = cellsOf(robot);
  }

  /** Takes notice of what has changed; `isUndoing`: by taking back what was done before. */
  follow(robot: EditedRobot, isUndoing: boolean): void {
    const now = cellsOf(robot);
    const missing = (from: Map<string, Cell>, other: Map<string, Cell>) =>
      [...from].filter(([text]) => !other.has(text)).map(([, cell]) => cell);
    const [attach, detach] = [missing(now, this.cells), missing(this.cells, now)];
    this.cells = now;
    const last = this.steps.at(-1);
    if (attach.length + detach.length === 0) {
      return;
    }
    if (isUndoing && last && isSame(last.attach, detach) && isSame(last.detach, attach)) {
      this.steps.pop();
      return;
    }
    this.steps.push({ ...(detach.length > 0 ? { detach } : {}), ...(attach.length > 0 ? { attach } : {}) });
  }

  /** The robot as it was at first, with the steps; all else is as it is now. */
  result(robot: EditedRobot): EditedRobot {
    const recorded = this.start.withoutPlanned();
    recorded.takeSettings(robot);
    recorded.surroundings = { ...robot.surroundings, steps: this.steps };
    return Object.assign(recorded, { name: robot.name, base: robot.base, laterSteps: 0, isEdited: true });
  }
}
