// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Sequences of steps: judged as by the native program, played, recorded, taken away.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { after, before, test } from 'node:test';
import {
  clickFace, count, dropFile, facePoint, launch, message, openExample, openPage, program, repository, settled, temporaryFolder, verdict,
  withoutCommandLine,
} from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

const file = (name, rest) => JSON.stringify({ format: 'holdfast-structure', version: 2, name, ...rest });
const row = (from, to, y, z) => Array.from({ length: to - from + 1 }, (_, i) => [from + i, y, z]);
const moves = (...cells) => cells.slice(1).map((to, i) => ({ move: [{ from: cells[i], to }] }));

/** A cantilever that bears a module near its root only; the base is wide enough not to topple. */
const LONG_BEAM = file('long_beam', {
  modules: [...row(0, 4, 0, 0), ...row(0, 4, 1, 0), [0, 0, 1], ...row(0, 4, 0, 2), [0, 0, 3]],
  steps: moves(...row(0, 4, 0, 3)),
});
/** Without its counterweight it tips. */
const COUNTERWEIGHT = file('counterweight', {
  modules: [[0, 0, 0], ...row(-2, 2, 0, 1)],
  steps: [{ detach: [[-2, 0, 1]] }, { detach: [[-1, 0, 1]] }, { attach: [[-1, 0, 1]] }],
});
const PLANNED = JSON.stringify({
  format: 'holdfast-structure',
  version: 1,
  name: 'planned',
  modules: [[0, 0, 0], [0, 0, 1]],
  planned: [[1, 0, 1]],
  later_steps: [[[2, 0, 1]], [[3, 0, 1], [-1, 0, 1]]],
});
const SPHERES = file('spheres', {
  lattice: 'face-centred',
  modules: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1]],
  steps: [{ attach: [[0, 0, 2]] }, { attach: [[1, 0, 2]] }, { detach: [[0, 1, 0]] }],
});

/** The native program's report of a sequence, without what is the run's own. */
function native(text) {
  const place = path.join(temporaryFolder(), 'steps.json');
  writeFileSync(place, text);
  const run = () => execFileSync(program, ['steps', '--quiet', '--json', '-', place], { encoding: 'utf8', maxBuffer: 1 << 28 });
  try {
    return comparable(withoutCommandLine(JSON.parse(run())));
  } catch (error) {
    // Exit codes 1 and 2 are verdicts.
    assert.ok(error.status === 1 || error.status === 2, error.message);
    return comparable(withoutCommandLine(JSON.parse(error.stdout)));
  }
}

const comparable = ({ seconds: _, warnings: __, ...report }) => report;

async function open(page, text) {
  const { name } = JSON.parse(text);
  await dropFile(page, `${name}.json`, text);
  await page.waitForFunction((title) => globalThis.holdfast.bench.robot.name === title, name);
  await settled(page);
}

async function openSteps(page, text) {
  await open(page, text);
  await page.waitForFunction(() => globalThis.holdfast.timeline.judged);
  return page.evaluate(() => globalThis.holdfast.timeline.judged.report);
}

/** Cell and drawn place of every module in the picture. */
const drawn = (page) =>
  page.evaluate(() => {
    const { robot } = globalThis.holdfast.app;
    return Array.from({ length: robot.count }, (_, slot) => ({ cell: [...robot.cellAt(slot)], place: [...robot.placeAt(slot)] }));
  });

const WALK = readFileSync(path.join(repository, 'scenarios/plan/walk_over_beam.json'), 'utf8');

test('every stage of every step is judged as by the native program, to the last digit', async () => {
  const page = await openPage(browser);
  const seen = new Set();
  for (const text of [WALK, LONG_BEAM, COUNTERWEIGHT, PLANNED, SPHERES]) {
    const own = comparable(await openSteps(page, text));
    assert.deepEqual(own, native(text), own.name);
    own.steps.forEach(({ stages }) => Object.values(stages).forEach((stage) => seen.add(stage.verdict)));
  }
  assert.ok(['safe', 'overload', 'unstable'].every((one) => seen.has(one)), [...seen].join());
  assert.deepEqual(page.faults, []);
});

test('the first unsafe stage is one click away, and shows what is so', async () => {
  const page = await openPage(browser);
  const report = await openSteps(page, LONG_BEAM);
  assert.ok(report.first_unsafe);
  assert.equal(await page.isVisible('#build-on'), false, 'what is built is shown first');
  await page.click('#first-unsafe');
  const { step, stage } = report.first_unsafe;
  assert.match(await page.textContent('#stage-text'), new RegExp(`Step ${step} .*${stage}: overload`));
  await page.waitForFunction(() => globalThis.holdfast.timeline.loads);
  assert.equal(await verdict(page), 'overload');
  assert.match(await page.textContent('#figures'), /Largest load1\.\d/);
  assert.ok((await page.textContent('#verdict-reason')).toLowerCase().includes(report.steps[step].stages[stage].reasons[0].slice(0, 30).toLowerCase()));
  // Ctrl Z has nothing to do with it, and nothing can be built in another robot than the one that is seen.
  const before = await count(page);
  await page.focus('#canvas');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Enter');
  assert.equal(await count(page), before);
  await page.click('#build-on');
  assert.equal(await verdict(page), 'safe');
  assert.equal((await drawn(page)).length, before);
  assert.deepEqual(page.faults, []);
});

test('in the shift a module is drawn on its way, in the other stages in its cells', async () => {
  const page = await openPage(browser);
  await openSteps(page, WALK);
  const at = async (stage) => {
    await page.fill('#stage-slider', String(stage));
    return drawn(page);
  };
  const placeIn = (list, cell) => list.find((one) => String(one.cell) === String(cell))?.place;
  assert.deepEqual(placeIn(await at(0), [0, 0, 3]), [0, 0, 3]);
  assert.deepEqual(placeIn(await at(2), [1, 0, 3]), [1, 0, 3]);
  assert.equal(placeIn(await at(2), [0, 0, 3]), undefined);
  // Every waypoint of the slide, by the page's own sequence: start, middle, end.
  const way = await page.evaluate(() => {
    const { sequence } = globalThis.holdfast.timeline;
    return [0, 1, 2].map((waypoint) => {
      const robot = sequence.robotAt(0, 'shift', waypoint);
      return [...robot.placeAt(robot.slot([0, 0, 3]))];
    });
  });
  assert.deepEqual(way, [[0, 0, 3], [0.5, 0, 3], [1, 0, 3]]);
  // The last stage is where the module is in the end; back again it is where it was.
  assert.deepEqual(placeIn(await at(17), [2, 0, 1]), [2, 0, 1]);
  assert.deepEqual(placeIn(await at(0), [0, 0, 3]), [0, 0, 3]);
  assert.deepEqual(page.faults, []);
});

test('steps are played to the end, with and without motion', async () => {
  for (const reducedMotion of ['reduce', 'no-preference']) {
    const page = await openPage(browser, { reducedMotion });
    await openSteps(page, WALK);
    await page.click('#stages-play');
    const places = new Set();
    while (await page.evaluate(() => globalThis.holdfast.timeline.isPlaying)) {
      places.add(String((await drawn(page)).at(-1).place));
    }
    assert.equal(await page.inputValue('#stage-slider'), '17');
    assert.ok(places.size > 3, `${places.size} places`);
    assert.deepEqual(page.faults, []);
  }
});

test('what is built is recorded, judged and saved as steps that the program accepts', async () => {
  const page = await openPage(browser);
  await open(page, file('post', { modules: [[0, 0, 0], [1, 0, 0], [0, 0, 1]] }));
  await page.click('#record');
  await clickFace(page, [0, 0, 1], [0, 0, 1]);
  for (const cell of [[0, 0, 3], [0, 0, 4]]) {
    await page.evaluate((at) => globalThis.holdfast.bench.use([at]), cell);
  }
  assert.match(await page.textContent('#sequence-text'), /Recording: 3 steps/);
  await page.click('#undo');
  assert.match(await page.textContent('#sequence-text'), /Recording: 2 steps/, 'what is undone is no step');
  await page.click('#record');
  await page.waitForFunction(() => globalThis.holdfast.timeline.judged);
  assert.equal(await count(page), 3, 'as it was at first');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#save-steps')]);
  const saved = readFileSync(await download.path(), 'utf8');
  assert.deepEqual(JSON.parse(saved).steps, [{ attach: [[0, 0, 2]] }, { attach: [[0, 0, 3]] }]);
  const own = comparable(await page.evaluate(() => globalThis.holdfast.timeline.judged.report));
  assert.deepEqual(own, native(saved));
  await page.click('#undo');
  assert.equal(await count(page), 5, 'undo brings back what was built');
  assert.equal(await page.isVisible('#sequence'), false);
  assert.deepEqual(page.faults, []);
});

test('what is taken away by hand is a step, and a recording ends with its robot', async () => {
  const page = await openPage(browser);
  await open(page, file('post', { modules: [[0, 0, 0], [1, 0, 0], [0, 0, 1]] }));
  await page.click('#record');
  await clickFace(page, [0, 0, 1], [0, 0, 1]);
  await page.evaluate(() => globalThis.holdfast.bench.remove([[0, 0, 2]]));
  assert.match(await page.textContent('#sequence-text'), /Recording: 2 steps/);
  await open(page, file('another', { modules: [[0, 0, 0], [0, 0, 1], [1, 0, 1]] }));
  assert.equal(await page.textContent('#record'), 'Record steps');
  assert.match(await message(page), /recording has ended/);
  assert.equal(await page.evaluate(() => globalThis.holdfast.bench.robot.name), 'another');
  assert.deepEqual(page.faults, []);
});

test('no colours of the computation or of a collapse outlive the robot they were of', async () => {
  const page = await openPage(browser);
  await openExample(page, 'arm_tips_b');
  const stale = () =>
    page.evaluate(() => {
      const { app: { view }, bench: { robot } } = globalThis.holdfast;
      const shown = [...view.modules.tints.slice(0, 3 * robot.count)];
      view.paint();
      return view.hasOwnColours || shown.some((value, i) => value !== view.modules.tints[i]);
    });
  const changes = [
    () => globalThis.holdfast.bench.use([globalThis.holdfast.bench.robot.freePlaces()[0]]),
    () => globalThis.holdfast.bench.history.undo(),
    () => globalThis.holdfast.bench.surround('the floor', { support_z: null }),
  ];
  for (const change of changes) {
    await page.click('#simulate');
    await page.waitForFunction(() => globalThis.holdfast.player.trace && globalThis.holdfast.app.view.paintOver);
    await page.evaluate(change);
    await settled(page);
    assert.equal(await stale(), false, String(change));
  }
  // A collapse leaves the player's colours as they were; without a floor there was nothing to compute.
  await page.click('#undo');
  await settled(page);
  await page.click('#simulate');
  await page.waitForFunction(() => globalThis.holdfast.player.trace && globalThis.holdfast.app.view.paintOver);
  const kept = await page.evaluate(() => {
    const { view } = globalThis.holdfast.app;
    const before = view.paintOver;
    view.showMechanism(new Float64Array(6 * globalThis.holdfast.bench.robot.count), [0]);
    view.showMechanism(undefined, []);
    return view.paintOver === before;
  });
  assert.ok(kept);
  assert.deepEqual(page.faults, []);
});

test('an order is found that the program finds too, and the robot grows by it', async () => {
  const page = await openPage(browser);
  const place = path.join(temporaryFolder(), 'order.json');
  const target = path.join(repository, 'scenarios/plan/balance.json');
  execFileSync(program, ['order', '--quiet', target, '--output', place]);
  const expected = JSON.parse(readFileSync(place, 'utf8'));
  await open(page, readFileSync(target, 'utf8'));
  await page.click('#order');
  await page.waitForFunction(() => globalThis.holdfast.timeline.judged);
  const [modules, steps] = await page.evaluate(() => {
    const { robot } = globalThis.holdfast.bench;
    return [robot.count, robot.surroundings.steps];
  });
  assert.equal(modules, expected.modules.length);
  assert.deepEqual(steps, expected.steps);
  assert.equal(await page.evaluate(() => globalThis.holdfast.timeline.judged.report.verdict), 'safe');
  await page.waitForFunction(() => !globalThis.holdfast.timeline.isPlaying);
  assert.equal((await drawn(page)).length, expected.modules.length + expected.steps.length, 'it has grown to the end');
  assert.deepEqual(page.faults, []);
});

test('where there is no order, that is said', async () => {
  const page = await openPage(browser);
  await open(page, readFileSync(path.join(repository, 'scenarios/plan/pair.json'), 'utf8'));
  const before = await count(page);
  await page.click('#order');
  await page.waitForFunction(() => /none|no order/i.test(document.getElementById('sequence-text').textContent));
  assert.equal(await count(page), before);
  assert.deepEqual(page.faults, []);
});

test('holdfast view opens the page with the sequence', async () => {
  const out = path.join(temporaryFolder(), 'view.html');
  execFileSync(program, ['view', path.join(repository, 'scenarios/plan/walk_over_beam.json'), '--no-open', '--out', out]);
  const page = await openPage(browser, { file: out });
  await page.waitForFunction(() => globalThis.holdfast.timeline.judged);
  assert.match(await page.textContent('#sequence-text'), /6 of 6 steps safe in every stage; largest load 0.750; smallest margin 12.00 mm/);
  assert.deepEqual(page.faults, []);
});

test('a step that cannot be done is named, with its stage', async () => {
  const page = await openPage(browser);
  await open(page, file('bad', { modules: [[0, 0, 0]], steps: [{ attach: [[0, 0, 1]] }, { detach: [[5, 5, 5]] }] }));
  await page.waitForFunction(() => /step 1/.test(document.getElementById('sequence-text').textContent));
  assert.match(await page.textContent('#sequence-text'), /\/steps\/1.*step 1, .*\(5,5,5\)/);
  assert.equal(await page.isVisible('#sequence'), false);
  assert.deepEqual(page.faults, []);
});

test('axe finds nothing to object to where steps are shown, and keys do all', async () => {
  const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
  for (const colorScheme of ['light', 'dark']) {
    const page = await openPage(browser, { colorScheme });
    const report = await openSteps(page, LONG_BEAM);
    await page.keyboard.press('u');
    assert.match(await page.getAttribute('#stage-slider', 'aria-valuetext'), /overload/);
    assert.match(await page.textContent('#spoken'), new RegExp(`Step ${report.first_unsafe.step} `));
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => globalThis.axe.run());
    assert.deepEqual(violations.map(({ id, nodes }) => [id, nodes[0].html]), []);
    assert.deepEqual(page.faults, []);
  }
});

test('all stages are in the picture from the first on, whatever grows', async () => {
  const page = await openPage(browser);
  // From one module, which the camera is near to, a tower and an arm far out.
  const cells = [...Array.from({ length: 9 }, (_, i) => [0, 0, i + 1]), ...row(1, 9, 0, 9)];
  await openSteps(page, file('grown', { modules: [[0, 0, 0]], steps: cells.map((cell) => ({ attach: [cell] })) }));
  const stages = Number(await page.getAttribute('#stage-slider', 'max')) + 1;
  const outside = () =>
    page.evaluate(() => {
      const { app: { stage, robot } } = globalThis.holdfast;
      const { clientWidth, clientHeight } = stage.canvas;
      const places = Array.from({ length: robot.count }, (_, slot) => stage.controls.target.clone().fromArray(robot.placeAt(slot)));
      stage.camera.updateMatrixWorld();
      return places.map((place) => stage.project(place)).filter((at) => !at || at.x < 0 || at.y < 0 || at.x > clientWidth || at.y > clientHeight).length;
    });
  for (let at = 0; at < stages; ++at) {
    await page.fill('#stage-slider', String(at));
    assert.equal(await outside(), 0, `stage ${at}`);
  }
  await page.fill('#stage-slider', '0');
  await page.click('#fit');
  await page.fill('#stage-slider', String(stages - 1));
  assert.equal(await outside(), 0, '“See all” sees them all too');
  assert.deepEqual(page.faults, []);
});

test('beside a stage nothing answers about the robot that is built, and a click says why nothing is done', async () => {
  const page = await openPage(browser);
  await openSteps(page, LONG_BEAM);
  await page.click('#simulate');
  await page.waitForFunction(() => globalThis.holdfast.player.trace);
  await page.click('#faces');
  await page.click('#first-unsafe');
  await page.waitForFunction(() => globalThis.holdfast.timeline.loads);
  const state = () =>
    page.evaluate(() => {
      const { app, player } = globalThis.holdfast;
      const off = ['find-limit', 'simulate', 'exaggeration', 'faces'].filter((id) => document.getElementById(id).closest('[inert]'));
      const faces = [...app.view.modules.faces.slice(0, 2 * app.view.drawn.length)].some((code) => code > 0);
      return { off: off.length, trace: player.trace !== undefined, own: app.view.hasOwnColours, faces };
    });
  assert.deepEqual(await state(), { off: 4, trace: false, own: false, faces: false });
  const before = await count(page);
  for (const key of ['f', 'k', ']']) {
    await page.keyboard.press(key);
  }
  assert.equal((await state()).trace, false);
  await page.click('#tools button[aria-label=Attach]');
  const { x, y } = await facePoint(page, [2, 0, 2], [0, -1, 0]);
  await page.mouse.click(x, y);
  assert.match(await message(page), /A stage of the steps is shown: “Back to building” ends that/);
  assert.equal(await count(page), before);
  await page.click('#build-on');
  assert.deepEqual(await state(), { off: 0, trace: false, own: false, faces: true });
  assert.deepEqual(page.faults, []);
});

test('steps that are played keep their colours from stage to stage', async () => {
  const page = await openPage(browser, { reducedMotion: 'no-preference' });
  await openSteps(page, WALK);
  await page.evaluate(() => {
    const { app } = globalThis.holdfast;
    globalThis.frames = [];
    app.stage.followers.push(() => app.isExhibiting && globalThis.frames.push(app.shown.answer.has_loads));
  });
  await page.click('#stages-play');
  await page.waitForFunction(() => globalThis.holdfast.timeline.at === 17 && !globalThis.holdfast.timeline.isPlaying);
  const frames = await page.evaluate(() => globalThis.frames);
  const first = frames.indexOf(true);
  assert.ok(first >= 0 && frames.length > 20, `${first} of ${frames.length} frames`);
  assert.equal(frames.slice(first).filter((hasLoads) => !hasLoads).length, 0, 'grey frames');
  assert.deepEqual(page.faults, []);
});
