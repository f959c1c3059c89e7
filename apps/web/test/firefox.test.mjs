// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The page in the other engine: it opens, answers as the program does, and can be worked with.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import puppeteer from 'puppeteer-core';
import { linkOf, pageFile, program, scenario } from './browser.mjs';

const WAIT = { timeout: 120_000 };

let browser;
let page;
const faults = [];
before(async () => {
  browser = await puppeteer.launch({
    browser: 'firefox', executablePath: '/usr/bin/firefox-esr', headless: false, timeout: WAIT.timeout, protocolTimeout: WAIT.timeout,
  });
  page = await browser.newPage();
  page.on('pageerror', (error) => faults.push(error.message));
  page.on('console', (message) => message.type() === 'error' && faults.push(message.text()));
  await page.setViewport({ width: 1200, height: 800 });
  await page.goto(pathToFileURL(pageFile).href + linkOf('arm_breaks_b'));
  await page.waitForSelector('html.ready', WAIT);
  await settled();
});
after(() => browser?.close());

const settled = () =>
  page.waitForFunction(() => {
    const { app } = globalThis.holdfast;
    return app.finding !== undefined && !app.finding.isFirstLook;
  }, WAIT);
const verdict = () => page.$eval('#verdict', (chip) => chip.dataset.verdict);
const count = () => page.evaluate(() => globalThis.holdfast.bench.robot.count);

/** Without what differs from one run to the next, or says how and where the report was made; angles have another libm's last digit. */
function essence(report) {
  const known = (key, value) => (/seconds|^(options|notes|threads|file)$/.test(key) ? undefined : typeof value === 'number' ? Number(value.toPrecision(13)) : value);
  return JSON.parse(JSON.stringify(report, known));
}

test('it shows a robot and its verdict, with a picture', async () => {
  assert.equal(await verdict(), 'overload');
  assert.match(await page.$eval('#chip-numbers', (numbers) => numbers.textContent), /load 1\.20/);
  const colours = await page.evaluate(() => {
    const { canvas } = globalThis.holdfast.app.stage.picture(() => 1);
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const seen = new Set();
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] > 250) {
        seen.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
      }
    }
    return seen.size;
  });
  assert.ok(colours > 50, `${colours} colours`);
});

test('its reports are those of the program', async () => {
  for (const name of ['arm_breaks_b', 'crane_tips_b', 'angle_breaks_a']) {
    const source = readFileSync(scenario(name), 'utf8');
    const own = JSON.parse(await page.evaluate((text, title) => globalThis.holdfast.reportOf(text, title), source, name));
    let printed;
    try {
      printed = execFileSync(program, ['check', scenario(name), '--json', '-', '--quiet'], { stdio: ['ignore', 'pipe', 'ignore'] });
    } catch (error) {
      printed = error.stdout; // The exit status is the verdict.
    }
    assert.deepEqual(essence(own), essence(JSON.parse(printed)), name);
  }
});

test('a click attaches a module, keys take it back', async () => {
  const before = await count();
  const at = await page.evaluate(() => {
    const { stage } = globalThis.holdfast.app;
    const tip = globalThis.holdfast.bench.robot;
    const place = stage.controls.target.clone().fromArray(tip.placeAt(0));
    const box = stage.canvas.getBoundingClientRect();
    // The first module's face that looks to the front.
    const { x, y } = stage.project(place.add({ x: 0, y: -0.5, z: 0 }));
    return { x: x + box.left, y: y + box.top };
  });
  await page.mouse.click(at.x, at.y);
  await page.waitForFunction((least) => globalThis.holdfast.bench.robot.count > least, WAIT, before);
  await settled();
  assert.equal(await count(), before + 1);
  await page.keyboard.down('Control');
  await page.keyboard.press('z');
  await page.keyboard.up('Control');
  await settled();
  assert.equal(await count(), before);
});

test('it breaks, is cut open, seen through, and steps are judged', async () => {
  for (const key of ['x', '7', '9', '6', 'x']) {
    await page.keyboard.press(key);
  }
  await page.select('#cut', 'above');
  await page.select('#cut', '');
  await page.keyboard.press('t');
  await page.waitForFunction(() => globalThis.holdfast.app.isToppled, WAIT);
  await page.keyboard.press('t');
  await page.click('#order');
  await page.waitForFunction(() => document.getElementById('sequence-text').textContent !== '' && document.getElementById('sequence-progress').hidden, WAIT);
  assert.deepEqual(faults, []);
});
