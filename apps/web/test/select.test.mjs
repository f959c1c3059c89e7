// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Selecting modules, and what is done with all of them at once.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { cube, dropFile, facePoint, launch, message, openExample, openPage, settled, verdict } from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const FRONT = [0, -1, 0];

/** Cells with their roles, loads and own masses, in an order that does not depend on slots. */
const structure = (page) =>
  page.evaluate(() => {
    const { robot } = globalThis.holdfast.bench;
    const modules = Array.from({ length: robot.count }, (_, i) => `${robot.cellAt(i)} ${robot.roleAt(i)}`);
    const { loads = [], modules: own = [] } = robot.surroundings;
    return [...modules, ...[...loads, ...own].map((one) => JSON.stringify(one, Object.keys(one).sort()))].sort();
  });

const chosen = (page) => page.evaluate(() => globalThis.holdfast.bench.selection.cells.map(String).sort());

const choose = (page, cells) =>
  page.evaluate((list) => {
    globalThis.holdfast.bench.setTool('select');
    globalThis.holdfast.bench.selection.set(list);
  }, cells);

const press = async (page, ...names) => {
  for (const name of names) {
    await page.click(`#select-${name}`);
    await settled(page);
  }
};

async function open(page, name, file) {
  const text = typeof file === 'string' ? file : JSON.stringify({ format: 'holdfast-structure', version: 2, name, ...file });
  await dropFile(page, `${name}.json`, text);
  await page.waitForFunction((title) => globalThis.holdfast.bench.robot.name === title, name);
  await settled(page);
}

test('a click selects one module, Shift one more, a drag a box, a click beside the robot nothing', async () => {
  const page = await openPage(browser);
  await open(page, 'cube_3', cube(3));
  await page.keyboard.press('g');
  const click = async (cell) => {
    const { x, y } = await facePoint(page, cell, FRONT);
    await page.mouse.click(x, y);
  };
  await click([0, 0, 0]);
  assert.deepEqual(await chosen(page), ['0,0,0']);
  await page.keyboard.down('Shift');
  await click([2, 0, 1]);
  await page.keyboard.up('Shift');
  assert.deepEqual(await chosen(page), ['0,0,0', '2,0,1']);
  await click([1, 0, 1]);
  assert.deepEqual(await chosen(page), ['1,0,1'], 'that one alone');
  const [from, to] = [await facePoint(page, [0, 0, 0], FRONT), await facePoint(page, [1, 0, 2], FRONT)];
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2);
  await page.mouse.move(to.x, to.y);
  await page.mouse.up();
  assert.deepEqual(await chosen(page), ['0,0,0', '0,0,1', '0,0,2', '1,0,0', '1,0,1', '1,0,2']);
  assert.equal(await page.innerText('#select-text'), '6 modules selected.');
  const frames = await page.evaluate(() => [...globalThis.holdfast.app.view.modules.patterns].filter((pattern) => pattern >= 16).length);
  assert.equal(frames, 6);
  await page.mouse.click(60, 320);
  assert.deepEqual(await chosen(page), []);
  assert.equal(await page.evaluate(() => globalThis.holdfast.bench.history.canUndo), true, 'only that the file was opened');
  assert.equal((await structure(page)).length, 27);
  assert.deepEqual(page.faults, []);
});

test('box, layer, connected and all are what they say', async () => {
  const page = await openPage(browser);
  const row = [0, 1, 2, 3].map((x) => ({ cell: [x, 0, 0], fixed: x > 1 }));
  const modules = [...row, ...[0, 1, 2].map((z) => ({ cell: [0, 1, z] })), { cell: [3, 0, 1], fixed: true }];
  await open(page, 'kinds', { modules });
  await choose(page, [[0, 1, 2]]);
  await press(page, 'connected');
  assert.deepEqual(await chosen(page), ['0,0,0', '0,1,0', '0,1,1', '0,1,2', '1,0,0'], 'existing ones, up to the fixed ones');
  await choose(page, [[0, 1, 1]]);
  await press(page, 'layer');
  assert.deepEqual(await chosen(page), ['0,1,1', '3,0,1']);
  await press(page, 'box');
  assert.deepEqual(await chosen(page), ['0,1,1', '3,0,1'], 'nothing else is between them');
  await choose(page, [[0, 0, 0], [3, 0, 1]]);
  await press(page, 'box');
  assert.deepEqual(await chosen(page), ['0,0,0', '1,0,0', '2,0,0', '3,0,0', '3,0,1']);
  await press(page, 'none');
  assert.deepEqual(await chosen(page), []);
  assert.ok(await page.isDisabled('#select-move'));
  await page.focus('#canvas');
  await page.keyboard.press('Control+a');
  assert.equal((await chosen(page)).length, 8);
  await page.keyboard.press('Escape');
  assert.deepEqual(await chosen(page), []);
  assert.deepEqual(page.faults, []);
});

const LATTICES = [
  ['cubic', 4, [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 1, 1]]],
  ['face-centred', 4, [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 1, 1]]],
  ['hexagonal-prism', 6, [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 1, 1]]],
  ['hexagonal', 6, [[5, 0, 9], [6, 0, 9], [7, 0, 9], [7, 0, 10]]],
];

for (const [lattice, turns, cells] of LATTICES) {
  test(`${lattice}: what is turned all around, mirrored twice, moved there and back is as before`, async () => {
    const page = await openPage(browser);
    // Something of its own on the last one, and a role of its own on the second.
    const modules = cells.map((cell, i) => ({ cell, ...(i === 1 ? { fixed: true } : {}), ...(i === cells.length - 1 ? { mass_kg: 0.2 } : {}) }));
    await open(page, 'own', { lattice, modules, loads: [{ cell: cells.at(-1), force_n: [0.1, 0, 0] }] });
    const before = await structure(page);
    await choose(page, cells);
    const seen = new Set();
    for (let i = 0; i < turns; ++i) {
      seen.add(String(await structure(page)));
      await press(page, 'turn');
      assert.equal((await structure(page)).length, before.length);
    }
    assert.equal(seen.size, turns, 'each turn is another one');
    assert.deepEqual(await structure(page), before);
    for (const mirror of ['mirror-x', 'mirror-y']) {
      await press(page, mirror, mirror);
      assert.deepEqual(await structure(page), before);
    }
    const count = await page.evaluate(() => document.getElementById('select-direction').options.length);
    for (let direction = 0; direction < count; direction += 2) {
      for (const way of [direction + 1, direction]) {
        // Down there is the floor, of discs and of what stands on it: back is up.
        await page.selectOption('#select-direction', String(way ^ (lattice === 'hexagonal' ? 0 : 1)));
        await press(page, 'move');
      }
      assert.deepEqual(await structure(page), before, `direction ${direction}`);
    }
    while (await page.evaluate(() => globalThis.holdfast.bench.history.canUndo && globalThis.holdfast.bench.robot.name === 'own' && Boolean(globalThis.holdfast.bench.history.undo()))) {
      await settled(page);
      if ((await page.evaluate(() => globalThis.holdfast.bench.robot.name)) === 'own') {
        assert.equal((await structure(page)).length, before.length);
      }
    }
    assert.deepEqual(page.faults, []);
  });
}

test('a robot that is turned or mirrored as a whole has the same answer', async () => {
  const page = await openPage(browser);
  const answer = () => page.evaluate(() => {
    const { verdict: word, load_ratio_max: ratio, stability } = globalThis.holdfast.app.finding.answer;
    return [word, ratio.toFixed(9), stability.margin_mm.toFixed(6)];
  });
  for (const example of ['arm_breaks_a', 'bush_tips_a']) {
    await openExample(page, example);
    const first = await answer();
    await page.keyboard.press('g');
    await press(page, 'all');
    for (const deed of ['turn', 'mirror-x', 'turn', 'mirror-y']) {
      await press(page, deed);
      assert.deepEqual(await answer(), first, `${example}, ${deed}`);
    }
  }
  assert.deepEqual(page.faults, []);
});

test('a copy stands beside what it is a copy of, and takes its loads along', async () => {
  const page = await openPage(browser);
  await open(page, 'row', {
    modules: [[0, 0, 0], { cell: [1, 0, 0], mass_kg: 0.1 }, [0, 0, 1]], loads: [{ cell: [0, 0, 1], force_n: [0, 0, -1] }],
  });
  await choose(page, [[0, 0, 0], [1, 0, 0], [0, 0, 1]]);
  await page.selectOption('#select-direction', { label: '+x' });
  await press(page, 'copy');
  const expected = [
    '0,0,0 0', '0,0,1 0', '1,0,0 0', '2,0,0 0', '2,0,1 0', '3,0,0 0',
    '{"cell":[0,0,1],"force_n":[0,0,-1],"torque_nmm":[0,0,0]}', '{"cell":[1,0,0],"mass_kg":0.1}',
    '{"cell":[2,0,1],"force_n":[0,0,-1],"torque_nmm":[0,0,0]}', '{"cell":[3,0,0],"mass_kg":0.1}',
  ];
  assert.deepEqual(await structure(page), expected.sort());
  assert.deepEqual(await chosen(page), ['2,0,0', '2,0,1', '3,0,0'], 'the copy is selected');
  await press(page, 'remove');
  assert.equal((await structure(page)).length, 5, 'with its loads');
  await page.click('#undo');
  await settled(page);
  assert.deepEqual(await structure(page), expected);
  assert.deepEqual(page.faults, []);
});

test('where there is no room nothing is moved, and the page says where', async () => {
  const page = await openPage(browser);
  await open(page, 'corner', { modules: [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 0, 1]], obstacles: [{ cells: [[0, 0, 3]] }] });
  const before = await structure(page);
  const steps = await page.evaluate(() => globalThis.holdfast.bench.history.done.length);
  const cases = [[[[0, 0, 1]], '−z', '(0,0,0)'], [[[0, 0, 0]], '−z', '(0,0,-1)'], [[[0, 0, 0], [1, 0, 0]], '+x', '(2,0,0)']];
  for (const [cells, side, where] of cases) {
    await choose(page, cells);
    await page.selectOption('#select-direction', { label: side });
    await press(page, 'move');
    assert.equal(await message(page), `There is no room at ${where}.`);
    assert.deepEqual(await structure(page), before);
    assert.deepEqual(await chosen(page), cells.map(String).sort());
    await page.click('.message .close');
  }
  await choose(page, [[0, 0, 1]]);
  await page.selectOption('#select-direction', { label: '+z' });
  await press(page, 'move', 'move');
  assert.equal(await message(page), 'There is no room at (0,0,3).', 'an obstacle is there');
  assert.equal(await page.evaluate(() => globalThis.holdfast.bench.history.done.length), steps + 1);
  assert.deepEqual(page.faults, []);
});

test('what is selected is painted, loaded, filled and removed as one', async () => {
  const page = await openPage(browser);
  await open(page, 'frame', { modules: [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2], [2, 0, 2]] });
  await choose(page, [[0, 0, 0], [2, 0, 2]]);
  await press(page, 'fill');
  assert.equal((await structure(page)).length, 9);
  assert.equal((await chosen(page)).length, 9);
  await page.click('#roles button >> text=Planned');
  await settled(page);
  assert.ok((await structure(page)).every((one) => one.endsWith(' 1')));
  await page.evaluate(() => globalThis.holdfast.bench.setBurden({ force: [0, 0, -1], torque: [0, 0, 0] }));
  await page.keyboard.press('g');
  await press(page, 'load');
  assert.equal((await structure(page)).filter((one) => one.includes('force_n')).length, 9);
  await page.focus('#canvas');
  await page.keyboard.press('Delete');
  await settled(page);
  assert.equal(await verdict(page), 'none');
  assert.deepEqual(await chosen(page), []);
  for (let i = 0; i < 4; ++i) {
    await page.keyboard.press('Control+z');
    await settled(page);
  }
  assert.equal((await structure(page)).length, 7);
  await open(page, 'far', { modules: [[0, 0, 0], [1, 0, 0], [99, 99, 99]].concat(Array.from({ length: 99 }, (_, z) => [0, 0, z + 1])) });
  await choose(page, [[0, 0, 0], [99, 99, 99]]);
  await page.click('#select-fill');
  assert.equal(await message(page), 'There are 1000000 cells between these modules; at most 10000 are filled at once.');
  assert.deepEqual(page.faults, []);
});

test('undo and redo bring back what was selected', async () => {
  const page = await openPage(browser);
  await open(page, 'row', { modules: [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 0, 1]] });
  await choose(page, [[2, 0, 0], [2, 0, 1]]);
  await page.selectOption('#select-direction', { label: '+y' });
  await press(page, 'copy', 'remove');
  assert.deepEqual(await chosen(page), []);
  const frames = () => page.evaluate(() => [...globalThis.holdfast.app.view.modules.patterns].filter((pattern) => pattern >= 16).length);
  const undo = async (key) => {
    await page.focus('#canvas');
    await page.keyboard.press(key);
    await settled(page);
    return chosen(page);
  };
  assert.deepEqual(await undo('Control+z'), ['2,1,0', '2,1,1'], 'the copy, which was removed');
  assert.equal(await frames(), 2);
  assert.deepEqual(await undo('Control+z'), ['2,0,0', '2,0,1']);
  assert.deepEqual(await undo('Control+y'), ['2,1,0', '2,1,1']);
  assert.deepEqual(await undo('Control+y'), []);
  assert.deepEqual(page.faults, []);
});

const together = (page) =>
  page.evaluate(() => {
    const { open = [], connections = [], bodies = [] } = globalThis.holdfast.bench.robot.surroundings;
    return { open, connections: connections.map(({ between }) => between), bodies };
  });

test('pairs and bodies go with modules that are moved, copied, turned and removed', async () => {
  const page = await openPage(browser);
  const base = [0, 1, 2, 3].map((x) => ({ cell: [x, 0, 0], fixed: true }));
  const tower = [[0, 0, 1], [1, 0, 1], [0, 0, 2], [1, 0, 2]];
  const between = [[0, 0, 1], [0, 0, 2]];
  await open(page, 'pairs', { modules: [...base, ...tower], open: [[[0, 0, 1], [1, 0, 1]]],
    connections: [{ between, strength_n: 6 }], bodies: [[[0, 0, 2], [1, 0, 2]]] });
  const first = await together(page);
  const word = await verdict(page);
  await choose(page, tower);
  await page.selectOption('#select-direction', { label: '+x' });
  await press(page, 'copy');
  const both = await together(page);
  assert.deepEqual([both.open.length, both.connections.length, both.bodies.length], [2, 2, 2]);
  assert.ok(['safe', 'overload', 'instability'].includes(await verdict(page)), await verdict(page));
  await press(page, 'remove');
  assert.deepEqual(await together(page), first);
  assert.equal(await verdict(page), word);
  await choose(page, tower);
  await press(page, 'move', 'move');
  assert.deepEqual((await together(page)).open.map((pair) => pair.map(String).sort()), [['2,0,1', '3,0,1']]);
  assert.equal(await verdict(page), word, 'the same tower on other modules that are fixed');
  await press(page, 'turn', 'turn', 'turn', 'turn');
  assert.equal(await verdict(page), word);
  await choose(page, [[2, 0, 2]]);
  await press(page, 'remove');
  assert.deepEqual({ ...(await together(page)), open: 1 }, { open: 1, connections: [], bodies: [] });
  assert.notEqual(await verdict(page), 'none');
  assert.deepEqual(page.faults, []);
});

test('beside a stage nothing of the robot that is built is selected', async () => {
  const page = await openPage(browser);
  await openExample(page, 'arm_breaks_a');
  await page.keyboard.press('g');
  await press(page, 'all');
  await page.click('#order');
  await page.waitForFunction(() => globalThis.holdfast.app.mode === 'stage', undefined, { timeout: 60_000 });
  const frames = () => page.evaluate(() => globalThis.holdfast.app.view.drawn.reduce((sum, _, i) => sum + (globalThis.holdfast.app.view.modules.patterns[i] >= 16 ? 1 : 0), 0));
  assert.equal(await frames(), 0);
  assert.ok(await page.evaluate(() => document.getElementById('selecting').inert));
  await page.click('#build-on');
  await settled(page);
  assert.ok((await frames()) > 0);
  assert.deepEqual(page.faults, []);
});

test('where a file lists what is joined, a module that is attached is joined as its ghost was, and goes without a trace', async () => {
  const page = await openPage(browser);
  const pairs = [[[0, 0, 0], [0, 0, 1]], [[0, 0, 1], [0, 0, 2]], [[0, 0, 2], [1, 0, 2]], [[1, 0, 2], [1, 0, 1]]];
  const file = {
    joined: 'listed', modules: [{ cell: [0, 0, 0], fixed: true }, [0, 0, 1], [0, 0, 2], [1, 0, 2], [1, 0, 1]],
    connections: pairs.map((between) => ({ between })),
  };
  await open(page, 'listed', file);
  const listed = () => page.evaluate(() => globalThis.holdfast.bench.robot.surroundings.connections);
  const first = await listed();
  // Above the corner, and then in a row and a half beside it: 1 and 2 neighbours that are there.
  for (const cells of [[[1, 0, 3]], [[0, 0, 3]], [[2, 0, 3], [2, 0, 2]]]) {
    const ratio = await page.evaluate(async (list) => {
      const { app, bench } = globalThis.holdfast;
      const trials = await app.whereNext.places.client.tryPlaces(bench.robot.toData().data, Int32Array.from(list.flat()), 0);
      bench.edit('attach', list, 0);
      return list.length === 1 ? trials[0].ratio : undefined;
    }, cells);
    await settled(page);
    const { found, pieces } = await page.evaluate(() => {
      const { answer } = globalThis.holdfast.app.finding;
      return { found: answer.load_ratio_max, pieces: answer.pieces?.length ?? 0 };
    });
    assert.equal(pieces, 0);
    assert.ok(cells.length > 1 || Math.abs(ratio - found) < 1e-9, `${ratio} ${found}`);
  }
  const keys = (await listed()).map(({ between }) => between.map(String).sort().join(' ')).sort();
  const expected = [...pairs, [[1, 0, 2], [1, 0, 3]], [[0, 0, 2], [0, 0, 3]], [[0, 0, 3], [1, 0, 3]], [[1, 0, 3], [2, 0, 3]], [[2, 0, 2], [2, 0, 3]], [[1, 0, 2], [2, 0, 2]]];
  assert.deepEqual(keys, expected.map((pair) => pair.map(String).sort().join(' ')).sort());
  await page.evaluate(() => globalThis.holdfast.bench.edit('remove', [[1, 0, 3], [0, 0, 3], [2, 0, 3], [2, 0, 2]], undefined));
  assert.deepEqual(await listed(), first);
  assert.deepEqual(page.faults, []);
});
