// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What is taken away to be seen elsewhere: glTF, GIF, paper; each read by another program.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { Box3 } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { launch, openExample, openPage, settled } from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

async function save(page, what) {
  await page.click('#save');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click(`[data-save=${what}]`)]);
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
}

async function readGlb(bytes) {
  const { scene } = await new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
  scene.updateMatrixWorld(true);
  const meshes = [];
  scene.traverse((node) => node.isMesh && meshes.push(node));
  return { meshes, box: new Box3().setFromObject(scene) };
}

test('a glTF model has a node for each module that is seen, in metres, y up, in the colours of the loads', async () => {
  const page = await openPage(browser, { viewport: { width: 1000, height: 700 } });
  const { name, bytes } = await save(page, 'glb');
  assert.equal(name, 'arm_breaks_b.glb');
  const { meshes, box } = await readGlb(bytes);
  const { count, low, high } = await page.evaluate(() => {
    const { robot } = globalThis.holdfast.bench;
    return { count: robot.count, ...robot.bounds() };
  });
  assert.equal(meshes.length, count);
  const m = (cells) => 0.04 * cells;
  // y is up, and what was y comes towards the eye.
  const expected = [[low[0] - 0.5, high[0] + 0.5], [low[2] - 0.5, high[2] + 0.5], [-high[1] - 0.5, -low[1] + 0.5]];
  ['x', 'y', 'z'].forEach((axis, k) => {
    assert.ok(Math.abs(box.min[axis] - m(expected[k][0])) < 1e-6, `${axis}: ${box.min[axis]}`);
    assert.ok(Math.abs(box.max[axis] - m(expected[k][1])) < 1e-6, `${axis}: ${box.max[axis]}`);
  });
  // Both modules of the connection that breaks are red, no other is.
  const red = meshes.filter(({ material: { color } }) => color.getHex() === 0xd6202b).map(({ name: text }) => text.replace(/[^\d]/g, ''));
  assert.deepEqual(red.sort(), ['212', '312']);
  assert.deepEqual(page.faults, []);
});

test('spheres, discs, prisms and obstacles are in the model too', async () => {
  const page = await openPage(browser, { viewport: { width: 1000, height: 700 } });
  for (const [example, extra] of [['catom_pyramid', 0], ['disc_arch', 0], ['prism_wall', 1], ['slot', 1]]) {
    await openExample(page, example);
    const { meshes } = await readGlb((await save(page, 'glb')).bytes);
    const drawn = await page.evaluate(() => globalThis.holdfast.app.view.drawn.length);
    assert.equal(meshes.length, drawn + extra, example);
    meshes.forEach(({ geometry }) => {
      assert.ok(geometry.attributes.position.count > 7 && geometry.attributes.normal, example);
      assert.ok(geometry.attributes.position.array.every(Number.isFinite));
    });
  }
  assert.deepEqual(page.faults, []);
});

/** The frames of a GIF as the browser reads it: size, durations in ms, and how much neighbours differ. */
const readGif = (page, bytes) =>
  page.evaluate(async (base64) => {
    const data = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const decoder = new ImageDecoder({ data, type: 'image/gif' });
    await decoder.completed;
    await decoder.tracks.ready;
    const frames = [];
    let before;
    for (let i = 0; i < decoder.tracks.selectedTrack.frameCount; ++i) {
      const { image } = await decoder.decode({ frameIndex: i });
      const canvas = new OffscreenCanvas(image.displayWidth, image.displayHeight);
      const context = canvas.getContext('2d');
      context.drawImage(image, 0, 0);
      const { data: pixels } = context.getImageData(0, 0, canvas.width, canvas.height);
      const changed = before ? pixels.reduce((sum, value, k) => sum + (Math.abs(value - before[k]) > 24 ? 1 : 0), 0) : 0;
      frames.push({ width: canvas.width, height: canvas.height, ms: image.duration / 1000, changed });
      before = pixels;
    }
    return { frames, repeats: decoder.tracks.selectedTrack.repetitionCount };
  }, bytes.toString('base64'));

test('a GIF of a fall moves to its end and goes round', async () => {
  const page = await openPage(browser, { viewport: { width: 1000, height: 700 }, reducedMotion: 'no-preference' });
  const { name, bytes } = await save(page, 'gif');
  assert.equal(name, 'arm_breaks_b.gif');
  const { frames, repeats } = await readGif(page, bytes);
  assert.equal(repeats, Infinity);
  assert.ok(frames.length > 15, `${frames.length} frames`);
  assert.ok(frames.every(({ width }) => width === 640));
  // In the middle it moves; in hundredths of seconds frames last as the moments do.
  const moving = frames.filter(({ changed }) => changed > 500).length;
  assert.ok(moving > 6, `${moving} of ${frames.length} frames move: ${frames.map(({ changed }) => changed)}`);
  assert.ok(frames.slice(1, -1).every(({ ms }) => Math.abs(ms - 70) < 1) && frames[0].ms === 700 && frames.at(-1).ms === 1500);
  const seconds = await page.evaluate(() => globalThis.holdfast.app.toppling.pieces.seconds);
  assert.equal(frames.length, 1 + Math.ceil(seconds / (0.07 / 4)), `${seconds} s`);
  assert.deepEqual(page.faults, []);
});

test('a GIF of steps has every stage; where nothing moves it is said', async () => {
  const page = await openPage(browser, { viewport: { width: 1000, height: 700 } });
  await openExample(page, 'arm_tips_a');
  await page.click('#judge-steps');
  await page.waitForSelector('#sequence:not([hidden])');
  await page.click('#stage-on');
  const { frames } = await readGif(page, (await save(page, 'gif')).bytes);
  assert.equal(frames.length, 1 + Number(await page.getAttribute('#stage-slider', 'max')));
  assert.ok(frames.some(({ changed }) => changed > 500));
  await page.click('#build-on');
  await openExample(page, 'tree');
  await page.click('#save');
  await page.click('[data-save=gif]');
  assert.match(await page.innerText('.message.error'), /nothing moves/);
  assert.deepEqual(page.faults, []);
});

test('on paper it is one page, in light, with the picture', async () => {
  const page = await openPage(browser, { viewport: { width: 1200, height: 800 }, colorScheme: 'dark' });
  await page.waitForSelector('#why-list li');
  for (const name of ['arm_breaks_b', 'scaffold', 'tree']) {
    await openExample(page, name);
    for (const format of ['A4', 'Letter']) {
      const pdf = (await page.pdf({ format, printBackground: true })).toString('latin1');
      assert.equal(pdf.match(/\/Type\s*\/Page\b/g).length, 1, `${name}, ${format}`);
    }
  }
  const { paper, dark } = await page.evaluate(() => {
    dispatchEvent(new Event('beforeprint'));
    const canvas = document.querySelector('#printed canvas');
    const [red] = canvas.getContext('2d').getImageData(2, 2, 1, 1).data;
    dispatchEvent(new Event('afterprint'));
    return { paper: red, dark: getComputedStyle(document.body).backgroundColor };
  });
  assert.ok(paper > 240, `the poster's ground is ${paper}`);
  assert.equal(dark, 'rgb(21, 24, 27)', 'the page is dark again');
  assert.equal(await page.locator('#printed canvas').count(), 0);
  await settled(page);
  assert.deepEqual(page.faults, []);
});
