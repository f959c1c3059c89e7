// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The puzzles: each has a solution, none is solved at its beginning, and none by what is not allowed.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, openPage, settled } from './browser.mjs';

let browser;
let page;
before(async () => {
  browser = await launch();
  page = await openPage(browser);
});
after(() => browser.close());

function line(a, b) {
  const count = Math.max(...a.map((value, k) => Math.abs(b[k] - value)));
  return Array.from({ length: count + 1 }, (_, i) => a.map((value, k) => value + Math.sign(b[k] - value) * i));
}
const below = (isKept) =>
  Array.from({ length: 50 }, (_, n) => [n % 5, Math.floor(n / 5) % 5, Math.floor(n / 25)]).filter(([x, y]) => !isKept(x, y));

/** By challenge: what is attached, one after the other, or taken away. */
const SOLUTIONS = {
  reach: { add: line([4, 1, 4], [5, 1, 4]) },
  stand: { add: [[1, 0, 0]] },
  prop: { add: line([7, 1, 2], [7, 1, 0]) },
  slope: { add: [[1, 0, 0]] },
  balance: { add: [1, -1, 2, -2, 3, -3, 4, -4].map((x) => [x, 0, 2]) },
  shelf: { add: [...line([1, 0, 0], [5, 0, 0]), ...line([0, 0, -1], [2, 0, -1])] },
  bridge: { add: line([1, 0, 3], [14, 0, 3]) },
  ease: { add: [[1, 0, 2], [14, 0, 2], ...line([1, 0, 3], [14, 0, 3])] },
  load: { add: line([4, 1, 4], [4, 1, 0]) },
  table: { remove: below((x, y) => (x === 0 && y === 0) || (x === 4 && y === 0) || (x === 2 && y === 4)) },
  mushroom: { remove: below((x, y) => x === 2 && y === 2) },
  catoms: { add: [...line([1, 0, 0], [5, 0, 0]), ...line([0, 0, 1], [1, 0, 1])] },
};

async function begin(id) {
  await page.click('#gallery-open');
  await page.click(`[data-challenge=${id}]`);
  await page.waitForSelector('#challenge:not([hidden])');
  await page.waitForFunction(
    (name) => document.getElementById('challenge-title').textContent.endsWith(globalThis.holdfast.bench.robot.name) && name,
    id,
  );
  await settled(page);
}

const isSolved = () => page.isVisible('#challenge-done');
const conditions = () => page.locator('#challenge-list li').allInnerTexts();

async function change(name, cells) {
  await page.evaluate(
    ([what, list]) => {
      const { bench } = globalThis.holdfast;
      bench.setTool('add');
      what === 'add' ? bench.use(list) : bench.remove(list);
    },
    [name, cells],
  );
  await settled(page);
}

async function solve(id) {
  const { add = [], remove = [] } = SOLUTIONS[id];
  for (const cell of add) {
    await change('add', [cell]);
  }
  if (remove.length > 0) {
    await change('remove', remove);
  }
}

test('there are twelve, and each has a solution', async () => {
  await page.click('#gallery-open');
  const all = await page.locator('[data-challenge]').evaluateAll((buttons) => buttons.map(({ dataset }) => dataset.challenge));
  await page.click('#gallery .close');
  assert.deepEqual(all, Object.keys(SOLUTIONS));
  assert.equal(all.length, 12);
});

for (const id of Object.keys(SOLUTIONS)) {
  test(`${id}: unsolved at first, solved by its solution, and by no help from outside`, async () => {
    await begin(id);
    assert.equal(await isSolved(), false, (await conditions()).join('; '));
    await solve(id);
    assert.equal(await isSolved(), true, (await conditions()).join('; '));
    const { count } = await page.evaluate(() => globalThis.holdfast.bench.robot);
    assert.ok((await page.innerText('#challenge-done')).includes(`${count} modules`));
    // Another material, less weight, a fixed module.
    for (const cheat of [
      () => {
        const { bench } = globalThis.holdfast;
        bench.surround('stronger', bench.robot.surroundings, { material: bench.robot.material.map((value) => 1.01 * value) });
      },
      () => {
        const { bench } = globalThis.holdfast;
        bench.surround('lighter', { ...bench.robot.surroundings, gravity_m_s2: [0, 0, -1] });
      },
      () => {
        const { bench } = globalThis.holdfast;
        bench.setRole(2);
        bench.setTool('paint');
        bench.use([bench.robot.cellAt(0)]);
        bench.setRole(0);
      },
    ]) {
      await page.evaluate(cheat);
      await settled(page);
      assert.equal(await isSolved(), false, (await conditions()).join('; '));
      await page.evaluate(() => globalThis.holdfast.bench.history.undo());
      await settled(page);
      assert.equal(await isSolved(), true);
    }
  });
}

test('too many modules, or one taken away, do not count', async () => {
  await begin('stand');
  await change('add', [[1, 0, 0], [2, 0, 0]]);
  assert.equal(await isSolved(), false);
  await page.click('#challenge-again');
  await page.waitForFunction(() => globalThis.holdfast.bench.robot.count === 6);
  await settled(page);
  await change('remove', [[2, 0, 3], [1, 0, 3]]);
  assert.equal(await isSolved(), false, 'it stands, but not as it was');
});

test('what fell on the way has to be begun again', async () => {
  await begin('balance');
  for (const x of [1, 2, 3, 4, -1, -2, -3, -4]) {
    await change('add', [[x, 0, 2]]);
  }
  assert.equal(await page.getAttribute('#verdict', 'data-verdict'), 'safe');
  assert.equal(await isSolved(), false);
});

test('another robot ends it, and what was solved keeps its tick', async () => {
  await begin('stand');
  await solve('stand');
  await page.click('#challenge-next');
  await page.waitForFunction(() => document.getElementById('challenge-title').textContent.includes('3 of 12'));
  await page.click('#new');
  await page.waitForSelector('#challenge', { state: 'hidden' });
  await page.click('#gallery-open');
  assert.equal(await page.getAttribute('[data-challenge=stand]', 'class'), 'met');
  await page.click('#gallery .close');
  assert.deepEqual(page.faults, []);
});
