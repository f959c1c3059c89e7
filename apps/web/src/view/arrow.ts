// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { BufferGeometry, Float32BufferAttribute, Quaternion, Vector3 } from 'three';

/** From the origin along x, its tip a little beyond `length`: two crossed blades, seen from every side. */
export function arrow(length: number): BufferGeometry {
  const outline = [[0, 0.03], [0, -0.03], [length, -0.03], [length, 0.03], [length, 0.16], [length, -0.16], [length + 0.35, 0]];
  const corners = outline.flatMap(([x, y]) => [x, y, 0]).concat(outline.flatMap(([x, y]) => [x, 0, y]));
  const triangles = [0, 1, 2, 0, 2, 3, 4, 5, 6];
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(corners, 3));
  geometry.setIndex([...triangles, ...triangles.map((i) => i + outline.length)]);
  return geometry;
}

const X = new Vector3(1, 0, 0);
/** Of the tip, beyond the length. */
const TIP = 0.35;

/** Along a force, its tip where it acts. */
export function arrowAlong(force: Vector3, length: number, at: Vector3): BufferGeometry {
  const turn = new Quaternion().setFromUnitVectors(X, force.clone().normalize());
  return arrow(length).translate(-length - TIP, 0, 0).applyQuaternion(turn).translate(at.x, at.y, at.z);
}
