// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Vector3 } from 'three';
import type { Answer } from '../core/types';
import { widen, type Box, type EditedRobot } from '../model/edited_robot';
import type { Ground } from '../view/ground';
import type { Stage } from '../view/stage';
import { Fall } from '../view/fall';
import { Topple, type Motion } from '../view/topple';

/** Then every fall is over. */
const LONG_SECONDS = 100;

/** Lets the robot fall, over its edge or as its rigid body begins to; it lies until it is stood up. */
export class Toppling {
  private running?: { motion: Motion; begun: number };

  constructor(
    private readonly stage: Stage,
    private readonly ground: Ground,
    private readonly tell: () => void,
  ) {
    stage.motions.push((now) => this.move(now));
  }

  /** It falls or lies. */
  get isToppled(): boolean {
    return this.running !== undefined;
  }

  start(robot: EditedRobot, answer: Answer): void {
    if (topples(answer)) {
      this.running = { motion: motionOf(robot, answer), begun: performance.now() };
      this.keepInPicture(robot, this.running.motion);
      this.stage.draw();
      this.tell();
    }
  }

  /** The camera steps back where the robot would leave the picture. */
  private keepInPicture(robot: EditedRobot, motion: Motion): void {
    const { low, high } = robot.bounds()!;
    const box: Box = { low: [...low], high: [...high] };
    const end = motion.matrix(LONG_SECONDS);
    for (let corner = 0; corner < 8; ++corner) {
      const at = low.map((value, k) => ((corner >> k) & 1 ? high[k] : value));
      widen(box, new Vector3().fromArray(at).applyMatrix4(end).toArray());
    }
    if (!this.stage.holds(box.low, box.high)) {
      this.stage.fit(box.low, box.high, true);
    }
  }

  /** Upright again. */
  stop(): void {
    this.running = undefined;
    this.tell();
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
    this.stage.robot.matrixAutoUpdate = false;
    this.stage.robot.matrix.copy(motion.matrix(Math.max(seconds, 0)));
    this.ground.follow(this.stage.robot.matrix);
    return !motion.isOver(seconds);
  }
}

/** It is known how it falls. */
export const topples = ({ verdict, stability }: Answer) =>
  verdict === 'unstable' && (stability.edge !== null || stability.rigid.motion !== null);

function motionOf(robot: EditedRobot, { stability }: Answer): Motion {
  const { edge } = stability;
  const scaled = edge?.map(([x, y]) => [x / robot.pitchMm, y / robot.pitchMm]) as typeof edge;
  return scaled ? new Topple(robot, scaled) : new Fall(robot, stability);
}
