// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { recall, remember } from '../model/settings';
import { UNKNOWN, brokenColour, hex, loadColour, mix, stepColours, verdictColour, type Rgb } from '../view/colours';
import type { Ground } from '../view/ground';
import type { RobotView } from '../view/robot_view';

/** Light or dark: as the reader's system prefers, or as chosen here. The style sheet has both. */

const DARK = matchMedia('(prefers-color-scheme: dark)');
const THEMES = ['system', 'light', 'dark'] as const;

let theme: (typeof THEMES)[number] = recall('theme', THEMES);

export const isDark = () => (theme === 'system' ? DARK.matches : theme === 'dark');

/** Rules for the dark that hold always, never, or by the system. */
const MEDIA = { system: `screen and ${DARK.media}`, light: 'not all', dark: 'screen' };

let darkRules: CSSMediaRule[] | undefined;

function applyTheme(): void {
  darkRules ??= [...document.styleSheets]
    .flatMap((sheet) => [...sheet.cssRules])
    .filter((rule) => rule instanceof CSSMediaRule && rule.media.mediaText === MEDIA.system) as CSSMediaRule[];
  darkRules.forEach((rule) => (rule.media.mediaText = MEDIA[theme]));
  document.documentElement.style.colorScheme = theme === 'system' ? '' : theme;
}

/** The choice of a theme; what is drawn, not styled, follows it. */
export function chooseTheme(select: HTMLSelectElement): void {
  select.value = theme;
  select.onchange = () => {
    theme = select.value as typeof theme;
    remember('theme', theme);
    applyTheme();
    followers.forEach((follow) => follow());
  };
}

const followers: (() => void)[] = [];

/** Draws something in light, whatever the theme is. */
export function inLight(draw: () => void): void {
  const chosen = theme;
  const put = (one: typeof theme) => {
    theme = one;
    applyTheme();
    followers.forEach((follow) => follow());
  };
  put('light');
  draw();
  put(chosen);
}

/** Calls `follow` whenever it becomes light or dark. */
export function followTheme(follow: () => void): void {
  DARK.addEventListener('change', follow);
  followers.push(follow);
}

export function setTheme(view: RobotView, ground: Ground, drawn: readonly { setInk(ink: number): void }[]): void {
  const dark = isDark();
  const ink: Rgb = dark ? [236, 238, 240] : [28, 32, 38];
  const { scale } = view;
  const codes = [
    loadColour(scale, 0),
    brokenColour(scale),
    verdictColour('unstable', scale),
    UNKNOWN,
    mix(UNKNOWN, dark ? [0, 0, 0] : [255, 255, 255], 0.6),
  ];
  view.setTheme(ink, codes, stepColours(scale));
  drawn.forEach((one) => one.setInk(hex(ink)));
  ground.colours = {
    ink: dark ? [0.62, 0.66, 0.7] : [0.36, 0.41, 0.46],
    polygon: dark ? 0x2f6178 : 0x9cc3d1,
    outline: dark ? 0x7fb4c9 : 0x3f6b7d,
    mass: hex(ink),
    warn: dark ? 0xd08be8 : 0x8e3fb2,
  };
}

applyTheme();
