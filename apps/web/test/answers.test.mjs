// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The page's answers are the native program's: every number of the report to the last digit, for all
// scenarios, for the 320 structures of tests/reference and for robots that multigrid solves. Only the
// shear force and the numbers of a rigid body's margins and motion, which are part of no verdict, come from
// the C library's hypot and atan2 and from sums whose order is Eigen's, so they are only near. And what a
// robot finds out by itself is the same, packet by packet.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import {
  launch, nativeReports, nativeSimulation, openExample, openPage, program, repository, scenario, temporaryFolder,
  withoutCommandLine,
} from './browser.mjs';

let browser;
let page;
before(async () => {
  browser = await launch();
  page = await openPage(browser);
});
after(() => browser.close());

/** The largest difference of two numbers, as a share of the larger, that their makers allow. */
const SHEAR_TIE = 1e-12;
/** A cone that is curved where the load leaves it is left within the root of the remainder's tie, 1e-10. */
const RIGID_TIE = 1e-5;
/** Below this a number is rounding. */
const ROUNDING = 1e-8;

const isNear = (a, b, tie) => Math.abs(a - b) <= Math.max(ROUNDING, tie * Math.max(Math.abs(a), Math.abs(b)));

/** Two trees with the same keys and texts, and numbers that are near each other. */
function expectNear(own, native, tie, name) {
  if (typeof own === 'number' && typeof native === 'number') {
    assert.ok(isNear(own, native, tie), `${name}: ${own} here, ${native} by the native program`);
  } else if (own && native && typeof own === 'object') {
    assert.deepEqual(Object.keys(own), Object.keys(native), name);
    Object.keys(own).forEach((key) => expectNear(own[key], native[key], tie, `${name}.${key}`));
  } else {
    assert.equal(own, native, name);
  }
}

/** Takes out of a report what is near the native one's, and how long it took. */
function takeInexact(report) {
  const inexact = { rigid: report.stability.rigid, shear: report.connections.map((one) => one.shear_n) };
  delete report.stability.rigid;
  delete report.solver.seconds;
  report.connections.forEach((one) => delete one.shear_n);
  return inexact;
}

function expectSameReport(own, native, name) {
  const [ownInexact, nativeInexact] = [takeInexact(own), takeInexact(native)];
  assert.deepEqual(own, withoutCommandLine(native), name);
  expectNear(ownInexact.rigid, nativeInexact.rigid, RIGID_TIE, `${name}: rigid`);
  expectNear(ownInexact.shear, nativeInexact.shear, SHEAR_TIE, `${name}: shear_n`);
}

async function expectNativeAnswers(files) {
  const native = nativeReports(files);
  assert.equal(native.length, files.length);
  let connections = 0;
  for (const [i, file] of files.entries()) {
    const name = path.basename(file, '.json');
    const text = await page.evaluate(
      ([source, title]) => globalThis.holdfast.reportOf(source, title),
      [readFileSync(file, 'utf8'), name],
    );
    const report = JSON.parse(text);
    expectSameReport(report, native[i], name);
    connections += report.connections.length;
  }
  return connections;
}

test('all scenarios have the same report, to the last digit', async () => {
  const folder = path.join(repository, 'scenarios');
  const files = readdirSync(folder).filter((name) => name.endsWith('.json'));
  assert.equal(files.length, 21);
  assert.ok((await expectNativeAnswers(files.map((name) => path.join(folder, name)))) > 250);
});

/** One holdfast JSON file for each structure; tests/reference/README.md has the format. */
function writeReferences(folder) {
  const lines = readFileSync(path.join(repository, 'tests/reference/structures.txt'), 'utf8').split('\n');
  const files = [];
  for (const [i, line] of lines.entries()) {
    const [keyword, name, existing] = line.split(' ');
    if (keyword === 'structure') {
      const cells = lines[i + 1].split(' ').map((cell) => cell.split(',').map(Number));
      const file = path.join(folder, `${name}.json`);
      const modules = cells.slice(0, Number(existing));
      const planned = cells.slice(Number(existing));
      writeFileSync(file, JSON.stringify({ format: 'holdfast-structure', version: 1, modules, planned }));
      files.push(file);
    }
  }
  return files;
}

test('all reference structures have the same report, to the last digit', async () => {
  const files = writeReferences(temporaryFolder());
  assert.equal(files.length, 220);
  assert.ok((await expectNativeAnswers(files)) > 5000);
  assert.deepEqual(page.faults, []);
});

test('the references of every lattice, support and load have the same report', async () => {
  const folder = temporaryFolder();
  const lines = readFileSync(path.join(repository, 'tests/reference/general.jsonl'), 'utf8').trim().split('\n');
  const files = lines.map((line) => {
    const { structure } = JSON.parse(line);
    const file = path.join(folder, `${structure.name}.json`);
    writeFileSync(file, JSON.stringify(structure));
    return file;
  });
  assert.ok(files.length >= 100);
  assert.ok((await expectNativeAnswers(files)) > 1000);
  assert.deepEqual(page.faults, []);
});

test('robots that multigrid solves have the same report, to the last digit', async () => {
  const folder = temporaryFolder();
  const sizes = { cube: 10, shell: 12, portal: 26, bridge: 14, growth: 1500 };
  const files = Object.entries(sizes).map(([family, size]) => {
    const file = path.join(folder, `${family}.json`);
    execFileSync(program, ['generate', family, String(size), '--output', file]);
    return file;
  });
  for (const report of nativeReports(files)) {
    assert.match(report.solver.name, /multigrid/, `${report.name}: ${report.solver.name}`);
  }
  assert.ok((await expectNativeAnswers(files)) > 5000);
  assert.deepEqual(page.faults, []);
});

/** In the order of agent::Method, whose numbers the page's choices have. */
const METHODS = ['polynomial', 'elimination'];

test('the robot finds out the same by every method, packet by packet', async () => {
  await openExample(page, 'arm_tips_a');
  assert.equal(await page.locator('#method option').count(), METHODS.length);
  for (const [number, method] of METHODS.entries()) {
    await page.selectOption('#method', String(number));
    await page.click('#simulate');
    await page.waitForFunction((name) => globalThis.holdfast.player.trace?.method === name, method);
    const own = await page.evaluate(() => globalThis.holdfast.player.trace);
    const native = nativeSimulation(scenario('arm_tips_a'), method);
    for (const key of ['verdict', 'method', 'messages', 'iterations', 'trace_hash', 'load_ratio_max']) {
      assert.equal(own[key], native[key], `${method}: ${key}`);
    }
  }
  assert.deepEqual(page.faults, []);
});
