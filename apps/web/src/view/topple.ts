// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Matrix4, Vector3 } from 'three';
import type { Point } from '../core/types';
import type { EditedRobot } from '../model/edited_robot';

/** How a robot that falls is shown: from 0 seconds on, until it lies still. */
export interface Motion {
  isOver(seconds: number): boolean;
  matrix(seconds: number): Matrix4;
}

/** Until it lies still on what it met. */
const BOUNCE_SECONDS = 1.1;

/** A robot that turns over an edge of its support polygon until it lies. Lengths in cells. */
export class Topple implements Motion {
  private readonly origin: Vector3;
  private readonly axis: Vector3;
  private readonly angleMax: number;
  private readonly acceleration: number;

  /** The polygon lies on the left of the edge from a to b, so the robot falls to its right. */
  constructor(robot: EditedRobot, [a, b]: [Point, Point]) {
    const ground = robot.floorHeight;
    this.origin = new Vector3(a[0], a[1], ground);
    this.axis = new Vector3(b[0] - a[0], b[1] - a[1], 0).normalize();
    const out = new Vector3(this.axis.y, -this.axis.x, 0);
    this.angleMax = fallAngle(robot, this.origin, out);
    this.acceleration = 2.6;
  }

  isOver(seconds: number): boolean {
    return seconds > Math.sqrt((2 * this.angleMax) / this.acceleration) + BOUNCE_SECONDS;
  }

  matrix(seconds: number): Matrix4 {
    const fallen = 0.5 * this.acceleration * seconds ** 2;
    const late = seconds - Math.sqrt((2 * this.angleMax) / this.acceleration);
    const bounce = late > 0 ? 0.05 * Math.abs(Math.sin(late * 9)) * Math.exp(-late * 5) : 0;
    const angle = Math.min(fallen, this.angleMax) - bounce * this.angleMax;
    const { x, y, z } = this.origin;
    return new Matrix4()
      .makeTranslation(x, y, z)
      .multiply(new Matrix4().makeRotationAxis(this.axis, angle))
      .multiply(new Matrix4().makeTranslation(-x, -y, -z));
  }
}

/** The smallest angle at which a corner on the falling side meets the ground. */
function fallAngle(robot: EditedRobot, origin: Vector3, out: Vector3): number {
  let angle = Math.PI / 2;
  for (let slot = 0; slot < robot.count; ++slot) {
    const [x, y, z] = robot.placeAt(slot);
    const distance =
      (x - origin.x) * out.x + (y - origin.y) * out.y + 0.5 * (Math.abs(out.x) + Math.abs(out.y));
    if (distance > 0.05 && z - 0.5 > origin.z) {
      angle = Math.min(angle, Math.atan2(z - 0.5 - origin.z, distance));
    }
  }
  return angle;
}
