// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Nothing that was built is lost when the page is closed, and nothing that was kept stands in for what
// a page was asked to show.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import path from 'node:path';
import { after, before, test } from 'node:test';
import {
  attach, count, cube, dropFile, launch, newContext, openExample, openPage, program, scenario, settled, temporaryFolder,
} from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const nameOf = (page) => page.evaluate(() => globalThis.holdfast.bench.robot.name);
const messages = (page) => page.innerText('#messages');

test('cells, name and material come back when the page is opened again', async () => {
  const context = await newContext(browser);
  const page = await openPage(browser, { context });
  assert.equal(await count(page), 11);
  await attach(page);
  await page.fill('#name', 'my own arm');
  await page.click('#material-form summary');
  await page.getByLabel('Mass of a module').fill('0.07');
  await page.getByLabel('Ground at z').press('Tab');
  // At once: what the page does when it goes away has to do.
  await page.close();
  const again = await openPage(browser, { context });
  assert.equal(await count(again), 12);
  assert.equal(await again.inputValue('#name'), 'my own arm');
  assert.equal(await again.evaluate(() => globalThis.holdfast.bench.robot.material[8]), 0.07);
  assert.match(await messages(again), /Back where you left off: my own arm/);
  assert.deepEqual([...page.faults, ...again.faults], []);
  await context.close();
});

test('a name alone is kept, what was only opened is not', async () => {
  const context = await newContext(browser);
  const page = await openPage(browser, { context });
  await openExample(page, 'crane_tips_a');
  await page.close();
  const opened = await openPage(browser, { context });
  assert.equal(await nameOf(opened), 'arm');
  await opened.fill('#name', 'renamed');
  await opened.press('#name', 'Enter');
  await opened.close();
  assert.equal(await nameOf(await openPage(browser, { context })), 'renamed');
  await context.close();
});

test('a page of holdfast view shows its file, and offers what was built from it', async () => {
  const context = await newContext(browser);
  const bare = await openPage(browser, { context });
  await attach(bare);
  await bare.fill('#name', 'on the bare page');
  await bare.close();
  const folder = temporaryFolder();
  const [file, other] = ['crane_tips_a', 'angle_breaks_a'].map((name) => {
    const out = path.join(folder, `${name}.html`);
    execFileSync(program, ['view', scenario(name), '--no-open', '--out', out]);
    return out;
  });
  const viewed = await openPage(browser, { context, file });
  assert.equal(await nameOf(viewed), 'crane_tips_a', 'the file, not what was kept');
  assert.equal(await messages(viewed), '', 'nothing was built from it');
  const modules = await count(viewed);
  await attach(viewed);
  await viewed.close();
  const again = await openPage(browser, { context, file });
  assert.equal(await count(again), modules, 'the file as it is');
  await again.click('#messages button >> text=Bring it back');
  await settled(again);
  assert.equal(await count(again), modules + 1);
  await again.click('#undo');
  assert.equal(await count(again), modules, 'and the file again');
  const third = await openPage(browser, { context, file: other });
  assert.equal(await messages(third), '', 'another file has nothing of the first');
  const last = await openPage(browser, { context });
  assert.equal(await nameOf(last), 'on the bare page', 'the file has not overwritten it');
  assert.deepEqual([...viewed.faults, ...again.faults, ...last.faults], []);
  await context.close();
});

test('each robot is kept for itself, and the gallery has them', async () => {
  const context = await newContext(browser);
  const page = await openPage(browser, { context });
  for (const name of ['arm_tips_a', 'bush_tips_a']) {
    await openExample(page, name);
    await attach(page);
    await settled(page);
  }
  const second = await openPage(browser, { context });
  await second.click('#new');
  await second.mouse.click(400, 300);
  await second.fill('#name', 'one module');
  await second.press('#name', 'Enter');
  await page.waitForTimeout(500);
  await second.click('#gallery-open');
  await second.waitForSelector('#kept .card-verdict[data-verdict]');
  const titles = await second.locator('#kept .card-title').allInnerTexts();
  assert.deepEqual(titles, ['one module', 'bush_tips_a', 'arm_tips_a'], 'newest first');
  await second.click('#kept .card >> text=arm_tips_a');
  await settled(second);
  assert.equal(await nameOf(second), 'arm_tips_a');
  await second.click('#gallery-open');
  await second.click('text=Forget these');
  assert.equal(await second.isVisible('#kept'), false);
  await second.click('#gallery .close');
  await Promise.all([page.close(), second.close()]);
  assert.equal(await nameOf(await openPage(browser, { context })), 'arm');
  await context.close();
});

test('a reload of the tab goes on where it was, whatever other tabs have kept', async () => {
  const context = await newContext(browser);
  const first = await openPage(browser, { context });
  await attach(first);
  await first.fill('#name', 'first tab');
  await first.press('#name', 'Enter');
  const second = await openPage(browser, { context });
  await second.fill('#name', 'second tab');
  await second.press('#name', 'Enter');
  await second.close();
  await first.reload();
  await first.waitForSelector('html.ready');
  await settled(first);
  assert.equal(await nameOf(first), 'first tab');
  await context.close();
});

test('damaged entries are left alone', async () => {
  const context = await newContext(browser);
  const page = await openPage(browser, { context });
  await page.evaluate(() => {
    localStorage.setItem('holdfast.kept.a', 'x');
    localStorage.setItem('holdfast.kept.b', '9 {"id":"b"}');
    localStorage.setItem('holdfast.kept.c', `9 {"id":"c","origin":"","time":9,"name":"","supportZ":0,"base":"","material":[1],"modules":[1,2,3,9]}`);
  });
  await page.close();
  const again = await openPage(browser, { context });
  assert.equal(await nameOf(again), 'arm');
  assert.deepEqual(again.faults, []);
  await context.close();
});

test('97,336 modules are kept as well', async () => {
  const context = await newContext(browser);
  const page = await openPage(browser, { context });
  await dropFile(page, 'cube_46.json', cube(46));
  await page.waitForFunction(() => globalThis.holdfast.bench.robot.count === 46 ** 3, null, { timeout: 60_000 });
  await settled(page);
  await attach(page);
  await page.close();
  const again = await openPage(browser, { context });
  assert.equal(await count(again), 46 ** 3 + 1);
  assert.deepEqual(again.faults, []);
  await context.close();
});

test('what is too large to be kept is said to be, and is asked about', async () => {
  const context = await newContext(browser);
  const page = await openPage(browser, { context });
  await attach(page);
  await page.fill('#name', 'small');
  await dropFile(page, 'cube_3.json', cube(3) + ' '.repeat(5_000_000));
  await page.waitForFunction(() => globalThis.holdfast.bench.robot.count === 27);
  await attach(page);
  await page.waitForSelector('.message >> text=Too large to be kept');
  const [dialog] = await Promise.all([page.waitForEvent('dialog'), page.close({ runBeforeUnload: true })]);
  assert.equal(dialog.type(), 'beforeunload');
  await dialog.accept();
  assert.equal(await nameOf(await openPage(browser, { context })), 'small', 'and nothing was forgotten for it');
  await context.close();
});

test('where nothing can be kept the page asks before it is closed', async () => {
  const context = await newContext(browser);
  await context.addInitScript(() => {
    Object.defineProperty(globalThis, 'localStorage', {
      get() {
        throw new DOMException('no storage here', 'SecurityError');
      },
    });
  });
  const page = await openPage(browser, { context });
  await page.mouse.click(400, 300);
  await attach(page);
  const [dialog] = await Promise.all([page.waitForEvent('dialog'), page.close({ runBeforeUnload: true })]);
  assert.equal(dialog.type(), 'beforeunload');
  await dialog.accept();
  await context.close();
});
