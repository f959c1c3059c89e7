// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { BufferGeometry, Float32BufferAttribute } from 'three';

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
