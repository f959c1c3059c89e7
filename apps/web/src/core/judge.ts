// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Robot } from '../model/robot';
import { CoreClient, Cancelled, compiledCore } from './client';
import type { Answer, RobotData } from './types';
import { Core } from './wasm';

/** What is known of the robot on the page. `slots` as in Robot.toData(). */
export interface Finding {
  slots: Int32Array;
  answer?: Answer;
  /** Why the cells are no robot, or why there is no answer. */
  problem?: string;
  /** The loads are still being worked out. */
  isFirstLook?: boolean;
}

/** Up to here the page computes by itself: a worker takes longer to wake up than to answer. */
const SMALL_COUNT = 150;
/** From here on the rigid body's answer is shown before the loads are known. */
const LARGE_COUNT = 1500;
/** A computation that has run for longer makes way for a newer robot. */
const PATIENCE_MS = 250;

interface Task {
  data: RobotData;
  slots: Int32Array;
  version: number;
}

/** Keeps the answer up with the robot: one computation at a time, and always for the newest. */
export class Judge {
  private readonly client = new CoreClient();
  private core?: Core;
  private next?: Task;
  private version = 0;
  private isRunning = false;
  private begun = 0;

  constructor(private readonly found: (finding: Finding) => void) {
    void compiledCore.then(Core.create).then((core) => (this.core = core));
  }

  ask(robot: Robot): void {
    const task = { ...robot.toData(), version: ++this.version };
    if (this.core && robot.count <= SMALL_COUNT) {
      this.next = undefined;
      this.judgeHere(this.core, task);
      return;
    }
    this.next = task;
    if (!this.isRunning) {
      void this.run();
    } else if (performance.now() - this.begun > PATIENCE_MS) {
      this.client.cancel();
    }
  }

  /** Gives up the loads that are being worked out. */
  stop(): void {
    this.client.cancel();
  }

  private async run(): Promise<void> {
    this.isRunning = true;
    while (this.next) {
      const task: Task = this.next;
      this.next = undefined;
      await this.judge(task);
    }
    this.isRunning = false;
  }

  private judgeHere(core: Core, { data, slots }: Task): void {
    try {
      this.found({ answer: core.check(data, false), slots });
    } catch (error) {
      this.found({ problem: error instanceof Error ? error.message : String(error), slots });
    }
  }

  private async judge({ data, slots, version }: Task): Promise<void> {
    const tell = (finding: Omit<Finding, 'slots'>) => {
      if (version === this.version) {
        this.found({ ...finding, slots });
      }
    };
    this.begun = performance.now();
    let look: Answer | undefined;
    try {
      if (slots.length >= LARGE_COUNT) {
        look = await this.client.check(data, true);
        tell({ answer: look, isFirstLook: true });
      }
      tell({ answer: await this.client.check(data) });
    } catch (error) {
      if (error instanceof Cancelled) {
        const reasons = ['stopped: the loads are not known'];
        tell(look ? { answer: { ...look, reasons } } : { problem: reasons[0] });
      } else {
        tell({ problem: error instanceof Error ? error.message : String(error) });
      }
    }
  }
}
