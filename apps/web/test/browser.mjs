// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What the tests of the page share: a headless Chromium, and the hands and eyes of a user.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

export const repository = fileURLToPath(new URL('../../../', import.meta.url));
export const pageFile = path.join(repository, 'build/page/holdfast.html');
export const program = path.join(repository, 'build/release/holdfast');
export const scenario = (name) => path.join(repository, 'scenarios', `${name}.json`);
export const temporaryFolder = () => mkdtempSync(path.join(tmpdir(), 'holdfast-'));

/** Software rendering, no sandbox for root, and no connections of the browser's own. */
const ARGUMENTS = [
  '--no-sandbox',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

export const launch = () => chromium.launch({ executablePath: '/usr/bin/chromium', args: ARGUMENTS });

/**
 * A page that has opened its first structure. Whatever it asks for beyond its own file, and every
 * fault in it, is listed in `faults`.
 */
export async function openPage(browser, { fragment = '', file = pageFile, ...options } = {}) {
  if (!existsSync(file)) {
    throw new Error(`${file} is not there: run ./dev page`);
  }
  const context = await browser.newContext({
    viewport: { width: 1000, height: 640 },
    reducedMotion: 'reduce',
    colorScheme: 'light',
    acceptDownloads: true,
    ...options,
  });
  const page = await context.newPage();
  page.faults = [];
  page.on('pageerror', (error) => page.faults.push(error.message));
  page.on('console', (message) => {
    if (message.type() === 'error') {
      page.faults.push(message.text());
    }
  });
  page.on('request', (request) => {
    if (!/^(blob|data):/.test(request.url()) && !request.url().startsWith('file:')) {
      page.faults.push(`request of ${request.url()}`);
    }
  });
  await page.goto(pathToFileURL(file).href + fragment);
  await page.waitForSelector('html.ready');
  await settled(page);
  return page;
}

/** Until the answer to the robot on the page is there and drawn. */
export const settled = (page) =>
  page.waitForFunction(() => {
    const { app } = globalThis.holdfast;
    const isDone = app.finding && !app.finding.isFirstLook;
    return isDone && new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))));
  });

export const verdict = (page) => page.getAttribute('#verdict', 'data-verdict');
export const figures = (page) => page.innerText('#figures');
export const count = (page) => page.evaluate(() => globalThis.holdfast.app.robot.count);
export const kindOf = (page, cell) => page.evaluate((at) => globalThis.holdfast.app.robot.kind(at), cell);

/** Where the middle of a cell's face is in the window. */
export const facePoint = (page, cell, direction, share = 0.5) =>
  page.evaluate(
    ([at, step, part]) => {
      const { stage } = globalThis.holdfast.app;
      const point = stage.controls.target.clone().fromArray(at.map((v, k) => v + part * step[k]));
      const { x, y } = stage.project(point);
      const box = stage.canvas.getBoundingClientRect();
      return { x: x + box.left, y: y + box.top };
    },
    [cell, direction, share],
  );

export async function clickFace(page, cell, direction) {
  const { x, y } = await facePoint(page, cell, direction);
  await page.mouse.click(x, y);
  await settled(page);
}

export async function dropFile(page, name, text) {
  await page.evaluate(
    ([fileName, content]) => {
      const data = new DataTransfer();
      data.items.add(new File([content], fileName));
      window.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    },
    [name, text],
  );
}

/** What the page says in the end, not that it is still reading. */
export const message = (page) => page.locator('.message').filter({ hasNotText: /^reading/ }).innerText();

export async function openExample(page, name) {
  await page.click('#gallery-open');
  await page.click(`[data-example=${name}]`);
  await page.waitForFunction((title) => globalThis.holdfast.app.robot.name === title, name);
  await settled(page);
}

/** The native program's reports of structure files. */
export const nativeReports = (files) => [report(['check', '--json', '-', ...files])].flat();

/** What a robot finds out by itself, natively. */
export const nativeSimulation = (file, method) =>
  report(['simulate', '--quiet', '--json', '-', '--method', method, file]).distributed;

function report(options) {
  try {
    return JSON.parse(execFileSync(program, options, { encoding: 'utf8', maxBuffer: 1 << 28 }));
  } catch (error) {
    // Exit codes 1 and 2 are verdicts.
    if (error.status !== 1 && error.status !== 2) {
      throw error;
    }
    return JSON.parse(error.stdout);
  }
}
