// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Role, plus, type Cell } from '../model/cell';
import { HOLDS } from '../model/surroundings';
import type { Workbench } from '../model/workbench';
import type { App } from './app';
import { byId, say } from './dom';
import { t, type Text } from '../texts';

/** Every key and what it does; the help shows the same list. */
export const KEYS: readonly [keys: string, text: Text][] = [
  ['A  D  P  V', 'tools: attach, remove, paint, look only'],
  ['O  L  G', 'tools: obstacles, loads, select'],
  ['Ctrl A  Delete', 'select all, remove what is selected'],
  ['1  2  3', 'what is attached or painted: existing, planned, fixed; an obstacle: 1 contact, 2 bonded'],
  ['← → ↑ ↓', 'move the cursor; page up and page down: higher, lower'],
  ['Enter', 'use the tool at the cursor; Shift with an arrow: draw a row'],
  ['Ctrl Z  Ctrl Y', 'undo, redo'],
  ['F', 'where may the next module go?'],
  ['[  ]', 'less, more exaggeration'],
  ['Q  E  +  −', 'turn left, turn right, nearer, further'],
  ['H  W', 'see all, see the worst connection'],
  ['6  7  8  9', 'see it from the front right, the front, the right, above'],
  ['5', 'orthographic, or in perspective'],
  ['X  M', 'see through the modules; the picture alone, for an audience'],
  ['N', 'how forces flow to the ground: N, V, M, T, and none again'],
  ['T', 'let it topple or break, if it does; put it together again'],
  ['K  ,  .', 'the robot’s own computation: play or pause, step back, step on'],
  ['S  U  R', 'steps: play or pause, to the first unsafe stage, record'],
  ['Esc', 'put the cursor away, let pinned numbers and the selection go'],
  ['?', 'this page'],
];

const ARROWS: Record<string, [right: number, away: number]> = {
  ArrowRight: [1, 0],
  ArrowLeft: [-1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

/** What takes letters, arrows or Enter for itself. */
const CONTROLS = 'input, select, textarea';
/** What has an undo of its own. */
const TEXTS = 'input[type=text], textarea';

export function listenToKeys(app: App, actions: Record<string, () => void>): void {
  window.addEventListener('keydown', (event) => {
    // Wherever the focus is: behind a dialog nothing is meant.
    if (document.querySelector('dialog[open]')) {
      return;
    }
    const target = event.target as HTMLElement;
    if ((event.ctrlKey || event.metaKey) && !target.matches(TEXTS) && /^[zy]$/i.test(event.key)) {
      const isRedo = event.key.toLowerCase() === 'y' || event.shiftKey;
      actions[isRedo ? 'redo' : 'undo']();
      event.preventDefault();
      return;
    }
    if ((event.key === 'Escape' && (app.unpin() || app.bench.selection.clear())) || onSelection(app, event)) {
      event.preventDefault();
      return;
    }
    if (target.matches(CONTROLS) || event.ctrlKey || event.metaKey || event.altKey) {
      return;
    }
    if (onStage(app, event) || letter(app.bench, actions, event.key)) {
      event.preventDefault();
    }
  });
}

/** What is selected is all or nothing to these keys; the tool is in hand. */
function onSelection({ bench }: App, event: KeyboardEvent): boolean {
  if (bench.tool !== 'select' || (event.target as HTMLElement).matches(CONTROLS)) {
    return false;
  }
  if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 'a') {
    bench.selection.all();
    return true;
  }
  const removes = (event.key === 'Delete' || event.key === 'Backspace') && bench.selection.cells.length > 0;
  if (removes) {
    bench.selection.remove();
  }
  return removes;
}

/** Keys of the cursor count only where the robot has the focus. */
function onStage(app: App, event: KeyboardEvent): boolean {
  if (document.activeElement !== app.stage.canvas) {
    return false;
  }
  const { bench } = app;
  const { cursor } = bench;
  const step = stepOf(app, event.key);
  if (step) {
    const next = cursor ? plus(cursor, step) : startOf(bench);
    app.moveCursor(next);
    if (event.shiftKey) {
      bench.use([next]);
      app.moveCursor(next);
    }
    return true;
  }
  if (event.key === 'Enter' || event.key === ' ') {
    if (cursor) {
      const label = bench.tool === 'look' ? t('nothing is done: the tool is look') : '';
      bench.use([cursor]);
      app.moveCursor(cursor);
      say(label);
    } else {
      app.moveCursor(startOf(bench));
    }
    return true;
  }
  if ((event.key === 'Delete' || event.key === 'Backspace') && cursor) {
    bench.remove([cursor]);
    app.moveCursor(cursor);
    return true;
  }
  if (event.key === 'Escape') {
    app.moveCursor(undefined);
    return true;
  }
  return false;
}

function startOf({ robot }: Workbench): Cell {
  return robot.count > 0 ? robot.cellAt(robot.count - 1) : [0, 0, robot.supportZ];
}

/** The step between cells that an arrow means as the robot is seen now. */
function stepOf(app: App, key: string): Cell | undefined {
  if (key === 'PageUp' || key === 'PageDown') {
    return [0, 0, key === 'PageUp' ? 1 : -1];
  }
  const arrow = ARROWS[key];
  if (!arrow) {
    return undefined;
  }
  const [right, away] = arrow;
  const angle = Math.round(app.stage.azimuth / (Math.PI / 2));
  // From the azimuth, a quarter turn at a time: right and away in plan.
  const quarter = ((angle % 4) + 4) % 4;
  const rights: [number, number][] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
  const [rx, ry] = rights[quarter];
  return [right * rx - away * ry, right * ry + away * rx, 0];
}

function letter(bench: Workbench, actions: Record<string, () => void>, key: string): boolean {
  const roles: Record<string, Role> = { 1: Role.kExisting, 2: Role.kPlanned, 3: Role.kFixed };
  if (bench.tool === 'obstacle' && (key === '1' || key === '2')) {
    bench.setHold(HOLDS[Number(key) - 1]);
    return true;
  }
  if (key in roles) {
    bench.setRole(roles[key]);
    return true;
  }
  const tools = { a: 'add', d: 'remove', p: 'paint', v: 'look', o: 'obstacle', l: 'load', g: 'select' } as const;
  const lower = key.toLowerCase();
  if (lower in tools) {
    bench.setTool(tools[lower as keyof typeof tools]);
    return true;
  }
  if (key === '[' || key === ']') {
    if (bench.refusesNow()) {
      return true;
    }
    const slider = byId<HTMLInputElement>('exaggeration');
    slider.value = String(Number(slider.value) + (key === ']' ? 10 : -10));
    slider.dispatchEvent(new Event('input'));
    return true;
  }
  const action = actions[lower];
  action?.();
  return action !== undefined;
}
