// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Cancelled, CoreClient } from '../core/client';
import type { LimitLoad } from '../core/types';
import type { EditedRobot } from '../model/edited_robot';
import type { App } from './app';
import { byId, reasonOf } from './dom';
import { digits, t } from '../texts';

/** The limit load, found on demand or by holdfast check --limit, and the collapse beyond it as a motion. */

/** Of one way there, in seconds; then it stays for a moment and goes back. */
const WAY_SECONDS = 1.6;
const STAY_SECONDS = 0.9;

/** Then the page says that it has not found it. */
const FIND_SECONDS_MAX = 60;

export class Collapse {
  private readonly client = new CoreClient();
  private shown?: { robot: EditedRobot; limit: LimitLoad };
  private running?: { begun: number; exaggeration: number };

  constructor(private readonly app: App) {
    byId('find-limit').onclick = () => void this.find();
    byId('collapse').onclick = () => this.start();
    app.stage.motions.push((now) => this.move(now));
    app.bench.robotListeners.push(() => this.forget());
    app.exhibitListeners.push(() => this.stop());
    app.fallListeners.push(() => app.isToppled && this.stop());
  }

  show(limit: LimitLoad | null): void {
    byId('find-limit').hidden = limit !== null;
    byId('limit-text').hidden = false;
    byId('limit-text').textContent =
      limit === null
        ? t('Not found within a minute; holdfast check --limit may find it.')
        : limit.factor === null
          ? t('Whatever the factor of all loads, some forces would balance them.')
          : t('No forces balance more than {0} times these loads.', digits(limit.factor.toPrecision(4)));
    byId('collapse').hidden = limit === null || limit.velocities.length === 0;
    this.shown = limit ? { robot: this.app.bench.robot, limit } : undefined;
  }

  private async find(): Promise<void> {
    const button = byId<HTMLButtonElement>('find-limit');
    button.disabled = true;
    try {
      this.show(await this.client.limit(this.app.bench.robot.toData().data, FIND_SECONDS_MAX));
    } catch (error) {
      if (!(error instanceof Cancelled)) {
        byId('limit-text').hidden = false;
        byId('limit-text').textContent = reasonOf(error);
      }
    } finally {
      button.disabled = false;
    }
  }

  start(): void {
    const { finding, view, stage, bench } = this.app;
    if (!finding || this.running || !this.shown || bench.refusesNow()) {
      return;
    }
    this.app.stopTopple();
    const { robot, limit } = this.shown;
    const motions = new Float64Array(6 * robot.count);
    finding.slots.forEach((slot, module) => motions.set(limit.velocities[module], 6 * slot));
    const cells = limit.yields.flatMap(({ a, b }) => [a, b]).filter((cell) => cell !== null);
    const slots = cells.map((cell) => robot.slot(cell)).filter((slot) => slot !== undefined);
    this.running = { begun: performance.now(), exaggeration: view.exaggeration };
    view.showMechanism(motions, slots);
    stage.draw();
  }

  /** Another robot, or the same with a change: nothing is known of it. */
  private forget(): void {
    this.stop();
    this.client.cancel();
    this.shown = undefined;
    byId('limit-text').hidden = true;
    byId('collapse').hidden = true;
    byId('find-limit').hidden = false;
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
    if (!this.running || !this.shown) {
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
    this.app.view.exaggeration = this.shown.robot.pitchMm * 0.5 * (1 - Math.cos(Math.PI * share));
    return true;
  }
}
