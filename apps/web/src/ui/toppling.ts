// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Answer } from '../core/types';
import type { EditedRobot } from '../model/edited_robot';
import type { Ground } from '../view/ground';
import type { Stage } from '../view/stage';
import { Topple } from '../view/topple';

/** Lets the robot fall over its edge, and puts it upright again. */
export class Toppling {
  private running?: { motion: Topple; begun: number };

  constructor(
    private readonly stage: Stage,
    private readonly ground: Ground,
  ) {
    stage.motions.push((now) => this.move(now));
  }

  get isRunning(): boolean {
    return this.running !== undefined;
  }

  start(robot: EditedRobot, answer: Answer): void {
    const { edge } = answer.stability;
    if (topples(answer) && edge) {
      const scaled = edge.map(([x, y]) => [x / robot.pitchMm, y / robot.pitchMm]) as typeof edge;
      this.running = { motion: new Topple(robot, scaled), begun: performance.now() };
      this.stage.draw();
    }
  }

  /** Upright again. */
  stop(): void {
    this.running = undefined;
    this.stage.robot.matrixAutoUpdate = true;
    this.stage.robot.updateMatrix();
    this.ground.follow(undefined);
    this.stage.draw();
  }

  private move(now: number): boolean {
    if (!this.running) {
      return false;
    }
    const { motion, begun } = this.running;
    const seconds = (now - begun) / 1000;
    if (motion.isOver(seconds)) {
      this.stop();
      return false;
    }
    this.stage.robot.matrixAutoUpdate = false;
    this.stage.robot.matrix.copy(motion.matrix(Math.max(seconds, 0)));
    this.ground.follow(this.stage.robot.matrix);
    return true;
  }
}

/** It falls over an edge that is known. */
export const topples = ({ verdict, stability }: Answer) => verdict === 'unstable' && stability.edge !== null;
