// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// How the robot is looked at: sides, cuts, through its modules, before an audience.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { cube, dropFile, launch, openExample, openPage, pixels, settled, verdict } from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

async function openCube(n) {
  const page = await openPage(browser, { viewport: { width: 1200, height: 800 } });
  await dropFile(page, 'cube.json', cube(n));
  await page.waitForFunction((count) => globalThis.holdfast.bench.robot.count === count, n ** 3);
  await settled(page);
  return page;
}

/** What is in the middle of the picture. */
async function pointed(page) {
  const { x, y } = await page.evaluate(() => {
    const { stage } = globalThis.holdfast.app;
    const at = stage.project(stage.controls.target);
    const box = stage.canvas.getBoundingClientRect();
    return { x: at.x + box.left + 3, y: at.y + box.top + 3 };
  });
  await page.mouse.move(x - 2, y);
  await page.mouse.move(x, y);
  await page.waitForSelector('#details .cell');
  return page.innerText('#details .cell');
}

async function cut(page, side, value) {
  await page.selectOption('#cut', side);
  await page.evaluate((at) => {
    const slider = document.getElementById('cut-at');
    slider.value = String(at);
    slider.dispatchEvent(new Event('input'));
  }, value);
  await settled(page);
}

test('a cut opens the robot, and what is behind it is pointed at', async () => {
  const page = await openCube(5);
  for (const [key, side, at, cell] of [
    ['9', 'above', 2, '(2,2,2)'], ['7', 'front', 1, '(2,1,2)'], ['8', 'right', 3, '(3,2,2)'], ['9', 'above', 2.75, '(2,2,2)'],
  ]) {
    await page.keyboard.press(key);
    await cut(page, side, at);
    assert.ok((await pointed(page)).startsWith(cell), `${side} ${at}: ${await page.innerText('#details .cell')}`);
    const shown = await page.evaluate(() => globalThis.holdfast.app.view.drawn.length);
    await page.selectOption('#cut', '');
    await settled(page);
    const whole = await page.evaluate(() => globalThis.holdfast.app.view.drawn.length);
    assert.equal(whole, 125 - 27, 'nobody sees the 27 within');
    assert.ok(shown < 125 && shown > 0);
  }
  assert.ok((await pointed(page)).startsWith('(2,2,4)'));
  assert.deepEqual(page.faults, []);
});

test('a cut hides as many modules as lie in front of it, in every lattice', async () => {
  const page = await openCube(3);
  for (const lattice of ['cubic', 'face-centred', 'hexagonal-prism']) {
    await page.evaluate((name) => globalThis.holdfast.bench.setLattice(name), lattice);
    await settled(page);
    for (const [side, axis, sense] of [['above', 2, 1], ['front', 1, -1], ['right', 0, 1]]) {
      await cut(page, side, 0.5);
      const [missing, expected] = await page.evaluate(
        ([k, sign]) => {
          const { bench, app } = globalThis.holdfast;
          const slots = Array.from({ length: bench.robot.count }, (_, slot) => slot);
          const before = slots.filter((slot) => sign * (bench.robot.placeAt(slot)[k] - 0.5) > 1e-6);
          return [before.filter((slot) => app.view.instances[slot] < 0).length, before.length];
        },
        [axis, sense],
      );
      assert.equal(missing, expected);
      assert.ok(expected > 0 && expected < 27);
    }
    await page.selectOption('#cut', '');
  }
  assert.deepEqual(page.faults, []);
});

test('through the modules each connection is seen in the colour of its load', async () => {
  const page = await openCube(3);
  await page.keyboard.press('x');
  await settled(page);
  const bars = () =>
    page.evaluate(() => {
      const { group } = globalThis.holdfast.app.view.bars;
      return group.visible ? group.children[0].count : 0;
    });
  assert.equal(await bars(), 54);
  await openExample(page, 'arm_breaks_b');
  await page.keyboard.press('7');
  await settled(page);
  const broken = await page.evaluate(() => {
    const { stage, view } = globalThis.holdfast.app;
    const at = stage.project(view.connectionPoint(view.worst));
    const box = stage.canvas.getBoundingClientRect();
    return { x: at.x + box.left, y: at.y + box.top };
  });
  const colours = await pixels(page, { x: broken.x - 2, y: broken.y - 2, width: 5, height: 5 });
  const red = colours.filter(([r, g, b]) => r > 150 && g < 90 && b < 90).length;
  assert.ok(red > 12, `${red} of 25 pixels are red`);
  // A robot in pieces has no bars between them, nor has one that is seen by losses.
  await page.click('#topple');
  await page.waitForFunction(() => globalThis.holdfast.app.isToppled);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  assert.equal(await bars(), 0);
  await page.keyboard.press('t');
  await page.keyboard.press('x');
  await settled(page);
  assert.equal(await bars(), 0);
  await page.evaluate(() => globalThis.holdfast.bench.setLattice('face-centred'));
  await page.keyboard.press('x');
  await settled(page);
  assert.deepEqual(page.faults, []);
});

test('keys and buttons look from a side at all of the robot', async () => {
  const page = await openCube(4);
  for (const [key, name, side] of [['7', 'front', [0, -1, 0]], ['8', 'right', [1, 0, 0]], ['9', 'top', [0, 0, 1]], ['6', 'oblique', [0.62, -0.62, 0.48]]]) {
    for (const act of [() => page.keyboard.press(key), () => page.click(`[data-from=${name}]`)]) {
      await page.evaluate(() => globalThis.holdfast.app.see([-1, 0.3, 0.2]));
      await act();
      await settled(page);
      const seen = await page.evaluate(() => {
        const { stage, bench } = { ...globalThis.holdfast, stage: globalThis.holdfast.app.stage };
        const { low, high } = bench.robot.bounds();
        return { side: stage.side.toArray(), holds: stage.holds(low, high) };
      });
      const size = Math.hypot(...side);
      side.forEach((value, k) => assert.ok(Math.abs(seen.side[k] - value / size) < 1e-3, `${name}: ${seen.side}`));
      assert.ok(seen.holds);
    }
  }
});

test('before an audience there is the picture alone, with large words, and a way back', async () => {
  const page = await openCube(2);
  const width = async () => (await page.locator('#verdict').boundingBox()).width;
  const before = await width();
  await page.keyboard.press('m');
  await settled(page);
  assert.ok((await width()) > 1.7 * before);
  assert.equal(await page.isVisible('aside'), false);
  assert.equal(await page.isVisible('#toolbar'), false);
  const { width: picture } = await page.locator('#canvas').boundingBox();
  assert.equal(picture, 1200);
  await page.click('#present-end');
  assert.equal(await page.isVisible('aside'), true);
  assert.equal(await page.getAttribute('#present', 'aria-pressed'), 'false');
  assert.equal(await width(), before);
});

/** Width in the picture of an edge of length one, at a cell. */
const edgeAt = (page, cell) =>
  page.evaluate((at) => {
    const { stage } = globalThis.holdfast.app;
    const point = (x) => stage.project(stage.controls.target.clone().fromArray([at[0] + x, at[1], at[2]]));
    return point(0.5).x - point(-0.5).x;
  }, cell);

test('orthographic: equal lengths are equal, and cuts and pointing are right in it, from every side', async () => {
  const page = await openCube(5);
  await page.keyboard.press('7');
  assert.ok((await edgeAt(page, [2, 0, 2])) > 1.05 * (await edgeAt(page, [2, 4, 2])), 'nearer is larger in perspective');
  const middle = await edgeAt(page, [2, 2, 2]);
  await page.keyboard.press('5');
  assert.equal(await page.getAttribute('#parallel', 'aria-pressed'), 'true');
  for (const y of [0, 2, 4]) {
    assert.ok(Math.abs((await edgeAt(page, [2, y, 2])) - middle) < 1e-6 * middle, `the same at ${y} as in the middle before`);
  }
  for (const [key, side, at, cell] of [['9', 'above', 2, '(2,2,2)'], ['7', 'front', 1, '(2,1,2)'], ['8', 'right', 3, '(3,2,2)']]) {
    await page.keyboard.press(key);
    await cut(page, side, at);
    assert.ok((await pointed(page)).startsWith(cell), `${side} ${at}: ${await page.innerText('#details .cell')}`);
    assert.ok(await page.evaluate(() => {
      const { low, high } = globalThis.holdfast.bench.robot.bounds();
      return globalThis.holdfast.app.stage.holds(low, high);
    }));
    await page.selectOption('#cut', '');
  }
  // A module far off, and one so near that the other camera is inside of the robot.
  for (const factor of [12, 0.02]) {
    await page.keyboard.press('6');
    await page.evaluate((share) => {
      const { camera, controls } = globalThis.holdfast.app.stage;
      camera.position.sub(controls.target).multiplyScalar(share).add(controls.target);
      controls.update();
    }, factor);
    await settled(page);
    assert.match(await pointed(page), /^\(\d,\d,\d\), existing/);
  }
  await page.keyboard.press('7');
  await page.keyboard.press('5');
  assert.ok((await edgeAt(page, [2, 0, 2])) > (await edgeAt(page, [2, 4, 2])));
  assert.deepEqual(page.faults, []);
});

test('orthographic: where a pixel is drawn is where it is pointed at, in every lattice', async () => {
  const page = await openCube(3);
  await page.keyboard.press('5');
  for (const lattice of ['cubic', 'face-centred', 'hexagonal', 'hexagonal-prism']) {
    await page.evaluate((name) => globalThis.holdfast.bench.setLattice(name), lattice);
    await settled(page);
    await page.keyboard.press('7');
    await settled(page);
    // Each module that is pointed at gets a rim of the pointer's colour: some pixels beside it change.
    const { x, y } = await page.evaluate(() => {
      const { app, bench } = globalThis.holdfast;
      const { robot } = bench;
      const front = Array.from({ length: robot.count }, (_, slot) => robot.placeAt(slot)).sort((a, b) => a[1] - b[1])[0];
      const at = app.stage.project(app.stage.controls.target.clone().fromArray(front));
      const box = app.stage.canvas.getBoundingClientRect();
      return { x: at.x + box.left, y: at.y + box.top };
    });
    await page.keyboard.press('v');
    await page.mouse.move(5, 300);
    await settled(page);
    const area = { x: x - 60, y: y - 60, width: 120, height: 120 };
    const before = await pixels(page, area);
    await page.mouse.move(x, y);
    await page.waitForSelector('#details .cell');
    await page.evaluate(() => (document.getElementById('details').style.visibility = 'hidden'));
    await settled(page);
    const after = await pixels(page, area);
    await page.evaluate(() => (document.getElementById('details').style.visibility = ''));
    const changed = after.flatMap((rgb, i) => (rgb.some((value, k) => Math.abs(value - before[i][k]) > 8) ? [[i % 120, Math.floor(i / 120)]] : []));
    assert.ok(changed.length > 100, `${lattice}: ${changed.length} pixels change`);
    const mean = [0, 1].map((k) => changed.reduce((sum, one) => sum + one[k], 0) / changed.length);
    mean.forEach((value) => assert.ok(Math.abs(value - 60) < 12, `${lattice}: around ${mean}`));
  }
  assert.deepEqual(page.faults, []);
});

test('a theme that was chosen holds against the system’s, in the picture too, and is remembered', async () => {
  const page = await openPage(browser, { viewport: { width: 1200, height: 800 }, colorScheme: 'light' });
  const paper = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const ink = () => page.evaluate(() => globalThis.holdfast.app.scenery.ground.colours.mass);
  const light = [await paper(), await ink()];
  await page.selectOption('#theme', 'dark');
  const dark = [await paper(), await ink()];
  assert.notDeepEqual(dark, light);
  await page.keyboard.press('5');
  await page.reload();
  await page.waitForSelector('html.ready');
  await settled(page);
  assert.deepEqual([await paper(), await ink()], dark);
  assert.equal(await page.inputValue('#theme'), 'dark');
  assert.equal(await page.evaluate(() => globalThis.holdfast.app.stage.isParallel), true);
  await page.emulateMedia({ colorScheme: 'dark' });
  await page.selectOption('#theme', 'light');
  assert.deepEqual([await paper(), await ink()], light);
  await page.selectOption('#theme', 'system');
  assert.deepEqual([await paper(), await ink()], dark, 'the system is dark now');
  await page.emulateMedia({ colorScheme: 'light' });
  await settled(page);
  assert.deepEqual([await paper(), await ink()], light);
  assert.deepEqual(page.faults, []);
});

test('?embed shows the picture and its verdict, and a way to the whole page', async () => {
  const page = await openPage(browser, { fragment: '?embed', viewport: { width: 480, height: 320 } });
  for (const part of ['.bar', 'aside', '#toolbar', '#hint']) {
    assert.ok(await page.isHidden(part), part);
  }
  assert.equal(await page.isVisible('#verdict'), true);
  assert.equal(await verdict(page), 'safe');
  const canvas = await page.locator('#canvas').boundingBox();
  assert.deepEqual([canvas.width, canvas.height], [480, 320]);
  const before = await page.evaluate(() => globalThis.holdfast.bench.robot.count);
  await page.mouse.click(240, 180);
  assert.equal(await page.evaluate(() => globalThis.holdfast.bench.robot.count), before, 'a click only looks');
  const href = await page.getAttribute('#embed-open', 'href');
  assert.ok(href.startsWith('file:') && !href.includes('embed'));
  assert.deepEqual(page.faults, []);
});
