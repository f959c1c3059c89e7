// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Color, CylinderGeometry, Group, InstancedMesh, Matrix4, MeshBasicMaterial, Quaternion, SRGBColorSpace, Vector3 } from 'three';
import { hex, type Rgb } from './colours';

/** Connections as bars across the faces that they join, in one draw call. */

const RADIUS = 0.09;
const LENGTH = 0.75;
const ALONG = new Vector3(0, 1, 0);

export interface Bar {
  middle: Vector3;
  direction: Vector3;
  colour: Rgb;
  /** In radii and lengths of others. */
  width: number;
  length: number;
}

export class Bars {
  readonly group = new Group();
  private readonly geometry = new CylinderGeometry(RADIUS, RADIUS, LENGTH, 8);
  private readonly material = new MeshBasicMaterial();
  private mesh?: InstancedMesh;

  show(bars: readonly Bar[]): void {
    if (!this.mesh || this.mesh.instanceMatrix.count < bars.length) {
      this.mesh?.dispose();
      this.mesh = new InstancedMesh(this.geometry, this.material, bars.length);
      this.mesh.frustumCulled = false;
      this.group.clear().add(this.mesh);
    }
    const { mesh } = this;
    const [matrix, turn, colour, size] = [new Matrix4(), new Quaternion(), new Color(), new Vector3()];
    bars.forEach((bar, i) => {
      turn.setFromUnitVectors(ALONG, bar.direction);
      mesh.setMatrixAt(i, matrix.compose(bar.middle, turn, size.set(bar.width, bar.length, bar.width)));
      mesh.setColorAt(i, colour.setHex(hex(bar.colour), SRGBColorSpace));
    });
    mesh.count = bars.length;
    mesh.instanceMatrix.needsUpdate = true;
    if (mesh.instanceColor) {
      mesh.instanceColor.needsUpdate = true;
    }
  }
}
