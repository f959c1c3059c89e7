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

const version2 = (name: string, lattice: string, modules: Iterable<Cell>, more: object = {}) =>
  structure(name, modules, { version: 2, lattice, ...more });

/** What the paper calls the general case. */
const GENERAL: Example[] = [
  {
    name: 'catom_pyramid',
    title: 'A pyramid of catoms',
    text: 'Spheres with twelve neighbours, four on four; take one out below.',
    source: () =>
      version2(
        'catom_pyramid',
        'face-centred',
        cells([5, 5, 5], (x, y, z) => Math.min(x, y) >= z >> 1 && Math.max(x, y) < 5 - ((z + 1) >> 1)),
      ),
  },
  {
    name: 'disc_arch',
    title: 'An arch of discs',
    text: 'Catoms that stand in a plane; friction holds its feet apart, or does not.',
    source: () =>
      version2(
        'disc_arch',
        'hexagonal',
        cells([9, 1, 6], (x, _y, z) => (z > 3 && x > 1 && x < 7) || (z < 4 && ((x > 0 && x < 3) || (x > 5 && x < 8)))),
        { floor: { friction: 0.3 } },
      ),
  },
  {
    name: 'prism_wall',
    title: 'Prisms on a wall',
    text: 'A bracket of hexagonal prisms, bonded to a wall, with a weight at its end.',
    source: () =>
      version2('prism_wall', 'hexagonal-prism', cells([4, 2, 2], (x, y, z) => y + z === 0 || x === 0), {
        support_z: null,
        obstacles: [{ from: [-1, 0, -1], to: [-1, 2, 2], hold: 'bonded' }],
        loads: [{ cell: [3, 0, 0], force_n: [0, 0, -1] }],
      }),
  },
  {
    name: 'slope',
    title: 'On a slope',
    text: 'A tower on a ground of 15 degrees that holds by friction: make it steeper.',
    source: () =>
      version2('slope', 'cubic', [...cells([2, 2, 1]), [0, 0, 1], [0, 0, 2]], {
        floor: { friction: 0.5 },
        gravity_m_s2: [2.53901466, 0, -9.47573286],
      }),
  },
  {
    name: 'slot',
    title: 'Clamped in a slot',
    text: 'An arm that only leans on two obstacles, below and above its end.',
    source: () =>
      version2('slot', 'cubic', cells([5, 1, 1]), {
        support_z: null,
        obstacles: [{ cells: [[1, 0, -1], [0, 0, 1]] }],
      }),
  },
];

export const GALLERY: ExampleGroup[] = [
  ...TESTS.map(([prefix, title]) => ({
    title,
    examples: ['a', 'b', 'c'].map((stage) => scenario(`${prefix}_${stage}`)),
  })),
  { title: 'Other modules, other supports', examples: GENERAL },
  { title: 'More to try', examples: MADE },
];

/** The strong arm with nothing planned: it holds one more module at its sides, and breaks by one at its tip. */
export const FIRST_EXAMPLE: Example = {
  ...scenario('arm_breaks_b'),
  name: 'arm',
  source: () => JSON.stringify({ ...SCENARIOS.arm_breaks_b, name: 'arm', planned: undefined, known_answer: undefined }),
};
