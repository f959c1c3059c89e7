// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import {
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  ShaderMaterial,
} from 'three';
import { CUBIC, type Lattice, type Shape } from '../model/lattice';
import { shapeGeometry } from './shapes';

/** All modules in one draw call: a shape per module, its place, colour and motion as attributes. */

/** Patterns of a module, as bits. */
export const enum Pattern {
  kPlanned = 1,
  kFixed = 2,
  kBroken = 4,
  kPointed = 8,
  kSelected = 16,
}

/** How much of the picture modules are that connections are seen through. */
const SHEER = 0.16;

/** By shape: what a shader is told to draw. */
const DEFINES: Record<Shape, Record<string, string>> = {
  cube: {},
  prism: { HEXAGON: '' },
  disc: { DISC: '' },
  sphere: { SPHERE: '' },
};

const COMMON = `
vec3 rotated(vec3 v, vec3 w) {
  float angle = length(w);
  if (angle < 1e-5) return v;
  vec3 axis = w / angle;
  return v * cos(angle) + cross(axis, v) * sin(angle) + axis * dot(axis, v) * (1.0 - cos(angle));
}

// The code of a direction's face, three bits of six in each number.
float codeOf(vec2 packed, float side) {
  float six = side < 5.5 ? packed.x : side < 11.5 ? packed.y : 0.0;
  return mod(floor((six + 0.5) / exp2(3.0 * mod(side + 0.5, 6.0) - 1.5)), 8.0);
}`;

const VERTEX = `
attribute vec3 place;
attribute vec3 tint;
attribute float pattern;
attribute vec3 motion;
attribute vec3 turn;
attribute vec2 faces;
attribute vec2 seams;
uniform float exaggeration;
varying vec3 vTint;
flat varying float vPattern;
flat varying vec2 vSeams;
#ifdef SPHERE
varying vec3 vCentre;
varying vec3 vAt;
flat varying vec3 vTurn;
flat varying vec2 vFaces;
#else
attribute float side;
attribute vec4 face;
varying vec4 vFace;
varying vec3 vNormal;
varying vec3 vBody;
flat varying float vCode;
flat varying float vSide;
#endif
${COMMON}

void main() {
  vSeams = seams;
  vec3 w = turn * exaggeration;
  vTint = tint;
  vPattern = pattern;
#ifdef SPHERE
  // A square across the line of sight, as large as the sphere is seen.
  vCentre = (modelViewMatrix * vec4(place + motion * exaggeration, 1.0)).xyz;
  vec3 sight = isOrthographic ? vec3(0.0, 0.0, -1.0) : vCentre;
  float square = dot(vCentre, vCentre);
  vec3 right = normalize(cross(sight, vec3(0.0, 1.0, 0.0)));
  vec3 up = normalize(cross(right, sight));
  float size = 1.02 * (isOrthographic ? 1.0 : sqrt(square / max(square - 0.25, 0.01)));
  vAt = vCentre + size * (position.x * right + position.y * up);
  vTurn = w;
  vFaces = faces;
  gl_Position = projectionMatrix * vec4(vAt, 1.0);
#else
  vec3 at = place + rotated(position, w) + motion * exaggeration;
  vFace = face;
  vBody = position;
  vSide = side;
  vNormal = mat3(modelMatrix) * rotated(normal, w);
  vCode = codeOf(faces, side);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(at, 1.0);
#endif
}`;

const FRAGMENT = `
uniform vec3 codes[6];
uniform vec3 steps[7];
uniform vec3 pointed;
uniform float opacity;
uniform vec3 units[12];
varying vec3 vTint;
flat varying float vPattern;
flat varying vec2 vSeams;
#ifdef SPHERE
uniform mat4 modelMatrix;
uniform mat4 projectionMatrix;
varying vec3 vCentre;
varying vec3 vAt;
flat varying vec3 vTurn;
flat varying vec2 vFaces;
#else
varying vec4 vFace;
varying vec3 vNormal;
varying vec3 vBody;
flat varying float vCode;
flat varying float vSide;
#endif
${COMMON}

float stroke(float across, float width, float pixel) {
  return 1.0 - smoothstep(width, width + pixel, abs(across));
}

// What a face says without its colour: a cross breaks, a stroke topples, a ring is not certain.
float markOf(float code, vec2 at, float pixel) {
  float isInside = 1.0 - smoothstep(0.27, 0.27 + pixel, max(abs(at.x), abs(at.y)));
  float rising = stroke((at.x - at.y) * 0.7071, 0.055, pixel);
  float falling = stroke((at.x + at.y) * 0.7071, 0.055, pixel);
  if (code < 1.5 || code > 4.5) return 0.0;
  if (code < 2.5) return isInside * max(rising, falling);
  if (code < 3.5) return isInside * rising;
  return stroke(length(at) - 0.2, 0.05, pixel);
}

bool has(float bit) { return mod(floor((vPattern + 0.5) / bit), 2.0) > 0.5; }

// A point of a face: where it is from the middle, its distance from the border and along it, how far the
// border is from the middle, and how much of all that is one pixel; the code of the nearest connection, and
// how far it is from where modules touch.
struct Spot {
  vec3 n;
  vec2 at;
  float border;
  float along;
  float reach;
  float pixel;
  float code;
  float seam;
  float gap;
};

// Half the width of a connection's band: around where round modules touch, along the edges of others.
#if defined(SPHERE) || defined(DISC)
const float BAND = 0.17;
#else
const float BAND = 0.075;
#endif

#ifdef SPHERE

Spot spotOn(vec3 n, vec3 body, float pixel) {
  float best = -2.0;
  float next = -2.0;
  int side = 0;
  int other = 0;
  for (int i = 0; i < 12; ++i) {
    float share = dot(units[i], body);
    if (share > best) {
      next = best;
      other = side;
      best = share;
      side = i;
    } else if (share > next) {
      next = share;
      other = i;
    }
  }
  vec3 middle = units[side];
  vec3 across = normalize(cross(middle, abs(middle.z) > 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, 1.0)));
  vec3 beside = normalize(cross(middle, units[other]));
  Spot spot;
  spot.n = n;
  spot.at = 0.5 * vec2(dot(body, across), dot(body, cross(across, middle)));
  spot.border = 0.5 * (best - next) / distance(middle, units[other]);
  spot.along = 0.5 * dot(body, beside);
  spot.reach = 0.25;
  spot.pixel = pixel;
  spot.code = codeOf(vFaces, float(side));
  spot.seam = codeOf(vSeams, float(side));
  spot.gap = 0.5 * distance(body, middle);
  return spot;
}

#else

// The direction that a point of the surface is nearest to, beside that of its own face.
Spot withSeam(Spot spot) {
#ifdef DISC
  vec3 body = normalize(vec3(vBody.x, 0.0, vBody.z));
#else
  vec3 body = vBody;
#endif
  float best = 0.0;
  int side = -1;
  for (int i = 0; i < 12; ++i) {
    float share = dot(units[i], body);
#ifndef DISC
    if (abs(float(i) - vSide) < 0.5) continue;
#endif
    if (share > best) {
      best = share;
      side = i;
    }
  }
  if (side < 0) return spot;
  spot.seam = codeOf(vSeams, float(side));
#ifdef DISC
  spot.gap = distance(vec2(vBody.x, vBody.z), 0.5 * vec2(units[side].x, units[side].z));
#else
  spot.gap = 0.5 - best;
#endif
  return spot;
}

Spot spotOfFace() {
  vec2 at = vFace.xy;
  vec2 inner = vFace.zw - abs(at);
  Spot spot;
  spot.n = normalize(vNormal);
  spot.at = at;
  spot.border = min(inner.x, inner.y);
  spot.along = 0.5 + (inner.x < inner.y ? at.y : at.x);
  spot.reach = min(vFace.z, vFace.w);
  spot.pixel = max(fwidth(at.x), fwidth(at.y));
  spot.code = vCode;
  if (vFace.w < 0.0) {
    spot.reach = vFace.z;
#ifdef HEXAGON
    vec3 halves = vec3(at.x, dot(at, vec2(0.5, 0.8660254)), dot(at, vec2(0.5, -0.8660254)));
    float most = max(abs(halves.x), max(abs(halves.y), abs(halves.z)));
    spot.border = vFace.z - most;
    spot.along = most == abs(halves.x) ? at.y : most == abs(halves.y) ? halves.z : halves.y;
#else
    spot.border = vFace.z - length(at);
    spot.along = 0.5 * atan(at.y, at.x);
#endif
  }
  spot.seam = 0.0;
  spot.gap = 1.0;
  if (vSeams.x + vSeams.y > 0.5) return withSeam(spot);
  return spot;
}

#endif

vec3 colourOf(Spot spot) {
  vec3 n = spot.n;
  float pixel = spot.pixel;
  // What is drawn on a face fits the smaller ones too.
  float scale = 0.5 / spot.reach;
  vec2 at = spot.at * scale;
  float inward = spot.border * scale;
  float fine = pixel * scale;
  float top = max(n.z, 0.0);
  float light = 0.86 + 0.06 * n.x - 0.08 * n.y - 0.10 * max(-n.z, 0.0);
  vec3 colour = mix(vTint * light, mix(vTint, vec3(1.0), 0.14), top);
  vec3 rimColour = colour * 0.55;
#ifdef SPHERE
  float width = has(1.0) ? 0.024 : 0.008;
#else
  float width = has(1.0) ? 0.035 : 0.014;
#endif
  float wave = abs(fract(spot.along * 5.0) - 0.5);
  float dash = has(1.0) ? smoothstep(0.25 - 2.5 * pixel, 0.25 + 2.5 * pixel, wave) : 1.0;
  if (has(4.0)) {
    float stripe = abs(fract((at.x + at.y + 1.0) * 3.0) - 0.5);
    float fade = clamp(0.5 / (fine * 12.0), 0.0, 1.0);
    colour = mix(colour, mix(colour, vec3(1.0), 0.5), fade * smoothstep(0.36, 0.40, stripe));
  }
  if (has(2.0)) {
    float ring = smoothstep(0.0, fine, inward - 0.24) - smoothstep(0.0, fine, inward - 0.30);
    colour = mix(colour, vec3(1.0), 0.85 * ring);
  }
  if (spot.code > 0.5) {
    float inset = smoothstep(0.0, fine, inward - 0.13);
    vec3 code = codes[int(spot.code + 0.5) - 1] * (0.35 + 0.65 * mix(light, 1.1, top));
    colour = mix(colour, code, inset);
    float isDark = step(dot(code, vec3(0.2126, 0.7152, 0.0722)), 0.45);
    colour = mix(colour, vec3(isDark), markOf(spot.code, at, fine));
  }
  if (spot.seam > 0.5) {
    bool breaks = spot.seam > 4.5;
    float reach = clamp(2.0 * pixel, BAND * (breaks ? 1.5 : 1.0), 0.3);
    float inside = 1.0 - smoothstep(reach - pixel, reach, spot.gap);
    vec3 band = steps[int(spot.seam + 0.5) - 1];
    // A crack: teeth across the band, where there is room for them.
    float tooth = abs(fract(spot.along * 5.0) - 0.5);
    float crack = stroke(spot.gap - 1.3 * reach * tooth, 0.012, pixel) * clamp(0.02 / pixel, 0.0, 1.0);
    band = breaks ? mix(band, vec3(1.0), 0.9 * crack) : band;
    colour = mix(colour, band * mix(light, 1.0, 0.5), inside);
  }
  float visible = clamp(1.5 * width / pixel, 0.25, 1.0);
  float edge = 1.0 - smoothstep(width, width + pixel, spot.border);
  colour = mix(colour, rimColour, edge * dash * visible);
  if (has(16.0)) {
    float frame = 1.0 - smoothstep(0.1, 0.1 + pixel, spot.border);
    float bead = abs(fract(spot.along * 4.0) - 0.5);
    colour = mix(mix(colour, vec3(1.0), 0.25), pointed, frame * smoothstep(0.2 - 2.0 * pixel, 0.2 + 2.0 * pixel, bead));
  }
  if (has(8.0)) {
    float rim = 1.0 - smoothstep(0.06, 0.06 + pixel, spot.border);
    colour = mix(mix(colour, vec3(1.0), 0.18), pointed, rim);
  }
  return colour;
}

void main() {
#ifdef SPHERE
  vec3 sight = isOrthographic ? vec3(0.0, 0.0, -1.0) : normalize(vAt);
  vec3 eye = isOrthographic ? vec3(vAt.xy, 0.0) : vec3(0.0);
  float nearest = dot(sight, vCentre - eye);
  float miss = length(vCentre - eye - sight * nearest);
  float soft = max(fwidth(miss), 1e-5);
  vec3 hit = eye + sight * (nearest - sqrt(max(0.25 - miss * miss, 0.0)));
  vec3 n = (hit - vCentre) * 2.0;
  vec3 world = n * mat3(viewMatrix);
  vec3 body = rotated(world * mat3(modelMatrix), -vTurn);
  float slant = max(-dot(n, sight), 0.15);
  vec3 colour = colourOf(spotOn(world, body, soft / slant));
  // Round: darker towards the outline, which is a line of its own.
  colour *= 0.7 + 0.3 * smoothstep(0.0, 0.75, -dot(n, sight));
  colour = mix(colour, colour * 0.55, smoothstep(-soft, 0.0, miss - 0.488));
  float cover = clamp((0.5 - miss) / soft + 0.5, 0.0, 1.0);
  if (cover <= 0.0) discard;
  vec4 at = projectionMatrix * vec4(hit, 1.0);
  gl_FragDepth = 0.5 * at.z / at.w + 0.5;
  gl_FragColor = vec4(colour, opacity * cover);
#else
  gl_FragColor = vec4(colourOf(spotOfFace()), opacity);
#endif
}`;

/** For the shader: of which the scalar product with a point of a module is 1/2 on the wall of each direction. */
const seamAxes = (lattice: Lattice) =>
  lattice.units.slice(0, 12).flatMap((unit, i) => unit.map((value) => (0.5 * value) / lattice.halves[i]));

export class ModuleMesh {
  readonly mesh: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private capacity = 0;
  places = new Float32Array(0);
  tints = new Uint8Array(0);
  patterns = new Float32Array(0);
  motions = new Float32Array(0);
  turns = new Float32Array(0);
  faces = new Float32Array(0);
  /** The step of the connection at each direction, packed as faces are. */
  seams = new Float32Array(0);

  private lattice = CUBIC;
  private readonly uniforms = {
    exaggeration: { value: 0 },
    opacity: { value: 1 },
    codes: { value: new Float32Array(18) },
    steps: { value: new Float32Array(21) },
    pointed: { value: [0, 0, 0] },
    units: { value: new Float32Array(36) },
  };
  /** Kept: with the last material of its kind the renderer drops the program, and compiles it anew. */
  private readonly materials = new Map<Shape, ShaderMaterial>();

  constructor(opacity = 1) {
    this.uniforms.opacity.value = opacity;
    this.uniforms.units.value.set(seamAxes(CUBIC));
    this.mesh = new Mesh(new InstancedBufferGeometry(), this.material());
    this.mesh.frustumCulled = false;
    this.reserve(64);
  }

  /** Whether what is behind and inside modules is seen through them. */
  set isSheer(isSheer: boolean) {
    this.uniforms.opacity.value = isSheer ? SHEER : 1;
    this.materials.forEach((material) => material.dispose());
    this.materials.clear();
    this.mesh.material = this.material();
  }

  set exaggeration(factor: number) {
    this.uniforms.exaggeration.value = factor;
  }

  get exaggeration(): number {
    return this.uniforms.exaggeration.value;
  }

  /** Colours from 0 to 1: the rim of what is pointed at, by FaceCode but the first, by step of load. */
  setColours(pointed: number[], codes: number[], steps: number[]): void {
    this.uniforms.pointed.value = pointed;
    this.uniforms.codes.value.set(codes);
    this.uniforms.steps.value.set(steps);
  }

  /** Modules of another lattice; what is in the arrays is lost. */
  setLattice(lattice: Lattice): void {
    if (lattice !== this.lattice) {
      this.lattice = lattice;
      this.uniforms.units.value.fill(0).set(seamAxes(lattice));
      this.mesh.material = this.material();
      this.capacity = 0;
      this.reserve(64);
    }
  }

  private material(): ShaderMaterial {
    const { shape } = this.lattice;
    const opacity = this.uniforms.opacity.value;
    const material =
      this.materials.get(shape) ??
      new ShaderMaterial({
        transparent: opacity < 1,
        depthWrite: opacity > SHEER,
        // The outline of a sphere is drawn by its shader, and smoothed so.
        alphaToCoverage: shape === 'sphere' && opacity === 1,
        defines: DEFINES[shape],
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        uniforms: this.uniforms,
      });
    this.materials.set(shape, material);
    return material;
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
    this.faces = new Float32Array(2 * this.capacity);
    this.seams = new Float32Array(2 * this.capacity);
    const geometry = new InstancedBufferGeometry();
    const shape = shapeGeometry(this.lattice);
    geometry.index = shape.index;
    for (const name of ['position', 'normal', 'face', 'side'].filter((one) => shape.hasAttribute(one))) {
      geometry.setAttribute(name, shape.getAttribute(name));
    }
    const add = (name: string, array: Float32Array | Uint8Array, size: number) => {
      const attribute = new InstancedBufferAttribute(array, size, array instanceof Uint8Array);
      geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
    };
    add('place', this.places, 3);
    add('tint', this.tints, 3);
    add('pattern', this.patterns, 1);
    add('motion', this.motions, 3);
    add('turn', this.turns, 3);
    add('faces', this.faces, 2);
    add('seams', this.seams, 2);
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
