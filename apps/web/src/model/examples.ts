// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import SCENARIOS from 'virtual:scenarios';
import type { Cell } from './cell';

/** What the gallery offers: the paper's tests in their stages, and shapes that are made here. */

export interface Example {
  name: string;
  title: string;
  text: string;
  /** A smaller one for the picture of one that is large. */
  sketch?(): string;
  /** The text of a structure file. */
  source(): string;
}

export interface ExampleGroup {
  title: string;
  examples: Example[];
}

interface ScenarioFile {
  name: string;
  description: string;
}

const STAGES: Record<string, string> = {
  a: 'a first step is planned',
  b: 'a second step is planned',
  c: 'the second step is done',
};

const TESTS: [prefix: string, title: string][] = [
  ['arm_tips', 'Test 1, an arm'],
  ['bush_tips', 'Test 2, a bush'],
  ['crane_tips', 'Test 2, a crane'],
  ['scary_tips', 'Test 3, a scary one'],
  ['arm_breaks', 'Test 4, a strong arm'],
  ['crane_breaks', 'Test 5, a crane'],
  ['angle_breaks', 'Test 6, an angle'],
];

function scenario(name: string): Example {
  const file = SCENARIOS[name] as ScenarioFile;
  const stage = name.slice(-1);
  return { name, title: stage, text: STAGES[stage], source: () => JSON.stringify(file) };
}

function structure(name: string, modules: Iterable<Cell>, more: object = {}): string {
  const file = { format: 'holdfast-structure', version: 1, name, modules: [...modules], ...more };
  return JSON.stringify(file);
}

function* cells(
  size: Cell,
  isThere: (x: number, y: number, z: number) => boolean = () => true,
): Generator<Cell> {
  for (let z = 0; z < size[2]; ++z) {
    for (let y = 0; y < size[1]; ++y) {
      for (let x = 0; x < size[0]; ++x) {
        if (isThere(x, y, z)) {
          yield [x, y, z];
        }
      }
    }
  }
}

/** A lattice of struts, `step` cells apart. */
const isStrut = (step: number) => (x: number, y: number, z: number) =>
  [x, y, z].filter((value) => value % step === 0).length >= 2;

const MADE: Example[] = [
  {
    name: 'fixed_arm',
    title: 'How long may an arm be?',
    text: 'One fixed module, seven in a row; plan one more at the tip, and another.',
    source: () =>
      structure('fixed_arm', [], {
        modules: [{ cell: [0, 0, 3], fixed: true }, ...[1, 2, 3, 4, 5, 6].map((x) => [x, 0, 3])],
        planned: [[7, 0, 3]],
      }),
  },
  {
    name: 'portal',
    title: 'A portal',
    text: 'Two posts and a beam: it carries itself, how much more?',
    source: () =>
      structure('portal', cells([9, 1, 5], (x, _y, z) => x < 1 || x > 7 || z > 3), {
        planned: [[4, 0, 5]],
      }),
  },
  {
    name: 'tree',
    title: 'A tree',
    text: 'Branches all around a trunk: lop some off and it leans.',
    source: () =>
      structure(
        'tree',
        cells([9, 9, 7], (x, y, z) => {
          const onTrunk = x === 4 && y === 4;
          const onFoot = z === 0 && Math.abs(x - 4) + Math.abs(y - 4) < 2;
          const onBranch = (z === 3 && y === 4 && x > 1 && x < 7) || (z === 5 && x === 4 && y > 2 && y < 6);
          return onTrunk || onFoot || onBranch;
        }),
      ),
  },
  {
    name: 'scaffold',
    title: 'A scaffold, 840 modules',
    text: 'A lattice of struts, solved again at every click.',
    source: () => structure('scaffold', cells([16, 16, 10], isStrut(3))),
  },
  {
    name: 'slab_50000',
    title: 'A slab, 50,000 modules',
    text: 'To see how the page turns a large robot.',
    sketch: () => structure('slab', cells([24, 15, 1])),
    source: () => structure('slab_50000', cells([200, 125, 2])),
  },
];

export const GALLERY: ExampleGroup[] = [
  ...TESTS.map(([prefix, title]) => ({
    title,
    examples: ['a', 'b', 'c'].map((stage) => scenario(`${prefix}_${stage}`)),
  })),
  { title: 'More to try', examples: MADE },
];

export const FIRST_EXAMPLE = scenario('arm_breaks_b');
