// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import {
  BufferGeometry,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  ShaderMaterial,
  Vector3,
  type Matrix4,
} from 'three';
import type { Point, Stability } from '../core/types';
import type { EditedRobot } from '../model/edited_robot';
import type { Place } from '../model/lattice';
import { arrow } from './arrow';

/** The ground: a grid, the support polygon, the centre of mass above it, the edge of toppling. */

const GRID_FRAGMENT = `
uniform vec3 ink;
uniform vec2 middle;
uniform float reach;
uniform vec2 pitch;
varying vec2 vAt;
void main() {
  vec2 cell = abs(fract(vAt) - 0.5);
  vec2 pixel = fwidth(vAt);
  vec2 line = 1.0 - smoothstep(vec2(0.0), pixel * 1.2, 0.5 - cell);
  float density = 1.0 - clamp(max(pixel.x, pixel.y) * 4.0, 0.0, 1.0);
  float fade = 1.0 - smoothstep(0.3 * reach, reach, distance(vAt * pitch, middle));
  gl_FragColor = vec4(ink, 0.22 * max(line.x, line.y) * fade * density);
}`;

const GRID_VERTEX = `
uniform vec2 pitch;
varying vec2 vAt;
void main() {
  vec4 at = modelMatrix * vec4(position, 1.0);
  vAt = at.xy / pitch + 0.5;
  gl_Position = projectionMatrix * viewMatrix * at;
}`;

export interface GroundColours {
  ink: [number, number, number];
  polygon: number;
  outline: number;
  mass: number;
  warn: number;
}

const SYMBOL_SEGMENTS = 32;
/** Of gravity, in cells. */
const ARROW_LENGTH = 1.6;

export class Ground {
  readonly group = new Group();
  private readonly grid: Mesh<PlaneGeometry, ShaderMaterial>;
  private readonly answer = new Group();
  /** Kept: with the last material of its kind the renderer drops the program, and compiles it anew. */
  private readonly materials = new Map<string, MeshBasicMaterial>();
  /** The centre of mass in the air, where it is while the robot stands, what shows how high. */
  private ball?: Mesh;
  private readonly ballPlace = new Vector3();
  private post?: Mesh;
  colours: GroundColours = { ink: [0, 0, 0], polygon: 0, outline: 0, mass: 0, warn: 0 };

  constructor() {
    const material = new ShaderMaterial({
      vertexShader: GRID_VERTEX,
      fragmentShader: GRID_FRAGMENT,
      transparent: true,
      depthWrite: false,
      uniforms: { ink: { value: [0, 0, 0] }, middle: { value: [0, 0] }, reach: { value: 20 }, pitch: { value: [1, 1] } },
    });
    this.grid = new Mesh(new PlaneGeometry(1, 1), material);
    this.grid.renderOrder = -2;
    this.group.add(this.grid, this.answer);
  }

  /** Where the ground is, how far the grid goes, and how large its cells are. */
  place(z: number, middle: Point, reach: number, [x, y]: Place, isThere = true): void {
    this.grid.visible = isThere;
    this.group.position.z = z;
    this.grid.position.set(middle[0], middle[1], -0.01);
    this.grid.scale.setScalar(2.2 * reach);
    this.grid.material.uniforms.middle.value = [middle[0] + x / 2, middle[1] + y / 2];
    this.grid.material.uniforms.pitch.value = [x, y];
    this.grid.material.uniforms.reach.value = reach;
    this.grid.material.uniforms.ink.value = this.colours.ink;
  }

  /** The answer of the rigid body. */
  show(robot: EditedRobot, stability: Stability | undefined): void {
    const pitch = robot.pitchMm;
    const height = stability ? stability.centre_of_mass[2] / pitch - robot.floorHeight : 0;
    for (const child of [...this.answer.children] as Mesh[]) {
      child.geometry.dispose();
      this.answer.remove(child);
    }
    this.ball = this.post = undefined;
    if (!stability) {
      return;
    }
    const [x, y] = stability.centre_of_mass;
    if (stability.polygon.length >= 3) {
      this.showPolygon(stability, pitch);
    }
    if (stability.polygon.length >= 3 || stability.rule === 'contact-forces') {
      this.showMass([x / pitch, y / pitch], height, robot);
    }
  }

  private showPolygon(stability: Stability, pitch: number): void {
    const scaled = ([x, y]: Point): Point => [x / pitch, y / pitch];
    const polygon = stability.polygon.map(scaled);
    const { colours } = this;
    this.add(fan(polygon), this.material(colours.polygon, 0.45), 0);
    polygon.forEach((a, i) => {
      this.add(band(a, polygon[(i + 1) % polygon.length], 0.035), this.material(colours.outline), 0.002);
    });
    const mass = scaled([stability.centre_of_mass[0], stability.centre_of_mass[1]]);
    if (stability.edge) {
      const [a, b] = stability.edge.map(scaled) as [Point, Point];
      this.add(band(a, b, stability.stable ? 0.06 : 0.1), this.material(colours.warn), 0.004);
      this.add(band(mass, foot(mass, a, b), 0.03), this.material(colours.mass), 0.005);
    }
    this.add(ring(mass, 0.2, 0.26), this.material(colours.mass), 0.006);
    this.add(ring(mass, 0, 0.08), this.material(colours.mass), 0.006);
  }

  /** The centre of mass moves with the robot; undefined: back to where it stands. */
  follow(motion: Matrix4 | undefined): void {
    if (!this.ball || !this.post) {
      return;
    }
    this.post.visible = motion === undefined;
    this.ball.position.copy(this.ballPlace);
    if (motion) {
      const { z } = this.group.position;
      this.ball.position.setZ(this.ballPlace.z + z).applyMatrix4(motion);
      this.ball.position.z -= z;
    }
  }

  /** Seen through the modules around it, with a post straight down, or an arrow where gravity goes elsewhere. */
  private showMass([x, y]: Point, height: number, robot: EditedRobot): void {
    const { mass } = this.colours;
    const pull = new Vector3(...robot.gravity);
    const isDown = pull.x === 0 && pull.y === 0 && pull.z <= 0 && robot.hasFloor;
    const shape = isDown ? band([0, 0], [height, 0], 0.02) : arrow(ARROW_LENGTH);
    const post = this.add(shape, this.material(mass, 0.8, true), 0);
    post.position.set(x, y, isDown ? 0 : height);
    if (isDown) {
      post.rotation.set(0, -Math.PI / 2, 0);
    } else {
      post.visible = pull.length() > 0;
      post.quaternion.setFromUnitVectors(new Vector3(1, 0, 0), pull.normalize());
    }
    const ball = this.add(ring([0, 0], 0, 0.09), this.material(mass, 0.9, true), 0);
    ball.position.copy(this.ballPlace.set(x, y, height));
    ball.onBeforeRender = (_renderer, _scene, camera) => {
      ball.quaternion.copy(camera.quaternion);
      ball.updateMatrixWorld();
    };
    post.renderOrder = ball.renderOrder = 3;
    this.post = post;
    this.ball = ball;
  }

  private material(colour: number, opacity = 1, isInFront = false): MeshBasicMaterial {
    const name = `${colour} ${opacity} ${isInFront}`;
    const material =
      this.materials.get(name) ??
      new MeshBasicMaterial({
        color: colour,
        opacity,
        transparent: true,
        depthTest: !isInFront,
        depthWrite: false,
        side: DoubleSide,
      });
    this.materials.set(name, material);
    return material;
  }

  private add(geometry: BufferGeometry, material: MeshBasicMaterial, z: number): Mesh {
    const mesh = new Mesh(geometry, material);
    mesh.position.z = z;
    mesh.renderOrder = -1;
    this.answer.add(mesh);
    return mesh;
  }
}

/** The point of a line that is nearest. */
function foot(p: Point, a: Point, b: Point): Point {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const along = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy);
  return [a[0] + along * dx, a[1] + along * dy];
}

function flat(points: Point[], index: number[]): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(points.flatMap(([x, y]) => [x, y, 0]), 3));
  geometry.setIndex(index);
  return geometry;
}

/** A convex polygon. */
function fan(points: Point[]): BufferGeometry {
  return flat(points, points.slice(2).flatMap((_, i) => [0, i + 1, i + 2]));
}

function band(a: Point, b: Point, half: number): BufferGeometry {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
  const [ux, uy] = [((b[0] - a[0]) / length) * half, ((b[1] - a[1]) / length) * half];
  return flat(
    [
      [a[0] - uy, a[1] + ux],
      [a[0] + uy, a[1] - ux],
      [b[0] + uy, b[1] - ux],
      [b[0] - uy, b[1] + ux],
    ],
    [0, 1, 2, 0, 2, 3],
  );
}

function ring(at: Point, inner: number, outer: number): BufferGeometry {
  const points: Point[] = [];
  const index: number[] = [];
  for (let i = 0; i <= SYMBOL_SEGMENTS; ++i) {
    const angle = (2 * Math.PI * i) / SYMBOL_SEGMENTS;
    for (const radius of [inner, outer]) {
      points.push([at[0] + radius * Math.cos(angle), at[1] + radius * Math.sin(angle)]);
    }
    if (i > 0) {
      index.push(2 * i - 2, 2 * i - 1, 2 * i, 2 * i - 1, 2 * i + 1, 2 * i);
    }
  }
  return flat(points, index);
}
