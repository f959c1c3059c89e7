// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { DoubleSide, Group, Mesh, MeshBasicMaterial, Quaternion, TorusGeometry, Vector3, type BufferGeometry } from 'three';
import { mergeGeometries } from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import type { EditedRobot } from '../model/edited_robot';
import type { Load, Vector } from '../model/surroundings';
import { arrow } from './arrow';

/** Payloads: an arrow along each force, a ring across each torque, seen through the modules. */

const LENGTH = 0.75;
const X = new Vector3(1, 0, 0);
const Z = new Vector3(0, 0, 1);

export class LoadView {
  readonly group = new Group();
  private readonly mesh = new Mesh<BufferGeometry, MeshBasicMaterial>(
    undefined,
    new MeshBasicMaterial({ side: DoubleSide, transparent: true, opacity: 0.85, depthTest: false }),
  );
  private shown?: readonly Load[];
  private robot?: EditedRobot;

  constructor() {
    this.mesh.renderOrder = 4;
    this.mesh.visible = false;
    this.group.add(this.mesh);
  }

  setInk(ink: number): void {
    this.mesh.material.color.setHex(ink);
  }

  show(robot: EditedRobot): void {
    const { loads } = robot.surroundings;
    if (loads === this.shown && robot === this.robot) {
      return;
    }
    this.shown = loads;
    this.robot = robot;
    const signs = (loads ?? []).flatMap((load) => signsOf(robot, load));
    this.mesh.visible = signs.length > 0;
    if (signs.length > 0) {
      this.mesh.geometry.dispose();
      this.mesh.geometry = mergeGeometries(signs);
    }
  }
}

function signsOf(robot: EditedRobot, { cell, force_n, torque_nmm }: Load): BufferGeometry[] {
  const [x, y, z] = robot.lattice.place(cell);
  const along = (from: Vector3, vector: Vector | undefined, make: () => BufferGeometry) => {
    const way = new Vector3(...(vector ?? [0, 0, 0]));
    const turn = new Quaternion().setFromUnitVectors(from, way.clone().normalize());
    return way.length() > 0 ? [make().applyQuaternion(turn).translate(x, y, z)] : [];
  };
  return [
    ...along(X, force_n, () => arrow(LENGTH).deleteAttribute('uv').deleteAttribute('normal')),
    ...along(Z, torque_nmm, () => new TorusGeometry(0.3, 0.04, 6, 24).deleteAttribute('uv').deleteAttribute('normal')),
  ];
}
