// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { DoubleSide, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, PlaneGeometry, ShaderMaterial } from 'three';
import { FACET_FIELDS, FACET_INTEGERS, type Answer } from '../core/types';
import type { EditedRobot } from '../model/edited_robot';
import { dot, type Place } from '../model/lattice';
import type { Rgb } from './colours';

/** The facets with which modules touch something, by what they do there. */

export const enum FacetState {
  kUnknown,
  kPresses,
  kTilts,
  kSlips,
  kOpen,
  kBonded,
}

/** By FacetState; colours nearly as libs/io draws them, but seen on dark ground too. */
export const FACET_LOOKS: readonly { text: string; colour: Rgb; isFilled: boolean }[] = [
  { text: 'touches', colour: [106, 113, 120], isFilled: false },
  { text: 'presses', colour: [23, 112, 143], isFilled: true },
  { text: 'tilts', colour: [194, 106, 0], isFilled: false },
  { text: 'slips', colour: [176, 48, 106], isFilled: true },
  { text: 'open', colour: [200, 51, 63], isFilled: false },
  { text: 'bonded', colour: [58, 112, 182], isFilled: true },
];

/** As ContactState::code(). */
const OPEN = 0;
const CLOSED = 5;

/** A facet that is drawn for a point has at least this half width, in pitches. */
const HALF_MIN = 0.06;
/** Beyond the coefficient by more than rounding. */
const SLIP_TIE = 1e-9;

export interface Facet {
  module: number;
  direction: number;
  state: FacetState;
  /** Of the edges that still press, in the facet's own frame: signs, 0 for none. */
  pressed: readonly [x: number, y: number];
  push: number;
  /** Share of friction, if there is friction. */
  slide?: number;
}

export function facetAt({ facets, facetForces }: Answer, i: number): Facet {
  const [module, direction, isBonded, code] = facets.subarray(FACET_INTEGERS * i, FACET_INTEGERS * (i + 1));
  const [push, x, y, z, friction] = facetForces.subarray(FACET_FIELDS * i, FACET_FIELDS * (i + 1));
  const slide = friction >= 0 && push > 0 ? Math.hypot(x, y, z) / (friction * push) : undefined;
  const tiltX = code > OPEN ? Math.floor((code - 1) / 3) - 1 : 0;
  const tiltY = code > OPEN ? ((code - 1) % 3) - 1 : 0;
  let state = code === CLOSED ? FacetState.kPresses : code === OPEN ? FacetState.kOpen : FacetState.kTilts;
  if (slide !== undefined && slide > 1 + SLIP_TIE) {
    state = FacetState.kSlips;
  }
  if (isBonded || code < 0) {
    state = isBonded ? FacetState.kBonded : FacetState.kUnknown;
  }
  return { module, direction, state, pressed: state === FacetState.kTilts ? [tiltY, -tiltX] : [0, 0], push, slide };
}

export const facetCount = ({ facets }: Answer) => facets.length / FACET_INTEGERS;

/** x' and y' of a facet whose outward normal is n: x' is upward across n, or +x. */
export function facetFrame(n: Place): [Place, Place] {
  const isVertical = Math.abs(n[2]) > 1 - 1e-9;
  const up: Place = isVertical ? [1, 0, 0] : [-n[2] * n[0], -n[2] * n[1], 1 - n[2] * n[2]];
  const length = Math.sqrt(dot(up, up));
  const x = up.map((value) => value / length) as unknown as Place;
  const z: Place = [-n[0], -n[1], -n[2]];
  return [x, [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]]];
}

const VERTEX = `
attribute vec3 centre;
attribute vec3 across;
attribute vec3 beside;
attribute vec4 look;
attribute vec2 pressed;
varying vec2 vAt;
flat varying vec4 vLook;
flat varying vec2 vPressed;
void main() {
  vAt = 2.0 * position.xy;
  vLook = look;
  vPressed = pressed;
  vec3 at = centre + vAt.x * across + vAt.y * beside;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(at, 1.0);
}`;

// Filled where it presses; a dashed outline where it is open; the edge that still presses is thick.
const FRAGMENT = `
varying vec2 vAt;
flat varying vec4 vLook;
flat varying vec2 vPressed;
void main() {
  float border = 1.0 - max(abs(vAt.x), abs(vAt.y));
  float along = abs(vAt.x) > abs(vAt.y) ? vAt.y : vAt.x;
  float line = step(border, 0.13);
  float state = vLook.w;
  if (state > 3.5 && state < 4.5) line *= step(0.45, fract(along * 2.5));
  float edge = max(vAt.x * vPressed.x, vAt.y * vPressed.y);
  line = max(line, step(0.55, edge));
  bool isFilled = abs(state - 1.0) < 0.1 || abs(state - 3.0) < 0.1 || abs(state - 5.0) < 0.1;
  float ground = isFilled ? 0.75 : 0.25;
  vec3 colour = isFilled ? vLook.rgb : mix(vLook.rgb, vec3(1.0), 0.85 * (1.0 - line));
  if (abs(state - 3.0) < 0.1) colour = mix(colour, vec3(1.0), 0.8 * step(0.6, fract((vAt.x + vAt.y) * 2.0)));
  if (abs(state - 5.0) < 0.1) colour = mix(colour, vec3(1.0), 0.8 * step(0.35, border) * step(border, 0.55));
  gl_FragColor = vec4(colour, max(line, ground));
}`;

export class FacetView {
  readonly mesh = new Mesh(
    new InstancedBufferGeometry(),
    new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      side: DoubleSide,
      depthWrite: false,
    }),
  );

  constructor() {
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 2;
    this.mesh.visible = false;
  }

  /** Nothing for cubes on a floor: their feet are the support polygon. */
  show(robot: EditedRobot, judged: { answer: Answer; slots: Int32Array } | undefined): void {
    const count = judged && !robot.isPlain ? facetCount(judged.answer) : 0;
    this.mesh.visible = count > 0;
    if (!judged || count === 0) {
      return;
    }
    const { answer, slots } = judged;
    const half = Math.max(answer.facet_half_mm / robot.pitchMm, HALF_MIN);
    const values = { centre: [] as number[], across: [] as number[], beside: [] as number[], look: [] as number[], pressed: [] as number[] };
    for (let i = 0; i < count; ++i) {
      const facet = facetAt(answer, i);
      const normal = robot.lattice.units[facet.direction];
      const reach = 1.006 * robot.lattice.halves[facet.direction];
      // A little beyond the middle, so that it is seen from outside of a flat face too.
      values.centre.push(...robot.placeAt(slots[facet.module]).map((value, k) => value + reach * normal[k]));
      const [x, y] = facetFrame(normal);
      values.across.push(...x.map((value) => half * value));
      values.beside.push(...y.map((value) => half * value));
      values.look.push(...FACET_LOOKS[facet.state].colour.map((value) => value / 255), facet.state);
      values.pressed.push(...facet.pressed);
    }
    const square = new PlaneGeometry();
    const geometry = new InstancedBufferGeometry();
    geometry.index = square.index;
    geometry.setAttribute('position', square.attributes.position);
    const sizes = { centre: 3, across: 3, beside: 3, look: 4, pressed: 2 };
    for (const [name, size] of Object.entries(sizes)) {
      const array = Float32Array.from(values[name as keyof typeof values]);
      geometry.setAttribute(name, new InstancedBufferAttribute(array, size));
    }
    geometry.instanceCount = count;
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
  }
}
