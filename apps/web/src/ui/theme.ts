// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { UNKNOWN, brokenColour, hex, loadColour, mix, stepColours, verdictColour, type Rgb } from '../view/colours';
import type { Ground } from '../view/ground';
import type { RobotView } from '../view/robot_view';

/** The colours of the picture, by what the reader's system prefers. */

const DARK = matchMedia('(prefers-color-scheme: dark)');

/** Calls `apply` at once, and whenever the preference changes. */
export function followTheme(apply: () => void): void {
  DARK.addEventListener('change', apply);
  apply();
}

export function setTheme(view: RobotView, ground: Ground, drawn: readonly { setInk(ink: number): void }[]): void {
  const isDark = DARK.matches;
  const ink: Rgb = isDark ? [236, 238, 240] : [28, 32, 38];
  const { scale } = view;
  const codes = [
    loadColour(scale, 0),
    brokenColour(scale),
    verdictColour('unstable', scale),
    UNKNOWN,
    mix(UNKNOWN, isDark ? [0, 0, 0] : [255, 255, 255], 0.6),
  ];
  view.setTheme(ink, codes, stepColours(scale));
  drawn.forEach((one) => one.setInk(hex(ink)));
  ground.colours = {
    ink: isDark ? [0.62, 0.66, 0.7] : [0.36, 0.41, 0.46],
    polygon: isDark ? 0x2f6178 : 0x9cc3d1,
    outline: isDark ? 0x7fb4c9 : 0x3f6b7d,
    mass: hex(ink),
    warn: isDark ? 0xd08be8 : 0x8e3fb2,
  };
}
