// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Cell } from '../model/cell';
import type { EditedRobot } from '../model/edited_robot';
import type { App } from './app';
import { byId } from './dom';

/**
 * The limit load that holdfast check --limit has found, and how the robot collapses beyond it. The page has
 * no linear programs, so it knows them only for the robot that the program has put into it.
 */

export interface LimitLoad {
  /** Null: whatever the factor of all loads, some forces balance them. */
  factor: number | null;
  /** Connections that give way, as two cells, null for a support; fastest first. */
  yields: { a: Cell | null; b: Cell | null; limit: string }[];
  /** By module in the program's order: velocity and angular velocity, the largest of 1 mm; may be empty. */
  velocities: number[][];
}

/** Of one way there, in seconds; then it stays for a moment and goes back. */
const WAY_SECONDS = 1.6;
const STAY_SECONDS = 0.9;

export class Collapse {
  private running?: { begun: number; exaggeration: number };

  constructor(
    private readonly app: App,
    private readonly robot: EditedRobot,
    private readonly limit: LimitLoad,
  ) {
    const { factor, velocities } = limit;
    byId('limit').hidden = false;
    byId('limit-text').textContent =
      factor === null
        ? 'Whatever the factor of all loads, some forces would balance them.'
        : `No forces balance more than ${factor.toPrecision(4)} times these loads.`;
    const button = byId('collapse');
    button.hidden = velocities.length === 0;
    button.onclick = () => this.start();
    app.stage.motions.push((now) => this.move(now));
    app.bench.robotListeners.push(() => this.changed());
  }

  start(): void {
    const { finding, view, stage } = this.app;
    if (!finding || this.running) {
      return;
    }
    const motions = new Float64Array(6 * this.robot.count);
    finding.slots.forEach((slot, module) => motions.set(this.limit.velocities[module], 6 * slot));
    const cells = this.limit.yields.flatMap(({ a, b }) => [a, b]).filter((cell) => cell !== null);
    const slots = cells.map((cell) => this.robot.slot(cell)).filter((slot) => slot !== undefined);
    this.running = { begun: performance.now(), exaggeration: view.exaggeration };
    view.showMechanism(motions, slots);
    stage.draw();
  }

  /** Another robot, or the same with a change: nothing is known of it. */
  private changed(): void {
    this.stop();
    const isSame = this.app.bench.robot === this.robot && !this.robot.isEdited;
    byId('limit').hidden = !isSame;
  }

  private stop(): void {
    if (this.running) {
      const { exaggeration } = this.running;
      this.running = undefined;
      this.app.view.showMechanism(undefined, []);
      this.app.view.exaggeration = exaggeration;
    }
  }

  private move(now: number): boolean {
    if (!this.running) {
      return false;
    }
    const seconds = Math.max(now - this.running.begun, 0) / 1000;
    const whole = 2 * WAY_SECONDS + STAY_SECONDS;
    if (seconds > whole) {
      this.stop();
      return false;
    }
    const share = Math.min(seconds, whole - seconds, WAY_SECONDS) / WAY_SECONDS;
    // The fastest module moves by one cell.
    this.app.view.exaggeration = this.robot.pitchMm * 0.5 * (1 - Math.cos(Math.PI * share));
    return true;
  }
}
