// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Building as a user does: the verdict changes exactly where the mechanics say.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { clickFace, count, facePoint, figures, roleOf, launch, openExample, openPage, settled, verdict } from './browser.mjs';

const UP = [0, 0, 1];
const RIGHT = [1, 0, 0];
const FRONT = [0, -1, 0];

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

test('an arm breaks with its fifth module, as statics say', async () => {
  // A fixed foot, a module on it, and a row of n modules at its side. With w the weight of a module, the
  // row's first connection bends by w L n^2 / 2 in its middle, the post's by w L n (n + 1) / 2 under
  // a pressure of (n + 1) w: shares n^2 w / 14.97 N and (n^2 - 1) w / 11.98 N of their strengths.
  const weight = 0.06106 * 9.81;
  const page = await openPage(browser);
  assert.ok(await page.isDisabled('#undo'), 'nothing was done yet');
  await page.click('#new');
  await page.click('#roles button >> text=Fixed');
  await page.mouse.click(400, 320);
  await settled(page);
  assert.equal(await count(page), 1);
  const [x, y, z] = await page.evaluate(() => globalThis.holdfast.bench.robot.cellAt(0));
  assert.equal(await roleOf(page, [x, y, z]), 2);
  await page.click('#roles button >> text=Existing');
  await clickFace(page, [x, y, z], UP);
  for (let n = 1; n <= 5; ++n) {
    await page.click('#fit');
    await clickFace(page, [x + n - 1, y, z + 1], RIGHT);
    assert.equal(await count(page), n + 2);
    const ratio = Math.max((n * n * weight) / 14.97, ((n * n - 1) * weight) / 11.98);
    const shown = Number(/Largest load\s+([\d.]+)/.exec(await figures(page))[1]);
    assert.ok(Math.abs(shown - ratio) < 6e-4, `${n}: ${shown}, expected ${ratio}`);
    assert.equal(await verdict(page), ratio < 1 ? 'safe' : 'overload', `${n} modules`);
  }
  await page.click('#undo');
  await settled(page);
  assert.equal(await verdict(page), 'safe');
  await page.keyboard.press('Control+y');
  await settled(page);
  assert.equal(await verdict(page), 'overload');
  assert.deepEqual(page.faults, []);
});

test('one more module topples the arm of test 1, without it the arm stands', async () => {
  const page = await openPage(browser);
  await openExample(page, 'arm_tips_a');
  assert.equal(await verdict(page), 'safe');
  assert.match(await figures(page), /Margin\s+6\.67 mm/);
  const tip = await page.evaluate(() => {
    const { robot } = globalThis.holdfast.bench;
    return Array.from({ length: robot.count }, (_, i) => robot.cellAt(i)).sort((a, b) => b[0] - a[0])[0];
  });
  await page.click('#roles button >> text=Planned');
  await clickFace(page, tip, RIGHT);
  assert.equal(await verdict(page), 'unstable');
  assert.match(await figures(page), /Margin\s+-8\.00 mm/);
  assert.ok(await page.isVisible('#topple'));
  await page.click('#tools button[aria-label=Remove]');
  await clickFace(page, [tip[0] + 1, tip[1], tip[2]], UP);
  assert.equal(await verdict(page), 'safe');
  assert.deepEqual(page.faults, []);
});

test('a drag draws a row, a stroke paints, and undo takes each back as one', async () => {
  const page = await openPage(browser);
  await page.click('#new');
  await page.mouse.click(400, 300);
  await settled(page);
  const [x, y, z] = await page.evaluate(() => globalThis.holdfast.bench.robot.cellAt(0));
  const from = await facePoint(page, [x, y, z], UP);
  const to = await facePoint(page, [x, y, z], UP, 3);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 8 });
  await page.mouse.up();
  await settled(page);
  assert.equal(await count(page), 4);
  await page.click('#fit');
  await page.keyboard.press('p');
  await page.keyboard.press('2');
  const low = await facePoint(page, [x, y, z + 2], FRONT);
  const high = await facePoint(page, [x, y, z + 3], FRONT);
  await page.mouse.move(low.x, low.y);
  await page.mouse.down();
  await page.mouse.move(high.x, high.y, { steps: 8 });
  await page.mouse.up();
  await settled(page);
  assert.deepEqual([await roleOf(page, [x, y, z + 2]), await roleOf(page, [x, y, z + 3])], [1, 1]);
  assert.equal(await roleOf(page, [x, y, z + 1]), 0);
  await page.click('#undo');
  assert.equal(await roleOf(page, [x, y, z + 2]), 0);
  await page.click('#undo');
  assert.equal(await count(page), 1);
  assert.deepEqual(page.faults, []);
});

test('everything can be built with keys alone', async () => {
  const page = await openPage(browser);
  await page.click('#new');
  await page.focus('#canvas');
  await page.keyboard.press('3');
  await page.keyboard.press('Enter'); // the cursor appears
  await page.keyboard.press('Enter');
  await page.keyboard.press('1');
  for (let i = 0; i < 3; ++i) {
    await page.keyboard.press('Shift+ArrowRight');
  }
  await settled(page);
  assert.equal(await count(page), 4);
  assert.equal(await verdict(page), 'safe');
  assert.match(await page.textContent('#spoken'), /existing/);
  await page.keyboard.press('Delete');
  await page.keyboard.press('Control+z');
  await settled(page);
  assert.equal(await count(page), 4);
  assert.deepEqual(page.faults, []);
});

test('fingers build too: a tap attaches', async () => {
  const page = await openPage(browser, { viewport: { width: 390, height: 780 }, hasTouch: true });
  await openExample(page, 'arm_tips_a');
  const before = await count(page);
  const { x, y } = await facePoint(page, [1, 1, 2], UP);
  await page.touchscreen.tap(x, y);
  await settled(page);
  assert.equal(await count(page), before + 1);
  assert.deepEqual(page.faults, []);
});

test('free faces are tinted by what would come of a module there', async () => {
  const page = await openPage(browser);
  await openExample(page, 'arm_breaks_a');
  await page.click('#roles button >> text=Planned');
  await page.click('#faces');
  await page.waitForFunction(() => /free places are safe/.test(document.getElementById('spoken').textContent));
  const known = await page.evaluate(() => {
    const { app, bench } = globalThis.holdfast;
    const at = (place) => app.whereNext.places.known(place, 1).verdict;
    return { count: bench.robot.freePlaces().length, beyondTip: at([7, 1, 2]), foot: at([0, 1, 0]) };
  });
  // (7,1,2) makes the free arm of test 4 five modules long, and its root then
  // carries 25 M g / Fmax = 25 x 0.04001 of its strength.
  assert.deepEqual([known.beyondTip, known.foot], ['overload', 'safe']);
  assert.ok(known.count > 30);
  assert.deepEqual(page.faults, []);
});

test('what is shown first holds; one more module, where the page asks for it, breaks it', async () => {
  const page = await openPage(browser, { fragment: '' });
  assert.equal(await verdict(page), 'safe');
  assert.match(await page.innerText('#hint'), /^Will it hold one more\?/);
  const tip = await page.evaluate(() => {
    const { robot } = globalThis.holdfast.bench;
    return Array.from({ length: robot.count }, (_, i) => robot.cellAt(i)).sort((a, b) => b[0] - a[0])[0];
  });
  await clickFace(page, tip, RIGHT);
  assert.equal(await verdict(page), 'overload');
  assert.ok(await page.isHidden('#hint'));
  await page.click('#undo');
  await settled(page);
  assert.equal(await verdict(page), 'safe');
  assert.deepEqual(page.faults, []);
});
