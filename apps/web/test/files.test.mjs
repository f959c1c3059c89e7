// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Structures in and out: files good and bad, links, what holdfast view writes. Nothing that fails
// may touch the robot on the page.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import {
  clickFace, count, dropFile, launch, message, nativeReports, openExample, openPage, program, scenario, settled,
  temporaryFolder, verdict,
} from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const XML = `<parameters globalSupportZ="0" />
<world gridSize="9,9,9"><blockList color="100,100,100">
<block position="1,1,0" color="10,20,30" /><block position="1,1,1" /><block position="2,1,0" /><block position="2,1,1" centroid="1" />
</blockList><targetList><target format="grid"><cell position="3,1,1" /></target></targetList></world>`;

async function takeAway(page, what) {
  await page.click('#save');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click(`[data-save=${what}]`)]);
  return readFileSync(await download.path());
}

test('VisibleSim XML is dropped, changed and taken away as XML and JSON without loss', async () => {
  const page = await openPage(browser);
  await dropFile(page, 'small.xml', XML);
  await page.waitForFunction(() => globalThis.holdfast.bench.robot.name === 'small');
  await settled(page);
  assert.equal(await verdict(page), 'safe');
  await clickFace(page, [1, 1, 1], [0, -1, 0]);
  const xml = (await takeAway(page, 'xml')).toString();
  assert.match(xml, /position="1,1,0"[^>]*color="10,20,30"/);
  assert.match(xml, /position="2,1,1"[^>]*centroid="1"/);
  assert.match(xml, /position="1,0,1"/);
  const json = JSON.parse(await takeAway(page, 'json'));
  assert.equal(json.modules.length, 5);
  assert.deepEqual(json.planned, [[3, 1, 1]]);
  assert.deepEqual(page.faults, []);
});

test('a mass of a module’s own stays when the material changes, even if it was the material’s', async () => {
  const page = await openPage(browser);
  const modules = [[0, 0, 0], [0, 0, 1], { cell: [1, 0, 1], mass_kg: 0.06106 }];
  const file = { format: 'holdfast-structure', version: 2, name: 'own', modules };
  await dropFile(page, 'own.json', JSON.stringify(file));
  await page.waitForFunction(() => globalThis.holdfast.bench.robot.name === 'own');
  assert.deepEqual(JSON.parse(await takeAway(page, 'json')).modules, modules, 'as it was opened');
  await page.evaluate(() => {
    const { bench } = globalThis.holdfast;
    bench.history.configure('heavier', { material: bench.robot.material.map((old, i) => (i === 8 ? 0.07 : old)) });
  });
  await settled(page);
  const changed = JSON.parse(await takeAway(page, 'json'));
  assert.deepEqual(changed.material, { mass_kg: 0.07 });
  assert.deepEqual(changed.modules, modules);
  assert.deepEqual(page.faults, []);
});

test('a bad file is refused in words and the robot stays', async () => {
  const page = await openPage(browser);
  await openExample(page, 'crane_tips_a');
  const before = await count(page);
  const noise = String.fromCharCode(...Array.from({ length: 4000 }, (_, i) => 33 + ((i * 7919) % 90)));
  const bad = [
    ['noise.xml', noise, /noise\.xml|expected/],
    ['empty.json', '', /found an empty input/],
    ['cut.json', '{"format": "holdfast-structure", "version": 1, "modules": [[0,0', /line 1/],
    ['future.json', '{"format": "holdfast-structure", "version": 99, "modules": [[0,0,0]]}', /version/],
    ['merge.xml', `<<<<<<< HEAD\n${XML}\n=======\n>>>>>>> other`, /merge/],
    ['far.json', '{"format":"holdfast-structure","version":1,"modules":[[0,0,0],[900000,0,0]]}', /100000 cells/],
  ];
  for (const [name, text, words] of bad) {
    await dropFile(page, name, text);
    const said = await message(page);
    assert.ok(said.startsWith(`${name}: `), said);
    assert.match(said, words);
    await page.click('.message .close');
    assert.equal(await count(page), before);
    assert.equal(await verdict(page), 'safe');
  }
  assert.deepEqual(page.faults, []);
});

test('a file that is too large is refused before it is read', async () => {
  const page = await openPage(browser);
  await page.evaluate(() => {
    const data = new DataTransfer();
    const file = new File(['x'], 'huge.xml');
    Object.defineProperty(file, 'size', { value: 300 << 20 });
    Object.defineProperty(data, 'files', { value: [file] });
    window.dispatchEvent(new DragEvent('drop', { dataTransfer: data, cancelable: true }));
    const event = new DragEvent('drop', { cancelable: true });
    Object.defineProperty(event, 'dataTransfer', { value: { files: [file] } });
    window.dispatchEvent(event);
  });
  assert.match(await message(page), /huge\.xml: 300 MiB, this page reads at most 256/);
  assert.equal(await count(page), 13);
});

test('cells that are no robot are said to be none, and undo brings the robot back', async () => {
  const page = await openPage(browser);
  await dropFile(page, 'two.json', '{"format":"holdfast-structure","version":1,"modules":[[0,0,0],[5,0,0]]}');
  await page.waitForFunction(() => globalThis.holdfast.bench.robot.name === 'two');
  await settled(page);
  assert.equal(await page.innerText('#verdict-word'), 'No answer');
  assert.match(await page.innerText('#verdict-reason'), /connect|pieces|parts/);
  await page.click('#undo');
  await settled(page);
  assert.equal(await verdict(page), 'overload');
});

test('a link holds the whole structure; a broken one is said to be broken', async () => {
  const page = await openPage(browser, { fragment: '' });
  await openExample(page, 'angle_breaks_b');
  await page.click('#save');
  await page.click('[data-save=link]');
  await page.waitForFunction(() => location.hash.startsWith('#s='));
  const fragment = await page.evaluate(() => location.hash);
  assert.ok(fragment.length < 1500, `${fragment.length} letters for 29 modules`);
  const other = await openPage(browser, { fragment });
  assert.equal(await count(other), 29);
  assert.equal(await verdict(other), 'overload');
  // The robot is its own mirror image: two connections carry the same.
  assert.match(
    await other.innerText('#figures'), /1\.209 (\(7,2,2\)-\(7,2,3\)|\(2,7,2\)-\(2,7,3\))/);
  const broken = await openPage(browser, { fragment: fragment.slice(0, 60) });
  assert.match(await message(broken), /the link is broken/);
  assert.equal(await count(broken), 11, 'the first example is there instead');
  assert.deepEqual([...page.faults, ...other.faults], []);
});

test('pictures and the report are taken away', async () => {
  const page = await openPage(browser);
  assert.match((await takeAway(page, 'svg')).toString(), /^<svg[\s\S]*OVERLOAD[\s\S]*<\/svg>/);
  const png = await takeAway(page, 'png');
  assert.deepEqual([...png.subarray(1, 4)], [...Buffer.from('PNG')]);
  assert.ok(png.length > 5000, 'the picture is not empty');
  await page.click('#save');
  await page.click('[data-save=report]');
  await page.waitForSelector('#report[open]');
  assert.match(await page.innerText('#report-text'), /load ratio +1\.2004 +\(2,1,2\)-\(3,1,2\)/);
  assert.deepEqual(page.faults, []);
});

test('what holdfast view and check --html write needs nothing but itself', async () => {
  const folder = temporaryFolder();
  const viewed = path.join(folder, 'view.html');
  execFileSync(program, ['view', scenario('crane_tips_b'), '--no-open', '--out', viewed]);
  const page = await openPage(browser, { file: viewed });
  assert.equal(await page.title(), 'crane_tips_b - holdfast');
  assert.equal(await verdict(page), 'unstable');
  assert.deepEqual(page.faults, []);
  const checked = path.join(folder, 'check.html');
  const [native] = nativeReports([scenario('angle_breaks_a')]);
  execFileSync(program, ['check', '--quiet', scenario('angle_breaks_a'), '--html', checked]);
  const report = await openPage(browser, { file: checked });
  assert.match(await report.innerText('#report-text'), /load ratio +0\.8375/);
  await report.click('#report .close');
  assert.match(await report.innerText('#figures'), new RegExp(native.overload.load_ratio_max.toFixed(3)));
  assert.deepEqual(report.faults, []);
});

test('a name cannot smuggle a script into the page', async () => {
  const folder = temporaryFolder();
  const source = `{"format":"holdfast-structure","version":1,"name":"</script><script>document.title='broken'</script>","modules":[[0,0,0]]}`;
  const out = path.join(folder, 'evil.html');
  execFileSync(program, ['view', '-', '--no-open', '--out', out], { input: source });
  const page = await openPage(browser, { file: out });
  assert.match(await page.title(), /^<\/script>/);
  assert.equal(await verdict(page), 'safe');
  assert.deepEqual(page.faults, []);
});
