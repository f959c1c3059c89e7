// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import {
  BoxGeometry,
  BufferAttribute,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  ShaderMaterial,
} from 'three';
import { DIRECTIONS } from '../model/cell';

/** All modules in one draw call: a box per module, its place, colour and motion as attributes. */

/** Patterns of a module, as bits. */
export const enum Pattern {
  kPlanned = 1,
  kFixed = 2,
  kBroken = 4,
  kPointed = 8,
}

const VERTEX = `
attribute vec3 place;
attribute vec3 tint;
attribute float pattern;
attribute vec3 motion;
attribute vec3 turn;
attribute float faces;
attribute float side;
uniform float exaggeration;
varying vec3 vTint;
varying vec2 vUv;
varying vec3 vNormal;
flat varying float vPattern;
flat varying float vCode;

vec3 rotated(vec3 v, vec3 w) {
  float angle = length(w);
  if (angle < 1e-5) return v;
  vec3 axis = w / angle;
  return v * cos(angle) + cross(axis, v) * sin(angle) + axis * dot(axis, v) * (1.0 - cos(angle));
}

void main() {
  vec3 w = turn * exaggeration;
  vec3 at = place + rotated(position, w) + motion * exaggeration;
  vTint = tint;
  vUv = uv;
  vNormal = mat3(modelMatrix) * rotated(normal, w);
  vPattern = pattern;
  vCode = mod(floor((faces + 0.5) / exp2(3.0 * side)), 8.0);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(at, 1.0);
}`;

const FRAGMENT = `
uniform vec3 codes[6];
uniform vec3 pointed;
uniform float opacity;
varying vec3 vTint;
varying vec2 vUv;
varying vec3 vNormal;
flat varying float vPattern;
flat varying float vCode;

float stroke(float across, float width, float pixel) {
  return 1.0 - smoothstep(width, width + pixel, abs(across));
}

// What a face says without its colour: a cross breaks, a stroke topples, a ring is not certain.
float markOf(float code, vec2 uv, float pixel) {
  vec2 at = uv - 0.5;
  float isInside = 1.0 - smoothstep(0.27, 0.27 + pixel, max(abs(at.x), abs(at.y)));
  float rising = stroke((at.x - at.y) * 0.7071, 0.055, pixel);
  float falling = stroke((at.x + at.y) * 0.7071, 0.055, pixel);
  if (code < 1.5 || code > 4.5) return 0.0;
  if (code < 2.5) return isInside * max(rising, falling);
  if (code < 3.5) return isInside * rising;
  return stroke(length(at) - 0.2, 0.05, pixel);
}

bool has(float bit) { return mod(floor((vPattern + 0.5) / bit), 2.0) > 0.5; }

void main() {
  vec3 n = normalize(vNormal);
  float top = max(n.z, 0.0);
  float light = 0.86 + 0.06 * n.x - 0.08 * n.y - 0.10 * max(-n.z, 0.0);
  vec3 colour = mix(vTint * light, mix(vTint, vec3(1.0), 0.14), top);
  vec2 inner = min(vUv, 1.0 - vUv);
  float border = min(inner.x, inner.y);
  float pixel = max(fwidth(vUv.x), fwidth(vUv.y));
  vec3 rimColour = colour * 0.55;
  float width = has(1.0) ? 0.035 : 0.014;
  float along = inner.x < inner.y ? vUv.y : vUv.x;
  float wave = abs(fract(along * 5.0) - 0.5);
  float dash = has(1.0) ? smoothstep(0.25 - 2.5 * pixel, 0.25 + 2.5 * pixel, wave) : 1.0;
  if (has(4.0)) {
    float stripe = abs(fract((vUv.x + vUv.y) * 3.0) - 0.5);
    float fade = clamp(0.5 / (pixel * 12.0), 0.0, 1.0);
    colour = mix(colour, mix(colour, vec3(1.0), 0.5), fade * smoothstep(0.36, 0.40, stripe));
  }
  if (has(2.0)) {
    float ring = smoothstep(0.0, pixel, border - 0.24) - smoothstep(0.0, pixel, border - 0.30);
    colour = mix(colour, vec3(1.0), 0.85 * ring);
  }
  if (vCode > 0.5) {
    float inset = smoothstep(0.0, pixel, border - 0.13);
    vec3 code = codes[int(vCode + 0.5) - 1] * (0.35 + 0.65 * mix(light, 1.1, top));
    colour = mix(colour, code, inset);
    float isDark = step(dot(code, vec3(0.2126, 0.7152, 0.0722)), 0.45);
    colour = mix(colour, vec3(isDark), markOf(vCode, vUv, pixel));
  }
  float visible = clamp(1.5 * width / pixel, 0.25, 1.0);
  float edge = 1.0 - smoothstep(width, width + pixel, border);
  colour = mix(colour, rimColour, edge * dash * visible);
  if (has(8.0)) {
    float rim = 1.0 - smoothstep(0.06, 0.06 + pixel, border);
    colour = mix(mix(colour, vec3(1.0), 0.18), pointed, rim);
  }
  gl_FragColor = vec4(colour, opacity);
}`;

export class ModuleMesh {
  readonly mesh: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private capacity = 0;
  places = new Float32Array(0);
  tints = new Uint8Array(0);
  patterns = new Float32Array(0);
  motions = new Float32Array(0);
  turns = new Float32Array(0);
  faces = new Float32Array(0);

  constructor(opacity = 1) {
    const material = new ShaderMaterial({
      transparent: opacity < 1,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        exaggeration: { value: 0 },
        opacity: { value: opacity },
        codes: { value: new Float32Array(18) },
        pointed: { value: [0, 0, 0] },
      },
    });
    this.mesh = new Mesh(new InstancedBufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.reserve(64);
  }

  /** Room for so many instances; what is in the arrays is lost if they grow. */
  reserve(count: number): void {
    if (count <= this.capacity) {
      return;
    }
    this.capacity = Math.max(count, 2 * this.capacity);
    this.places = new Float32Array(3 * this.capacity);
    this.tints = new Uint8Array(3 * this.capacity);
    this.patterns = new Float32Array(this.capacity);
    this.motions = new Float32Array(3 * this.capacity);
    this.turns = new Float32Array(3 * this.capacity);
    this.faces = new Float32Array(this.capacity);
    const geometry = new InstancedBufferGeometry();
    const box = new BoxGeometry();
    geometry.index = box.index;
    geometry.setAttribute('position', box.attributes.position);
    geometry.setAttribute('normal', box.attributes.normal);
    geometry.setAttribute('uv', box.attributes.uv);
    geometry.setAttribute('side', sidesOf(box));
    const add = (name: string, array: Float32Array | Uint8Array, size: number) => {
      const attribute = new InstancedBufferAttribute(array, size, array instanceof Uint8Array);
      geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
    };
    add('place', this.places, 3);
    add('tint', this.tints, 3);
    add('pattern', this.patterns, 1);
    add('motion', this.motions, 3);
    add('turn', this.turns, 3);
    add('faces', this.faces, 1);
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
  }

  /** Says that an array has changed at one instance. */
  updateAt(index: number, name: string): void {
    const attribute = this.mesh.geometry.getAttribute(name) as InstancedBufferAttribute;
    attribute.addUpdateRange(index * attribute.itemSize, attribute.itemSize);
    attribute.needsUpdate = true;
  }

  /** Says which arrays have changed. */
  update(count: number, ...names: string[]): void {
    this.mesh.geometry.instanceCount = count;
    for (const name of names) {
      const attribute = this.mesh.geometry.getAttribute(name) as InstancedBufferAttribute;
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, count * attribute.itemSize);
      attribute.needsUpdate = true;
    }
  }
}

/** The direction of each vertex's face, as in base::Direction. */
function sidesOf(box: BoxGeometry): BufferAttribute {
  const normals = box.attributes.normal;
  const sides = new Float32Array(normals.count);
  for (let i = 0; i < normals.count; ++i) {
    const normal = [normals.getX(i), normals.getY(i), normals.getZ(i)];
    sides[i] = DIRECTIONS.findIndex((direction) => direction.every((v, k) => v === normal[k]));
  }
  return new BufferAttribute(sides, 1);
}
