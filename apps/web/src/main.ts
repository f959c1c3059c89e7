// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import './style.css';
import { ROLE_NAMES, type Role } from './model/cell';
import { EditedRobot } from './model/edited_robot';
import { HOLDS } from './model/surroundings';
import { Workbench, type Tool } from './model/workbench';
import type { ScaleName, Subject } from './view/colours';
import { App } from './ui/app';
import { showFaceLegend, showLegend } from './ui/answer_panel';
import { byId, icon, make, reasonOf, say, tell } from './ui/dom';
import { listenToFiles, reportOf, take, write } from './ui/files';
import { BreakingPanel } from './ui/breaking';
import { ChallengePanel } from './ui/challenges';
import { Collapse } from './ui/collapse';
import { ConnectionTable } from './ui/connections';
import { DeformedPanel } from './ui/deformed';
import { FlowPanel } from './ui/flow';
import { openGallery } from './ui/gallery';
import { Keeper } from './ui/keeper';
import { KEYS, listenToKeys } from './ui/keyboard';
import { offerLanguages } from './ui/language';
import { makeLooking } from './ui/looking';
import { makeMaterial } from './ui/material';
import { Player } from './ui/player';
import { printPoster } from './ui/poster';
import { listenToPointer } from './ui/pointer';
import { SelectionPanel } from './ui/selecting';
import { openFirst, showWithoutPicture } from './ui/start';
import { makeSurroundings } from './ui/surroundings';
import { Timeline } from './ui/timeline';
import { LossPanel, Sure } from './ui/what_if';
import { WhyPanel } from './ui/why';
import { digits, t, translatePage, word, type Text } from './texts';

declare global {
  /** A handle for the browser's console, and for the tests. */
  var holdfast: { bench: Workbench; app: App; flow: FlowPanel; player: Player; timeline: Timeline; reportOf: typeof reportOf; write: typeof write };
}

const TOOLS: readonly [tool: Tool, text: Text, key: string][] = [
  ['look', 'Look', 'V'],
  ['select', 'Select', 'G'],
  ['add', 'Attach', 'A'],
  ['remove', 'Remove', 'D'],
  ['paint', 'Paint', 'P'],
  ['obstacle', 'Obstacle', 'O'],
  ['load', 'Load', 'L'],
];

function radio(text: string, title: string, action: () => void): HTMLButtonElement {
  const button = make('button', { type: 'button', title }, text);
  button.setAttribute('role', 'radio');
  button.onclick = action;
  return button;
}

/** Arrow keys move inside a group of radio buttons, as everywhere. */
function moveInside(group: HTMLElement): void {
  group.addEventListener('keydown', (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    const buttons = [...group.querySelectorAll('button')];
    const at = buttons.indexOf(document.activeElement as HTMLButtonElement);
    if (step && at >= 0) {
      event.preventDefault();
      event.stopPropagation();
      const next = buttons[(at + step + buttons.length) % buttons.length];
      next.focus();
      next.click();
    }
  });
}

function makeTools(bench: Workbench): void {
  const tools = TOOLS.map(([tool, text, key]) => {
    const button = radio('', `${t(text)} (${key})`, () => bench.setTool(tool));
    // There is room for four names only.
    button.append(icon(tool), ...(['select', 'obstacle', 'load'].includes(tool) ? [] : [make('span', {}, t(text))]));
    button.setAttribute('aria-label', t(text));
    return button;
  });
  const roles = ROLE_NAMES.map((name, role) => {
    const text = word(`${name[0].toUpperCase()}${name.slice(1)}`);
    const button = radio('', `${text} (${role + 1})`, () => bench.setRole(role as Role));
    button.append(make('span', { className: `swatch ${name}` }), make('span', {}, text));
    return button;
  });
  byId('tools').append(...tools);
  const holds = HOLDS.map((hold, i) => {
    const text = word(`${hold[0].toUpperCase()}${hold.slice(1)}`);
    const button = radio('', `${text} (${i + 1})`, () => bench.setHold(hold));
    button.append(make('span', { className: `swatch obstacle ${hold}` }), make('span', {}, text));
    return button;
  });
  moveInside(byId('tools'));
  moveInside(byId('roles'));
  const check = (buttons: HTMLButtonElement[], chosen: number) =>
    buttons.forEach((button, i) => {
      button.setAttribute('aria-checked', String(i === chosen));
      button.tabIndex = i === chosen ? 0 : -1;
    });
  const show = () => {
    check(tools, TOOLS.findIndex(([tool]) => tool === bench.tool));
    check(roles, bench.role);
    check(holds, HOLDS.indexOf(bench.hold));
    const offered = bench.tool === 'obstacle' ? holds : roles;
    if (offered[0].parentElement !== byId('roles')) {
      byId('roles').replaceChildren(...offered);
      byId('roles').ariaLabel = bench.tool === 'obstacle' ? t('How an obstacle holds') : t('What is attached or painted');
    }
    byId('roles').classList.toggle('idle', !['add', 'paint', 'select', 'obstacle'].includes(bench.tool));
    byId<HTMLButtonElement>('undo').disabled = !bench.history.canUndo;
    byId<HTMLButtonElement>('redo').disabled = !bench.history.canRedo;
  };
  bench.robotListeners.push(show);
  bench.toolListeners.push(show);
  show();
}

function makeDialogs(): void {
  for (const dialog of document.querySelectorAll('dialog')) {
    const close = dialog.querySelector<HTMLButtonElement>('.close')!;
    close.append(icon('close'));
    close.onclick = () => dialog.close();
    dialog.addEventListener('click', (event) => {
      if (event.target === dialog) {
        dialog.close();
      }
    });
  }
  const rows = KEYS.map(([keys, text]) => make('tr', {}, make('th', { scope: 'row' }, word(keys)), make('td', {}, t(text))));
  byId('keys-list').append(
    make(
      'p',
      {},
      t('Click a face to attach a module, drag from a face to draw a row, drag elsewhere to turn the view. With a finger: tap, long press and drag, drag. The colour of the ghost is the answer before you click.'),
    ),
    make('table', { className: 'keys' }, make('tbody', {}, ...rows)),
  );
}

function makePanel(app: App, keeper: Keeper): void {
  const { bench } = app;
  showLegend('paper', 'connections');
  showFaceLegend('paper');
  const [scale, subject] = ['scale', 'subject'].map((id) => byId<HTMLSelectElement>(id));
  scale.onchange = subject.onchange = () => app.setColours(scale.value as ScaleName, subject.value as Subject);
  const slider = byId<HTMLInputElement>('exaggeration');
  slider.oninput = () => {
    const factor = app.setExaggeration(Number(slider.value) / 100);
    byId('exaggeration-value').textContent = `${digits(factor === 0 || factor >= 10 ? factor.toFixed(0) : factor.toFixed(1))} ×`;
  };
  byId('stop').onclick = () => app.stop();
  const faces = byId('faces');
  faces.onclick = () => {
    const isShown = faces.getAttribute('aria-pressed') !== 'true';
    faces.setAttribute('aria-pressed', String(isShown));
    app.whereNext.show(isShown);
  };
  const name = byId<HTMLInputElement>('name');
  name.oninput = () => {
    bench.robot.name = name.value;
    bench.robot.isEdited = true;
    showTitle(bench);
    keeper.changed();
  };
  makeMaterial(bench);
  makeSurroundings(bench);
  bench.robotListeners.push((what) => {
    if (what === 'robot') {
      name.value = bench.robot.name;
      showTitle(bench);
    }
    if (Number(slider.value) > 0) {
      app.straighten();
    }
  });
}

const showTitle = ({ robot }: Workbench) => (document.title = robot.name ? `${robot.name} - holdfast` : 'holdfast');

function makeActions(app: App, player: Player, timeline: Timeline): Record<string, () => void> {
  const { bench } = app;
  const turn = (angle: number) => {
    const { camera, controls } = app.stage;
    camera.position.sub(controls.target).applyAxisAngle(camera.up, angle).add(controls.target);
    controls.update();
  };
  const near = (factor: number) => {
    const { camera, controls } = app.stage;
    camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
    controls.update();
  };
  const tellDone = (label: string | undefined, text: Text) => say(label ? t(text, label) : t('nothing to undo'));
  return {
    undo: () => tellDone(bench.history.undo(), 'undone: {0}'),
    redo: () => tellDone(bench.history.redo(), 'done again: {0}'),
    f: () => bench.refusesNow() || byId('faces').click(),
    h: () => app.see(),
    w: () => app.seeWorst(),
    t: () => app.toggleTopple(),
    q: () => turn(-Math.PI / 12),
    e: () => turn(Math.PI / 12),
    '+': () => near(0.85),
    '=': () => near(0.85),
    '-': () => near(1 / 0.85),
    k: () => player.toggle(),
    ',': () => player.step(-1),
    '.': () => player.step(1),
    s: () => timeline.toggle(),
    u: () => timeline.toFirstUnsafe(),
    r: () => timeline.record(),
    '?': () => byId<HTMLDialogElement>('keys').showModal(),
  };
}

function begin(): void {
  const bench = new Workbench(tell);
  const app = new App(bench);
  const player = new Player(app);
  const timeline = new Timeline(app);
  globalThis.holdfast = { bench, app, flow: new FlowPanel(app), player, timeline, reportOf, write };
  const keeper = new Keeper(bench);
  makeTools(bench);
  makeDialogs();
  makePanel(app, keeper);
  new SelectionPanel(app);
  new ConnectionTable(app);
  new WhyPanel(app);
  new Sure(app);
  new LossPanel(app);
  new DeformedPanel(app);
  new BreakingPanel(app);
  const looking = makeLooking(app);
  const actions: Record<string, () => void> = { ...makeActions(app, player, timeline), ...looking, n: () => globalThis.holdfast.flow.next() };
  listenToPointer(app);
  listenToKeys(app, actions);
  listenToFiles(bench);
  offerLanguages(bench);
  printPoster(app);
  bench.robotListeners.push(() => (byId('hint').hidden ||= bench.history.canUndo));
  for (const [id, name] of [['undo', 'undo'], ['redo', 'redo'], ['fit', 'fit']] as const) {
    byId(id).append(icon(name));
  }
  byId('undo').onclick = actions.undo;
  byId('redo').onclick = actions.redo;
  byId('fit').onclick = actions.h;
  byId('verdict').onclick = actions.w;
  byId('help').onclick = actions['?'];
  const challenges = new ChallengePanel(app);
  byId('gallery-open').onclick = () => openGallery(bench, keeper, (challenge) => void challenges.begin(challenge));
  byId('new').onclick = () => bench.history.replace(t('beginning anew'), new EditedRobot(bench.robot.lattice.unstretched));
  byId('save').onclick = () => byId<HTMLDialogElement>('takeaway').showModal();
  for (const button of document.querySelectorAll<HTMLButtonElement>('[data-save]')) {
    button.onclick = () => {
      byId<HTMLDialogElement>('takeaway').close();
      void take(app, button.dataset.save!);
    };
  }
  void openFirst(app, keeper, new Collapse(app)).then(showReady);
}

translatePage(document.documentElement);

const showReady = () => document.documentElement.classList.add('ready');

// First the page is painted, then the canvas made, which takes longer; the core compiles meanwhile.
requestAnimationFrame(() =>
  setTimeout(() => {
    try {
      begin();
    } catch (error) {
      const reason = reasonOf(error);
      void showWithoutPicture(reason).then(showReady);
    }
  }),
);
