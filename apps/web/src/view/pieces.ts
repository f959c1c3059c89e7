// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Matrix3, Matrix4, Quaternion, Vector3 } from 'three';
import { MOTION_FIELDS, type Breaking } from '../core/types';
import type { EditedRobot } from '../model/edited_robot';

/** Where the modules of pieces that fall are, at any moment of the fall that the core has computed. */

/** How far a body has moved, in mm, and its turn as a quaternion (w, x, y, z). */
const POSE_FIELDS = 7;

interface Pose {
  moved: Vector3;
  turn: Quaternion;
}

export class FallingPieces {
  private readonly motions: Float64Array;
  /** Of each module from the centre of its body, mm. */
  private readonly arms: Float64Array;
  private readonly bodyCount: number;
  private readonly frameCount: number;
  readonly seconds: number;

  /** `slots`: of the core's modules. */
  constructor(
    private readonly robot: EditedRobot,
    private readonly slots: Int32Array,
    readonly breaking: Breaking,
  ) {
    const { bodies, centres, poses, frame_s: frame } = breaking;
    this.bodyCount = centres.length / 3;
    this.frameCount = this.bodyCount > 0 ? poses.length / POSE_FIELDS / this.bodyCount : 1;
    this.seconds = frame * (this.frameCount - 1);
    this.motions = new Float64Array(MOTION_FIELDS * robot.count);
    this.arms = new Float64Array(3 * slots.length);
    slots.forEach((slot, module) => {
      const place = robot.placeAt(slot);
      for (let k = 0; bodies[module] >= 0 && k < 3; ++k) {
        this.arms[3 * module + k] = place[k] * robot.pitchMm - centres[3 * bodies[module] + k];
      }
    });
  }

  /** Displacements in mm and rotation vectors, six numbers for each slot; the same array each time. */
  at(seconds: number): Float64Array {
    const { arms, motions, breaking: { bodies } } = this;
    const poses = Array.from({ length: this.bodyCount }, (_, body) => {
      const { moved, turn } = this.pose(body, seconds);
      const rotation = new Matrix3().setFromMatrix4(new Matrix4().makeRotationFromQuaternion(turn)).elements;
      return { moved: moved.toArray(), rotation, axis: axisOf(turn).toArray() };
    });
    for (let module = 0; module < bodies.length; ++module) {
      if (bodies[module] >= 0) {
        const { moved, rotation, axis } = poses[bodies[module]];
        for (let k = 0; k < 3; ++k) {
          let way = moved[k] - arms[3 * module + k];
          for (let j = 0; j < 3; ++j) {
            way += rotation[3 * j + k] * arms[3 * module + j];
          }
          motions[MOTION_FIELDS * this.slots[module] + k] = way;
          motions[MOTION_FIELDS * this.slots[module] + 3 + k] = axis[k];
        }
      }
    }
    return motions;
  }

  /** How many rounds have begun. */
  begun(seconds: number): number {
    return this.breaking.round_s.filter((begin) => begin <= seconds).length;
  }

  /** Slots of the modules that fall in the first rounds. */
  fallen(roundCount: number): ReadonlySet<number> {
    const rounds = this.breaking.cascade.rounds.slice(0, roundCount);
    return new Set(rounds.flatMap(({ fallen }) => fallen.map((cell) => this.robot.slot(cell)!)));
  }

  /** The motion of the whole robot where it falls in one piece, lengths in pitches; none if something stands. */
  whole(seconds: number): Matrix4 {
    const matrix = new Matrix4();
    if (this.bodyCount === 1 && !this.breaking.bodies.includes(-1)) {
      const { moved, turn } = this.pose(0, seconds);
      const { pitchMm } = this.robot;
      const centre = new Vector3().fromArray(this.breaking.centres).divideScalar(pitchMm);
      matrix.makeRotationFromQuaternion(turn).multiply(new Matrix4().makeTranslation(centre.clone().negate()));
      matrix.premultiply(new Matrix4().makeTranslation(centre.addScaledVector(moved, 1 / pitchMm)));
    }
    return matrix;
  }

  private pose(body: number, seconds: number): Pose {
    const at = Math.min(Math.max(seconds / this.breaking.frame_s, 0), this.frameCount - 1);
    const [from, to] = [Math.floor(at), Math.ceil(at)].map((frame) => this.frame(body, frame));
    return { moved: from.moved.lerp(to.moved, at % 1), turn: from.turn.slerp(to.turn, at % 1) };
  }

  private frame(body: number, frame: number): Pose {
    const at = POSE_FIELDS * (frame * this.bodyCount + body);
    const [w, x, y, z] = this.breaking.poses.subarray(at + 3, at + POSE_FIELDS);
    return { moved: new Vector3().fromArray(this.breaking.poses, at), turn: new Quaternion(x, y, z, w) };
  }
}

/** The rotation vector of a turn. */
function axisOf({ w, x, y, z }: Quaternion): Vector3 {
  const axis = new Vector3(x, y, z);
  const sine = axis.length();
  return sine > 0 ? axis.multiplyScalar((2 * Math.atan2(sine, w)) / sine) : axis;
}
