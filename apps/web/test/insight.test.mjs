// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What one sees at a glance and finds out by asking: the verdict over the picture, numbers at the pointer, loads on
// connections, why it breaks and what would help, the deformed shape, how sure it is, what a loss would do. Numbers
// are compared with those of the program, or with what follows from the cells.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import {
  clickFace, dropFile, facePoint, launch, nativeReports, openExample, openPage, pixels, program, scenario, settled, temporaryFolder, verdict,
} from './browser.mjs';

const UP = [0, 0, 1];
const RIGHT = [1, 0, 0];
const DESKTOP = { width: 1280, height: 800 };

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

/** A report of the program with more than its check says. */
function ask(file, ...options) {
  try {
    return JSON.parse(execFileSync(program, ['check', '--quiet', '--json', '-', ...options, file], { encoding: 'utf8' }));
  } catch (error) {
    return JSON.parse(error.stdout);
  }
}

const numbers = (page) => page.innerText('#chip-numbers');
const fileOf = (name) => (existsSync(scenario(name)) ? scenario(name) : scenario(`general/${name}`));
const native = (name) => nativeReports([fileOf(name)])[0];
const keyOf = (a, b) => [String(a), String(b)].sort().join(' ');

for (const [name, options] of [
  ['desktop', { viewport: DESKTOP }],
  ['phone', { viewport: { width: 390, height: 780 }, hasTouch: true }],
]) {
  test(`the verdict and its numbers stay in sight: ${name}`, async () => {
    const page = await openPage(browser, options);
    await page.evaluate(() => document.querySelector('aside').scrollTo(0, 1e6));
    const { box, width, height, covered } = await page.evaluate(() => {
      const rect = document.getElementById('verdict').getBoundingClientRect();
      const hit = document.elementFromPoint(rect.left + rect.width / 2, rect.top + rect.height / 2);
      return {
        box: [rect.left, rect.top, rect.right, rect.bottom], width: innerWidth, height: innerHeight,
        covered: !document.getElementById('verdict').contains(hit),
      };
    });
    assert.ok(box[0] >= 0 && box[1] >= 0 && box[2] <= width && box[3] <= height && !covered, JSON.stringify({ box, covered }));
    // arm_breaks_b of the paper: 1.2004 at one of 14 connections.
    assert.match(await numbers(page), /^load 1\.20 · margin 10\.8 mm · 1 of 14 break$/);
  });
}

test('the gauge ends beyond its 1 exactly where something breaks, and its tick is where the click leads', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  const gauge = () =>
    page.evaluate(() => {
      const one = (name) => document.querySelector(`#gauge .${name}`);
      const ghost = /translate\(([\d.]+)/.exec(one('ghost').getAttribute('transform'));
      return { fill: Number(one('fill').getAttribute('width')), ghost: one('ghost').hasAttribute('hidden') ? undefined : Number(ghost[1]) };
    });
  const one = 108;
  assert.ok((await gauge()).fill > one);
  await openExample(page, 'arm_breaks_a');
  const { fill, ghost } = await gauge();
  const { overload } = native('arm_breaks_a');
  assert.ok(Math.abs(fill - one * overload.load_ratio_max) < 0.5, 'up to 1 it is a share of the strength');
  assert.equal(ghost, undefined);
  await page.click('#fit');
  // Beside the planned module at the tip only another planned one can be.
  await page.keyboard.press('2');
  const tip = await page.evaluate(() => {
    const { robot } = globalThis.holdfast.bench;
    return Array.from({ length: robot.count }, (_, i) => robot.cellAt(i)).sort((a, b) => b[0] - a[0])[0];
  });
  const { x, y } = await facePoint(page, tip, RIGHT);
  await page.mouse.move(x, y);
  await page.waitForFunction(() => document.getElementById('chip-numbers').textContent.includes('→'));
  const said = /load ([\d.]+) → ([\d.]+)/.exec(await numbers(page));
  const tick = (await gauge()).ghost;
  assert.ok(Number(said[2]) > 1 ? tick > one : tick <= one);
  await clickFace(page, tip, RIGHT);
  await page.mouse.move(20, 400);
  assert.match(await numbers(page), new RegExp(`^load ${said[2].replace('.', '\\.')}`), 'the click gives what the ghost has said');
  assert.ok(Math.abs((await gauge()).fill - tick) < 0.5);
  assert.deepEqual(page.faults, []);
});

test('numbers with units stand at the pointer; a click keeps them, Escape and a click let them go', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  await page.keyboard.press('v');
  const seam = await facePoint(page, [2, 1, 2], [1, 0, 0.96]);
  await page.mouse.move(seam.x - 2, seam.y);
  const report = native('arm_breaks_b').connections.find(({ a, b }) => keyOf(a, b) === keyOf([2, 1, 2], [3, 1, 2]));
  const text = await page.innerText('#details tr.pointed');
  assert.ok(text.includes(report.load_ratio.toFixed(3)) && text.includes(`${report.bending_nmm.toFixed(0)} N mm`), text);
  const far = async () => {
    const box = await page.locator('#details').boundingBox();
    const [dx, dy] = [Math.max(box.x - seam.x, seam.x - box.x - box.width, 0), Math.max(box.y - seam.y, seam.y - box.y - box.height, 0)];
    return Math.hypot(dx, dy);
  };
  assert.ok((await far()) < 40, `${await far()} px from the pointer`);
  await page.mouse.click(seam.x - 2, seam.y);
  const kept = await page.innerText('#details');
  await page.mouse.move(60, 300);
  assert.equal(await page.innerText('#details'), kept);
  await page.keyboard.press('Escape');
  await page.mouse.move(61, 300);
  assert.ok(await page.isHidden('#details'));
  await page.mouse.click(seam.x - 2, seam.y);
  await page.mouse.click(60, 300);
  await page.mouse.move(61, 301);
  assert.ok(await page.isHidden('#details'), 'a click elsewhere lets go');
  assert.deepEqual(page.faults, []);
});

/** The step of each connection as both of its modules have it, by its ends. */
const seamsOf = (page) =>
  page.evaluate(() => {
    const { app } = globalThis.holdfast;
    const { view, robot } = app;
    const found = [];
    for (let slot = 0; slot < robot.count; ++slot) {
      const at = view.instances[slot];
      for (let side = 0; at >= 0 && side < robot.lattice.directionCount; ++side) {
        const step = Math.floor(view.modules.seams[2 * at + Math.floor(side / 6)] / 8 ** (side % 6)) % 8;
        const [a, b] = [robot.cellAt(slot), robot.lattice.neighbour(robot.cellAt(slot), side)];
        if (step > 0) {
          found.push([[String(a), String(b)].sort().join(' '), step]);
        }
      }
    }
    return found;
  });

/** By the bounds of the legend. */
const stepOf = ({ load_ratio: ratio }, isBroken) => {
  const step = 1 + [0.25, 0.5, 0.75, 1, 2, 5, Infinity].findIndex((most) => ratio <= most);
  return isBroken ? Math.max(step, 5) : Math.min(step, 4);
};

test('every connection has the step of the program’s load on both modules, in cubes, spheres and prisms', async () => {
  const page = await openPage(browser);
  for (const name of ['angle_breaks_b', 'arm_breaks_b', 'catoms_under_ceiling', 'prism_wall']) {
    await dropFile(page, `${name}.json`, readFileSync(fileOf(name), 'utf8'));
    await page.waitForFunction((title) => globalThis.holdfast.bench.robot.name === title, name);
    await settled(page);
    const { connections, overload } = native(name);
    const broken = new Set(overload.broken.map(([a, b]) => keyOf(a, b)));
    const expected = new Map(connections.map((one) => [keyOf(one.a, one.b), stepOf(one, broken.has(keyOf(one.a, one.b)))]));
    const seams = await seamsOf(page);
    assert.equal(seams.length, 2 * connections.length, `${name}: both ends`);
    for (const [key, step] of seams) {
      assert.equal(step, expected.get(key), `${name}: ${key}`);
    }
  }
  await openExample(page, 'arm_tips_b');
  assert.deepEqual(await seamsOf(page), [], 'of what topples no load is shown');
  assert.deepEqual(page.faults, []);
});

test('a connection that breaks is seen in the picture, in the colour of the legend', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  const spot = await facePoint(page, [2, 1, 2], [0.94, -1, -0.2]);
  const band = await pixels(page, { x: spot.x - 4, y: spot.y, width: 9, height: 1 });
  const isRed = ([r, g, b]) => r > 1.8 * g && r > 1.8 * b;
  assert.ok(band.some(isRed), `beside the connection: ${band.join(' ')}`);
  await page.selectOption('#subject', 'modules');
  await settled(page);
  const middle = await facePoint(page, [2, 1, 2], [0, -1, 0]);
  assert.ok((await pixels(page, { x: middle.x - 6, y: middle.y, width: 13, height: 1 })).some(isRed), 'as in the paper: the module');
  await page.selectOption('#subject', 'connections');
  await settled(page);
  const grey = (await pixels(page, { x: middle.x, y: middle.y, width: 1, height: 1 }))[0];
  assert.ok(Math.max(...grey) - Math.min(...grey) < 20, `${grey}`);
});

test('the table has the program’s loads in the order that is asked for, and its rows fly there', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  await openExample(page, 'angle_breaks_b');
  const { connections, overload } = native('angle_breaks_b');
  assert.equal(await page.innerText('#connections-count'), `${overload.broken.length} of ${connections.length} break`);
  await page.click('#connections summary');
  const column = (k) => page.$$eval(`#connections-table tbody tr > :nth-child(${k + 2})`, (all) => all.map((one) => one.textContent));
  const sorted = (value) => connections.map(value).sort((a, b) => b - a);
  const near = (shown, values, digits) =>
    shown.forEach((text, i) => assert.ok(Math.abs(Number(text) - values[i]) <= 0.51 * 10 ** -digits, `${i}: ${text}, expected ${values[i]}`));
  near(await column(0), sorted((one) => one.load_ratio), 3);
  await page.click('#connections thead >> text=Bending');
  near(await column(2), sorted((one) => one.bending_nmm), 0);
  assert.equal(await page.getAttribute('#connections thead th:nth-child(4)', 'aria-sort'), 'descending');
  await page.click('#connections thead >> text=Bending');
  near(await column(2), sorted((one) => one.bending_nmm).reverse(), 0);
  await page.click('#connections thead >> text=Load');
  const first = await page.innerText('#connections-table tbody tr:first-child th');
  await page.click('#connections-table tbody tr:first-child button');
  await settled(page);
  const [a, b] = [...first.matchAll(/\((-?\d+),(-?\d+),(-?\d+)\)/g)].map(([, ...cell]) => cell.map(Number));
  const target = await page.evaluate(() => globalThis.holdfast.app.stage.controls.target.toArray());
  target.forEach((value, k) => assert.ok(Math.abs(value - (a[k] + b[k]) / 2) < 1e-6, `${target} is the middle of ${first}`));
  assert.ok(await page.isVisible('#details.pinned tr.pointed'));
  await page.keyboard.press('Escape');
  await page.click('#fit');
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('w');
  await settled(page);
  assert.ok((await page.innerText('#details tr.pointed')).includes(overload.load_ratio_max.toFixed(3)), 'W goes to the worst');
  await page.keyboard.press('Escape');
  await page.click('#verdict');
  assert.ok((await page.innerText('#details tr.pointed')).includes(overload.load_ratio_max.toFixed(3)), 'and so does the verdict');
  assert.deepEqual(page.faults, []);
});

const whyText = async (page) => {
  await page.waitForFunction(() => document.querySelector('#why-list li'));
  return page.innerText('#why-text');
};

test('why it breaks: what the connection alone holds, how heavy, how far out', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  // arm_breaks_b without one of its connections: what is beyond it, by its cells alone.
  const text = await whyText(page);
  const { modules, planned } = JSON.parse(readFileSync(scenario('arm_breaks_b'), 'utf8'));
  const cellOf = (one) => one.cell ?? one;
  const beyond = [...modules, ...(planned ?? [])].map(cellOf).filter(([x, , z]) => x >= 3 && z === 2);
  const out = 40 * (beyond.reduce((sum, [x]) => sum + x, 0) / beyond.length - 2.5);
  const sideways = 40 * (beyond.reduce((sum, [, y]) => sum + y, 0) / beyond.length - 1);
  const { load_ratio_max: ratio } = native('arm_breaks_b').overload;
  const found = /^\(2,1,2\)-\(3,1,2\) alone holds (\d+) modules: ([\d.]+) kg, centre ([\d.]+) mm out\. They bend it with ([\d.]+) N mm.*; it holds (\d+) % of that\.$/.exec(text);
  assert.ok(found, text);
  assert.equal(Number(found[1]), beyond.length);
  const mass = 0.06106 * beyond.length;
  assert.ok(Math.abs(Number(found[2]) - mass) < 6e-4, `${found[2]} kg, expected ${mass}`);
  assert.ok(Math.abs(Number(found[3]) - Math.hypot(out, sideways)) < 0.06, `${found[3]} mm out, expected ${out}`);
  // Statics: weight times lever.
  assert.ok(Math.abs(Number(found[4]) - mass * 9.81 * out) < 0.06 * 10, `${found[4]} N mm, expected ${mass * 9.81 * out}`);
  assert.equal(Number(found[5]), Math.round(100 / ratio));
  assert.deepEqual(page.faults, []);
});

test('each change that is offered makes it hold, with the load that is promised; they are the program’s', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  for (const name of ['arm_breaks_b', 'arm_tips_b', 'angle_breaks_b']) {
    await openExample(page, name);
    await page.waitForFunction(() => document.querySelector('#why-list li'));
    const { remedies } = ask(scenario(name), '--remedies');
    const kinds = ['module', 'prop', 'fixing', 'removal'].filter((kind) => remedies[kind].safe.length > 0);
    assert.deepEqual(await page.$$eval('#why-list button', (all) => all.map((one) => one.dataset.remedy)), kinds, name);
    for (const kind of kinds) {
      await page.waitForSelector(`[data-remedy=${kind}]`);
      const [{ cell, load_ratio_max: promised }] = remedies[kind].safe;
      assert.ok((await page.innerText(`[data-remedy=${kind}]`)).includes(`(${cell.join(',')})`), `${name}, ${kind}`);
      await page.click(`[data-remedy=${kind}]`);
      await settled(page);
      assert.equal(await verdict(page), 'safe', `${name}, ${kind}`);
      const ratio = await page.evaluate(() => globalThis.holdfast.app.finding.answer.load_ratio_max);
      assert.ok(Math.abs(ratio - promised) <= 1e-9 * Math.max(1, promised), `${name}, ${kind}: ${ratio}, promised ${promised}`);
      assert.ok(await page.isHidden('#why'));
      await page.click('#undo');
      await settled(page);
      assert.notEqual(await verdict(page), 'safe');
    }
  }
  assert.deepEqual(page.faults, []);
});

test('a change is seen before it is made', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  await whyText(page);
  const ghosts = () => page.evaluate(() => [globalThis.holdfast.app.view.ghosts.mesh.geometry.instanceCount, globalThis.holdfast.app.view.cursor.visible]);
  await page.hover('[data-remedy=module]');
  assert.deepEqual(await ghosts(), [1, true]);
  await page.hover('[data-remedy=fixing]');
  assert.deepEqual(await ghosts(), [0, true]);
  await page.hover('#verdict-reason');
  assert.deepEqual(await ghosts(), [0, false]);
});

/** A file with gravity times a factor. */
function heavier(name, factor) {
  const text = JSON.parse(readFileSync(scenario(name), 'utf8'));
  const file = path.join(temporaryFolder(), `${name}.json`);
  writeFileSync(file, JSON.stringify({ ...text, material: { ...text.material, gravity_m_s2: 9.81 * factor } }));
  return file;
}

test('the deformed shape is the program’s, true to scale, at every factor of the loads', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  await openExample(page, 'arm_breaks_a');
  await page.click('#deform');
  const shown = (factor) =>
    page.waitForFunction((value) => {
      const { app } = globalThis.holdfast;
      return app.mode === 'deformed' && document.getElementById('deformed-text').textContent.length > 2 && document.getElementById('load-factor').value === String(value);
    }, Math.round(100 * factor));
  for (const factor of [1, 0.5, 1.3]) {
    await page.fill('#load-factor', String(Math.round(100 * factor)));
    await shown(factor);
    const { load_ratio_max: ratio } = ask(heavier('arm_breaks_a', factor), '--deformed').overload;
    const own = await page.evaluate(() => globalThis.holdfast.app.shown.answer.load_ratio_max);
    assert.ok(Math.abs(own - ratio) < 1e-9, `${factor}: ${own} on the page, ${ratio} by the program`);
    assert.equal(await page.evaluate(() => globalThis.holdfast.app.view.exaggeration), 1);
  }
  assert.ok(await page.locator('[data-built]').first().evaluate((part) => part.inert), 'nothing answers about the robot that is built');
  await page.keyboard.press('a');
  await page.click('#deform');
  assert.deepEqual(await page.evaluate(() => [globalThis.holdfast.app.mode, globalThis.holdfast.bench.closed, globalThis.holdfast.app.view.exaggeration]), ['build', '', 0]);
  assert.deepEqual(page.faults, []);
});

test('what breaks falls as the program says, round by round, and is put together again', async () => {
  const page = await openPage(browser, { viewport: DESKTOP, reducedMotion: 'no-preference' });
  await openExample(page, 'arm_breaks_b');
  assert.deepEqual(await page.evaluate(() => globalThis.holdfast.app.isToppled), false, 'of itself nothing breaks');
  assert.equal(await page.innerText('#topple'), 'Let it break');
  await page.click('#topple');
  await page.waitForFunction(() => globalThis.holdfast.app.isToppled);
  const { cascade } = ask(scenario('arm_breaks_b'), '--cascade');
  const shown = await page.evaluate(() => {
    const { pieces } = globalThis.holdfast.app.toppling;
    return { cascade: pieces.breaking.cascade, fallen: [...pieces.fallen(pieces.begun(100))].map((slot) => globalThis.holdfast.bench.robot.cellAt(slot)) };
  });
  assert.deepEqual(shown.cascade, cascade);
  assert.deepEqual(new Set(shown.fallen.map(String)), new Set(cascade.rounds.flatMap(({ fallen }) => fallen.map(String))));
  assert.match(await page.innerText('#breaking-text'), /breaks in 1 round; 6 of 13 modules fall/);
  await page.waitForFunction(() => globalThis.holdfast.app.toppling.playing.seconds >= globalThis.holdfast.app.toppling.pieces.seconds);
  // In the picture: what stands has not moved, what fell lies above the floor and lower than it was.
  const ways = await page.evaluate(() => {
    const { app: { view }, bench: { robot } } = globalThis.holdfast;
    return Array.from({ length: robot.count }, (_, slot) => {
      const at = view.instances[slot];
      return { cell: robot.cellAt(slot), z: robot.placeAt(slot)[2], way: [...view.modules.motions.slice(3 * at, 3 * at + 3)], factor: view.exaggeration };
    });
  });
  const standing = new Set(cascade.standing.map(String));
  for (const { cell, z, way, factor } of ways) {
    assert.equal(factor, 1);
    if (standing.has(String(cell))) {
      assert.deepEqual(way, [0, 0, 0], String(cell));
    } else {
      assert.ok(way[2] < -0.2 && z + way[2] > -0.02, `${cell}: ${way}`);
    }
  }
  // A click at the robot is no change of it, and stands it up.
  await page.click('#fall-again');
  await page.keyboard.press('t');
  assert.deepEqual(await page.evaluate(() => [globalThis.holdfast.app.isToppled, globalThis.holdfast.app.view.exaggeration, globalThis.holdfast.app.view.paintOver === undefined]), [false, 0, true]);
  assert.equal(await page.innerText('#topple'), 'Let it break');
  assert.deepEqual(page.faults, []);
});

test('one thing moves modules at a time: a fall, the shape under load, the collapse, the robot’s own computation', async () => {
  const page = await openPage(browser, { viewport: DESKTOP, reducedMotion: 'no-preference' });
  await openExample(page, 'arm_breaks_b');
  const state = () => page.evaluate(() => {
    const { app, player } = globalThis.holdfast;
    return { isToppled: app.isToppled, factor: app.view.exaggeration, isPlaying: player.trace !== undefined, hasPose: app.view.mechanism !== undefined };
  });
  const fall = async () => {
    await page.click('#topple');
    await page.waitForFunction(() => globalThis.holdfast.app.isToppled);
    const { factor, hasPose, isPlaying } = await state();
    assert.deepEqual([factor, hasPose, isPlaying], [1, true, false]);
  };
  await fall();
  await page.fill('#exaggeration', '50');
  assert.deepEqual([(await state()).isToppled, (await state()).hasPose], [false, false]);
  await fall();
  assert.equal(await page.inputValue('#exaggeration'), '0');
  await page.click('#simulate');
  await page.waitForFunction(() => globalThis.holdfast.player.trace !== undefined);
  assert.deepEqual(await state(), { isToppled: false, factor: 0, isPlaying: true, hasPose: false });
  await fall();
  await page.click('#find-limit');
  await page.waitForSelector('#collapse:not([hidden])');
  await page.click('#collapse');
  assert.equal((await state()).isToppled, false);
  assert.equal((await state()).hasPose, true);
  await fall();
  await page.click('#deform');
  await page.waitForFunction(() => globalThis.holdfast.app.mode === 'deformed');
  assert.deepEqual([(await state()).isToppled, (await state()).hasPose], [false, false]);
  assert.equal(await page.isVisible('#breaking'), false);
  assert.deepEqual(page.faults, []);
});

test('a robot that is changed while it falls is shown as it is', async () => {
  const page = await openPage(browser, { viewport: DESKTOP, reducedMotion: 'no-preference' });
  await openExample(page, 'arm_breaks_b');
  await page.click('#topple');
  await page.waitForFunction(() => globalThis.holdfast.app.isToppled);
  await page.evaluate(() => {
    const { bench } = globalThis.holdfast;
    bench.remove([bench.robot.cellAt(bench.robot.count - 1)]);
  });
  await settled(page);
  assert.deepEqual(await page.evaluate(() => [globalThis.holdfast.app.isToppled, globalThis.holdfast.app.view.exaggeration]), [false, 0]);
  await page.click('#new');
  await settled(page);
  assert.equal(await page.isVisible('#breaking'), false);
  assert.deepEqual(page.faults, []);
});

test('one thing is shown at a time: a stage ends the deformed shape', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  await page.click('#judge-steps');
  await page.waitForSelector('#sequence:not([hidden])');
  await page.click('#deform');
  await page.waitForFunction(() => globalThis.holdfast.app.mode === 'deformed');
  await page.click('#stage-on');
  assert.deepEqual(await page.evaluate(() => [globalThis.holdfast.app.mode, document.getElementById('deformed').hidden, globalThis.holdfast.app.view.exaggeration]), ['stage', true, 0]);
  await page.click('#deform');
  assert.equal(await page.evaluate(() => globalThis.holdfast.app.mode), 'stage', 'and says why not');
  await page.click('#build-on');
  assert.deepEqual(await page.evaluate(() => [globalThis.holdfast.app.mode, globalThis.holdfast.bench.closed]), ['build', '']);
  assert.deepEqual(page.faults, []);
});

test('before a module is taken away it is known what would be left, as the program says', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  await openExample(page, 'angle_breaks_b');
  await page.click('#tools button[aria-label=Remove]');
  const folder = temporaryFolder();
  const { modules, planned = [], ...rest } = JSON.parse(readFileSync(scenario('angle_breaks_b'), 'utf8'));
  const said = {};
  for (const cell of [...modules, ...planned]) {
    const shown = await page.evaluate(async (at) => {
      const { app } = globalThis.holdfast;
      app.whereNext.previewRemoval(at);
      for (let i = 0; i < 400 && !app.whereNext.trial; ++i) {
        await new Promise((done) => setTimeout(done, 5));
      }
      return { ...app.whereNext.trial, chip: document.getElementById('chip-numbers').textContent };
    }, cell);
    const without = (list) => list.filter((one) => String(one) !== String(cell));
    const file = path.join(folder, 'left.json');
    writeFileSync(file, JSON.stringify({ ...rest, modules: without(modules), planned: without(planned) }));
    const report = ask(file);
    said[shown.verdict] = (said[shown.verdict] ?? 0) + 1;
    assert.equal(shown.verdict, report.verdict ?? null, String(cell));
    assert.equal(shown.refusal !== undefined, report.verdict === undefined, shown.refusal);
    if (shown.verdict === 'safe' || shown.verdict === 'overload') {
      const { load_ratio_max: ratio } = report.overload;
      assert.ok(Math.abs(shown.ratio - ratio) <= 1e-9 * ratio, `${cell}: ${shown.ratio}, expected ${ratio}`);
      assert.match(shown.chip, /→|margin/);
    }
  }
  assert.ok(Object.keys(said).length > 1, JSON.stringify(said));
  // What is shown goes with the pointer, and with the tool.
  await page.click('#tools button[aria-label=Attach]');
  assert.equal(await page.evaluate(() => globalThis.holdfast.app.whereNext.trial), undefined);
  assert.deepEqual(page.faults, []);
});

test('how sure it is where strengths scatter is what the program says', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  for (const [name, scatter, common, mass] of [['arm_breaks_b', 10, 0, 0], ['arm_breaks_a', 30, 10, 0], ['arm_breaks_b', 10, 0, 20]]) {
    await openExample(page, name);
    await page.fill('#scatter', String(scatter));
    await page.fill('#scatter-common', String(common));
    await page.fill('#scatter-mass', String(mass));
    await page.waitForFunction(() => / p = /.test(document.getElementById('chip-numbers').textContent) && document.getElementById('sure-text').textContent !== '');
    const options = ['--scatter', `${scatter}%`, ...(common ? ['--scatter-common', `${common}%`] : []), ...(mass ? ['--scatter-mass', `${mass}%`] : [])];
    const { probability_holds: holds, probability_fails: fails } = ask(scenario(name), ...options).reliability;
    const [, word, shown] = /(holds|fails) with p = ([\d.e-]+)/.exec(await numbers(page));
    const expected = word === 'holds' ? holds : fails;
    assert.ok(Math.abs(Number(shown) - expected) <= 0.051 * expected, `${name}: ${shown}, expected ${expected}`);
  }
  await page.evaluate(() => globalThis.holdfast.bench.use([globalThis.holdfast.bench.robot.freePlaces()[0]]));
  await settled(page);
  await page.waitForFunction(() => / p = /.test(document.getElementById('chip-numbers').textContent), undefined, { timeout: 5000 });
  await page.fill('#scatter', '0');
  assert.doesNotMatch(await numbers(page), / p = /);
  assert.deepEqual(page.faults, []);
});

test('what the robot cannot do without is red: what the program’s losses say', async () => {
  const page = await openPage(browser, { viewport: DESKTOP });
  await openExample(page, 'arm_tips_a');
  await page.click('#lose');
  await page.waitForSelector('#lose[aria-pressed=true]');
  const { fatal } = ask(scenario('arm_tips_a'), '--lose-one').lose_one;
  const expected = {
    joints: fatal.filter(({ a }) => a).map(({ a, b }) => keyOf(a, b)).sort(),
    modules: fatal.filter(({ module }) => module).map(({ module }) => String(module)).sort(),
  };
  assert.ok(expected.joints.length > 2 && expected.modules.length > 2);
  const seams = await seamsOf(page);
  const red = [...new Set(seams.filter(([, step]) => step > 4).map(([key]) => key))].sort();
  const modules = await page.evaluate(() => [...globalThis.holdfast.app.view.losses.modules].map((slot) => String(globalThis.holdfast.bench.robot.cellAt(slot))).sort());
  assert.deepEqual({ joints: red, modules }, expected);
  await page.click('#undo', { force: true }).catch(() => undefined);
  await page.evaluate(() => globalThis.holdfast.bench.use([globalThis.holdfast.bench.robot.freePlaces()[0]]));
  await settled(page);
  assert.equal(await page.evaluate(() => globalThis.holdfast.app.view.losses), undefined, 'another robot has loads again');
  assert.deepEqual(page.faults, []);
});

test('Second order: the panel says what the program says', async () => {
  const page = await openPage(browser);
  const text = execFileSync(program, ['check', scenario('arm_breaks_a')], { encoding: 'utf8' });
  await openExample(page, 'arm_breaks_a');
  const own = await page.innerText('#figures');
  assert.ok(own.includes(/second order {2}(.*)/.exec(text)[1]), own);
});

test('keys alone: the cursor on a free cell says what would come of a module there', async () => {
  const page = await openPage(browser);
  await openExample(page, 'arm_tips_a');
  await page.focus('#canvas');
  await page.keyboard.press('2');
  const tip = await page.evaluate(() => {
    const { app, bench } = globalThis.holdfast;
    const cells = Array.from({ length: bench.robot.count }, (_, i) => bench.robot.cellAt(i)).sort((a, b) => b[0] - a[0]);
    app.moveCursor([cells[0][0] + 1, cells[0][1], cells[0][2]]);
    return cells[0];
  });
  await page.waitForFunction(() => /would topple/.test(document.getElementById('spoken').textContent));
  assert.match(await page.innerText('#details'), /would topple/);
  await page.keyboard.press('Enter');
  await settled(page);
  assert.equal(await verdict(page), 'unstable', `beyond ${tip}`);
});

// A tower of 60 cubes buckles: undecided where somebody states the elastic modulus, also that it is the default one.
for (const [what, material] of [['nobody states', {}], ['is stated to be the default', { elastic_modulus_mpa: 100 }], ['is stated', { elastic_modulus_mpa: 50 }]]) {
  test(`a tower whose elastic modulus ${what} is judged as by the program`, async () => {
    const page = await openPage(browser, { viewport: DESKTOP });
    const text = JSON.stringify({
      format: 'holdfast-structure', version: 2, material, modules: [{ from: [0, 0, 0], to: [0, 0, 59] }],
    });
    const file = path.join(temporaryFolder(), 'tower.json');
    writeFileSync(file, text);
    await dropFile(page, 'tower.json', text);
    await page.waitForFunction((source) => globalThis.holdfast.bench.robot.base === source, text);
    await settled(page);
    assert.equal(await verdict(page), ask(file).verdict);
    await page.close();
  });
}
