// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Every text of the page is in the table, and the table's French is what a French reader sees.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { attach, cube, dropFile, launch, newContext, openExample, linkOf, openPage, pageFile, repository, settled } from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const openIn = (language, options = {}) => openPage(browser, { fragment: `?lang=${language}${linkOf('arm_breaks_b')}`, viewport: { width: 1200, height: 800 }, ...options });

/**
 * Texts and attributes with a word in them that stands in no brackets. Numbers, cells, units, names of keys, axes and what
 * the core says in its own words are no texts of the page.
 */
const strays = (page) =>
  page.evaluate(() => {
    const CORE = '#verdict-reason, #why-text, #breaking-text, #sure-text, #lose-text, #deformed-text, #report-text, #legend .none';
    const OWN = 'script, style, noscript, option[lang], #axes, #name, h1, .keys th, #sequence-text, #kept .card';
    const isFine = (text) => {
      const left = text
        .replace(/⟦[^⟦⟧]*(⟦[^⟦⟧]*⟧[^⟦⟧]*)*⟧/g, '')
        .replace(/\b(N mm|N|mm|ms|s|kg|MPa|mm²|mm⁴|m\/s²)(?![a-z])/g, '')
        .replace(/[+−-][xyz]{1,3}\b|\b[xyz]\b/g, '')
        .replace(/\b[NVMT] \(/g, '');
      return !/[A-Za-z]{2,}/.test(left);
    };
    const found = [];
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
      const { data, parentElement } = walk.currentNode;
      if (!parentElement.closest(`${CORE}, ${OWN}`) && !isFine(data)) {
        found.push(data.trim());
      }
    }
    for (const name of ['title', 'aria-label', 'aria-roledescription', 'placeholder', 'aria-valuetext']) {
      document.querySelectorAll(`body [${name}]`).forEach((one) => {
        if (!one.closest(OWN) && !isFine(one.getAttribute(name))) {
          found.push(`${name}: ${one.getAttribute(name)}`);
        }
      });
    }
    return found;
  });

/** What only the core says: the sentence on second order. */
const isOfCore = (text) => /^(buckling|linear|not |does not)/.test(text);

async function expectNoStrays(page, where) {
  assert.deepEqual((await strays(page)).filter((text) => !isOfCore(text)), [], where);
}

test('no text of the page bypasses the table', async () => {
  const page = await openIn('pseudo');
  await expectNoStrays(page, 'at first');
  for (const tool of ['v', 'd', 'p', 'o', 'l', 'a']) {
    await page.keyboard.press(tool);
    await expectNoStrays(page, `the tool ${tool}`);
  }
  await page.click('#gallery-open');
  await page.waitForFunction(() => document.querySelectorAll('.card-verdict:not(:empty)').length > 20);
  await expectNoStrays(page, 'the gallery');
  await page.keyboard.press('Escape');
  await page.click('#connections summary');
  await page.keyboard.press('w');
  await page.waitForSelector('#why-list li');
  await expectNoStrays(page, 'why, and the table of connections');
  await page.keyboard.press('n');
  await expectNoStrays(page, 'force flow');
  await page.keyboard.press('n');
  await page.keyboard.press('f');
  await page.waitForFunction(() => document.getElementById('faces').textContent.startsWith('⟦'));
  await page.click('#topple');
  await page.waitForFunction(() => globalThis.holdfast.app.isToppled);
  await expectNoStrays(page, 'what has fallen');
  await page.keyboard.press('t');
  await page.click('#deform');
  await page.waitForFunction(() => globalThis.holdfast.app.mode === 'deformed');
  await expectNoStrays(page, 'the deformed shape');
  await page.click('#deform');
  await page.selectOption('#subject', 'modules');
  await page.selectOption('#cut', 'above');
  await page.click('#find-limit');
  await page.waitForFunction(() => document.getElementById('limit-text').textContent);
  await expectNoStrays(page, 'the limit load');
  assert.deepEqual(page.faults, []);
});

test('no text of other robots, of steps and of refusals does either', async () => {
  const page = await openIn('pseudo');
  for (const name of ['slope', 'slot', 'prism_wall', 'disc_arch', 'catom_pyramid', 'arm_tips_b', 'fixed_arm']) {
    await openExample(page, name);
    await expectNoStrays(page, name);
  }
  await page.click('#lose');
  await page.waitForFunction(() => document.getElementById('lose').getAttribute('aria-pressed') === 'true' || document.getElementById('lose-text').textContent);
  await expectNoStrays(page, 'losses');
  await page.click('#judge-steps');
  await page.waitForSelector('#sequence:not([hidden])');
  await page.click('#stage-on');
  await expectNoStrays(page, 'a stage');
  await page.click('#build-on');
  await page.click('#record');
  await attach(page);
  await settled(page);
  await expectNoStrays(page, 'recording');
  await page.click('#record');
  await page.click('#simulate');
  await page.waitForSelector('#player:not([hidden])');
  await page.click('#play');
  await page.click('#step-on');
  await expectNoStrays(page, 'the robot’s own computation');
  await page.click('#material-form summary');
  for (const [field, text] of [['#material input', 'abc'], ['#material input', '-1'], ['#surroundings input[type=text]', 'x']]) {
    await page.locator(field).first().fill(text);
    await page.keyboard.press('Tab');
    await expectNoStrays(page, `${text} in a field`);
  }
  await page.click('#gallery-open');
  await page.click('[data-challenge=reach]');
  await page.waitForSelector('#challenge:not([hidden])');
  await expectNoStrays(page, 'a challenge');
  await page.click('#new');
  await expectNoStrays(page, 'no robot');
  await page.evaluate(() => (location.hash = '#s=broken'));
  await expectNoStrays(page, 'a broken link');
  assert.deepEqual(page.faults, []);
});

test('a French reader has French words and numbers, and can have English', async () => {
  const context = await newContext(browser, { viewport: { width: 1200, height: 800 }, locale: 'fr-FR' });
  const page = await openPage(browser, { context, fragment: linkOf('arm_breaks_b') });
  assert.equal(await page.getAttribute('html', 'lang'), 'fr');
  assert.match(await page.innerText('#verdict-word'), /Surcharge\s+il casse/);
  assert.match(await page.innerText('#chip-numbers'), /charge 1,20 · marge 10,8 mm · 1 sur 14 cassent/);
  assert.doesNotMatch(await page.innerText('.label'), /\./);
  assert.match(await page.innerText('#help'), /\?/);
  // The robot goes along, whatever was done to it.
  await attach(page);
  await settled(page);
  const before = await page.evaluate(() => globalThis.holdfast.bench.robot.count);
  await page.selectOption('#language', 'en');
  await page.waitForFunction(() => location.search === '?lang=en' && document.documentElement.classList.contains('ready'));
  await settled(page);
  assert.match(await page.innerText('#verdict-word'), /Overload/);
  assert.equal(await page.evaluate(() => globalThis.holdfast.bench.robot.count), before);
  // It is remembered; an address says otherwise.
  await page.goto(pathToFileURL(pageFile).href);
  await page.waitForSelector('html.ready');
  assert.equal(await page.getAttribute('html', 'lang'), 'en');
  await page.goto(`${pathToFileURL(pageFile).href}?lang=fr`);
  await page.waitForSelector('html.ready');
  assert.equal(await page.inputValue('#language'), 'fr');
  assert.deepEqual(page.faults, []);
});

test('French numbers are read and shown with a comma', async () => {
  const page = await openIn('fr');
  await page.click('#material-form summary');
  const field = page.locator('#material label', { hasText: 'Coefficient de Poisson' }).locator('input');
  assert.equal(await field.inputValue(), '0,3');
  for (const [text, shown] of [['0,25', '0,25'], ['0.2', '0,2']]) {
    await field.fill(text);
    await page.keyboard.press('Tab');
    assert.equal(await field.inputValue(), shown);
    assert.equal(await page.evaluate(() => globalThis.holdfast.bench.robot.material[7]), Number(text.replace(',', '.')));
  }
  assert.deepEqual(page.faults, []);
});

test('on a phone nothing is cut off in French', async () => {
  const page = await openIn('fr', { viewport: { width: 390, height: 780 } });
  const wide = await page.evaluate(() =>
    [...document.querySelectorAll('button, #verdict h2, select, .row')]
      .filter((one) => one.checkVisibility() && !one.closest('dialog') && (one.getBoundingClientRect().right > innerWidth + 0.5 || one.scrollWidth > one.clientWidth + 1))
      .map((one) => one.id || one.textContent),
  );
  assert.deepEqual(wide, []);
});

/** Words of its answers. */
const FROM_THE_CORE = ['regularised', 'unilateral', 'holds', 'falls', 'nothing to spare'];

test('the table has no text that nobody uses, and the same places for values in both languages', async () => {
  const page = await openPage(browser);
  // Labels, phases, methods: the core's vocabulary is in the script.
  const core = await page.evaluate(() => document.querySelector('script[type=module]:last-of-type').textContent);
  const folder = path.join(repository, 'apps/web/src');
  const sources = readdirSync(folder, { recursive: true })
    .filter((name) => name.endsWith('.ts') && !name.startsWith('texts'))
    .map((name) => readFileSync(path.join(folder, name), 'utf8'));
  const all = [...sources, readFileSync(path.join(repository, 'apps/web/index.html'), 'utf8')].join('\n');
  const entries = ['page', 'said', 'gallery'].flatMap((name) =>
    [...readFileSync(path.join(folder, 'texts', `${name}.ts`), 'utf8').matchAll(/^ {2}('(?:[^'\\]|\\.)*'|"[^"]*"|\w+):\s+'((?:[^'\\]|\\.)*)',$/gm)].map(([, key, french]) => [
      key.replace(/^['"]|['"]$/g, '').replaceAll("\\'", "'"),
      french,
    ]),
  );
  assert.ok(entries.length > 350, `${entries.length} texts`);
  const places = (text) => [...text.matchAll(/\{\d\}/g)].map(String).sort();
  const unused = entries.filter(([english]) => {
    const inCode = all.includes(english) || all.includes(english.replaceAll("'", "\\'")) || all.toLowerCase().includes(`'${english.toLowerCase()}'`);
    return !inCode && !core.includes(`"${english}"`) && !FROM_THE_CORE.includes(english) && !/^\{0\} (step|module)s?$/.test(english);
  });
  assert.deepEqual(unused.map(([english]) => english), []);
  entries.forEach(([english, french]) => assert.deepEqual(places(french), places(english), english));
});
