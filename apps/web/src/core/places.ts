// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { cellText, type Cell, type Role } from '../model/cell';
import type { EditedRobot } from '../model/edited_robot';
import { CoreClient } from './client';
import { CoreError, type Trial } from './types';

/** About so long may a batch of places take. */
const BATCH_MS = 40;

/** Where may the next module of a role go? Tries free places in the background, batch by batch. */
export class Places {
  private readonly client = new CoreClient();
  private trials = new Map<string, Trial>();
  private version = 0;
  /** Of findAll(): the newest one goes on, others end. */
  private searches = 0;
  private begun = 0;

  /** Forgets everything: the robot has changed. */
  reset(): void {
    ++this.version;
    this.trials.clear();
    if (this.client.isBusy && performance.now() - this.begun > 4 * BATCH_MS) {
      this.client.cancel();
    }
  }

  /** Without a role: of the removal of the module there. */
  known(place: Cell, role?: Role): Trial | undefined {
    return this.trials.get(keyOf(place, role));
  }

  /** The verdict at one place; undefined if the robot has changed meanwhile. */
  async find(robot: EditedRobot, place: Cell, role: Role): Promise<Trial | undefined> {
    const isCurrent = await this.batch(robot, [place], role);
    return isCurrent ? this.known(place, role) : undefined;
  }

  /** The verdict without a module; undefined if the robot has changed meanwhile. */
  async findRemoval(robot: EditedRobot, cell: Cell): Promise<Trial | undefined> {
    const { version } = this;
    this.begun = performance.now();
    let trial: Trial = { verdict: null, ratio: NaN, marginMm: NaN };
    try {
      const { verdict, load_ratio_max: ratio, stability } = await this.client.check(robot.dataWithout([cell]));
      trial = { verdict, ratio: ratio ?? NaN, marginMm: stability.margin_mm ?? NaN };
    } catch (error) {
      if (!(error instanceof CoreError)) {
        return undefined;
      }
      trial.refusal = error.message;
    }
    if (version === this.version) {
      this.trials.set(keyOf(cell), trial);
    }
    return version === this.version ? trial : undefined;
  }

  /** All places; `told` after each batch. False: the robot or the question has changed meanwhile. */
  async findAll(robot: EditedRobot, places: readonly Cell[], role: Role, told: (count: number) => void) {
    const search = ++this.searches;
    const waiting = places.filter((place) => !this.known(place, role));
    let size = 4;
    for (let at = 0; at < waiting.length; ) {
      const begun = performance.now();
      const isCurrent = await this.batch(robot, waiting.slice(at, at + size), role);
      if (!isCurrent || search !== this.searches) {
        return false;
      }
      at += size;
      told(places.length - waiting.length + Math.min(at, waiting.length));
      const wanted = (size * BATCH_MS) / Math.max(performance.now() - begun, 1);
      size = Math.max(1, Math.min(Math.round(wanted), 4 * size));
    }
    return true;
  }

  private async batch(robot: EditedRobot, places: readonly Cell[], role: Role): Promise<boolean> {
    const { version } = this;
    this.begun = performance.now();
    try {
      const cells = Int32Array.from(places.flat());
      const trials = await this.client.tryPlaces(robot.toData().data, cells, role);
      if (version === this.version) {
        places.forEach((place, i) => this.trials.set(keyOf(place, role), trials[i]));
      }
    } catch {
      return false;
    }
    return version === this.version;
  }
}

/** Without a role: of the removal of the module there. */
const keyOf = (place: Cell, role?: Role) => `${role ?? 'removal'} ${cellText(place)}`;
