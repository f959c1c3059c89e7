// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A walk of random actions of a user over one page, each after any other. After each of them the page says what
// the program says of the robot that the page's own state describes, and what a page that has just opened the
// saved file says and shows. HOLDFAST_WALK is the number of actions, HOLDFAST_SEED another walk; HOLDFAST_DEEDS
// names what is done in the first walk, by commas, and after every HOLDFAST_FRESH actions the file is opened anew.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { dropFile, launch, openPage, program, repository, settled, temporaryFolder } from './browser.mjs';

const ACTIONS = Number(process.env.HOLDFAST_WALK ?? 60);
const FRESH = Number(process.env.HOLDFAST_FRESH ?? 1);
const SEED = Number(process.env.HOLDFAST_SEED ?? 1);

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

/** Mulberry32: numbers in [0, 1), the same for the same seed everywhere. */
function randomOf(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let value = Math.imul(state ^ (state >>> 15), 1 | state);
    value = (value + Math.imul(value ^ (value >>> 7), 61 | value)) ^ value;
    return ((value ^ (value >>> 14)) >>> 0) / 2 ** 32;
  };
}

const FILES = [
  'arm_breaks_a', 'arm_tips_b', 'bush_tips_a', 'angle_breaks_b', 'plan/walk_over_beam', 'plan/balance', 'plan/pair',
].map((name) => readFileSync(path.join(repository, 'scenarios', `${name}.json`), 'utf8'));

/** In the order of the page's numbers. */
const KEYS = readFileSync(path.join(repository, 'libs/model/include/holdfast/model/material.hpp'), 'utf8')
  .match(/^ {4}\{"\w+"/gm)
  .map((text) => text.slice(6, -1));

/** What the page has and what it says and shows. */
const look = (page) =>
  page.evaluate((keys) => {
    const { app, bench, player, timeline } = globalThis.holdfast;
    const { robot } = bench;
    const { view } = app;
    app.unpin();
    app.point(undefined);
    const one = (id) => document.getElementById(id);
    const textOf = (id) => (one(id).hidden ? '' : one(id).innerText.trim());
    const modules = [];
    const planned = [];
    const own = new Map((robot.surroundings.modules ?? []).map((entry) => [String(entry.cell), entry]));
    for (let slot = 0; slot < robot.count; ++slot) {
      const cell = robot.cellAt(slot);
      const entry = { ...own.get(String(cell)), cell };
      (robot.roleAt(slot) === 1 ? planned : modules).push(robot.roleAt(slot) === 2 ? { ...entry, fixed: true } : entry);
    }
    const { steps: _, ...surroundings } = robot.surroundings;
    // The elastic modulus of 100 MPa is stated only where the file does so; any other is stated by being another.
    const isSaid = ([key, value]) => key !== 'gravity_m_s2' && !(key === 'elastic_modulus_mpa' && value === 100);
    const material = Object.fromEntries(keys.map((key, i) => [key, robot.material[i]]).filter(isSaid));
    const structure = {
      ...surroundings,
      format: 'holdfast-structure', version: 2, name: 'walk', lattice: robot.lattice.name,
      support_z: robot.hasFloor ? robot.supportZ : null, gravity_m_s2: [...robot.gravity],
      material: { ...surroundings.material, ...material }, modules, planned,
    };
    const looks = [...view.drawn].map((slot, i) => [
      String(app.robot.cellAt(slot)), [...view.modules.tints.slice(3 * i, 3 * i + 3)], view.modules.patterns[i] % 16,
    ]);
    const rows = [...one('figures').children].map((row) => row.innerText);
    const fields = [...document.querySelectorAll('#surroundings input, #material input')]
      .map((input) => [input.ariaLabel ?? input.closest('label').textContent, input.type === 'checkbox' ? input.checked : input.ariaInvalid ? 'refused' : input.value])
      // The level of a floor that is not there is in no file.
      .filter(([label]) => !/^(Obstacles|Downhill)/.test(label) && (robot.hasFloor || label !== 'Ground at z'));
    const { answer, problem } = app.finding ?? {};
    return {
      structure,
      count: robot.count,
      answer: answer && { verdict: answer.verdict, ratio: answer.load_ratio_max, margin: answer.stability.margin_mm, stable: answer.stability.stable },
      problem,
      panel: {
        verdict: one('verdict').dataset.verdict, word: textOf('verdict-word'), reason: textOf('verdict-reason'),
        // Of connections that are alike the worst one is whichever comes first.
        figures: rows.filter((_, i) => !/^Solved/.test(rows[i - (i % 2)])).map((text) => text.replace(/ {2}\(.*/, '')),
        facets: textOf('facet-legend'), topple: one('topple').hidden, lattice: one('lattice').value, fields,
      },
      looks: looks.sort(([a], [b]) => (a < b ? -1 : 1)),
      collar: view.collar.visible,
      hasOwnColours: view.hasOwnColours,
      stage: timeline.at,
      stageVerdict: timeline.report?.verdict,
      mode: app.mode,
      isExhibiting: app.isExhibiting,
      hasLosses: view.losses !== undefined,
      chip: textOf('chip-numbers'),
      scatter: Number(one('scatter').value),
      hasTrace: player.trace !== undefined,
      limit: textOf('limit-text'),
      recording: one('record').getAttribute('aria-pressed') === 'true' ? Number(/(\d+) step/.exec(one('sequence-text').innerText)?.[1]) : undefined,
      isOff: [...document.querySelectorAll('[data-built]')].map((part) => part.inert),
      existing: modules.map(({ cell }) => String(cell)).sort().join(' '),
    };
  }, KEYS);

/** A button that a user can reach is clicked; otherwise nothing happens. */
const press = (page, id) =>
  page.evaluate((name) => {
    const button = document.getElementById(name);
    const isThere = button.checkVisibility() && !button.disabled && !button.closest('[inert]');
    if (isThere) {
      button.click();
    }
    return isThere;
  }, id);

const waitFor = (page, condition, ms) => page.waitForFunction(condition, undefined, { timeout: ms }).catch(() => undefined);

/** A number that is not refused is the one that its field shows from then on; the field shows what the robot has. */
async function expectTaken(field, name, text) {
  const isRefused = await field.evaluate((input) => Boolean(input.ariaInvalid));
  const typed = Number(text);
  // A slope follows from the vector, which has many of them.
  if (isRefused || text.trim() === '' || /^(Slope|Downhill|Strength)/.test(name)) {
    return;
  }
  const shown = Number(await field.inputValue());
  assert.ok(Math.abs(shown - typed) <= 1e-3 * Math.abs(typed), `${name}: ${text} is typed, the field shows ${shown}`);
}

/** Where the robot is cut open, as a share of its size. */
const setCut = (page, share) =>
  page.evaluate((part) => {
    const slider = document.getElementById('cut-at');
    if (!slider.hidden) {
      slider.value = String(Number(slider.min) + part * (slider.max - slider.min));
      slider.dispatchEvent(new Event('input'));
    }
  }, share);

/** What a user can do, by the name that a failure shows; each gets the page and a source of chance. */
const DEEDS = {
  async edit(page, { pick, chance }) {
    const [tool, role] = [pick(['add', 'add', 'remove', 'paint']), pick([0, 0, 1, 2])];
    await page.evaluate(([what, which, where]) => {
      const { bench } = globalThis.holdfast;
      const { robot } = bench;
      bench.setTool(what, which);
      const free = robot.count > 0 ? robot.freePlaces() : [[0, 0, robot.supportZ]];
      const all = what === 'add' ? free : Array.from({ length: robot.count }, (_, slot) => robot.cellAt(slot));
      if (all.length > 0) {
        bench.use([all[Math.floor(where * all.length)]]);
      }
    }, [tool, role, chance()]);
    return `${tool} ${role}`;
  },
  /** A module that `take away` may remove by hand: no undoing, whatever the recording made of the one before. */
  async put(page, chance) {
    chance.put = await page.evaluate((where) => {
      const { bench } = globalThis.holdfast;
      bench.setTool('add', 0);
      const free = bench.robot.count > 0 ? bench.robot.freePlaces() : [];
      const cell = free[Math.floor(where * free.length)];
      if (cell) {
        bench.use([cell]);
      }
      return cell;
    }, chance.chance());
  },
  async 'take away'(page, chance) {
    await page.evaluate((cell) => {
      const { bench } = globalThis.holdfast;
      bench.setTool('remove', 0);
      if (cell) {
        bench.use([cell]);
      }
    }, chance.put);
    chance.put = undefined;
  },
  async obstacle(page, { chance, pick }) {
    await page.evaluate(([hold, where]) => {
      const { bench } = globalThis.holdfast;
      bench.setHold(hold);
      const free = bench.robot.freePlaces();
      if (free.length > 0) {
        bench.use([free[Math.floor(where * free.length)]]);
      }
    }, [pick(['contact', 'bonded']), chance()]);
  },
  async load(page, { chance, pick }) {
    await page.evaluate(([burden, where]) => {
      const { bench } = globalThis.holdfast;
      bench.setBurden(burden);
      if (bench.robot.count > 0) {
        bench.use([bench.robot.cellAt(Math.floor(where * bench.robot.count))]);
      }
    }, [pick([
      { force: [0, 0, 0], torque: [0, 0, 0] },
      { force: [chance() - 0.5, 0, -3 * chance()], torque: [0, 20 * chance(), 0] },
      { mass: 0.01 + 0.3 * chance(), force: [0, 0, 0], torque: [0, 0, 0] },
    ]), chance()]);
  },
  async type(page, { pick, chance }) {
    await page.evaluate(() => (document.querySelector('#material-form').open = true));
    const fields = page.locator('#surroundings input[type=text], #material input');
    const field = chance() < 0.3 ? page.getByLabel('Gravity z') : fields.nth(Math.floor(chance() * (await fields.count())));
    const old = Number(await field.inputValue());
    const near = String(Number((old * 4 ** (2 * chance() - 1)).toPrecision(4)));
    const text = pick([near, near, near, near, String(-old), '0', '15', '0.4', '-30', '-1', 'abc', '1e300', '']);
    await field.fill(text);
    await field.press('Enter');
    const name = await field.evaluate((input) => input.ariaLabel ?? input.closest('label').textContent);
    await expectTaken(field, name, text);
    return `${name}: ${text}`;
  },
  floor: (page) => page.evaluate(() => document.getElementById('floor').click()),
  async lattice(page, { pick }) {
    await page.selectOption('#lattice', pick(['cubic', 'cubic', 'face-centred', 'hexagonal', 'hexagonal-prism']));
  },
  undo: (page) => press(page, 'undo'),
  redo: (page) => press(page, 'redo'),
  record: (page) => press(page, 'record'),
  async open(page, { pick }) {
    const text = pick(FILES);
    await dropFile(page, 'walk.json', text);
    await page.waitForFunction((source) => globalThis.holdfast.bench.robot.base === source, text);
    return JSON.parse(text).name;
  },
  async limit(page) {
    if (await press(page, 'find-limit')) {
      await waitFor(page, () => !document.getElementById('limit-text').hidden, 3000);
    }
  },
  collapse: (page) => press(page, 'collapse'),
  async simulate(page, { chance }) {
    if ((await press(page, 'simulate')) && chance() < 0.8) {
      await waitFor(page, () => globalThis.holdfast.player.trace, 2000);
    }
  },
  async order(page) {
    if (await press(page, 'order')) {
      await waitFor(page, () => !document.getElementById('order').disabled, 1500);
    }
  },
  async stages(page, { pick }) {
    await waitFor(page, () => globalThis.holdfast.timeline.judged, 600);
    const id = pick(['stages-play', 'stage-on', 'stage-back', 'first-unsafe']);
    await press(page, id);
    return id;
  },
  'build on': (page) => press(page, 'build-on'),
  faces: (page) => press(page, 'faces'),
  async bend(page, { pick }) {
    const value = pick([0, 60]);
    await page.evaluate((share) => {
      const slider = document.getElementById('exaggeration');
      if (!slider.closest('[inert]')) {
        slider.value = share;
        slider.dispatchEvent(new Event('input'));
      }
    }, value);
  },
  async deform(page) {
    if ((await press(page, 'deform')) && !(await page.isHidden('#deformed'))) {
      await waitFor(page, () => globalThis.holdfast.app.mode === 'deformed', 1500);
    }
  },
  async remedy(page, { pick }) {
    await waitFor(page, () => document.querySelector('#why-list button'), 800);
    const kind = pick(['module', 'prop', 'fixing', 'removal']);
    await page.evaluate((name) => {
      const button = document.querySelector(`[data-remedy=${name}]`);
      if (button && !button.closest('[inert]')) {
        button.click();
      }
    }, kind);
    return kind;
  },
  async lose(page) {
    if (await press(page, 'lose')) {
      await waitFor(page, () => document.getElementById('lose-text').textContent !== '', 1500);
    }
  },
  async scatter(page, { pick }) {
    await page.evaluate((value) => {
      const slider = document.getElementById('scatter');
      if (!slider.closest('[inert]')) {
        slider.value = value;
        slider.dispatchEvent(new Event('input'));
      }
    }, pick([0, 10, 30]));
  },
  async look(page, { pick, chance }) {
    const how = pick(['xray', 'from', 'cut', 'present']);
    if (how === 'xray') {
      await press(page, 'xray');
    } else if (how === 'present') {
      await press(page, pick(['present', 'present-end']));
      await press(page, 'present-end');
    } else if (how === 'from') {
      await page.evaluate((side) => document.querySelector(`[data-from=${side}]`).click(), pick(['oblique', 'front', 'right', 'top']));
    } else {
      await page.selectOption('#cut', pick(['', '', 'above', 'front', 'right']));
      await setCut(page, chance());
    }
    return how;
  },
  async challenge(page, { chance }) {
    await press(page, 'gallery-open');
    await page.evaluate((where) => {
      const all = document.querySelectorAll('[data-challenge]');
      all[Math.floor(where * all.length)]?.click();
    }, chance());
    await page.waitForFunction(() => !document.querySelector('dialog[open]'));
    await settled(page);
  },
  /** Some modules, and something that is done with all of them. What is selected has frames, nothing else has. */
  async select(page, { pick, chance }) {
    const deed = pick(['move', 'move', 'copy', 'turn', 'mirror-x', 'mirror-y', 'fill', 'load', 'remove', 'connected', 'layer', 'none']);
    await page.evaluate(([from, size, side]) => {
      const { bench } = globalThis.holdfast;
      bench.setTool('select');
      const cells = Array.from({ length: bench.robot.count }, (_, slot) => bench.robot.cellAt(slot));
      bench.selection.set(cells.slice(from * cells.length, from * cells.length + 1 + 3 * size));
      const { options } = document.getElementById('select-direction');
      document.getElementById('select-direction').selectedIndex = Math.floor(side * options.length);
    }, [chance(), chance(), chance()]);
    await press(page, `select-${deed}`);
    await settled(page);
    const [framed, chosen] = await page.evaluate(() => {
      const { app, bench } = globalThis.holdfast;
      const isFramed = (_, i) => app.view.modules.patterns[i] >= 16;
      const textOf = (cell) => String(cell);
      const seen = [...app.view.drawn].filter(isFramed).map((slot) => textOf(app.robot.cellAt(slot)));
      const drawn = new Set([...app.view.drawn].map((slot) => textOf(app.robot.cellAt(slot))));
      return [seen.sort(), app.mode === 'build' ? bench.selection.cells.map(textOf).filter((cell) => drawn.has(cell)).sort() : []];
    });
    assert.deepEqual(framed, chosen, `${deed}: frames`);
    return deed;
  },
  worst: (page) => page.evaluate(() => globalThis.holdfast.app.seeWorst()),
  async colours(page, { pick }) {
    await page.selectOption('#scale', pick(['paper', 'cividis']));
    await page.selectOption('#subject', pick(['connections', 'modules']));
  },
};

/** How often each is done. */
const WEIGHTS = { edit: 8, put: 2, 'take away': 2, type: 8, undo: 4, redo: 2, record: 2, open: 2, simulate: 3, stages: 4, limit: 2, collapse: 2, load: 2, obstacle: 2, deform: 3, remedy: 2, lose: 2, select: 3 };
const CHOSEN = process.env.HOLDFAST_DEEDS?.split(',') ?? Object.keys(DEEDS);
const NAMES = CHOSEN.flatMap((name) => Array(WEIGHTS[name] ?? 1).fill(name));

/** What the text of a recording has to count: undoing what came last is none, undoing beyond its beginning a change as others are. */
class Count {
  constructor(existing) {
    this.states = [existing];
  }

  get length() {
    return this.states.length - 1;
  }

  follow(deed, existing) {
    if (deed === 'undo' && this.states.at(-2) === existing) {
      this.states.pop();
    } else {
      this.states.push(existing);
    }
  }
}

/** The picture and the panel are those of a page that has just opened the file that this one saves. */
async function expectFresh(page, fresh, seen, where) {
  const text = await page.evaluate(() => globalThis.holdfast.write(globalThis.holdfast.bench, 0));
  for (const id of ['#scale', '#subject']) {
    await fresh.selectOption(id, await page.inputValue(id));
  }
  await dropFile(fresh, 'walk.json', text);
  await fresh.waitForFunction((source) => globalThis.holdfast.bench.robot.base === source, text);
  await settled(fresh);
  await fresh.selectOption('#cut', await page.inputValue('#cut'));
  await setCut(fresh, await page.evaluate(() => {
    const { min, max, value } = document.getElementById('cut-at');
    return max > min ? (value - min) / (max - min) : 0;
  }));
  if ((await page.getAttribute('#xray', 'aria-pressed')) !== (await fresh.getAttribute('#xray', 'aria-pressed'))) {
    await press(fresh, 'xray');
  }
  const other = await look(fresh);
  // What was refused still stands in its field.
  const fields = other.panel.fields.map(([label, value], k) => [label, seen.panel.fields[k][1] === 'refused' ? 'refused' : value]);
  assert.deepEqual(seen.panel, { ...other.panel, fields }, `${where}: panel`);
  if (!seen.hasTrace) {
    const isNear = ([, a], [, b]) => a.every((value, k) => Math.abs(value - b[k]) <= 1);
    assert.deepEqual(seen.looks.map(([cell, , pattern]) => [cell, pattern]), other.looks.map(([cell, , pattern]) => [cell, pattern]), where);
    assert.ok(seen.looks.every((one, i) => isNear(one, other.looks[i])), `${where}: colours`);
    assert.equal(seen.collar, other.collar, `${where}: collar`);
  }
}

const isNear = (a, b) => a === b || Math.abs(a - b) <= 1e-9 * Math.max(1, Math.abs(a), Math.abs(b));

/** The program's answers to the structures, all asked at once. */
function expectProgram(asked) {
  const folder = temporaryFolder();
  const fileOf = ({ seen }, i) => {
    const file = path.join(folder, `${i}.json`);
    writeFileSync(file, JSON.stringify(seen.structure));
    return file;
  };
  const check = (files) => spawnSync(program, ['check', '--quiet', '--json', '-', ...files], { encoding: 'utf8', maxBuffer: 1 << 28 });
  const files = asked.map(fileOf);
  const [good, bad] = [asked.filter(({ seen }) => seen.answer), asked.filter(({ seen }) => !seen.answer)];
  const reports = good.length === 0 ? [] : [JSON.parse(check(good.map((one) => files[asked.indexOf(one)])).stdout)].flat();
  good.forEach(({ seen, where }, i) => {
    const { verdict, overload: { load_ratio_max }, stability } = reports[i];
    assert.equal(seen.answer.verdict, verdict, where);
    assert.equal(seen.answer.stable, stability.stable, where);
    for (const [own, native] of [[seen.answer.ratio, load_ratio_max], [seen.answer.margin, stability.simplified.margin_mm]]) {
      assert.ok(isNear(own, native), `${where}: ${own} on the page, ${native} by the program`);
    }
  });
  for (const one of bad) {
    const { status, stderr } = check([files[asked.indexOf(one)]]);
    assert.equal(status, 65, `${one.where}: “${one.seen.problem}” on the page, ${status} by the program`);
    assert.ok(stderr.length > 0);
  }
  rmSync(folder, { recursive: true });
  return { good: good.length, bad: bad.length };
}

/** What holds of the page by itself, whatever came before. */
function expectConsistent(seen, where) {
  assert.ok(!/is not possible|\/material|gravity/.test(seen.problem ?? ''), `${where}: a field has taken what cannot be: ${seen.problem}`);
  assert.ok(seen.isOff.every((isOff) => isOff === seen.isExhibiting), `${where}: what is about the robot that is built is off beside a stage`);
  assert.doesNotMatch(`${seen.panel.figures} ${seen.limit}`, /-0\b(?!\.[1-9])|NaN|undefined/, where);
  assert.ok(!seen.hasTrace || seen.hasOwnColours, `${where}: the computation that is open has its colours`);
  assert.ok(!seen.hasLosses || (seen.mode === 'build' && seen.answer?.verdict === 'safe'), `${where}: losses of what is not safe, or not shown`);
  assert.ok(!/ p = /.test(seen.chip) || (seen.scatter > 0 && seen.mode === 'build'), `${where}: a probability that nobody asked for`);
  if (seen.isExhibiting) {
    assert.ok(seen.mode !== 'stage' || seen.panel.verdict === seen.stageVerdict, where);
    assert.ok(!seen.hasTrace && !seen.hasOwnColours, `${where}: a stage has its own colours`);
  }
}

test('whatever is done in whatever order, the page says and shows what is so', { timeout: 3_600_000 }, () => walk(NAMES, ACTIONS));

test('whatever is built and taken back, the recorder counts what is so', { timeout: 3_600_000 }, () =>
  walk(['record', 'put', 'put', 'take away', 'take away', 'undo', 'redo', 'edit'], ACTIONS));

async function walk(names, actions) {
  // Small, as most of the time goes into pictures.
  const viewport = { width: 840, height: 320 };
  const [page, fresh] = [await openPage(browser, { viewport }), await openPage(browser, { viewport })];
  const random = randomOf(SEED);
  const chance = { chance: random, pick: (list) => list[Math.floor(random() * list.length)] };
  const asked = [];
  const trail = [];
  let recorded;
  let limitOf;
  let compared = 0;
  let before = await look(page);
  for (let i = 0; i < actions; ++i) {
    // What is no robot is mostly taken back: answers are to be compared, not refusals.
    const name = before.problem && random() < 0.8 ? 'undo' : chance.pick(names);
    const said = await DEEDS[name](page, chance);
    trail.push(typeof said === 'string' ? `${name} ${said}` : name);
    const where = `seed ${SEED}, action ${i}: ${trail.slice(-8).join(', ')}`;
    await settled(page);
    const seen = await look(page);
    expectConsistent(seen, where);
    const mayReplace = ['open', 'challenge', 'lattice', 'undo', 'redo'].includes(name);
    if (name === 'record') {
      recorded = recorded ? undefined : new Count(seen.existing);
    } else if (name === 'open' || name === 'challenge' || (mayReplace && seen.recording === undefined)) {
      recorded = undefined;
    } else if (recorded && seen.existing !== before.existing) {
      recorded.follow(name, seen.existing);
    }
    assert.equal(seen.recording, recorded?.length, `${where}: steps that are recorded`);
    limitOf = seen.limit === '' ? undefined : (limitOf ?? JSON.stringify(seen.structure));
    assert.ok(seen.limit === '' || limitOf === JSON.stringify(seen.structure), `${where}: a limit load of another robot`);
    if (seen.count > 0) {
      asked.push({ seen, where });
    }
    if (i % FRESH === 0 && seen.count > 0 && !seen.isExhibiting && !(seen.hasOwnColours && !seen.hasTrace) && !seen.hasLosses) {
      await expectFresh(page, fresh, seen, where);
      ++compared;
    }
    before = seen;
  }
  const { good, bad } = expectProgram(asked);
  console.log(`# ${actions} actions: ${good} answers and ${bad} refusals of the program, ${compared} pages opened anew`);
  assert.ok(good > 0.5 * actions && compared > (0.4 * actions) / FRESH);
  assert.deepEqual([...page.faults, ...fresh.faults], []);
}
