// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Verdict } from '../core/types';

/** Colours as libs/io draws them: Fig. 6 of [Piranda 2021]; and a scale for every eye. */

export type Rgb = readonly [red: number, green: number, blue: number];
export type ScaleName = 'paper' | 'cividis';

/** What the colours are about. */
export type Subject = 'connections' | 'modules';

interface Scale {
  stops: readonly [share: number, colour: Rgb][];
  broken: Rgb;
  /** Two steps further. */
  worse: readonly [Rgb, Rgb];
}

const SCALES: Record<ScaleName, Scale> = {
  paper: {
    stops: [
      [0, [62, 166, 88]],
      [0.5, [242, 218, 78]],
      [1, [240, 138, 36]],
    ],
    broken: [214, 32, 43],
    worse: [[150, 12, 84], [72, 6, 66]],
  },
  // Cividis [Nunez 2018]: the same order of lightness whatever the eye; broken is near black.
  cividis: {
    stops: [
      [0, [0, 62, 128]],
      [0.25, [65, 85, 108]],
      [0.5, [124, 123, 120]],
      [0.75, [188, 174, 108]],
      [1, [255, 234, 70]],
    ],
    broken: [36, 20, 28],
    worse: [[128, 8, 84], [205, 24, 120]],
  },
};

/** Of modules whose connections show the loads. */
export const NEUTRAL: Rgb = [214, 216, 215];
export const FIXED: Rgb = [58, 123, 200];
export const UNSTABLE: Rgb = [142, 77, 178];
export const UNKNOWN: Rgb = [165, 170, 176];
/** By how they hold. */
export const OBSTACLE: Record<'contact' | 'bonded', Rgb> = { contact: [120, 126, 134], bonded: FIXED };

export function mix(a: Rgb, b: Rgb, share: number): Rgb {
  const channel = (i: 0 | 1 | 2) => Math.round(a[i] + (b[i] - a[i]) * share);
  return [channel(0), channel(1), channel(2)];
}

/** The colour of a share of strength below 1. */
export function loadColour(scale: ScaleName, ratio: number): Rgb {
  const { stops } = SCALES[scale];
  const share = Math.round(Math.min(Math.max(ratio, 0), 1) * 100) / 100;
  const next = stops.findIndex(([at]) => at >= share);
  if (next <= 0) {
    return stops[0][1];
  }
  const [low, from] = stops[next - 1];
  const [high, to] = stops[next];
  return mix(from, to, (share - low) / (high - low));
}

/** The steps of a connection's load: up to which ratio each goes. Those beyond 1 break. */
export const LOAD_STEPS = [0.25, 0.5, 0.75, 1, 2, 5, Infinity] as const;
const STEPS_BELOW = 4;

/** The step of a load, from 1; what breaks is beyond 1, and nothing else. 0: it is not known. */
export function loadStep(ratio: number, isBroken: boolean): number {
  if (Number.isNaN(ratio)) {
    return 0;
  }
  const step = 1 + LOAD_STEPS.findIndex((most) => ratio <= most);
  return isBroken ? Math.max(step, STEPS_BELOW + 1) : Math.min(step, STEPS_BELOW);
}

/** By step, from the first on. */
export function stepColours(scale: ScaleName): Rgb[] {
  const below = Array.from({ length: STEPS_BELOW }, (_, i) => loadColour(scale, (i + 0.5) / STEPS_BELOW));
  return [...below, SCALES[scale].broken, ...SCALES[scale].worse];
}

export const brokenColour = (scale: ScaleName) => SCALES[scale].broken;

export function verdictColour(verdict: Verdict, scale: ScaleName): Rgb {
  switch (verdict) {
    case 'safe':
      return loadColour(scale, 0);
    case 'overload':
      return brokenColour(scale);
    case 'unstable':
      return UNSTABLE;
    case 'undecided':
      return UNKNOWN;
  }
}

export const css = ([red, green, blue]: Rgb) => `rgb(${red} ${green} ${blue})`;
export const hex = ([red, green, blue]: Rgb) => (red << 16) | (green << 8) | blue;
