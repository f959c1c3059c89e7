// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Vector3 } from 'three';
import type { Stage } from '../view/stage';
import { byId } from './dom';

/** Numbers of what is pointed at, beside the pointer; pinned ones stay at their place of the robot. */

/** From the pointer, and from the border of the picture, in pixels. */
const GAP = 16;
const BORDER = 6;
/** Where it is narrower it stands above the tools, as it would cover the robot. */
const NARROW = 560;

export class Tip {
  private x = 0;
  private y = 0;
  /** Where in the scene it is pinned. */
  private anchor?: Vector3;

  constructor(private readonly stage: Stage) {
    stage.followers.push(() => this.follow());
  }

  /** Beside a point of the window. */
  move(x: number, y: number): void {
    const box = this.stage.canvas.getBoundingClientRect();
    this.put(x - box.left, y - box.top);
  }

  /** At a point of the scene, wherever the camera goes; undefined: at the pointer again. */
  pin(anchor: Vector3 | undefined): void {
    this.anchor = anchor;
    byId('details').classList.toggle('pinned', anchor !== undefined);
    this.follow();
  }

  show(isShown: boolean): void {
    byId('details').hidden = !isShown;
    this.put(this.x, this.y);
  }

  private follow(): void {
    const at = this.anchor && this.stage.project(this.anchor);
    if (at) {
      this.put(at.x, at.y);
    }
  }

  /** Right below the point, and elsewhere where it would leave the picture. */
  private put(x: number, y: number): void {
    [this.x, this.y] = [x, y];
    const tip = byId('details');
    if (tip.hidden) {
      return;
    }
    const { clientWidth, clientHeight } = this.stage.canvas;
    const fit = (value: number, size: number, most: number) => {
      const other = value + GAP + size + BORDER > most ? value - GAP - size : value + GAP;
      return Math.round(Math.max(BORDER, Math.min(other, most - size - BORDER)));
    };
    if (clientWidth < NARROW) {
      const bottom = clientHeight - tip.offsetHeight - byId('toolbar').offsetHeight - 2 * BORDER;
      tip.style.transform = `translate(${BORDER}px, ${Math.max(BORDER, bottom)}px)`;
      return;
    }
    const left = fit(x, tip.offsetWidth, clientWidth);
    const top = fit(y, tip.offsetHeight, clientHeight);
    tip.style.transform = `translate(${left}px, ${top}px)`;
  }
}
