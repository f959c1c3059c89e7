// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { EditedRobot, RobotData } from '../model/edited_robot';
import { CoreClient, Cancelled, compiledCore, explain } from './client';
import { CoreError, type Answer } from './types';
import { Core } from './wasm';

/** What is known of the robot on the page. `slots` as in EditedRobot.toData(). */
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

const STOPPED = 'stopped: the loads are not known';

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
    this.startCore();
  }

  ask(robot: EditedRobot): void {
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

  /** Until it is there, the worker answers. */
  private startCore(): void {
    this.core = undefined;
    void compiledCore.then(Core.create).then((core) => (this.core = core));
  }

  private async run(): Promise<void> {
    this.isRunning = true;
    try {
      while (this.next) {
        const task: Task = this.next;
        this.next = undefined;
        await this.judge(task);
      }
    } finally {
      this.isRunning = false;
    }
  }

  private judgeHere(core: Core, { data, slots }: Task): void {
    this.tell({ ...this.answerHere(core, data), slots });
  }

  private answerHere(core: Core, data: RobotData): Omit<Finding, 'slots'> {
    try {
      return { answer: core.check(data, false) };
    } catch (error) {
      const message = error instanceof Error ? error.message : String(error);
      if (error instanceof CoreError) {
        return { problem: message };
      }
      // It has stopped somewhere in the middle: its memory is not to be used again.
      this.startCore();
      return { problem: explain(message) };
    }
  }

  private async judge({ data, slots, version }: Task): Promise<void> {
    const tell = (finding: Omit<Finding, 'slots'>) => {
      if (version === this.version) {
        this.tell({ ...finding, slots });
      }
    };
    this.begun = performance.now();
    let look: Answer | undefined;
    if (slots.length >= LARGE_COUNT) {
      const first = await this.answer(data, true);
      look = first.answer;
      if (!look) {
        return tell(first);
      }
      tell({ ...first, isFirstLook: true });
    }
    const finding = await this.answer(data, false);
    tell(finding.problem === STOPPED && look ? { answer: { ...look, reasons: [STOPPED] } } : finding);
  }

  private async answer(data: RobotData, firstLook: boolean): Promise<Omit<Finding, 'slots'>> {
    try {
      return { answer: await this.client.check(data, firstLook) };
    } catch (error) {
      if (error instanceof Cancelled) {
        return { problem: STOPPED };
      }
      return { problem: error instanceof Error ? error.message : String(error) };
    }
  }

  /** A fault in what is drawn is no fault of the answer, and no reason to give no more answers. */
  private tell(finding: Finding): void {
    try {
      this.found(finding);
    } catch (error) {
      reportError(error);
    }
  }
}
