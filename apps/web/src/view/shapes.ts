// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { BoxGeometry, BufferGeometry, Float32BufferAttribute, PlaneGeometry } from 'three';
import { DISC_HALF, dot, type Lattice, type Place } from '../model/lattice';

/**
 * What a module looks like, by its lattice: a mesh whose vertices know the direction of their face (`side`,
 * kNoSide where no neighbour can be) and where on it they are (`face`: a point from the face's middle, and
 * the half widths of a rectangle; or the inradius of a cap and a number below 0).
 * A sphere is a square that faces the eye, on which the shader draws it.
 */

const NO_SIDE = 15;
/** A hexagon of inradius 1/2 has corners so far from its middle. */
const HEXAGON_CORNER = 1 / Math.sqrt(3);
/** Of a disc's rim, for each direction. */
const ARC_PARTS = 4;

export function shapeGeometry(lattice: Lattice): BufferGeometry {
  const geometry = unstretched(lattice);
  const { stretch } = lattice;
  if (stretch.every((factor) => factor === 1)) {
    return geometry;
  }
  const { normal, face } = geometry.attributes;
  for (let i = 0; face !== undefined && i < face.count; ++i) {
    const [across, up] = faceAxes([normal.getX(i), normal.getY(i), normal.getZ(i)]).map((k) => stretch[k]);
    face.setXYZW(i, face.getX(i) * across, face.getY(i) * up, face.getZ(i) * across, face.getW(i) < 0 ? -1 : face.getW(i) * up);
  }
  return geometry.scale(...(stretch as [number, number, number]));
}

/** The axes along which the two coordinates on a face count: of cubes, and of prisms, which are stretched along z alone. */
function faceAxes(normal: Place): [across: number, up: number] {
  if (Math.abs(normal[2]) > 0.5) {
    return [0, 1];
  }
  return Math.abs(normal[0]) > 0.99 ? [1, 2] : [0, 2];
}

function unstretched(lattice: Lattice): BufferGeometry {
  switch (lattice.shape) {
    case 'cube':
      return cube(lattice);
    case 'prism':
      return prism(lattice);
    case 'disc':
      return disc(lattice);
    case 'sphere':
      return new PlaneGeometry();
  }
}

const sideOf = (lattice: Lattice, normal: Place) => lattice.units.findIndex((unit) => dot(unit, normal) > 0.99);

function cube(lattice: Lattice): BufferGeometry {
  const box = new BoxGeometry();
  const { normal, uv } = box.attributes;
  const sides: number[] = [];
  const faces: number[] = [];
  for (let i = 0; i < normal.count; ++i) {
    sides.push(sideOf(lattice, [normal.getX(i), normal.getY(i), normal.getZ(i)]));
    faces.push(uv.getX(i) - 0.5, uv.getY(i) - 0.5, 0.5, 0.5);
  }
  box.setAttribute('side', new Float32BufferAttribute(sides, 1));
  box.setAttribute('face', new Float32BufferAttribute(faces, 4));
  return box;
}

/** Collects vertices and triangles. */
class Builder {
  private readonly data = { position: [] as number[], normal: [] as number[], face: [] as number[], side: [] as number[] };
  private readonly index: number[] = [];
  private count = 0;

  vertex(position: Place, normal: Place, face: readonly number[], side: number): number {
    this.data.position.push(...position);
    this.data.normal.push(...normal);
    this.data.face.push(...face);
    this.data.side.push(side);
    return this.count++;
  }

  /** A convex polygon, counterclockwise as seen from outside. */
  fan(vertices: readonly number[]): void {
    for (let i = 2; i < vertices.length; ++i) {
      this.index.push(vertices[0], vertices[i - 1], vertices[i]);
    }
  }

  geometry(): BufferGeometry {
    const geometry = new BufferGeometry();
    const sizes = { position: 3, normal: 3, face: 4, side: 1 } as const;
    for (const name of ['position', 'normal', 'face', 'side'] as const) {
      geometry.setAttribute(name, new Float32BufferAttribute(this.data[name], sizes[name]));
    }
    geometry.setIndex(this.index);
    return geometry;
  }
}

/** Upright, with a face for every level direction. */
function prism(lattice: Lattice): BufferGeometry {
  const builder = new Builder();
  const half = HEXAGON_CORNER / 2;
  lattice.units.forEach((unit, side) => {
    const [x, y, z] = unit;
    if (z === 0) {
      const corner = (along: number, up: number) => {
        const position: Place = [x / 2 - y * along, y / 2 + x * along, up];
        return builder.vertex(position, unit, [along, up, half, 0.5], side);
      };
      builder.fan([corner(-half, -0.5), corner(half, -0.5), corner(half, 0.5), corner(-half, 0.5)]);
    } else {
      const corners = Array.from({ length: 6 }, (_, i) => {
        const angle = Math.sign(z) * (Math.PI / 6 + (i * Math.PI) / 3);
        const [u, v] = [HEXAGON_CORNER * Math.cos(angle), HEXAGON_CORNER * Math.sin(angle)];
        return builder.vertex([u, v, z / 2], unit, [u, v, 0.5, -1], side);
      });
      builder.fan(corners);
    }
  });
  return builder.geometry();
}

/** Standing, its axis along y, with a sixth of its rim for every direction. */
function disc(lattice: Lattice): BufferGeometry {
  const builder = new Builder();
  const arc = Math.PI / 6;
  const around = (angle: number, y: number): Place => [Math.cos(angle) / 2, y, Math.sin(angle) / 2];
  for (let side = 0; side < lattice.directionCount; ++side) {
    const middle = Math.atan2(lattice.units[side][2], lattice.units[side][0]);
    for (let part = 0; part < ARC_PARTS; ++part) {
      const corner = (share: number, y: number) => {
        const angle = -arc + 2 * arc * share;
        const [x, , z] = around(middle + angle, y);
        return builder.vertex([x, y, z], [2 * x, 0, 2 * z], [angle / 2, y, arc / 2, DISC_HALF], side);
      };
      const [a, b] = [part / ARC_PARTS, (part + 1) / ARC_PARTS];
      builder.fan([corner(a, -DISC_HALF), corner(a, DISC_HALF), corner(b, DISC_HALF), corner(b, -DISC_HALF)]);
    }
  }
  const count = ARC_PARTS * lattice.directionCount;
  for (const y of [-1, 1]) {
    const rim = Array.from({ length: count }, (_, i) => {
      const [u, , v] = around((-y * 2 * Math.PI * i) / count, 0);
      return builder.vertex([u, y * DISC_HALF, v], [0, y, 0], [u, v, 0.5, -1], NO_SIDE);
    });
    builder.fan(rim);
  }
  return builder.geometry();
}
