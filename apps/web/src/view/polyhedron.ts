// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { BufferGeometry, Float32BufferAttribute } from 'three';
import { dot, type Lattice, type Place } from '../model/lattice';

/** The space that is nearer to a node than to any other: what an obstacle fills. */

/** The corners of each wall's face around the node, counterclockwise as seen from outside. */
export function cellFaces(lattice: Lattice): Place[][] {
  const { walls } = lattice;
  const wide = WIDE * Math.max(...lattice.stretch);
  return walls.map((wall) =>
    walls.reduce((polygon, other) => (other === wall ? polygon : cut(polygon, other)), square(wall.normal, wide)),
  );
}

const WIDE = 4;

/** A large square halfway along a normal. */
function square(normal: Place, wide: number): Place[] {
  const along = unit(normal);
  const helper: Place = Math.abs(along[2]) > 0.9 ? [1, 0, 0] : [0, 0, 1];
  const u = unit(cross(helper, along));
  const v = cross(along, u);
  const at = (a: number, b: number) =>
    normal.map((value, i) => value / 2 + wide * (a * u[i] + b * v[i])) as unknown as Place;
  return [at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)];
}

/** What of a convex polygon is on the node's side of a wall [Sutherland 1974]. */
function cut(polygon: readonly Place[], { normal, reach }: Lattice['walls'][number]): Place[] {
  const beyond = polygon.map((corner) => dot(normal, corner) - reach);
  return polygon.flatMap((corner, i) => {
    const next = (i + 1) % polygon.length;
    const kept = beyond[i] <= 1e-9 ? [corner] : [];
    const crosses = (beyond[i] < -1e-9 && beyond[next] > 1e-9) || (beyond[i] > 1e-9 && beyond[next] < -1e-9);
    const share = beyond[i] / (beyond[i] - beyond[next]);
    const middle = corner.map((value, k) => value + share * (polygon[next][k] - value)) as unknown as Place;
    return crosses ? [...kept, middle] : kept;
  });
}

const cross = (a: Place, b: Place): Place => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

const unit = (a: Place): Place => a.map((value) => value / Math.hypot(...a)) as unknown as Place;

/** The edges of a cell, `scale` times as large. */
export function cellEdges(lattice: Lattice, scale: number): BufferGeometry {
  const seen = new Set<string>();
  const points: number[] = [];
  for (const face of cellFaces(lattice)) {
    face.forEach((a, i) => {
      const b = face[(i + 1) % face.length];
      const key = a.map((value, k) => Math.round(1e4 * (value + b[k]))).join();
      if (!seen.has(key)) {
        seen.add(key);
        points.push(...[...a, ...b].map((value) => scale * value));
      }
    });
  }
  return new BufferGeometry().setAttribute('position', new Float32BufferAttribute(points, 3));
}
