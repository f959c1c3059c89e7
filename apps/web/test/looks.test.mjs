// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What the page looks like and who can use it: accessibility, the gallery's pictures beside
// known-good ones, the policy, and the player.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { facePoint, launch, openExample, openPage, pageFile, pixels, repository, settled } from './browser.mjs';
import { pictureFile, takePicture } from './screenshot.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

async function expectAccessible(page, state) {
  // Through the debugger: the page's own policy lets no such script in.
  await page.evaluate(axe);
  const { violations, passes } = await page.evaluate(() => globalThis.axe.run());
  const list = violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(' | ').slice(0, 300)}`);
  assert.deepEqual(list, [], state);
  assert.ok(passes.length > 15, `${state}: ${passes.length} rules passed`);
}

for (const colorScheme of ['light', 'dark']) {
  for (const [name, viewport] of [['desktop', { width: 1280, height: 800 }], ['phone', { width: 390, height: 780 }]]) {
    test(`axe finds nothing to object to: ${name}, ${colorScheme}`, async () => {
      const page = await openPage(browser, { colorScheme, viewport });
      await expectAccessible(page, 'first sight');
      await page.evaluate(() => globalThis.holdfast.bench.use([globalThis.holdfast.bench.robot.freePlaces()[0]]));
      await page.click('#faces');
      await expectAccessible(page, 'where next');
      await page.waitForFunction(() => localStorage.length > 0);
      await page.click('#material-form summary');
      await page.click('#simulate');
      await page.waitForSelector('#player:not([hidden])');
      await expectAccessible(page, 'the player and the material');
      await page.evaluate(() => {
        const { bench } = globalThis.holdfast;
        bench.setLattice('face-centred');
        bench.surround('a wall', { obstacles: [{ from: [8, 0, 0], to: [8, 2, 2], hold: 'bonded' }] });
        bench.setTool('load');
      });
      await settled(page);
      await expectAccessible(page, 'spheres, an obstacle, the form of loads');
      await page.click('#tools button[aria-label=Obstacle]');
      await expectAccessible(page, 'the choice of how an obstacle holds');
      for (const [button, dialog] of [['#gallery-open', '#gallery'], ['#save', '#takeaway'], ['#help', '#keys']]) {
        await page.click(button);
        await expectAccessible(page, dialog);
        await page.click(`${dialog} .close`);
      }
      assert.equal(
        await page.evaluate(() => document.documentElement.scrollWidth > document.documentElement.clientWidth),
        false,
        'nothing sticks out',
      );
    });
  }
}

const COLUMNS = 20;
const ROWS = 12;

/** The robot without the verdict and the tools. */
async function coarsePicture(page) {
  const { x, y, width, height } = await page.locator('#canvas').boundingBox();
  return coarse(page, await page.screenshot({ clip: { x, y: y + 120, width, height: height - 180 } }));
}

/** A picture in coarse: COLUMNS x ROWS mean colours, a hexadecimal digit for each channel. */
function coarse(page, picture) {
  return page.evaluate(
    async ([base64, columns, rows]) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes]));
      const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
      context.drawImage(bitmap, 0, 0);
      const { data, width, height } = context.getImageData(0, 0, bitmap.width, bitmap.height);
      const sums = new Float64Array(3 * columns * rows);
      const counts = new Float64Array(columns * rows);
      for (let y = 0; y < height; ++y) {
        for (let x = 0; x < width; ++x) {
          const cell = Math.floor((y * rows) / height) * columns + Math.floor((x * columns) / width);
          ++counts[cell];
          for (let k = 0; k < 3; ++k) {
            sums[3 * cell + k] += data[4 * (y * width + x) + k];
          }
        }
      }
      return Array.from(sums, (sum, i) => Math.min(15, Math.floor(sum / counts[Math.floor(i / 3)] / 16)).toString(16)).join('');
    },
    [picture.toString('base64'), COLUMNS, ROWS],
  );
}

const digits = (text) => Array.from(text, (digit) => parseInt(digit, 16));

/** Mean difference of the colours, as a share of the full range. */
function difference(a, b) {
  const [x, y] = [digits(a), digits(b)];
  assert.equal(x.length, y.length);
  return x.reduce((sum, value, i) => sum + Math.abs(value - y[i]), 0) / x.length / 15;
}

/** Another rasterizer moves edges by a pixel, about 0.003; another robot changes 0.05 and more. */
const TOLERANCE = 0.01;
const KNOWN_FILE = new URL('pictures.json', import.meta.url);

test('the gallery looks as it should', async () => {
  const names = readdirSync(path.join(repository, 'scenarios'))
    .filter((name) => name.endsWith('.json'))
    .map((name) => name.replace('.json', ''));
  const page = await openPage(browser, { viewport: { width: 900, height: 560 } });
  // Whole modules in colour tell robots apart; what stands on connections is in insight.test.mjs.
  await page.selectOption('#subject', 'modules');
  const pictures = {};
  for (const name of names) {
    await openExample(page, name);
    await page.mouse.move(0, 0);
    pictures[name] = await coarsePicture(page);
  }
  if (process.env.HOLDFAST_RENEW_PICTURES) {
    writeFileSync(KNOWN_FILE, `${JSON.stringify(pictures, null, 1)}\n`);
  }
  const known = JSON.parse(readFileSync(KNOWN_FILE, 'utf8'));
  assert.deepEqual(Object.keys(pictures), Object.keys(known));
  for (const name of names) {
    const found = difference(pictures[name], known[name]);
    assert.ok(found < TOLERANCE, `${name} differs by ${found.toFixed(4)}`);
  }
  // The comparison can tell robots apart.
  assert.ok(difference(pictures.arm_breaks_a, pictures.angle_breaks_a) > 3 * TOLERANCE);
  assert.ok(difference(pictures.crane_tips_a, pictures.crane_tips_b) > 3 * TOLERANCE);
  assert.deepEqual(page.faults, []);
});

test('the README shows the page as it is', async () => {
  const now = await coarse(await openPage(browser), await takePicture(browser, { type: 'png' }));
  const shown = await coarse(await openPage(browser), readFileSync(pictureFile));
  assert.ok(difference(now, shown) < TOLERANCE, 'node test/screenshot.mjs renews it');
});

test('modules have the colours of the paper, or of the scale for every eye', async () => {
  const page = await openPage(browser);
  await page.selectOption('#subject', 'modules');
  await settled(page);
  const at = await facePoint(page, [6, 1, 2], [0, 0, 1]);
  const pixelAt = async (point) => (await pixels(page, { ...point, width: 1, height: 1 }))[0];
  const [red, green, blue] = await pixelAt(at);
  assert.ok(green > red + 20 && green > blue + 20, `nearly no load is green: ${[red, green, blue]}`);
  await page.selectOption('#scale', 'cividis');
  await settled(page);
  const [r, g, b] = await pixelAt(at);
  assert.ok(b > r + 20 && b > g, `and blue on the other scale: ${[r, g, b]}`);
});

test('the load bends the arm down when it is exaggerated', async () => {
  const page = await openPage(browser);
  const drawn = () => page.evaluate(() => {
    const { app } = globalThis.holdfast;
    return { factor: app.view.exaggeration, z: app.view.connectionPoint(11).z };
  });
  const before = await drawn();
  await page.locator('#exaggeration').fill('100');
  const after = await drawn();
  assert.equal(before.factor, 0);
  assert.ok(after.factor > 10 && after.z < before.z - 0.3, JSON.stringify([before, after]));
});

test('the policy allows nothing but the page itself', async () => {
  const text = readFileSync(pageFile, 'utf8');
  const policy = /Content-Security-Policy" content="([^"]*)"/.exec(text)[1];
  assert.match(policy, /default-src 'none'/);
  assert.doesNotMatch(policy, /unsafe-inline|'unsafe-eval'|https?:|\*/);
  const page = await openPage(browser);
  const isBlocked = await page.evaluate(
    () =>
      new Promise((done) => {
        document.addEventListener('securitypolicyviolation', () => done(true));
        const script = document.createElement('script');
        script.textContent = 'globalThis.intruder = true';
        document.body.append(script);
        setTimeout(() => done(globalThis.intruder !== true), 500);
      }),
  );
  assert.ok(isBlocked);
});

test('the robot finds out by itself, and the trace can be stepped through', async () => {
  const page = await openPage(browser);
  await openExample(page, 'arm_tips_a');
  await page.selectOption('#link', '2');
  await page.click('#simulate');
  await page.waitForSelector('#player:not([hidden])');
  assert.match(await page.innerText('#trace-result'), /verdict: safe, load ratio 0\.36\d; all modules agree/);
  const moment = () => page.innerText('#moment');
  await page.click('#play');
  await page.locator('#time').fill('0');
  assert.match(await moment(), /discovery .* 0 of 8 know/);
  for (let i = 0; i < 6; ++i) {
    await page.click('#phase-on');
  }
  assert.match(await moment(), /equilibrium · iteration 0 /);
  const orders = [];
  while (!/equilibrium · iteration 1 /.test(await moment())) {
    await page.click('#step-on');
    orders.push(/order: (.*)$/.exec(await moment())[1]);
    assert.ok(orders.length < 10, orders.join('; '));
  }
  assert.deepEqual(orders.slice(-2), ['condense the branches', 'an iteration: move, residual'], orders.join('; '));
  const later = await moment();
  await page.click('#step-back');
  await page.click('#step-on');
  assert.equal(await moment(), later, 'back and on again is the same');
  await page.locator('#time').fill('10000');
  assert.match(await moment(), /8 of 8 know the verdict/);
  assert.deepEqual(page.faults, []);
});
