// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What the page weighs and how fast it is, on this machine: ./dev bench page
import { readFileSync, statSync } from 'node:fs';
import { gzipSync } from 'node:zlib';
import path from 'node:path';
import { launch, openPage, pageFile, pointerMoves, repository } from './browser.mjs';

const kilobytes = (bytes) => `${(bytes / 1000).toFixed(0)} kB`;
const ms = (values) => {
  const sorted = [...values].sort((a, b) => a - b);
  return `${sorted[Math.floor(sorted.length / 2)].toFixed(1)} ms (${sorted[0].toFixed(1)} to ${sorted.at(-1).toFixed(1)})`;
};
const line = (name, text) => console.log(`${name.padEnd(44)} ${text}`);

const core = path.join(repository, 'build/wasm/holdfast_core.wasm');
const html = readFileSync(pageFile);
line('the page, one file', kilobytes(html.length));
line('  as a server sends it, gzip -9', kilobytes(gzipSync(html, { level: 9 }).length));
let rest = html.length;
for (const [name, file] of [['core', 'holdfast-core'], ['script', 'holdfast-script']]) {
  const [, letters] = new RegExp(`id="${file}"[^>]*>([^<]*)`).exec(html.toString('latin1'));
  rest -= letters.length;
  line(`  its ${name}, packed`, kilobytes(letters.length));
}
line('  style and markup', kilobytes(rest));
line('  the core unpacked', kilobytes(statSync(core).size));

const browser = await launch();
let begun = performance.now();
const small = { viewport: { width: 900, height: 560 } };
let page = await openPage(browser, small);
const paint = await page.evaluate(() => ({
  shown: performance.getEntriesByName('shown')[0]?.startTime,
  paint: performance.getEntriesByName('first-contentful-paint')[0]?.startTime,
}));
line('opened: first paint, first robot with colours', `${paint.paint?.toFixed(0)} ms, ${paint.shown?.toFixed(0)} ms`);

function* box(size, isThere = () => true) {
  for (let z = 0; z < size[2]; ++z) {
    for (let y = 0; y < size[1]; ++y) {
      for (let x = 0; x < size[0]; ++x) {
        if (isThere(x, y, z)) {
          yield [x, y, z];
        }
      }
    }
  }
}
const strut = (step) => (...cell) => cell.filter((value) => value % step === 0).length >= 2;
const onShell = (n) => (...cell) => cell.some((value) => value === 0 || value === n - 1);

async function load(name, modules) {
  const file = JSON.stringify({ format: 'holdfast-structure', version: 1, name, modules: [...modules] });
  return page.evaluate(async ([text, title]) => {
    const { app, bench } = globalThis.holdfast;
    const begin = performance.now();
    const data = new DataTransfer();
    data.items.add(new File([text], `${title}.json`));
    window.dispatchEvent(new DragEvent('drop', { dataTransfer: data, cancelable: true }));
    const until = async (isDone) => {
      while (!isDone()) {
        await new Promise((done) => setTimeout(done, 4));
      }
      return performance.now() - begin;
    };
    const shown = await until(() => bench.robot.name === title && app.finding);
    const answered = await Promise.race([
      until(() => app.finding && !app.finding.isFirstLook),
      new Promise((done) => setTimeout(() => done(undefined), 120_000)),
    ]);
    return { shown, answered, verdict: app.finding.answer?.verdict, problem: app.finding.problem };
  }, [file, name]);
}

/** From the click that attaches a module to its answer in the buffers of the next picture. */
async function edits(count) {
  return page.evaluate(async (times) => {
    const { app, bench } = globalThis.holdfast;
    const found = [];
    const place = bench.robot.freePlaces().sort((a, b) => b[2] - a[2] || b[0] - a[0])[0];
    for (let i = 0; i < times; ++i) {
      const begin = performance.now();
      performance.clearMarks('shown');
      bench.edit('bench', [place], i % 2 === 0 ? 0 : undefined);
      // Small robots are there already.
      while (performance.getEntriesByName('shown').length === 0) {
        await new Promise((done) => {
          const channel = new MessageChannel();
          channel.port1.onmessage = done;
          channel.port2.postMessage(0);
        });
      }
      found.push(performance.getEntriesByName('shown')[0].startTime - begin);
      // The picture is drawn in software by the same cores: it is not to disturb the next click.
      await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 150))));
    }
    return found.slice(4);
  }, count);
}

const EDITED = {
  arm_29: [...box([27, 1, 1]), [0, 0, 1], [1, 0, 1]],
  portal_30: box([12, 1, 6], (x, _y, z) => x < 1 || x > 10 || z > 3),
  scaffold_840: box([16, 16, 10], strut(3)),
  scaffold_1120: box([16, 16, 13], strut(3)),
  shell_1016: box([14, 14, 14], onShell(14)),
  plate_1024: box([32, 32, 1]),
  cube_1000: box([10, 10, 10]),
  tower_999: box([3, 3, 111]),
  table_996: box([30, 30, 25], (x, y, z) => z > 23 || (x % 29 === 0 && y % 29 === 0)),
};
for (const [name, cells] of Object.entries(EDITED)) {
  const modules = [...cells];
  await load(name, modules);
  line(`edit, ${name}, ${modules.length} modules`, ms(await edits(16)));
}

/** From the click on "Where next?" until every free face has its answer. */
async function whereNext() {
  return page.evaluate(async () => {
    const { app, bench } = globalThis.holdfast;
    const button = document.getElementById('faces');
    const begin = performance.now();
    button.click();
    const places = bench.robot.freePlaces();
    while (places.some((place) => !app.whereNext.places.known(place, bench.role))) {
      await new Promise((done) => setTimeout(done, 4));
    }
    const seconds = (performance.now() - begin) / 1000;
    button.click();
    return { count: places.length, seconds };
  });
}
const ASKED = {
  cube_1000: box([10, 10, 10]),
  tower_9999: box([3, 3, 1111]),
  plate_10000: box([100, 100, 1]),
};
for (const [name, cells] of Object.entries(ASKED)) {
  await load(name, [...cells]);
  const { count, seconds } = await whereNext();
  line(`where next, ${name}`, `${count} free places in ${seconds.toFixed(2)} s`);
}

await load('cube_97336', box([46, 46, 46]));
const { found: moves } = await pointerMoves(page);
line('a move of the pointer, cube_97336', ms(moves.map((move) => move.ms)));
await page.close();
page = await openPage(browser, small);

for (const [name, size] of [['slab_50000', [200, 125, 2]], ['slab_100000', [250, 200, 2]], ['tower_100000', [20, 20, 250]]]) {
  const { shown, answered, verdict, problem } = await load(name, box(size));
  const loads = answered ? `${(answered / 1000).toFixed(1)} s ${problem ?? verdict}` : 'not within 2 minutes';
  line(`opened, ${name}`, `stability and picture ${(shown / 1000).toFixed(2)} s; loads ${loads}`);
  const turn = await page.evaluate(async () => {
    const { stage } = globalThis.holdfast.app;
    const script = [];
    for (let i = 0; i < 20; ++i) {
      stage.camera.position.applyAxisAngle(stage.camera.up, 0.02);
      const begin = performance.now();
      stage.controls.update();
      stage.drawFrame(begin);
      script.push(performance.now() - begin);
    }
    return { calls: stage.drawCalls, script: script.slice(2) };
  });
  line(`  one frame while turning`, `${turn.calls} draw calls, script ${ms(turn.script)}`);
  await page.close();
  page = await openPage(browser, small);
}
line('all in', `${((performance.now() - begun) / 1000).toFixed(0)} s`);
await browser.close();
