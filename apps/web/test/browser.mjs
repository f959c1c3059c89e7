// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What the tests of the page share: a headless Chromium, and the hands and eyes of a user.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { deflateRawSync } from 'node:zlib';
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

export const launch = (...more) =>
  chromium.launch({ executablePath: '/usr/bin/chromium', args: [...ARGUMENTS, ...more] });

/** A browser of its own: nothing is kept in it yet. */
export const newContext = (browser, options = {}) =>
  browser.newContext({
    viewport: { width: 1000, height: 640 },
    reducedMotion: 'reduce',
    colorScheme: 'light',
    acceptDownloads: true,
    ...options,
  });

/** The link of a scenario, as the page makes it. */
export const linkOf = (name) => `#s=${deflateRawSync(JSON.stringify(JSON.parse(readFileSync(scenario(name), 'utf8')))).toString('base64url')}`;

/** A page of a browser in which nothing is kept begins with a robot that breaks; `fragment: ''`: with its own first one. */
const firstOf = (context, file) => (context || file !== pageFile ? '' : linkOf('arm_breaks_b'));

/**
 * A page that has opened its first structure. Whatever it asks for beyond its own file, and every
 * fault in it, is listed in `faults`.
 */
export async function openPage(browser, { context, file = pageFile, fragment = firstOf(context, file), ...options } = {}) {
  const page = await openUnsettled(browser, { fragment, file, context, ...options });
  await settled(page);
  return page;
}

/** The same where there may be no robot to wait for. */
export async function openUnsettled(browser, { context, file = pageFile, fragment = firstOf(context, file), ...options } = {}) {
  if (!existsSync(file)) {
    throw new Error(`${file} is not there: run ./dev page`);
  }
  const page = await (context ?? (await newContext(browser, options))).newPage();
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
export const count = (page) => page.evaluate(() => globalThis.holdfast.bench.robot.count);
export const roleOf = (page, cell) => page.evaluate((at) => globalThis.holdfast.bench.robot.role(at), cell);

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

/** Attaches one module at the first free place, as a click does. */
export const attach = (page) =>
  page.evaluate(() => globalThis.holdfast.bench.use([globalThis.holdfast.bench.robot.freePlaces()[0]]));

/** A cube of n^3 modules, as a file. */
export function cube(n) {
  const modules = Array.from({ length: n ** 3 }, (_, i) => [i % n, Math.floor(i / n) % n, Math.floor(i / n / n)]);
  return JSON.stringify({ format: 'holdfast-structure', version: 1, name: `cube_${n}`, modules });
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
  await page.waitForFunction((title) => globalThis.holdfast.bench.robot.name === title, name);
  await settled(page);
}

/** The colours of the pixels of a part of the window, row by row. */
export async function pixels(page, { x, y, width, height }) {
  const clip = { x: Math.round(x), y: Math.round(y), width, height };
  const shot = (await page.screenshot({ clip })).toString('base64');
  return page.evaluate(async ([base64, columns, rows]) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes]));
    const context = new OffscreenCanvas(columns, rows).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, columns, rows);
    return Array.from({ length: columns * rows }, (_, i) => [...data.slice(4 * i, 4 * i + 3)]);
  }, [shot, width, height]);
}

/** Relative luminance and contrast as WCAG 2 defines them. */
export const luminance = (rgb) => {
  const [r, g, b] = rgb.map((value) => (value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
export const contrast = (a, b) => {
  const [high, low] = [luminance(a), luminance(b)].sort((x, y) => y - x);
  return (high + 0.05) / (low + 0.05);
};

/** Moves the pointer over the middle of the canvas: time of each move, and how often it asks about cells. */
export const pointerMoves = (page) =>
  page.evaluate(() => {
    const { app, bench } = globalThis.holdfast;
    const { stage } = app;
    const { robot } = bench;
    const box = stage.canvas.getBoundingClientRect();
    let calls = 0;
    for (const name of ['cellAt', 'roleAt', 'slot', 'isHidden']) {
      const own = robot[name].bind(robot);
      robot[name] = (...values) => (++calls, own(...values));
    }
    const found = [];
    const cells = new Set();
    for (let i = 0; i < 80; ++i) {
      calls = 0;
      const clientX = box.left + box.width * (0.35 + (0.3 * ((i * 37) % 80)) / 80);
      const clientY = box.top + box.height * (0.35 + (0.2 * i) / 80);
      const begun = performance.now();
      stage.canvas.dispatchEvent(new PointerEvent('pointermove', { clientX, clientY, pointerType: 'mouse' }));
      found.push({ ms: performance.now() - begun, calls });
      cells.add(String(app.pointed.cell));
    }
    return { found, cells: cells.size };
  });

/** A native report without what only a command line has: options, and the file's name. */
export function withoutCommandLine({ options: _, ...report }) {
  const { file: __, ...robot } = report.robot;
  return { ...report, robot };
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
