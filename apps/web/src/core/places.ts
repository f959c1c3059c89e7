// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { cellText, type Robot } from '../model/robot';
import { CoreClient } from './client';
import type { Cell, Trial } from './types';

/** About so long may a batch of places take. */
const BATCH_MS = 40;
/** Robots up to this size are tried at once where the pointer is. */
export const TRIAL_COUNT_MAX = 1500;

/** Where may the next module go? Tries free places in the background, batch by batch. */
export class Places {
  private readonly client = new CoreClient();
  private trials = new Map<string, Trial>();
  private version = 0;
  private begun = 0;

  /** Forgets everything: the robot has changed. */
  reset(): void {
    ++this.version;
    this.trials.clear();
    if (this.client.isBusy && performance.now() - this.begun > 4 * BATCH_MS) {
      this.client.cancel();
    }
  }

  known(place: Cell): Trial | undefined {
    return this.trials.get(cellText(place));
  }

  /** The verdict at one place; undefined if the robot has changed meanwhile. */
  async find(robot: Robot, place: Cell): Promise<Trial | undefined> {
    const isCurrent = await this.batch(robot, [place]);
    return isCurrent ? this.known(place) : undefined;
  }

  /** All places; `told` after each batch. False: the robot has changed meanwhile. */
  async findAll(robot: Robot, places: readonly Cell[], told: (count: number) => void) {
    const waiting = places.filter((place) => !this.known(place));
    let size = 4;
    for (let at = 0; at < waiting.length; ) {
      const begun = performance.now();
      if (!(await this.batch(robot, waiting.slice(at, at + size)))) {
        return false;
      }
      at += size;
      told(places.length - waiting.length + Math.min(at, waiting.length));
      const wanted = (size * BATCH_MS) / Math.max(performance.now() - begun, 1);
      size = Math.max(1, Math.min(Math.round(wanted), 4 * size));
    }
    return true;
  }

  private async batch(robot: Robot, places: readonly Cell[]): Promise<boolean> {
    const { version } = this;
    this.begun = performance.now();
    try {
      const trials = await this.client.tryPlaces(robot.toData().data, Int32Array.from(places.flat()));
      if (version === this.version) {
        places.forEach((place, i) => this.trials.set(cellText(place), trials[i]));
      }
    } catch {
      return false;
    }
    return version === this.version;
  }
}
