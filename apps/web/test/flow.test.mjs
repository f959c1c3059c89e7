// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Force flow: the way to the ground, its numbers, and what the ground does.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { attach, dropFile, launch, openExample, openPage, pixels, settled } from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

/** Blinky Blocks: weight in N, pitch in mm. */
const WEIGHT = 0.06106 * 9.81;
const PITCH = 40;

async function openRobot(page, structure) {
  const text = JSON.stringify({ format: 'holdfast-structure', version: 2, ...structure });
  await dropFile(page, 'robot.json', text);
  await page.waitForFunction((base) => globalThis.holdfast.bench.robot.base === base, text);
  await settled(page);
}

const rows = (page) =>
  page.$$eval('#flow-table tbody tr', (list) => list.map((row) => [...row.children].map((cell) => cell.textContent)));
const near = (value, expected, share, what) => assert.ok(Math.abs(value - expected) <= share * Math.abs(expected) + 0.006, `${what}: ${value}, expected ${expected}`);

test('along a cantilever shear and bending are those of its weight: n w and n^2 w L / 2', async () => {
  const page = await openPage(browser, { viewport: { width: 1200, height: 800 } });
  const modules = [{ cell: [0, 0, 3], fixed: true }, ...[1, 2, 3, 4, 5].map((x) => [x, 0, 3])];
  await openRobot(page, { support_z: null, modules });
  await page.click('[data-flow=M]');
  await page.waitForSelector('#flow-table tbody tr');
  // From the worst connection, which is that at the wall.
  assert.deepEqual((await rows(page)).map(([name]) => name), ['(0,0,3)-(1,0,3)']);
  // From its tip, which is pinned: all five, in their order.
  await page.keyboard.press('v');
  await page.evaluate(() => globalThis.holdfast.app.pin([5, 0, 3]));
  const found = await rows(page);
  assert.equal(found.length, 5);
  found.forEach(([, , shear, bending], i) => {
    const n = i + 1;
    near(Number(shear), n * WEIGHT, 0.01, `shear of ${n}`);
    near(Number(bending), (n * n * WEIGHT * PITCH) / 2, 0.05, `bending of ${n}`);
  });
  assert.match(await page.innerText('#flow-text'), /From \(4,0,3\)-\(5,0,3\) to the ground below \(0,0,3\): the widest ribbon is 299 N mm\./);
  // Widths are as the bending is: the last connection's is the widest.
  const widths = await page.evaluate(() => {
    const { view } = globalThis.holdfast.app;
    return [...view.ribbonWidths(view.judged.answer).values()];
  });
  widths.forEach((width, i) => near(width, 0.35 + (3.2 - 0.35) * ((i + 1) / 5) ** 2, 0.02, `width ${i}`));
  assert.deepEqual(page.faults, []);
});

test('what the ground does balances weights and loads, on a floor, a slope, in a slot and of catoms', async () => {
  const page = await openPage(browser, { viewport: { width: 1200, height: 800 } });
  await page.click('[data-flow=N]');
  for (const name of ['arm_breaks_a', 'arm_tips_a', 'slope', 'slot', 'prism_wall', 'catom_pyramid', 'disc_arch', 'portal', 'tree']) {
    await openExample(page, name);
    const { sum, needed, count } = await page.evaluate(() => {
      const { bench, app } = globalThis.holdfast;
      const { robot } = bench;
      const sums = [0, 0, 0];
      // The panel keeps them: what is drawn is what is summed.
      const panel = globalThis.holdfast.flow;
      panel.reactions.forEach(({ force }) => force.toArray().forEach((value, k) => (sums[k] += value)));
      const mass = robot.material[8] * robot.count;
      const wanted = robot.gravity.map((value) => -value * mass);
      for (const { force_n: force } of robot.surroundings.loads ?? []) {
        force.forEach((value, k) => (wanted[k] -= value));
      }
      return { sum: sums, needed: wanted, count: panel.reactions.length, verdict: app.finding.answer.verdict };
    });
    assert.ok(count > 0, `${name}: no reactions`);
    const size = Math.hypot(...needed);
    sum.forEach((value, k) => assert.ok(Math.abs(value - needed[k]) < 0.02 * size, `${name}: ${sum}, expected ${needed}`));
  }
  assert.deepEqual(page.faults, []);
});

test('a way begins at the worst connection, is the shortest, and ends where something stands', async () => {
  const page = await openPage(browser, { viewport: { width: 1200, height: 800 } });
  for (const name of ['arm_breaks_a', 'arm_breaks_b', 'crane_breaks_b', 'portal', 'tree', 'catom_pyramid']) {
    await openExample(page, name);
    if ((await page.getAttribute('[data-flow=M]', 'aria-pressed')) === 'false') {
      await page.click('[data-flow=M]');
    }
    const { way, worst, distance, contiguous } = await page.evaluate(() => {
      const { app, flow, bench } = globalThis.holdfast;
      const { answer, slots } = app.finding;
      const { connections } = answer;
      const ends = (i) => [connections[3 * i], connections[3 * i + 1]];
      // Another way to the distance: relaxation over all connections until nothing changes.
      const far = slots.map((slot, module) => {
        const isHeld = Array.from({ length: answer.facets.length / 4 }, (_, i) => answer.facets.subarray(4 * i, 4 * i + 4))
          .some(([of, , bonded, code]) => of === module && (bonded || code > 0));
        return isHeld || bench.robot.roleAt(slot) === 2 ? 0 : 1e9;
      });
      for (let changed = true; changed; ) {
        changed = false;
        for (let i = 0; 3 * i < connections.length; ++i) {
          const [a, b] = ends(i);
          const least = Math.min(far[a], far[b]) + 1;
          for (const end of [a, b]) {
            if (far[end] > least) {
              [far[end], changed] = [least, true];
            }
          }
        }
      }
      const path = flow.way.connections;
      return {
        way: path, worst: answer.worst, distance: 1 + Math.min(...ends(answer.worst).map((end) => far[end])),
        contiguous: path.every((one, i) => i === 0 || ends(one).some((end) => ends(path[i - 1]).includes(end))),
      };
    });
    assert.equal(way[0], worst, name);
    assert.equal(way.length, distance, name);
    assert.ok(contiguous, name);
  }
  assert.deepEqual(page.faults, []);
});

test('ribbons are seen, by keys too, and nothing is left of them where loads are not what is shown', async () => {
  const page = await openPage(browser, { viewport: { width: 1200, height: 800 } });
  const shown = () => page.locator('#flow-labels .label').count();
  for (const name of ['N', 'V', 'M', 'T']) {
    await page.keyboard.press('n');
    assert.equal(await page.getAttribute(`[data-flow=${name}]`, 'aria-pressed'), 'true');
    assert.ok((await shown()) > 3);
  }
  for (const theme of ['dark', 'light']) {
    await page.selectOption('#theme', theme);
    const [ink, arrows] = await page.evaluate(() => {
      const { app, flow } = globalThis.holdfast;
      return [app.scenery.ground.colours.mass, flow.arrows.mesh.material.color.getHex()];
    });
    assert.equal(arrows, ink);
  }
  await page.keyboard.press('n');
  assert.equal(await shown(), 0);
  assert.equal(await page.isVisible('#flow'), false);
  await page.click('[data-flow=M]');
  await settled(page);
  const { x, y } = await page.evaluate(() => {
    const { stage, view } = globalThis.holdfast.app;
    const at = stage.project(view.connectionPoint(view.worst));
    const box = stage.canvas.getBoundingClientRect();
    return { x: at.x + box.left, y: at.y + box.top };
  });
  const red = (await pixels(page, { x: x - 6, y: y - 6, width: 13, height: 13 })).filter(([r, g, b]) => r > 150 && g < 90 && b < 90).length;
  assert.ok(red > 60, `${red} of 169 pixels are red`);
  await attach(page);
  await settled(page);
  assert.ok((await shown()) > 3, 'an edit keeps them');
  await page.click('#topple');
  await page.waitForFunction(() => globalThis.holdfast.app.isToppled);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  assert.equal(await shown(), 0, 'what falls has none');
  await page.keyboard.press('t');
  await openExample(page, 'arm_tips_b');
  assert.equal(await shown(), 0);
  assert.match(await page.innerText('#flow-text'), /No loads are known/);
  await page.click('#new');
  await openExample(page, 'arm_breaks_a');
  assert.ok((await shown()) > 3);
  assert.deepEqual(page.faults, []);
});
