// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Matrix4, Vector3 } from 'three';
import type { Stability } from '../core/types';
import type { EditedRobot } from '../model/edited_robot';
import type { Motion } from './topple';

/**
 * A robot that falls as its rigid body begins to: the screw of the first instant goes on until the robot
 * meets the floor or an obstacle, or has gone far enough to be understood. Lengths in pitches.
 */

/** Per second, in rad and in pitches. */
const TURN = 2.6;
const SLIDE = 4;
const ANGLE_MAX = Math.PI / 2;
const WAY_MAX = 1.5;
const STEPS = 60;
/** Of the modules only so many are asked whether they meet something. */
const PROBES_MAX = 600;
/** A node is this much less than half a pitch above the floor where its module lies on it tilted. */
const DIP = 0.2;
/** A robot that turns by less than this, in its own size, slides. */
const STILL = 1e-3;

export class Fall implements Motion {
  private readonly turn: number;
  private readonly axis = new Vector3(0, 0, 1);
  /** A point of the axis. */
  private readonly origin = new Vector3();
  /** Along the axis or without one, for each unit of what is driven: rad, or pitches if nothing turns. */
  private readonly way = new Vector3();
  private readonly most: number;

  constructor(robot: EditedRobot, { rigid, centre_of_mass }: Stability) {
    const pitch = robot.pitchMm;
    const velocity = new Vector3().fromArray(rigid.motion!.velocity).divideScalar(pitch);
    const angular = new Vector3().fromArray(rigid.motion!.angular);
    const centre = new Vector3().fromArray(centre_of_mass).divideScalar(pitch);
    this.turn = angular.length() * Math.max(reachOf(robot, centre), 1) > STILL * velocity.length() ? 1 : 0;
    if (this.turn) {
      const square = angular.lengthSq();
      this.axis.copy(angular).normalize();
      this.origin.copy(centre).add(angular.clone().cross(velocity).divideScalar(square));
      this.way.copy(angular).multiplyScalar(velocity.dot(angular) / square / Math.sqrt(square));
    } else {
      this.way.copy(velocity).normalize();
    }
    this.most = this.freeWay(robot);
  }

  isOver(seconds: number): boolean {
    return seconds > this.duration;
  }

  matrix(seconds: number): Matrix4 {
    return this.at(Math.min(0.5 * this.acceleration * seconds ** 2, this.most));
  }

  private get acceleration(): number {
    return this.turn ? TURN : SLIDE;
  }

  private get duration(): number {
    return Math.sqrt((2 * this.most) / this.acceleration);
  }

  private at(share: number): Matrix4 {
    const { x, y, z } = this.origin;
    const [u, v, w] = this.way.toArray().map((value) => value * share);
    return new Matrix4()
      .makeTranslation(x + u, y + v, z + w)
      .multiply(new Matrix4().makeRotationAxis(this.axis, this.turn * share))
      .multiply(new Matrix4().makeTranslation(-x, -y, -z));
  }

  /** How far it goes before a module meets something; a small part of it in any case. */
  private freeWay(robot: EditedRobot): number {
    const whole = this.turn ? ANGLE_MAX : WAY_MAX;
    const step = Math.ceil(robot.count / PROBES_MAX);
    const nodes: Vector3[] = [];
    for (let slot = 0; slot < robot.count; slot += step) {
      nodes.push(new Vector3().fromArray(robot.placeAt(slot)));
    }
    for (let i = 1; i <= STEPS; ++i) {
      const matrix = this.at((whole * i) / STEPS);
      if (nodes.some((node) => meets(robot, node.clone().applyMatrix4(matrix)))) {
        return (whole * Math.max(i - 1, 4)) / STEPS;
      }
    }
    return whole;
  }
}

/** How far modules are from a point. */
function reachOf(robot: EditedRobot, centre: Vector3): number {
  const { low, high } = robot.bounds()!;
  return Math.max(centre.distanceTo(new Vector3(...low)), centre.distanceTo(new Vector3(...high)));
}

/** A module's node is below the floor, or within an obstacle. */
function meets(robot: EditedRobot, { x, y, z }: Vector3): boolean {
  const isBelow = robot.hasFloor && z < robot.floorHeight + 0.5 - DIP;
  return isBelow || robot.obstacles.has(robot.lattice.cell(robot.lattice.nearestAxial([x, y, z])));
}
