// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Vector3 } from 'three';
import { equal, type Cell } from '../model/cell';
import type { EditedRobot } from '../model/edited_robot';
import type { Stage } from '../view/stage';
import { Tip } from './tip';

/** What is pointed at: a module, or its connection at a side; pinned it stays so, wherever the pointer goes. */
export class Pointed {
  cell?: Cell;
  side?: number;
  isPinned = false;
  readonly tip: Tip;
  /** Called when something else is pinned, or nothing. */
  readonly pinListeners: (() => void)[] = [];

  /** `changed` hears of another module or side. */
  constructor(
    stage: Stage,
    private readonly changed: () => void,
  ) {
    this.tip = new Tip(stage);
  }

  /** At a point of the window, if it is known. Nothing while something is pinned. */
  point(cell: Cell | undefined, side?: number, x?: number, y?: number): void {
    if (this.isPinned) {
      return;
    }
    if (x !== undefined && y !== undefined) {
      this.tip.move(x, y);
    }
    const isSame = (cell && this.cell ? equal(cell, this.cell) : cell === this.cell) && side === this.side;
    if (!isSame) {
      [this.cell, this.side] = [cell, side];
      this.changed();
    }
  }

  /** Keeps the numbers of a module of a robot, or of its connection at a side, in the picture. */
  pin({ lattice }: EditedRobot, cell: Cell, side?: number): void {
    this.unpin();
    this.point(cell, side);
    const place = new Vector3().fromArray(lattice.place(cell));
    this.tip.pin(side === undefined ? place : place.addScaledVector(new Vector3().fromArray(lattice.units[side]), lattice.halves[side]));
    this.isPinned = true;
    this.pinListeners.forEach((tell) => tell());
  }

  /** False if nothing was pinned. */
  unpin(): boolean {
    const { isPinned } = this;
    this.isPinned = false;
    if (isPinned) {
      this.tip.pin(undefined);
      this.point(undefined);
      this.pinListeners.forEach((tell) => tell());
    }
    return isPinned;
  }
}
