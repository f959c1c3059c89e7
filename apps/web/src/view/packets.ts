// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute, BufferGeometry, Points, ShaderMaterial } from 'three';
import type { Rgb } from './colours';

/** Packets on their way, as points in one draw call. */

const VERTEX = `
attribute vec3 tint;
uniform float size;
varying vec3 vTint;
void main() {
  vTint = tint;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  // As large as they are from where a camera of 32 degrees would see the same.
  float distance = isOrthographic ? 3.4874 / projectionMatrix[1][1] : gl_Position.w;
  gl_PointSize = clamp(size / distance, 5.0, 26.0);
}`;

const FRAGMENT = `
varying vec3 vTint;
void main() {
  float r = distance(gl_PointCoord, vec2(0.5));
  if (r > 0.5) discard;
  gl_FragColor = vec4(mix(vTint, vec3(1.0), step(r, 0.17) * 0.7), 1.0 - smoothstep(0.44, 0.5, r));
}`;

const COUNT_MAX = 4096;

export class Packets {
  readonly points: Points<BufferGeometry, ShaderMaterial>;
  private readonly places = new Float32Array(3 * COUNT_MAX);
  private readonly tints = new Uint8Array(3 * COUNT_MAX);
  private count = 0;

  constructor() {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(this.places, 3));
    geometry.setAttribute('tint', new BufferAttribute(this.tints, 3, true));
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      depthTest: false,
      uniforms: { size: { value: 300 * Math.min(devicePixelRatio, 2) } },
    });
    this.points = new Points(geometry, material);
    this.points.frustumCulled = false;
    this.points.renderOrder = 4;
    this.clear();
  }

  clear(): void {
    this.count = 0;
    this.points.geometry.setDrawRange(0, 0);
  }

  add(x: number, y: number, z: number, colour: Rgb): void {
    if (this.count < COUNT_MAX) {
      this.places.set([x, y, z], 3 * this.count);
      this.tints.set(colour, 3 * this.count);
      ++this.count;
    }
  }

  update(): void {
    this.points.geometry.setDrawRange(0, this.count);
    this.points.geometry.attributes.position.needsUpdate = true;
    this.points.geometry.attributes.tint.needsUpdate = true;
  }
}
