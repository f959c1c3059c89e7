// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { DIRECTIONS, plus, type Cell } from '../model/cell';
import type { EditedRobot } from '../model/edited_robot';
import { ROW_MAX } from '../model/workbench';
import { alongAxis, nearSeam, pick, type Hit } from '../view/pick';
import type { App } from './app';

/**
 * Mouse, pen and fingers on the canvas. A click uses the tool; a drag that begins on the robot draws
 * a row or a stroke; any other drag turns the view. Fingers turn the view at once and draw after
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
  const { canvas, controls } = app.stage;
  let gesture: Gesture | undefined;

  canvas.addEventListener(
    'pointerdown',
    (event) => {
      app.stopTopple();
      if (app.bench.cursor) {
        app.moveCursor(undefined);
      }
      if (gesture || event.button !== 0) {
        clearTimeout(gesture?.timer);
        gesture = undefined;
        controls.enabled = true;
        app.whereNext.preview([]);
        return;
      }
      const hit = pick(app.bench.robot, app.stage.ray(event.clientX, event.clientY));
      const isOnRobot = hit !== undefined && !hit.isGround && app.bench.tool !== 'look' && !isBent(app);
      const turns = event.altKey || event.ctrlKey || event.metaKey || event.shiftKey;
      gesture = { hit, x: event.clientX, y: event.clientY, draws: false, isClick: true, cells: [], timer: 0 };
      if (isOnRobot && !turns) {
        const begin = () => {
          gesture!.draws = true;
          gesture!.cells = cellsOf(app, hit);
          controls.enabled = false;
          app.whereNext.preview(app.bench.tool === 'add' ? gesture!.cells : []);
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
    controls.enabled = true;
    clearTimeout(ended?.timer);
    if (ended?.isClick && isBent(app)) {
      app.straighten();
    } else if (ended?.draws || ended?.isClick) {
      app.bench.use(ended.draws ? ended.cells : cellsOf(app, ended.hit));
      app.whereNext.preview([]);
    }
    if (event.pointerType === 'touch' && ended?.isClick) {
      app.point(ended.hit?.isGround ? undefined : ended.hit?.cell, ended.hit && nearSeam(app.bench.robot, ended.hit));
    }
  });

  const forget = () => {
    clearTimeout(gesture?.timer);
    gesture = undefined;
    controls.enabled = true;
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

/** The shape under load is to look at; what is built is straight. */
const isBent = (app: App) => app.view.exaggeration > 0;

function hover(app: App, x: number, y: number): void {
  const hit = pick(app.bench.robot, app.stage.ray(x, y));
  const isModule = hit !== undefined && !hit.isGround;
  app.point(isModule ? hit.cell : undefined, isModule ? nearSeam(app.bench.robot, hit) : undefined);
  app.stage.canvas.style.cursor = isModule && app.bench.tool !== 'look' ? 'pointer' : 'grab';
  app.whereNext.preview(app.bench.tool === 'add' && !isBent(app) ? cellsOf(app, hit) : []);
}

/** What a click there would change. */
function cellsOf(app: App, hit: Hit | undefined): Cell[] {
  if (!hit || app.bench.tool === 'look') {
    return [];
  }
  if (app.bench.tool !== 'add') {
    return hit.isGround ? [] : [hit.cell];
  }
  const cell = hit.isGround ? hit.cell : plus(hit.cell, DIRECTIONS[hit.face]);
  return mayBe(app.bench.robot, cell, !hit.isGround || touches(app.bench.robot, cell)) ? [cell] : [];
}

const touches = (robot: EditedRobot, cell: Cell) =>
  robot.count === 0 || DIRECTIONS.some((direction) => robot.has(plus(cell, direction)));

const mayBe = (robot: EditedRobot, cell: Cell, touchesRobot: boolean) =>
  touchesRobot && cell[2] >= robot.supportZ && !robot.has(cell);

/** A row of new modules, or more modules for a stroke. */
function draw(app: App, gesture: Gesture, x: number, y: number): void {
  const ray = app.stage.ray(x, y);
  const { cell, face } = gesture.hit!;
  if (app.bench.tool === 'add') {
    const count = Math.min(Math.max(1, Math.round(alongAxis(cell, face, ray))), ROW_MAX);
    const row: Cell[] = [];
    for (let at = plus(cell, DIRECTIONS[face]); row.length < count; at = plus(at, DIRECTIONS[face])) {
      if (!mayBe(app.bench.robot, at, true)) {
        break;
      }
      row.push(at);
    }
    gesture.cells = row;
    app.whereNext.preview(row);
    return;
  }
  const hit = pick(app.bench.robot, ray);
  if (hit && !hit.isGround && !gesture.cells.some((other) => String(other) === String(hit.cell))) {
    gesture.cells.push(hit.cell);
    app.view.point(gesture.cells.map((one) => app.bench.robot.slot(one)!));
  }
}
