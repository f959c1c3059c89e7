// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Robot } from '../model/robot';
import { CoreClient, Cancelled } from './client';
import type { Answer, RobotData } from './types';

/** What is known of the robot on the page. `slots` as in Robot.toData(). */
export interface Finding {
  slots: Int32Array;
  answer?: Answer;
  /** Why the cells are no robot, or why there is no answer. */
  problem?: string;
  /** The loads are still being worked out. */
  isFirstLook?: boolean;
}

/** From here on the rigid body's answer is shown before the loads are known. */
const LARGE_COUNT = 1500;
/** A computation that has run for longer makes way for a newer robot. */
const PATIENCE_MS = 250;

interface Task {
  data: RobotData;
  slots: Int32Array;
}

/** Keeps the answer up with the robot: one computation at a time, and always for the newest. */
export class Judge {
  private readonly client = new CoreClient();
  private next?: Task;
  private isRunning = false;
  private begun = 0;

  constructor(private readonly found: (finding: Finding) => void) {}

  ask(robot: Robot): void {
    this.next = robot.toData();
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

  private async judge({ data, slots }: Task): Promise<void> {
    const tell = (finding: Omit<Finding, 'slots'>) => {
      if (!this.next) {
        this.found({ ...finding, slots });
      }
    };
    this.begun = performance.now();
    try {
      let look: Answer | undefined;
      if (slots.length >= LARGE_COUNT) {
        look = await this.client.check(data, true);
        tell({ answer: look, isFirstLook: true });
      }
      tell({ answer: await this.client.check(data) });
    } catch (error) {
      if (error instanceof Cancelled) {
        tell({ problem: 'stopped: the loads are not known' });
      } else {
        tell({ problem: error instanceof Error ? error.message : String(error) });
      }
    }
  }
}
