// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Cell } from '../model/cell';
import { ROW_MAX, mayBe } from '../model/workbench';
import { alongAxis, nearSeam, pick, type Hit } from '../view/pick';
import type { App } from './app';

/**
 * Mouse, pen and fingers on the canvas. A click uses the tool; a drag that begins on the robot draws
 * a row or a stroke, or selects a box; any other drag turns the view. Fingers turn the view at once and draw after
 * a long press.
 */

const CLICK_PIXELS = 6;
const LONG_PRESS_MS = 350;

interface Gesture {
  hit: Hit | undefined;
  x: number;
  y: number;
  /** Draws instead of turning the view. */
  draws: boolean;
  isClick: boolean;
  cells: Cell[];
  timer: number;
}

export function listenToPointer(app: App): void {
  const { stage } = app;
  const { canvas } = stage;
  let gesture: Gesture | undefined;

  canvas.addEventListener(
    'pointerdown',
    (event) => {
      const wasFalling = app.stopTopple();
      if (app.bench.cursor) {
        app.moveCursor(undefined);
      }
      // A click that stands the robot up is meant for nothing else.
      if (gesture || event.button !== 0 || wasFalling) {
        clearTimeout(gesture?.timer);
        gesture = undefined;
        stage.controls.enabled = true;
        app.whereNext.preview([]);
        return;
      }
      const hit = pick(app.robot, app.stage.ray(event.clientX, event.clientY), app.view.section);
      const isOnRobot = hit !== undefined && hit.what !== 'ground' && app.bench.tool !== 'look' && !app.isExhibiting && !isBent(app);
      const turns = event.altKey || event.ctrlKey || event.metaKey || event.shiftKey;
      gesture = { hit, x: event.clientX, y: event.clientY, draws: false, isClick: true, cells: [], timer: 0 };
      if (isOnRobot && !turns) {
        const begin = () => {
          gesture!.draws = true;
          gesture!.cells = cellsOf(app, hit);
          stage.controls.enabled = false;
          preview(app, gesture!.cells);
        };
        if (event.pointerType === 'touch') {
          gesture.timer = window.setTimeout(begin, LONG_PRESS_MS);
        } else {
          begin();
          canvas.setPointerCapture(event.pointerId);
        }
      }
    },
    { capture: true },
  );

  canvas.addEventListener('pointermove', (event) => {
    if (!gesture) {
      if (event.pointerType !== 'touch' && event.buttons === 0) {
        hover(app, event.clientX, event.clientY);
      }
      return;
    }
    if (Math.hypot(event.clientX - gesture.x, event.clientY - gesture.y) > CLICK_PIXELS) {
      gesture.isClick = false;
      if (!gesture.draws) {
        clearTimeout(gesture.timer);
      }
    }
    if (gesture.draws && !gesture.isClick) {
      draw(app, gesture, event.clientX, event.clientY);
    }
  });

  canvas.addEventListener('pointerup', (event) => {
    const ended = gesture;
    gesture = undefined;
    stage.controls.enabled = true;
    clearTimeout(ended?.timer);
    if (ended?.isClick && app.bench.tool === 'look' && event.pointerType !== 'touch') {
      pinAt(app, ended.hit);
    } else if (ended?.isClick && isBent(app)) {
      app.straighten();
    } else if (ended && app.bench.tool === 'select' && !app.isExhibiting) {
      select(app, ended, event);
    } else if (ended?.draws || ended?.isClick) {
      app.bench.use(ended.draws ? ended.cells : cellsOf(app, ended.hit));
      app.whereNext.preview([]);
    }
    if (event.pointerType === 'touch' && ended?.isClick) {
      app.point(ended.hit?.what === 'ground' ? undefined : ended.hit?.cell, ended.hit && nearSeam(app.robot, ended.hit), event.clientX, event.clientY);
    }
  });

  const forget = () => {
    clearTimeout(gesture?.timer);
    gesture = undefined;
    stage.controls.enabled = true;
    app.whereNext.preview([]);
  };
  canvas.addEventListener('pointercancel', forget);
  canvas.addEventListener('pointerleave', (event) => {
    // A finger leaves with every tap: what it has pointed at stays until the next one.
    if (!gesture && event.pointerType !== 'touch') {
      app.point(undefined);
      app.whereNext.preview([]);
    }
  });
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
}

/** A click keeps the numbers of a module or a connection; another one lets them go. */
function pinAt(app: App, hit: Hit | undefined): void {
  if (!app.unpin() && hit?.what === 'module' && !app.isToppled) {
    app.pin(hit.cell, nearSeam(app.robot, hit));
  }
}

/** A click selects a module alone, with Shift or Ctrl or a finger one more or one less; beside the robot nothing. */
function select({ bench: { selection } }: App, { hit, draws, isClick, cells }: Gesture, event: PointerEvent): void {
  const adds = event.shiftKey || event.ctrlKey || event.metaKey || event.pointerType === 'touch';
  if (draws && !isClick) {
    selection.box(cells);
  } else if (isClick && hit?.what !== 'module') {
    selection.clear();
  } else if (isClick) {
    adds ? selection.toggle([hit!.cell]) : selection.set([hit!.cell]);
  }
}

/** The shape under load is to look at; what is built is straight. */
const isBent = (app: App) => app.view.exaggeration > 0 && !app.isExhibiting;

function hover(app: App, x: number, y: number): void {
  if (app.isElsewhere) {
    app.point(undefined);
    app.whereNext.preview([]);
    return; // Nothing is where it is built.
  }
  const hit = pick(app.robot, app.stage.ray(x, y), app.view.section);
  const isModule = hit?.what === 'module';
  const isThere = hit !== undefined && hit.what !== 'ground';
  app.point(isThere ? hit.cell : undefined, isModule ? nearSeam(app.robot, hit) : undefined, x, y);
  app.stage.canvas.style.cursor = isThere && app.bench.tool !== 'look' && !app.isExhibiting ? 'pointer' : 'grab';
  preview(app, isBent(app) || app.isExhibiting ? [] : cellsOf(app, hit));
}

/** Ghosts of what would be placed, by the tools that place something. */
function preview(app: App, cells: readonly Cell[]): void {
  const { tool } = app.bench;
  app.whereNext.preview(tool === 'add' || tool === 'obstacle' ? cells : []);
  const [cell, ...others] = cells;
  app.whereNext.previewRemoval(tool === 'remove' && others.length === 0 && cell && app.bench.robot.has(cell) ? cell : undefined);
}

/** What a click there would change. */
function cellsOf(app: App, hit: Hit | undefined): Cell[] {
  const { robot, tool } = app.bench;
  if (!hit || tool === 'look') {
    return [];
  }
  if (app.isExhibiting) {
    return [hit.cell]; // To be refused, in words.
  }
  if (tool !== 'add' && tool !== 'obstacle') {
    const isMeant = hit.what === 'module' || (hit.what === 'obstacle' && tool === 'remove');
    return isMeant ? [hit.cell] : [];
  }
  const cell = hit.what === 'ground' ? hit.cell : robot.lattice.neighbour(hit.cell, hit.face);
  return mayBe(app.bench, cell) ? [cell] : [];
}

/** A row of new modules, or more modules for a stroke. */
function draw(app: App, gesture: Gesture, x: number, y: number): void {
  const ray = app.stage.ray(x, y);
  const { cell, face } = gesture.hit!;
  const { robot, tool } = app.bench;
  if (tool === 'add' || tool === 'obstacle') {
    const { lattice } = robot;
    const along = Math.round(alongAxis(lattice.place(cell), lattice.units[face], ray));
    const count = Math.min(Math.max(1, along), ROW_MAX);
    const row: Cell[] = [];
    // From a module on: the first one touches the robot, and each the one before it.
    for (let at = lattice.neighbour(cell, face); row.length < count; at = lattice.neighbour(at, face)) {
      if (!robot.isFree(at) || (row.length === 0 && !mayBe(app.bench, at))) {
        break;
      }
      row.push(at);
    }
    gesture.cells = row;
    app.whereNext.preview(row);
    return;
  }
  const hit = pick(robot, ray, app.view.section);
  if (hit?.what === 'module' && tool === 'select') {
    gesture.cells = [cell, hit.cell];
    app.view.point(gesture.cells.map((one) => robot.slot(one)).filter((slot) => slot !== undefined));
  } else if (hit && hit.what !== 'ground' && !gesture.cells.some((other) => String(other) === String(hit.cell))) {
    gesture.cells.push(hit.cell);
    app.view.point(gesture.cells.map((one) => robot.slot(one)).filter((slot) => slot !== undefined));
  }
}
