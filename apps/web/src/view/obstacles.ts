// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import {
  BufferGeometry, DoubleSide, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Mesh, ShaderMaterial,
} from 'three';
import { type Cell } from '../model/cell';
import { widen, type Box, type EditedRobot } from '../model/edited_robot';
import type { Lattice, Place } from '../model/lattice';
import { holdOf, type Obstacle } from '../model/surroundings';
import { OBSTACLE } from './colours';
import { cellFaces } from './polyhedron';

/** Cells that the environment occupies, translucent, without the faces between two of them. */

/** Obstacles may reach further than anyone can see: cells further than this from the robot are not drawn. */
const REACH = 24;
const OPACITY = 0.42;

const VERTEX = `
attribute vec4 tint;
varying vec4 vTint;
varying vec3 vNormal;
void main() {
  vTint = tint;
  vNormal = normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const FRAGMENT = `
varying vec4 vTint;
varying vec3 vNormal;
void main() {
  float light = 0.9 + 0.06 * vNormal.x - 0.08 * vNormal.y + 0.12 * vNormal.z;
  gl_FragColor = vec4(vTint.rgb * light, vTint.a);
}`;

export class ObstacleView {
  readonly group = new Group();
  readonly faces = new Mesh(
    new BufferGeometry(),
    new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      side: DoubleSide,
      depthWrite: false,
    }),
  );
  private readonly edges = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ transparent: true, opacity: 0.3 }));
  private shown?: { obstacles: readonly Obstacle[]; lattice: Lattice; key: string };

  constructor() {
    this.faces.renderOrder = 1;
    this.edges.renderOrder = 1;
    this.group.add(this.faces, this.edges);
  }

  setInk(ink: number): void {
    this.edges.material.color.setHex(ink);
  }

  /** Made anew only if the obstacles, or what of them is near the robot, are others. */
  show(robot: EditedRobot): void {
    const { obstacles } = robot.obstacles;
    const cells = robot.count > 0 ? cellRange(robot) : undefined;
    const key = String(cells && [...cells.low, ...cells.high]);
    const { shown } = this;
    if (shown && shown.obstacles === obstacles && shown.lattice === robot.lattice && (shown.key === key || !hasBoxes(obstacles))) {
      return;
    }
    this.shown = { obstacles, lattice: robot.lattice, key };
    const corners: number[] = [];
    const normals: number[] = [];
    const tints: number[] = [];
    const lines: number[] = [];
    const polygons = cellFaces(robot.lattice);
    const { walls } = robot.lattice;
    for (const [cell, i] of outerCells(obstacles, cells)) {
      const node = robot.lattice.place(cell);
      const tint = OBSTACLE[holdOf(obstacles[i])].map((value) => value / 255);
      polygons.forEach((polygon, wall) => {
        if (robot.obstacles.has(robot.lattice.neighbour(cell, wall))) {
          return;
        }
        const at = polygon.map((corner) => corner.map((value, k) => node[k] + value));
        at.forEach((corner, k) => lines.push(...corner, ...at[(k + 1) % at.length]));
        for (let k = 2; k < at.length; ++k) {
          for (const corner of [at[0], at[k - 1], at[k]]) {
            corners.push(...corner);
            normals.push(...walls[wall].normal);
            tints.push(...tint, OPACITY);
          }
        }
      });
    }
    replace(this.faces, { position: corners, normal: normals, tint: tints });
    replace(this.edges, { position: lines });
  }
}

const hasBoxes = (obstacles: readonly Obstacle[]) => obstacles.some(({ cells }) => !cells);

function replace(mesh: Mesh | LineSegments, attributes: Record<string, number[]>): void {
  mesh.geometry.dispose();
  mesh.geometry = new BufferGeometry();
  for (const [name, values] of Object.entries(attributes)) {
    mesh.geometry.setAttribute(name, new Float32BufferAttribute(values, name === 'tint' ? 4 : 3));
  }
  mesh.visible = attributes.position.length > 0;
}

/** Of a robot's cells. */
function cellRange(robot: EditedRobot): Box {
  const first = robot.cellAt(0);
  const range: Box = { low: [...first], high: [...first] };
  for (let slot = 1; slot < robot.count; ++slot) {
    widen(range, robot.cellAt(slot));
  }
  return range;
}

/** All cells of the lists, and of the boxes those on their sides and near the robot; each with its obstacle. */
function* outerCells(obstacles: readonly Obstacle[], near: Box | undefined): Generator<[Cell, number]> {
  const { low, high } = near ?? { low: [0, 0, 0], high: [0, 0, 0] };
  for (const [i, { cells, from, to }] of obstacles.entries()) {
    for (const cell of cells ?? []) {
      yield [cell, i];
    }
    if (!cells && from && to) {
      const first = from.map((value, k) => Math.max(value, low[k] - REACH));
      const last = to.map((value, k) => Math.min(value, high[k] + REACH));
      const isSide = (value: number, k: number) => value === from[k] || value === to[k];
      for (let z = first[2]; z <= last[2]; ++z) {
        for (let y = first[1]; y <= last[1]; ++y) {
          // Of a row inside only its two ends.
          const isInside = !isSide(z, 2) && !isSide(y, 1);
          const step = isInside ? Math.max(to[0] - from[0], 1) : 1;
          for (let x = isInside ? from[0] : first[0]; x <= last[0]; x += step) {
            if (x >= first[0]) {
              yield [[x, y, z], i];
            }
          }
        }
      }
    }
  }
}

/** The box around what of the obstacles is drawn, nodes in pitches. */
export function obstacleBox(robot: EditedRobot, box: Box): void {
  const bounds = robot.bounds() ?? { low: [0, 0, 0], high: [0, 0, 0] };
  const clip = (place: Place) =>
    place.map((v, k) => Math.min(Math.max(v, bounds.low[k] - REACH), bounds.high[k] + REACH)) as unknown as Place;
  for (const { cells, from, to } of robot.obstacles.obstacles) {
    for (const cell of cells ?? []) {
      widen(box, robot.lattice.place(cell));
    }
    if (from && to) {
      for (const [x, y, z] of cornersOf(from, to)) {
        widen(box, clip(robot.lattice.place([x, y, z])));
      }
    }
  }
}

function cornersOf(from: Cell, to: Cell): Cell[] {
  const ends = [from, to];
  return [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [ends[i & 1][0], ends[(i >> 1) & 1][1], ends[i >> 2][2]]);
}
