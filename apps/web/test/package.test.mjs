// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The package that ./dev npm makes, installed in a fresh folder, against the program.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';

const repository = fileURLToPath(new URL('../../../', import.meta.url));
const built = join(repository, 'build/npm');
const scenarios = join(repository, 'scenarios');
let folder;
let holdfast;
let HoldfastError;

const program = (...args) => spawnSync(join(repository, 'build/release/holdfast'), args, { encoding: 'utf8' });
const scenario = (name) => readFileSync(join(scenarios, name), 'utf8');

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'holdfast-package-'));
  const [archive] = readdirSync(built).filter((name) => name.endsWith('.tgz'));
  writeFileSync(join(folder, 'package.json'), '{"private": true, "type": "module"}');
  execFileSync('npm', ['install', '--offline', '--no-audit', '--no-fund', join(built, archive)], { cwd: folder });
  const entry = pathToFileURL(join(folder, 'node_modules/holdfast/index.js')).href;
  const loaded = await import(entry);
  HoldfastError = loaded.HoldfastError;
  holdfast = await loaded.load();
});

after(() => rmSync(folder, { recursive: true }));

test('its reports are those of the program', () => {
  const names = readdirSync(scenarios).filter((name) => name.endsWith('.json'));
  assert.ok(names.length > 20);
  for (const name of names) {
    const theirs = JSON.parse(program('check', '--json', '-', join(scenarios, name)).stdout);
    const ours = holdfast.check(scenario(name));
    assert.equal(ours.verdict, theirs.verdict, name);
    assert.equal(ours.connections.length, theirs.connections.length, name);
    for (const [i, connection] of ours.connections.entries()) {
      assert.deepEqual([connection.a, connection.b], [theirs.connections[i].a, theirs.connections[i].b], name);
      const limit = 1e-9 * Math.max(1, theirs.connections[i].load_ratio);
      assert.ok(Math.abs(connection.load_ratio - theirs.connections[i].load_ratio) < limit, name);
    }
  }
});

test('cells, objects, texts and bytes are structures', () => {
  const cells = [[0, 0, 0], [0, 0, 1], [1, 0, 1]];
  const whole = { format: 'holdfast-structure', version: 1, support_z: 0, modules: cells };
  const text = JSON.stringify(whole);
  const ratio = holdfast.check(cells).overload.load_ratio_max;
  assert.ok(ratio > 0);
  for (const structure of [whole, text, new TextEncoder().encode(text), holdfast.convert(whole, 'xml')]) {
    assert.equal(holdfast.check(structure).overload.load_ratio_max, ratio);
  }
});

test('cells are tried as next does', () => {
  const name = 'arm_breaks_a.json';
  const { candidates } = JSON.parse(program('next', '--json', '-', join(scenarios, name)).stdout);
  const tried = holdfast.tryCells(scenario(name), candidates.map(({ cell }) => cell));
  assert.ok(candidates.length > 10);
  for (const [i, candidate] of candidates.entries()) {
    assert.deepEqual(tried[i].cell, candidate.cell);
    assert.equal(tried[i].verdict, candidate.verdict);
    if (candidate.load_ratio_max !== null) {
      assert.ok(Math.abs(tried[i].load_ratio_max - candidate.load_ratio_max) < 1e-8);
    }
  }
  assert.equal(holdfast.tryCells(scenario(name), [[50, 50, 50]])[0].verdict, null);
});

test('an order is found, its steps are safe, a picture is drawn', () => {
  const stairs = [[0, 0, 0], [1, 0, 0], [1, 0, 1], [2, 0, 0], [2, 0, 1], [2, 0, 2]];
  const { outcome, structure } = holdfast.order(stairs);
  assert.equal(outcome, 'found');
  const judged = holdfast.steps(structure);
  assert.equal(judged.verdict, 'safe');
  assert.equal(judged.steps.length, stairs.length - 1);
  assert.match(holdfast.picture(stairs), /^<svg|^<\?xml/);
  assert.match(holdfast.text(stairs), /^robot: safe/);
  const arm = join(scenarios, 'arm_breaks_a.json');
  const asked = program('check', '--limit', '--lose-one', '--json', '-', arm).stdout;
  const { limit_load_factor: factor, lose_one: losses } = JSON.parse(asked);
  assert.ok(Math.abs(holdfast.limitLoad(scenario('arm_breaks_a.json')).factor - factor) < 1e-6);
  assert.ok(holdfast.reliability(scenario('arm_breaks_a.json'), 0.1).holds < 1);
  const lost = holdfast.loseOne(scenario('arm_breaks_a.json')).lose_one;
  assert.equal(lost.holds_all, losses.holds_all);
  assert.deepEqual(lost.fatal, losses.fatal);
});

test('what is wrong is thrown, and the next call is answered', () => {
  assert.throws(() => holdfast.check([[0, 0, 0], [0, 0]]), HoldfastError);
  assert.throws(() => holdfast.check([[0, 0, 0], [5, 0, 0]]), /connected/);
  assert.throws(() => holdfast.check('{"format": '), HoldfastError);
  assert.equal(holdfast.check([[0, 0, 0]]).verdict, 'safe');
});

test('types are those of a strict program, and the archive has what it needs', () => {
  writeFileSync(join(folder, 'use.ts'), `
import { load, HoldfastError, type Cell, type CheckReport, type TriedCell } from 'holdfast';
const holdfast = await load();
const cells: Cell[] = [[0, 0, 0], [0, 0, 1]];
const report: CheckReport = holdfast.check(cells);
const ratio: number | null = report.connections[0].load_ratio;
const tried: TriedCell[] = holdfast.tryCells(cells, cells);
const order: 'found' | 'none' | 'not-found' = holdfast.order(cells, 5).outcome;
try {
  holdfast.check('');
} catch (error) {
  if (error instanceof HoldfastError) {
    export_(error.message, ratio, tried, order);
  }
}
// @ts-expect-error A format that there is not.
holdfast.convert(cells, 'pdf');
function export_(...values: unknown[]): void {
  console.log(values.length);
}
`);
  const tsc = fileURLToPath(new URL('../node_modules/.bin/tsc', import.meta.url));
  const options = ['--strict', '--module', 'nodenext', '--target', 'es2022', '--lib', 'es2022,dom', '--noEmit', '--types', ''];
  const checked = spawnSync(tsc, [...options, 'use.ts'], { cwd: folder, encoding: 'utf8' });
  assert.equal(checked.status, 0, checked.stdout);
  const about = JSON.parse(readFileSync(join(folder, 'node_modules/holdfast/package.json'), 'utf8'));
  assert.equal(`holdfast ${about.version}`, program('--version').stdout.trim());
  const [archive] = readdirSync(built).filter((name) => name.endsWith('.tgz'));
  assert.ok(statSync(join(built, archive)).size < 2e6);
});
