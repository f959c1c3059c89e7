// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The page's answers are the native program's: every number of the report to the last digit, for all
// scenarios, for the 320 structures of tests/reference and for robots that multigrid solves. Only the
// shear force and the numbers of a rigid body's margins and motion, which are part of no verdict, come from
// the C library's hypot and atan2 and from sums whose order is Eigen's, which may differ in that digit. And what a robot finds out by itself is the same, packet by packet.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { launch, nativeReports, nativeSimulation, openExample, openPage, program, repository, scenario, temporaryFolder } from './browser.mjs';

let browser;
let page;
before(async () => {
  browser = await launch();
  page = await openPage(browser);
});
after(() => browser.close());

/** All numbers in it with so many digits, and those that are rounding as 0. */
const rounded = (value) =>
  typeof value === 'number' ? Number((Math.abs(value) < 1e-9 ? 0 : value).toPrecision(6))
  : value && typeof value === 'object' ? Object.fromEntries(Object.entries(value).map(([key, one]) => [key, rounded(one)]))
  : value;

/** Without how long it took, and with digits that neither the C library nor Eigen touch. */
function comparable(report) {
  delete report.solver.seconds;
  report.stability.rigid = rounded(report.stability.rigid);
  for (const connection of report.connections) {
    connection.shear_n = connection.shear_n.toPrecision(12);
  }
  return report;
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
    assert.deepEqual(comparable(report), comparable(native[i]), name);
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
const METHODS = ['jacobi', 'block-jacobi', 'cg', 'polynomial', 'elimination'];

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
