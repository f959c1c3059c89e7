// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Modules that are not as long as wide: where they stand, what is clicked, what is saved, beside the program.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import {
  clickFace, count, dropFile, launch, newContext, openPage, pageFile, program, repository, roleOf, settled,
  temporaryFolder, verdict,
} from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const TALL = {
  format: 'holdfast-structure', version: 2, name: 'tall', material: { pitch_mm: [40, 40, 80] },
  modules: [[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2], [2, 0, 2], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
};
const FLAT = { ...TALL, name: 'flat', lattice: 'hexagonal-prism', material: { pitch_mm: [50, 50, 20] } };
const LONG = { ...TALL, name: 'long', material: { pitch_mm: [60, 20, 30] } };
const TIPS = { ...TALL, name: 'tips', modules: [[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1], [3, 0, 1]] };

async function open(page, file) {
  await dropFile(page, `${file.name}.json`, JSON.stringify(file));
  await page.waitForFunction((title) => globalThis.holdfast.bench.robot.name === title, file.name);
  await settled(page);
}

async function saved(page) {
  await page.click('#save');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('[data-save=json]')]);
  return readFileSync(await download.path(), 'utf8');
}

/** Drops a sample of the formats of other programs, as bytes; its text. */
async function dropSample(page, name) {
  const bytes = readFileSync(path.join(repository, 'examples/formats', name));
  await page.evaluate(([fileName, content]) => {
    globalThis.holdfast.bench.robot.name = 'before';
    const data = new DataTransfer();
    data.items.add(new File([Uint8Array.from(content)], fileName));
    window.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
  }, [name, [...bytes]]);
  await page.waitForFunction(() => globalThis.holdfast.bench.robot.name !== 'before');
  await settled(page);
  return bytes.toString('utf8');
}

/** The program's report of a file. */
function report(text, name = 'robot.json') {
  const file = path.join(temporaryFolder(), name);
  writeFileSync(file, text);
  try {
    return JSON.parse(execFileSync(program, ['check', '--quiet', '--json', '-', file], { stdio: ['ignore', 'pipe', 'ignore'] }));
  } catch (error) {
    return JSON.parse(error.stdout);
  }
}

async function expectAsProgram(page, text, name) {
  const truth = report(text, name);
  assert.equal(await verdict(page), truth.verdict);
  const { ratio, margin } = await page.evaluate(() => {
    const { answer } = globalThis.holdfast.app.finding;
    return { ratio: answer.load_ratio_max, margin: answer.stability?.margin_mm };
  });
  assert.ok(Math.abs((ratio ?? 0) - (truth.overload.load_ratio_max ?? 0)) < 1e-9, `${ratio}`);
  return { truth, margin };
}

test('the answer is the program’s, and the file is what it was', async () => {
  const page = await openPage(browser);
  for (const file of [TALL, FLAT, LONG, TIPS]) {
    await open(page, file);
    await expectAsProgram(page, JSON.stringify(file));
    const text = await saved(page);
    assert.deepEqual(JSON.parse(text).material.pitch_mm, file.material.pitch_mm);
    await expectAsProgram(page, text);
  }
  assert.deepEqual(page.faults, []);
});

test('modules stand where they are, and what is clicked is what is seen', async () => {
  const page = await openPage(browser);
  for (const [file, stretch] of [[TALL, [1, 1, 2]], [LONG, [3, 1, 1.5]]]) {
    await open(page, file);
    const places = await page.evaluate(() => {
      const { robot } = globalThis.holdfast.bench;
      const { lattice } = robot;
      const cells = Array.from({ length: robot.count }, (_, slot) => robot.cellAt(slot));
      return cells.map((cell) => ({ cell, place: lattice.place(cell), back: lattice.cell(lattice.nearestAxial(lattice.place(cell))) }));
    });
    for (const { cell, place, back } of places) {
      assert.deepEqual(place, cell.map((value, k) => value * stretch[k]));
      assert.deepEqual(back, cell);
    }
    // On top of the middle of the foot that is free above.
    const before = await count(page);
    await clickFace(page, [1, 1, 0].map((value, k) => value * stretch[k]), [0, 0, stretch[2]]);
    assert.equal(await roleOf(page, [1, 1, 1]), 0, 'on top');
    // And beside it, where the front is as high as the module.
    await clickFace(page, [1, 0, 0].map((value, k) => value * stretch[k]), [0, -stretch[1], 0]);
    assert.equal(await roleOf(page, [1, -1, 0]), 0, 'in front');
    assert.equal(await count(page), before + 2);
    await expectAsProgram(page, await saved(page));
  }
  assert.deepEqual(page.faults, []);
});

test('the floor is below the feet, and what topples does not go through it', async () => {
  const page = await openPage(browser);
  await open(page, TIPS);
  assert.equal(await verdict(page), 'unstable');
  const floor = await page.evaluate(() => globalThis.holdfast.bench.robot.floorHeight);
  assert.equal(floor, -1);
  const lowest = await page.evaluate(async () => {
    const { app, bench: { robot } } = globalThis.holdfast;
    await app.toppling.start(robot, app.finding);
    const motions = app.toppling.pieces.at(9);
    const all = Array.from({ length: robot.count }, (_, slot) => robot.placeAt(slot)[2] + motions[6 * slot + 2] / robot.pitchMm);
    app.stopTopple();
    return Math.min(...all);
  });
  // The middle of a module that lies on its side is half its shorter edge above the floor.
  assert.ok(lowest > -1 + 0.5 - 0.05, `${lowest}`);
});

test('the pitch scales all lengths, another lattice and a new robot have one pitch', async () => {
  const page = await openPage(browser);
  await open(page, TALL);
  await page.click('#material-form summary');
  const field = page.getByLabel('Pitch L').first();
  await field.fill('20');
  await field.press('Enter');
  await settled(page);
  const text = await saved(page);
  assert.deepEqual(JSON.parse(text).material.pitch_mm, [20, 20, 40]);
  await expectAsProgram(page, text);
  await page.selectOption('#lattice', 'hexagonal-prism');
  await settled(page);
  assert.equal(JSON.parse(await saved(page)).material.pitch_mm, 20);
  await page.click('#undo');
  await settled(page);
  assert.deepEqual(JSON.parse(await saved(page)).material.pitch_mm, [20, 20, 40]);
  await page.click('#new');
  assert.deepEqual(await page.evaluate(() => [...globalThis.holdfast.bench.robot.lattice.stretch]), [1, 1, 1]);
  assert.deepEqual(page.faults, []);
});

test('a reload keeps it', async () => {
  const context = await newContext(browser);
  const page = await openPage(browser, { context, file: pageFile, fragment: '' });
  await open(page, TALL);
  await clickFace(page, [1, 1, 0], [0, 0, 2]);
  await page.reload();
  await page.waitForSelector('html.ready');
  await settled(page);
  assert.equal(await count(page), TALL.modules.length + 1);
  assert.deepEqual(await page.evaluate(() => [...globalThis.holdfast.bench.robot.lattice.stretch]), [1, 1, 2]);
  await context.close();
});

test('bricks are as high as they are, and judged as by the program', async () => {
  const page = await openPage(browser);
  for (const name of ['wall.ldr', 'bricks.txt', 'stable_lego.json']) {
    const text = await dropSample(page, name);
    assert.deepEqual(await page.evaluate(() => [...globalThis.holdfast.bench.robot.lattice.stretch]), [1, 1, 9.6 / 8]);
    await expectAsProgram(page, text, name);
    await expectAsProgram(page, await saved(page));
  }
  assert.deepEqual(page.faults, []);
});

test('every format that the program reads is read, meshes with the edge that the user gives', async () => {
  const page = await openPage(browser);
  page.on('dialog', (dialog) => dialog.accept('20'));
  const names = readdirSync(path.join(repository, 'examples/formats')).filter((name) => !name.endsWith('.rofi'));
  for (const name of names) {
    await dropSample(page, name);
    const args = ['convert', path.join(repository, 'examples/formats', name), path.join(temporaryFolder(), 'robot.json')];
    execFileSync(program, [...args, ...(/stl|obj/.test(name) ? ['--pitch', '20'] : [])], { stdio: 'ignore' });
    const cells = (file) => file.modules.map((module) => String(module.cell ?? module)).sort();
    const text = await saved(page);
    assert.deepEqual(cells(JSON.parse(text)), cells(JSON.parse(readFileSync(args[2], 'utf8'))), name);
  }
  const accepted = await page.getAttribute('#file', 'accept');
  assert.ok(['.json', '.xml', '.ldr', '.vox', '.csv'].every((ending) => accepted.split(',').includes(ending)), accepted);
  assert.deepEqual(page.faults, []);
});
