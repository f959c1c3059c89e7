// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Any module, any support, any load: lattices as tables, building with them, obstacles, slopes, loads.
// Expected values are those of statics.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import {
  clickFace, count, dropFile, figures, launch, message, newContext, openExample, openPage, pageFile, program, settled,
  temporaryFolder, verdict, scenario,
} from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const NAMES = ['cubic', 'face-centred', 'hexagonal', 'hexagonal-prism'];
const WEIGHT = 0.06106 * 9.81;

async function begin(page, lattice, cells = []) {
  await page.click('#new');
  await page.selectOption('#lattice', lattice);
  await page.evaluate((all) => {
    const { app, bench } = globalThis.holdfast;
    bench.edit('begin', all, 0);
    app.see();
  }, cells);
  await settled(page);
}

async function savedJson(page) {
  await page.click('#save');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('[data-save=json]')]);
  return JSON.parse(readFileSync(await download.path()));
}

async function open(page, name, file) {
  await dropFile(page, `${name}.json`, JSON.stringify({ format: 'holdfast-structure', version: 2, name, ...file }));
  await page.waitForFunction((title) => globalThis.holdfast.bench.robot.name === title, name);
  await settled(page);
}

const typeInto = async (page, label, text) => {
  const field = page.getByLabel(label).first();
  await field.fill(text);
  await field.press('Enter');
  return field;
};

const ghosts = (page) => page.evaluate(() => globalThis.holdfast.app.whereNext.previewed);
const cellsOf = (page) =>
  page.evaluate(() => {
    const { robot } = globalThis.holdfast.bench;
    return Array.from({ length: robot.count }, (_, slot) => robot.cellAt(slot));
  });
const surroundings = (page) => page.evaluate(() => globalThis.holdfast.bench.robot.surroundings);

/** Where a point beside a cell's node is in the window; in pitches. */
const pointBeside = (page, cell, offset) =>
  page.evaluate(
    ([at, by]) => {
      const { app: { stage }, bench: { robot } } = globalThis.holdfast;
      const place = robot.lattice.place(at).map((value, k) => value + by[k]);
      const { x, y } = stage.project(stage.controls.target.clone().fromArray(place));
      const box = stage.canvas.getBoundingClientRect();
      return { x: x + box.left, y: y + box.top };
    },
    [cell, offset],
  );

/** How far a module has moved so many seconds after the robot began to fall, mm, and its rotation vector. */
const fallAt = (page, seconds, slot = 0) =>
  page.evaluate(async ([at, of]) => {
    const { app, bench } = globalThis.holdfast;
    await app.toppling.start(bench.robot, app.finding);
    const motion = [...app.toppling.pieces.at(at).slice(6 * of, 6 * of + 6)];
    app.stopTopple();
    return motion;
  }, [seconds, slot]);

test('neighbours are one pitch apart, opposite directions lead back, nothing else is as near', async () => {
  const page = await openPage(browser);
  for (const [name, most] of [['cubic', 6], ['face-centred', 12], ['hexagonal', 6], ['hexagonal-prism', 8]]) {
    await begin(page, name);
    const found = await page.evaluate(() => {
      const { lattice } = globalThis.holdfast.bench.robot;
      const cells = [[0, 0, 0], [3, -2, 5], [-4, 1, -3], [7, 7, -8]];
      const distance = (a, b) => Math.hypot(...lattice.place(a).map((value, k) => value - lattice.place(b)[k]));
      const near = (cell) => {
        let there = 0;
        for (let x = -2; x <= 2; ++x) for (let y = -2; y <= 2; ++y) for (let z = -2; z <= 2; ++z) {
          const other = [cell[0] + x, cell[1] + y, cell[2] + z];
          there += Math.abs(distance(cell, other) - 1) < 1e-12 ? 1 : 0;
        }
        return there;
      };
      return cells.map((cell) => ({
        lengths: lattice.neighbours(cell).map((other) => distance(cell, other)),
        isBack: lattice.neighbours(cell).every((other, d) => String(lattice.neighbour(other, d ^ 1)) === String(cell)),
        near: near(cell),
        isNearest: String(lattice.cell(lattice.nearestAxial(lattice.place(cell).map((value) => value + 0.2)))) === String(cell),
      }));
    });
    for (const { lengths, isBack, near, isNearest } of found) {
      assert.equal(lengths.length, most, name);
      assert.ok(lengths.every((length) => Math.abs(length - 1) < 1e-12), `${name}: ${lengths}`);
      // Layers of discs are one pitch apart too, and do not touch.
      assert.equal(near, name === 'hexagonal' ? most + 2 : most, name);
      assert.ok(isBack && isNearest, name);
    }
  }
});

test('the pointer meets what a ray meets first, in every lattice', async () => {
  const page = await openPage(browser);
  const cells = [];
  for (let i = 0; i < 60; ++i) {
    cells.push([(i * 7) % 5, (i * 3) % 4, (i * 11) % 6]);
  }
  for (const name of ['cubic', 'face-centred', 'hexagonal-prism', 'hexagonal']) {
    await begin(page, name, cells);
    const wrong = await page.evaluate(() => {
      const { app, bench: { robot } } = globalThis.holdfast;
      const { canvas } = app.stage;
      const box = canvas.getBoundingClientRect();
      const { lattice } = robot;
      const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      const places = Array.from({ length: robot.count }, (_, slot) => robot.placeAt(slot));
      /** By brute force: the first module that has the ray inside of it, looked at in small steps where one is near. */
      const first = (ray) => {
        let nearest = 0;
        for (let t = 0; t < 60; t += Math.max(0.004, nearest - 0.9)) {
          const p = ['x', 'y', 'z'].map((k) => ray.origin[k] + t * ray.direction[k]);
          nearest = Infinity;
          for (let slot = 0; slot < robot.count; ++slot) {
            const by = places[slot].map((value, k) => p[k] - value);
            nearest = Math.min(nearest, Math.sqrt(dot(by, by)));
            const isIn =
              lattice.shape === 'sphere' ? dot(by, by) < 0.25
              : lattice.shape === 'disc' ? by[0] ** 2 + by[2] ** 2 < 0.25 && Math.abs(by[1]) < 0.25
              : lattice.units.every((unit) => dot(unit, by) < 0.5);
            if (isIn) {
              return String(robot.cellAt(slot));
            }
          }
        }
        return '';
      };
      const all = [];
      for (let i = 0; i < 40; ++i) {
        const x = box.left + box.width * (0.2 + (0.6 * ((i * 17) % 40)) / 40);
        const y = box.top + box.height * (0.2 + (0.5 * i) / 40);
        canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: x, clientY: y, pointerType: 'mouse' }));
        all.push([app.pointed.cell ? String(app.pointed.cell) : '', first(app.stage.ray(x, y))]);
      }
      return { all: all.length, met: all.filter(([, b]) => b).length, wrong: all.filter(([a, b]) => a !== b) };
    });
    assert.ok(wrong.met > 10, `${name}: ${wrong.met}`);
    // A step of brute force may miss a sphere by its edge.
    assert.ok(wrong.wrong.length <= 1, `${name}: ${JSON.stringify(wrong.wrong)}`);
  }
  assert.deepEqual(page.faults, []);
});

test('a click on a sphere, a disc, a prism attaches a module where it is pointed at', async () => {
  const page = await openPage(browser);
  for (const [name, direction] of [['face-centred', 4], ['hexagonal', 2], ['hexagonal-prism', 6], ['cubic', 4]]) {
    await begin(page, name, [[0, 0, 0]]);
    const unit = await page.evaluate((d) => globalThis.holdfast.bench.robot.lattice.units[d], direction);
    const wanted = await page.evaluate((d) => globalThis.holdfast.bench.robot.lattice.neighbour([0, 0, 0], d), direction);
    // A point of the facet that the camera sees: of a disc on its flat front.
    const offset = name === 'hexagonal' ? [0.4 * unit[0], -0.25, 0.4 * unit[2]] : unit.map((value) => value / 2);
    const at = await pointBeside(page, [0, 0, 0], offset);
    await page.mouse.move(at.x, at.y);
    assert.deepEqual(await ghosts(page), [wanted], name);
    await page.mouse.click(at.x, at.y);
    await settled(page);
    assert.deepEqual((await cellsOf(page))[1], wanted, name);
    await page.click('#undo');
    assert.equal(await count(page), 1, name);
  }
  assert.deepEqual(page.faults, []);
});

test('a drag draws a row of spheres along their neighbours, and so do keys', async () => {
  const page = await openPage(browser);
  await begin(page, 'face-centred', [[0, 0, 0]]);
  const from = await pointBeside(page, [0, 0, 0], [0.5, 0, 0]);
  const to = await pointBeside(page, [0, 0, 0], [3.1, 0, 0]);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 8 });
  await page.mouse.up();
  await settled(page);
  assert.deepEqual(await cellsOf(page), [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]);
  await page.focus('#canvas');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Shift+PageUp');
  await page.keyboard.press('Shift+PageUp');
  await settled(page);
  assert.deepEqual((await cellsOf(page)).slice(4), [[3, 0, 1], [3, 0, 2]]);
  assert.notEqual(await page.innerText('#verdict-word'), 'No answer', 'they are connected');
  assert.deepEqual(page.faults, []);
});

test('another lattice keeps the cells, and undo brings the old one back', async () => {
  const page = await openPage(browser);
  const cells = await cellsOf(page);
  for (const name of NAMES.slice(1)) {
    await page.selectOption('#lattice', name);
    await settled(page);
    assert.deepEqual(await cellsOf(page), cells, name);
    assert.equal((await savedJson(page)).lattice, name);
  }
  for (const name of [...NAMES].reverse().slice(1)) {
    await page.click('#undo');
    assert.equal(await page.inputValue('#lattice'), name);
  }
  await settled(page);
  assert.equal(await verdict(page), 'overload', 'as at first');
});

test('“Where next?” asks about every neighbour of a sphere, and a ghost says what the click gives', async () => {
  const page = await openPage(browser);
  await begin(page, 'face-centred', [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1]]);
  await page.click('#faces');
  await page.waitForFunction(() => /free places are safe/.test(document.getElementById('spoken').textContent));
  const rows = await page.evaluate(() => {
    const { app, bench } = globalThis.holdfast;
    const known = bench.robot.freePlaces().map((place) => [place, app.whereNext.places.known(place, 0)]);
    return known.map(([place, { verdict: ghost, ratio }]) => {
      bench.use([place]);
      const { answer } = app.finding;
      bench.history.undo();
      return { place, ghost, ratio, verdict: answer?.verdict, clicked: answer?.load_ratio_max };
    });
  });
  assert.ok(rows.length > 15);
  for (const row of rows) {
    assert.equal(row.ghost, row.verdict, String(row.place));
    assert.ok(row.verdict === 'unstable' || Math.abs(row.ratio - row.clicked) <= 1e-7, JSON.stringify(row));
  }
});

test('obstacles are placed, removed, taken back and saved; boxes fall apart around a hole', async () => {
  const page = await openPage(browser);
  await begin(page, 'cubic', [[0, 0, 0]]);
  await page.keyboard.press('o');
  assert.equal(await page.locator('#roles button').count(), 2);
  await clickFace(page, [0, 0, 0], [1, 0, 0]);
  assert.deepEqual((await surroundings(page)).obstacles, [{ cells: [[1, 0, 0]], hold: 'contact' }]);
  await page.keyboard.press('2');
  await clickFace(page, [0, 0, 0], [0, -1, 0]);
  await clickFace(page, [1, 0, 0], [0, 0, 1]);
  const both = [
    { cells: [[1, 0, 0]], hold: 'contact' },
    { cells: [[0, -1, 0], [1, 0, 1]], hold: 'bonded' },
  ];
  assert.deepEqual((await surroundings(page)).obstacles, both);
  assert.equal(await verdict(page), 'safe', 'a bonded obstacle holds it');
  await page.click('#tools button[aria-label=Remove]');
  await clickFace(page, [1, 0, 1], [0, 0, 1]);
  await page.click('#undo');
  assert.deepEqual((await surroundings(page)).obstacles, both);
  assert.equal(await count(page), 1, 'the module is still there');
  const saved = await savedJson(page);
  assert.deepEqual(saved.obstacles.map(({ cells, hold = 'contact' }) => ({ cells, hold })), both);
  const left = await page.evaluate(() => {
    const { bench } = globalThis.holdfast;
    bench.surround('a box', { obstacles: [{ from: [3, 0, 0], to: [5, 2, 2], friction: 0.5 }] });
    bench.remove([[4, 1, 1]]);
    const cells = [];
    for (let x = 2; x < 7; ++x) for (let y = -1; y < 4; ++y) for (let z = -1; z < 4; ++z) {
      if (bench.robot.obstacles.has([x, y, z])) cells.push([x, y, z]);
    }
    return { cells: cells.length, hole: bench.robot.obstacles.has([4, 1, 1]), list: bench.robot.surroundings.obstacles };
  });
  assert.deepEqual([left.cells, left.hole], [26, false]);
  assert.ok(left.list.every(({ friction }) => friction === 0.5));
  assert.deepEqual(page.faults, []);
});

test('a cube on a slope slides where friction is less than its tangent', async () => {
  const page = await openPage(browser);
  await begin(page, 'cubic', [[0, 0, 0]]);
  await page.getByLabel('Floor’s friction').fill('0.5');
  await page.getByLabel('Floor’s friction').press('Enter');
  for (const [angle, holds] of [[20, true], [26, true], [27, false], [40, false]]) {
    await page.getByLabel('Slope').fill(String(angle));
    await page.getByLabel('Slope').press('Enter');
    await settled(page);
    const tangent = Math.tan((angle * Math.PI) / 180);
    assert.equal(await verdict(page), holds ? 'safe' : 'unstable', `${angle} degrees, ${tangent}`);
    if (holds) {
      const needed = Number(/Friction needed\s+([\d.]+)/.exec(await figures(page))[1]);
      assert.ok(Math.abs(needed - tangent) < 2e-3, `${needed}, expected ${tangent}`);
    } else {
      assert.match(await page.innerText('#verdict-reason'), /No contact forces balance the loads/);
    }
  }
  const gravity = await page.evaluate(() => globalThis.holdfast.bench.robot.gravity);
  assert.ok(Math.abs(gravity[0] - 9.81 * Math.sin((40 * Math.PI) / 180)) < 1e-9, 'downhill is +x');
  // It goes the way that gravity pulls it along the floor.
  assert.ok(await page.isVisible('#topple'));
  const [x, y, , ...turn] = await fallAt(page, 0.5);
  // By Coulomb, from rest; half a step ahead.
  const radians = (40 * Math.PI) / 180;
  const expected = 0.5 * 9810 * (Math.sin(radians) - 0.5 * Math.cos(radians)) * 0.5 ** 2;
  assert.ok(Math.abs(x - expected) < 0.01 * expected && Math.abs(y) < 0.01 && turn.every((angle) => Math.abs(angle) < 1e-3), `${x}, ${y}, ${turn}: ${expected}`);
  await page.click('#undo');
  await settled(page);
  assert.equal(await page.inputValue('#surroundings input'), '27');
  assert.deepEqual(page.faults, []);
});

test('a tower tips where the slope is steeper than its foot is wide', async () => {
  const page = await openPage(browser);
  await begin(page, 'cubic', [[0, 0, 0], [0, 0, 1], [0, 0, 2]]);
  // Half a foot over half a height of three: it tips at 18.43 degrees.
  assert.match(await figures(page), /Tilt|Margin/);
  await page.getByLabel('Downhill').fill('90');
  await page.getByLabel('Downhill').press('Enter');
  for (const [angle, expected] of [[18, 'safe'], [19, 'unstable']]) {
    await page.getByLabel('Slope').fill(String(angle));
    await page.getByLabel('Slope').press('Enter');
    await settled(page);
    assert.equal(await verdict(page), expected, `${angle}`);
  }
  assert.match(await page.innerText('#verdict-reason'), /tips over/);
  const top = await fallAt(page, 1.5, 2);
  assert.ok(top[1] > 12 && Math.abs(top[0]) < 0.5, `it tips towards +y: ${top}`);
  assert.deepEqual(page.faults, []);
});

test('a load is put on a module and counts as statics say; removing the module takes it along', async () => {
  const page = await openPage(browser);
  await begin(page, 'cubic');
  await page.evaluate(() => {
    const { app, bench } = globalThis.holdfast;
    bench.edit('hung', [[0, 0, 3]], 2);
    bench.edit('hung', [[0, 0, 2]], 0);
    app.see();
  });
  await settled(page);
  await page.keyboard.press('l');
  await page.getByLabel('Force z').fill('-4');
  await page.getByLabel('Force z').press('Enter');
  await clickFace(page, [0, 0, 2], [1, 0, 0]);
  const ratio = async () => Number(/Largest load\s+([\d.]+)/.exec(await figures(page))[1]);
  assert.ok(Math.abs((await ratio()) - (4 + WEIGHT) / 11.98) < 6e-4, 'force and weight pull at it');
  await page.evaluate(() => globalThis.holdfast.app.point([0, 0, 2]));
  assert.match(await page.textContent('#details'), /force \(0, 0, -4\) N/);
  await page.getByLabel('Own mass').fill('0.5');
  await page.getByLabel('Own mass').press('Enter');
  await clickFace(page, [0, 0, 2], [1, 0, 0]);
  assert.ok(Math.abs((await ratio()) - (4 + 0.5 * 9.81) / 11.98) < 6e-4, 'and a mass of its own');
  const saved = await savedJson(page);
  assert.deepEqual(saved.loads, [{ cell: [0, 0, 2], force_n: [0, 0, -4], torque_nmm: [0, 0, 0] }]);
  assert.deepEqual(saved.modules.find(({ mass_kg }) => mass_kg), { cell: [0, 0, 2], mass_kg: 0.5 });
  await page.evaluate(() => globalThis.holdfast.bench.edit('off', [[0, 0, 2]], undefined));
  assert.deepEqual(await surroundings(page), {});
  await page.click('#undo');
  await settled(page);
  assert.ok(Math.abs((await ratio()) - (4 + 0.5 * 9.81) / 11.98) < 6e-4, 'undo brings both back');
  await page.click('text=Nothing: take loads off');
  await clickFace(page, [0, 0, 2], [1, 0, 0]);
  assert.ok(Math.abs((await ratio()) - WEIGHT / 11.98) < 6e-4, 'and off again');
  assert.deepEqual(page.faults, []);
});

test('every number that is typed is judged and saved as the program judges it', async () => {
  // Each field of the forms in turn, straight down and slanting gravity, up and down in size: the page's answer is
  // the program's for the file that the page saves, and the file says what was typed.
  const page = await openPage(browser);
  const folder = temporaryFolder();
  const file = path.join(folder, 'typed.json');
  const check = async (typed) => {
    await settled(page);
    const saved = await savedJson(page);
    writeFileSync(file, JSON.stringify(saved));
    let report;
    try {
      report = execFileSync(program, ['check', '--quiet', '--json', '-', file], { stdio: ['ignore', 'pipe', 'ignore'] });
    } catch (error) {
      assert.ok(error.status === 1 || error.status === 2, `${typed}: exit code ${error.status}`);
      report = error.stdout;
    }
    const truth = JSON.parse(report);
    assert.equal(await verdict(page), truth.verdict, typed);
    const ratio = await page.evaluate(() => globalThis.holdfast.app.finding.answer.load_ratio_max);
    assert.ok(
      ratio === truth.overload.load_ratio_max || Math.abs(ratio - truth.overload.load_ratio_max) <= 1e-9 * Math.max(1, ratio),
      `${typed}: ${ratio} on the page, ${truth.overload.load_ratio_max} by the program`,
    );
    return saved;
  };
  const fill = (label, value) => typeInto(page, label, String(value));
  await openExample(page, 'arm_breaks_a');
  await page.click('#material-form summary');
  for (const value of [-30, -19.62, -4, -9.81, -1e-3]) {
    await fill('Gravity z', value);
    const { gravity_m_s2: own, material } = await check(`gravity ${value}`);
    const said = own?.[2] ?? -(material?.gravity_m_s2 ?? 9.81);
    assert.equal(said, value, 'what was typed is in the file');
  }
  await fill('Gravity x', 0.5);
  await fill('Gravity z', -12);
  assert.deepEqual((await check('slanting')).gravity_m_s2, [0.5, 0, -12]);
  await fill('Gravity x', 0);
  const upright = await check('upright again');
  assert.equal(upright.gravity_m_s2?.[2] ?? -upright.material.gravity_m_s2, -12);
  await fill('Slope', 15);
  await fill('Slope', 0);
  const level = await check('level again');
  assert.equal(level.gravity_m_s2?.[2] ?? -level.material.gravity_m_s2, -12, 'turned to and fro');
  // All fields of the material: a tenth less, and back.
  const fields = page.locator('#material input');
  for (let i = 0; i < (await fields.count()) - 1; ++i) {
    const before = await fields.nth(i).inputValue();
    const typed = Number((Number(before) * 0.9).toPrecision(8));
    await fields.nth(i).fill(String(typed));
    await fields.nth(i).press('Enter');
    const saved = await check(`material ${i}: ${typed}`);
    assert.ok(typed === 0 || Object.values(saved.material).some((value) => value === typed), `${typed} is in the file`);
    await fields.nth(i).fill(before);
    await fields.nth(i).press('Enter');
  }
  assert.deepEqual(page.faults, []);
  rmSync(folder, { recursive: true });
});

const FULL = {
  lattice: 'face-centred',
  support_z: 0,
  floor: { friction: 0.5 },
  gravity_m_s2: [0.5, 0, -9.7],
  material: { mass_kg: 0.07, foot_mm: 18, shear_strength_n: 9 },
  kinds: { battery: { mass_kg: 0.2 } },
  modules: [[0, 0, 0], { cell: [1, 0, 0], kind: 'battery' }, { cell: [0, 1, 0], mass_kg: 0.21 }, { cell: [0, 0, 1], fixed: false }],
  planned: [[1, 1, 0]],
  obstacles: [{ from: [-1, -3, 0], to: [-1, 3, 2], friction: 0.4 }, { cells: [[0, 0, -1]], hold: 'bonded' }],
  loads: [{ cell: [0, 0, 1], force_n: [0, 0, -2], torque_nmm: [1, 0, 3] }],
};

/** Without what holds anyway. */
const plain = ({ modules, obstacles, support_z, ...rest }) => ({
  ...rest,
  support_z: support_z ?? 0,
  modules: modules.map((one) => (one.fixed === false ? one.cell : one)),
  obstacles: obstacles.map(({ hold, ...one }) => (hold === 'bonded' ? { ...one, hold } : one)),
});

test('a file that says everything is opened, saved, linked and kept without loss', async () => {
  const context = await newContext(browser);
  const page = await openPage(browser, { context });
  await open(page, 'everything', FULL);
  const { format: _f, version, name, ...saved } = await savedJson(page);
  assert.deepEqual([version, name], [2, 'everything']);
  assert.deepEqual(plain(saved), plain(FULL));
  await page.evaluate(() => globalThis.holdfast.bench.edit('one more', [[0, -1, 0]], 0));
  await page.click('#save');
  await page.click('[data-save=link]');
  await page.waitForFunction(() => location.hash.startsWith('#s='));
  const fragment = await page.evaluate(() => location.hash);
  const linked = await openPage(browser, { fragment });
  const more = { ...FULL, modules: [...FULL.modules, [0, -1, 0]] };
  const { format: _h, version: _w, name: _m, ...again } = await savedJson(linked);
  assert.deepEqual(plain(again), plain(more), 'linked');
  // Kept as the bare page's robot, not as the link's.
  await page.evaluate(() => {
    history.replaceState(null, '', location.pathname);
    for (const role of [undefined, 0]) {
      globalThis.holdfast.bench.edit('once more', [[0, -1, 0]], role);
    }
  });
  await page.close();
  const kept = await openPage(browser, { context });
  const { format: _g, version: _v, name: _n, ...back } = await savedJson(kept);
  assert.deepEqual(plain(back), plain(more), 'kept');
  assert.deepEqual([...page.faults, ...linked.faults, ...kept.faults], []);
  await context.close();
});

test('what cannot be is said in words, and the robot stays', async () => {
  const page = await openPage(browser);
  const before = await count(page);
  const file = (more) => JSON.stringify({ format: 'holdfast-structure', version: 2, modules: [[0, 0, 0]], ...more });
  for (const [text, words] of [
    [file({ lattice: 'penrose' }), /lattice/],
    [file({ version: 3 }), /version/],
    [file({ obstacles: [{ cells: [[0, 0]] }] }), /obstacles/],
  ]) {
    await dropFile(page, 'bad.json', text);
    assert.match(await message(page), words);
    await page.click('.message .close');
    assert.equal(await count(page), before);
  }
});

test('the limit that a connection is near is named: latches shear before they open', async () => {
  const page = await openPage(browser);
  // Shear is one weight, which 1 N may hold; it opens at w L / 2 over a lever of 20 mm.
  await open(page, 'latch', {
    material: { shear_strength_n: 1 },
    support_z: null,
    modules: [{ cell: [0, 0, 0], fixed: true }, [1, 0, 0]],
  });
  const ratio = Number(/Largest load\s+([\d.]+)/.exec(await figures(page))[1]);
  assert.ok(Math.abs(ratio - WEIGHT) < 6e-4, `${ratio}`);
  await page.evaluate(() => globalThis.holdfast.app.point([1, 0, 0]));
  assert.match(await page.textContent('#details'), /0\.599 shears/);
  assert.deepEqual(page.faults, []);
});

test('facets show what they do, each for itself', async () => {
  const page = await openPage(browser);
  // A beam on two contacts, its end beyond the second one; a wall holds nothing where nothing leans on it.
  await open(page, 'facets', {
    support_z: null,
    modules: [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]],
    obstacles: [{ cells: [[0, 0, -1], [3, 0, -1]] }, { cells: [[1, 0, 1]] }],
  });
  const legend = await page.innerText('#facet-legend');
  assert.match(legend, /presses|tilts/);
  const states = await page.evaluate(() => {
    const { app } = globalThis.holdfast;
    const { facets, facetForces } = app.finding.answer;
    return Array.from({ length: facets.length / 4 }, (_, i) => ({
      module: facets[4 * i], code: facets[4 * i + 3], push: facetForces[5 * i],
    }));
  });
  assert.equal(states.length, 3);
  // Those below push up, the one above pushes down.
  const pushes = states.reduce((sum, { push, module }) => sum + (module === 1 ? -push : push), 0);
  assert.ok(Math.abs(pushes - 4 * WEIGHT) < 1e-6, `together they carry the weight: ${pushes}`);
  assert.ok(await page.evaluate(() => globalThis.holdfast.app.scenery.facets.mesh.visible));
  await page.evaluate(() => globalThis.holdfast.app.point([0, 0, 0]));
  assert.match(await page.textContent('#details'), /facet −z (presses|tilts), pressed with 1\.2/);
  assert.deepEqual(page.faults, []);
});

for (const name of ['catom_pyramid', 'disc_arch', 'prism_wall', 'slope', 'slot']) {
  test(`the example ${name} has an answer and a picture`, async () => {
    const page = await openPage(browser);
    await openExample(page, name);
    assert.match(await verdict(page), /safe|overload|unstable/, await page.innerText('#verdict-reason'));
    assert.deepEqual(page.faults, []);
  });
}

test('the collapse that the program has found is shown as a motion, and belongs to that robot alone', async () => {
  const folder = temporaryFolder();
  const file = path.join(folder, 'collapse.html');
  const modules = [{ cell: [0, 0, 0], fixed: true }, [1, 0, 0], [2, 0, 0]];
  const structure = JSON.stringify({ format: 'holdfast-structure', version: 1, name: 'collapse', support_z: -5, modules });
  // The connection of the last two opens: the last one turns about the lower edge of the face between them.
  const velocities = [[0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0.5, 0, -0.5, 0, 0.025, 0]];
  const limit = { factor: 12.5, yields: [{ a: [1, 0, 0], b: [2, 0, 0], limit: 'opens' }], velocities };
  const start = JSON.stringify({ structure, name: 'collapse', limit });
  writeFileSync(file, readFileSync(pageFile, 'utf8').replace('id="holdfast-start">null<', () => `id="holdfast-start">${start}<`));
  const page = await openPage(browser, { file });
  assert.match(await page.innerText('#limit'), /No forces balance more than 12\.50 times these loads/);
  await page.click('#collapse');
  const moved = await page.evaluate(async () => {
    const { app, bench } = globalThis.holdfast;
    let most = 0;
    const { view } = app;
    const at = view.instances[bench.robot.slot([2, 0, 0])];
    const motion = [...view.modules.motions.slice(3 * at, 3 * at + 3)];
    const still = [...view.modules.motions.slice(0, 3 * at)];
    while (app.stage.motions.some((move) => move(performance.now()))) {
      most = Math.max(most, view.exaggeration);
      await new Promise((done) => setTimeout(done, 50));
    }
    return { motion, still, most, after: view.exaggeration };
  });
  // In cells of 40 mm: as far as the program says, then magnified until the fastest goes one cell.
  assert.deepEqual(moved.motion.map((value) => Math.round(value * 40 * 1e6) / 1e6), [0.5, 0, -0.5]);
  assert.ok(moved.still.every((value) => value === 0));
  assert.ok(moved.most > 35 && moved.most <= 40 && moved.after === 0, JSON.stringify(moved));
  await page.evaluate(() => globalThis.holdfast.bench.edit('another', [[3, 0, 0]], 0));
  assert.equal(await page.isVisible('#limit-text'), false, 'nothing is known of another robot');
  assert.ok(await page.isVisible('#find-limit'));
  assert.deepEqual(page.faults, []);
});

test('the page finds the limit load itself, and the collapse', async () => {
  const file = path.join(temporaryFolder(), 'hung.html');
  // As below: 11.98 N hold so many weights of the module that hangs from a fixed one.
  const modules = [{ cell: [0, 0, 3], fixed: true }, [0, 0, 2]];
  const structure = JSON.stringify({ format: 'holdfast-structure', version: 1, name: 'hung', modules });
  const start = JSON.stringify({ structure, name: 'hung' });
  writeFileSync(file, readFileSync(pageFile, 'utf8').replace('id="holdfast-start">null<', () => `id="holdfast-start">${start}<`));
  const page = await openPage(browser, { file });
  await page.click('#find-limit');
  await page.waitForSelector('#limit-text:not([hidden])');
  const factor = Number(/more than ([\d.]+) times/.exec(await page.innerText('#limit-text'))[1]);
  assert.ok(Math.abs(factor - 11.98 / WEIGHT) < 0.01, `${factor}`);
  assert.ok(await page.isVisible('#collapse'));
  assert.deepEqual(page.faults, []);
});

test('holdfast check --limit --html hands the page what it has found', async () => {
  const folder = temporaryFolder();
  const [file, out] = ['hung.json', 'hung.html'].map((name) => path.join(folder, name));
  // A module hangs from a fixed one: 11.98 N hold so many of its weights, then it opens and falls.
  const modules = [{ cell: [0, 0, 3], fixed: true }, [0, 0, 2]];
  writeFileSync(file, JSON.stringify({ format: 'holdfast-structure', version: 1, name: 'hung', modules }));
  execFileSync(program, ['check', '--quiet', '--limit', file, '--html', out]);
  const page = await openPage(browser, { file: out });
  await page.click('#report .close');
  const factor = Number(/more than ([\d.]+) times/.exec(await page.innerText('#limit'))[1]);
  assert.ok(Math.abs(factor - 11.98 / WEIGHT) < 0.01, `${factor}`);
  await page.click('#collapse');
  const down = await page.evaluate(() => {
    const { app: { view }, bench: { robot } } = globalThis.holdfast;
    return view.modules.motions[3 * view.instances[robot.slot([0, 0, 2])] + 2];
  });
  assert.ok(down < 0, `it falls: ${down}`);
  assert.deepEqual(page.faults, []);
});

test('a number that cannot be is refused in its field, in words, and nothing is changed', async () => {
  const page = await openPage(browser);
  await page.click('#material-form summary');
  for (const [label, text, words, right] of [
    ['Elastic modulus E', '0', /^0 is not possible: expected 1e-12 to 1e12 MPa\.$/, '100'],
    ['Mass of a module', '-1', /^-1 is not possible/, '0.06106'],
    ['Poisson’s ratio', '0.7', /expected -0.99 to 0.5\.$/, '0.3'],
    ['Pitch L', 'abc', /^“abc” is not a number\.$/, '40'],
    ['Strength, lateral', '', /^A number is needed here\.$/, '14,97'],
    ['Ground at z', '1.5', /^1.5 is not a whole number\.$/, '0'],
    ['Floor’s friction', '-0.5', /^-0.5 is not possible: expected 0 to/, ''],
    ['Gravity z', '0', /^Without gravity nothing rests on anything\.$/, '-9.81'],
    ['Gravity x', '-1e300', /^-1e300 is not possible/, '0'],
  ]) {
    const field = await typeInto(page, label, text);
    assert.equal(await field.getAttribute('aria-invalid'), 'true', label);
    const note = page.locator(`#${await field.getAttribute('aria-describedby')}`);
    assert.ok(await note.isVisible(), label);
    assert.match(await note.innerText(), words);
    assert.equal(await page.locator('.message.error').count(), 0, 'at the field and nowhere else');
    assert.equal(await page.isDisabled('#undo'), true, `${label}: nothing was done`);
    await field.fill(right);
    await field.press('Enter');
    assert.equal(await field.getAttribute('aria-invalid'), null, `${label}: ${right}`);
    assert.equal(await page.locator('.fault:visible').count(), 0);
    assert.equal(await page.isDisabled('#undo'), true, `${label}: it is what it was`);
  }
  assert.equal(await verdict(page), 'overload', 'as at first');
  assert.deepEqual(page.faults, []);
});

test('gravity that is turned to and fro is what it was, to the last digit', async () => {
  const page = await openPage(browser);
  for (const strength of ['9.80665123456789', '9.81', '1.6']) {
    await typeInto(page, 'Gravity z', `-${strength}`);
    for (const angle of ['15', '0']) {
      await typeInto(page, 'Slope', angle);
    }
    assert.deepEqual(await page.evaluate(() => [...globalThis.holdfast.bench.robot.gravity]), [0, 0, -Number(strength)]);
    assert.equal((await surroundings(page)).gravity_m_s2, undefined, 'straight down it is a number of the material');
  }
  assert.deepEqual(page.faults, []);
});

test('a load of nothing is no change, and a click that stops a fall attaches nothing', async () => {
  const page = await openPage(browser, { reducedMotion: 'no-preference' });
  await begin(page, 'cubic', [[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1]]);
  await page.keyboard.press('l');
  await page.click('text=Nothing: take loads off');
  const label = () => page.evaluate(() => globalThis.holdfast.bench.history.done.at(-1).label);
  const last = await label();
  await page.evaluate(() => globalThis.holdfast.bench.use([[0, 0, 1]]));
  assert.equal(await label(), last);
  assert.equal(await verdict(page), 'unstable');
  await page.keyboard.press('a');
  const at = await pointBeside(page, [0, 0, 1], [0, -0.5, 0]);
  await page.evaluate(() => globalThis.holdfast.app.startTopple());
  await page.waitForFunction(() => globalThis.holdfast.app.isToppled);
  await page.mouse.click(at.x, at.y);
  assert.equal(await count(page), 4);
  assert.equal(await page.evaluate(() => globalThis.holdfast.app.isToppled), false);
  assert.deepEqual(page.faults, []);
});

test('gravity pulls down the picture, wherever it goes', async () => {
  const page = await openPage(browser);
  await begin(page, 'cubic', [[0, 0, 0], [0, 0, 1]]);
  const pulled = () => page.evaluate(() => {
    const { app: { stage }, bench } = globalThis.holdfast;
    const { target } = stage.controls;
    stage.camera.updateMatrixWorld();
    const along = target.clone().fromArray(bench.robot.gravity).normalize().multiplyScalar(0.5).add(target);
    const [from, to] = [stage.project(target), stage.project(along)];
    return { across: to.x - from.x, down: to.y - from.y };
  });
  for (const gravity of [[0, 0, -9.81], [3, 0, -9], [0, -9.81, 0], [5, 5, 5], [0, 0, 9.81], [-1, 2, -9]]) {
    await open(page, 'pulled', { gravity_m_s2: gravity, modules: [{ cell: [0, 0, 0], fixed: true }, [0, 0, 1]] });
    for (const keys of ['', 'qqq', 'eh']) {
      for (const key of keys) {
        await page.keyboard.press(key);
      }
      const { across, down } = await pulled();
      assert.ok(Math.abs(across) < 0.01 * down && down > 10, `${gravity} ${keys}: ${across}, ${down}`);
    }
  }
  assert.deepEqual(page.faults, []);
});

test('what has toppled lies until it is stood up', async () => {
  const page = await openPage(browser, { reducedMotion: 'no-preference' });
  const lies = () => page.evaluate(() => ({
    isToppled: globalThis.holdfast.app.isToppled,
    way: globalThis.holdfast.app.view.exaggeration * globalThis.holdfast.app.view.modules.motions.reduce((sum, x) => sum + Math.abs(x), 0),
  }));
  const stands = async (act) => {
    await page.evaluate(() => globalThis.holdfast.app.stopTopple());
    await page.click('#topple');
    await page.waitForTimeout(3500); // And then no longer.
    const { isToppled, way } = await lies();
    assert.ok(isToppled && way > 0.5, `${act}: ${isToppled}, ${way}`);
    assert.equal(await page.innerText('#topple'), 'Stand it up');
    await act();
    assert.deepEqual(await lies(), { isToppled: false, way: 0 }, String(act));
    assert.equal(await page.innerText('#topple'), 'Let it topple');
  };
  await begin(page, 'cubic', [[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1]]);
  await stands(() => page.click('#topple'));
  await stands(() => page.keyboard.press('t'));
  await stands(() => page.focus('canvas').then(() => page.keyboard.press('ArrowUp')));
  await page.keyboard.press('Escape');
  const at = await pointBeside(page, [0, 0, 1], [0, -0.5, 0]);
  await stands(() => page.mouse.click(at.x, at.y));
  assert.equal(await count(page), 4);
  assert.deepEqual(page.faults, []);
});

test('what falls stays in the picture', async () => {
  const page = await openPage(browser, { reducedMotion: 'no-preference' });
  for (const name of ['general/slides_off_slope', 'arm_tips_c', 'scary_tips_c']) {
    const text = readFileSync(scenario(name), 'utf8');
    await dropFile(page, 'fall.json', text);
    await page.waitForFunction((source) => globalThis.holdfast.bench.robot.base === source, text);
    await settled(page);
    await page.evaluate(() => globalThis.holdfast.app.see());
    await page.evaluate(() => globalThis.holdfast.app.stopTopple());
    await page.click('#topple');
    await page.waitForTimeout(3500);
    const outside = await page.evaluate(() => {
      const { stage, robot } = globalThis.holdfast.app;
      const { clientWidth, clientHeight } = stage.canvas;
      const places = Array.from({ length: robot.count }, (_, slot) => stage.controls.target.clone().fromArray(robot.placeAt(slot)));
      const motion = (slot) => globalThis.holdfast.app.toppling.pieces.at(9).slice(6 * slot, 6 * slot + 3).map((mm) => mm / robot.pitchMm);
      return places.map((place, slot) => stage.project(place.add(stage.controls.target.clone().fromArray(motion(slot)))))
        .filter((at) => !at || at.x < 0 || at.y < 0 || at.x > clientWidth || at.y > clientHeight).length;
    });
    assert.equal(outside, 0, name);
  }
  assert.deepEqual(page.faults, []);
});

test('numbers have two digits that say something, and nothing is minus nothing', async () => {
  const page = await openPage(browser);
  // Weight presses a tower together: nothing pulls at it. Hung up, each number is known.
  await begin(page, 'cubic', [[0, 0, 0], [0, 0, 1], [0, 0, 2]]);
  assert.match(await figures(page), /Largest load\s+nothing pulls/);
  await page.evaluate(() => globalThis.holdfast.app.point([0, 0, 1]));
  assert.doesNotMatch(`${await figures(page)} ${await page.innerText('#details')}`, /-0(?![.\d])|-0\.0*(?!\d)/);
  const hung = { support_z: null, modules: [{ cell: [0, 0, 1], fixed: true }, [0, 0, 0]] };
  for (const [name, mass, ratio, factor] of [['light', 0.001, '0.00082', '1221.20'], ['heavy', 20, '16.377', '0.061']]) {
    await open(page, name, { ...hung, material: { mass_kg: mass } });
    const share = (mass * 9.81) / 11.98;
    assert.ok(Math.abs(Number(ratio) / share - 1) < 0.01 && Math.abs(Number(factor) * share - 1) < 0.01);
    assert.match(await figures(page), new RegExp(`Largest load\\s+${ratio}\\b`));
    assert.match(await figures(page), new RegExp(`First break at\\s+${factor} times`));
  }
  assert.equal(await page.innerText('#exaggeration-value'), '0 ×');
  await page.fill('#exaggeration', '50');
  await page.fill('#exaggeration', '0');
  assert.equal(await page.innerText('#exaggeration-value'), '0 ×');
  assert.deepEqual(page.faults, []);
});
