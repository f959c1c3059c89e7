// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { CoreClient } from '../core/client';
import type { Answer } from '../core/types';
import { DIRECTIONS, Role, plus } from '../model/cell';
import type { EditedRobot } from '../model/edited_robot';
import { GALLERY, type Example } from '../model/examples';
import type { Workbench } from '../model/workbench';
import { FIXED, UNKNOWN, UNSTABLE, brokenColour, css, loadColour, mix, type Rgb } from '../view/colours';
import { moduleLoads } from '../view/robot_view';
import { byId, make } from './dom';
import { openText, robotOf } from './files';
import { nameOf, whenOf, type Keeper } from './keeper';

/** The gallery: a small picture of each example in the colours of its answer. */

const WIDTH = 132;
const HEIGHT = 92;
/** Larger robots have no picture: it would take seconds. */
const PICTURE_COUNT_MAX = 2000;

const client = new CoreClient();
let isFilled = false;

export function openGallery(bench: Workbench, keeper: Keeper): void {
  const dialog = byId<HTMLDialogElement>('gallery');
  if (!isFilled) {
    isFilled = true;
    fill(bench, dialog);
  }
  showKept(dialog, keeper);
  dialog.showModal();
}

function fill(bench: Workbench, dialog: HTMLDialogElement): void {
  for (const group of GALLERY) {
    const cards = group.examples.map((example) => {
      const open = () => void openText(bench, new TextEncoder().encode(example.source()), example.name);
      const title = example.title.length === 1 ? '' : example.title;
      const made = card(dialog, title, example.text, open);
      made.button.dataset.example = example.name;
      void exampleRobot(example).then((robot) => judge(robot, made, !example.sketch));
      return made.button;
    });
    byId('gallery-list').append(section(group.title, cards));
  }
}

/** Robots of this browser, newest first. */
function showKept(dialog: HTMLDialogElement, keeper: Keeper): void {
  const cards = keeper.list().map((entry) => {
    const made = card(dialog, nameOf(entry), whenOf(entry), () => keeper.open(entry));
    const robot = keeper.restore(entry);
    if (robot.count <= PICTURE_COUNT_MAX) {
      void judge(robot, made, true);
    }
    return made.button;
  });
  const place = byId('kept');
  place.hidden = cards.length === 0;
  const forget = make('button', { type: 'button', textContent: 'Forget these' });
  forget.onclick = () => {
    keeper.forgetAll();
    showKept(dialog, keeper);
  };
  place.replaceChildren(...section('Built here, kept in this browser', cards).children, forget);
}

const section = (title: string, cards: HTMLElement[]) =>
  make('section', {}, make('h3', {}, title), make('div', { className: 'cards' }, ...cards));

interface Card {
  button: HTMLButtonElement;
  picture: HTMLCanvasElement;
  verdict: HTMLElement;
}

function card(dialog: HTMLDialogElement, title: string, text: string, open: () => void): Card {
  const picture = make('canvas', { width: 2 * WIDTH, height: 2 * HEIGHT });
  const verdict = make('span', { className: 'card-verdict' });
  const heading = title ? [make('span', { className: 'card-title' }, title)] : [];
  const button = make('button', { type: 'button', className: 'card' }, picture, verdict, ...heading, text);
  button.onclick = () => {
    dialog.close();
    open();
  };
  return { button, picture, verdict };
}

async function exampleRobot(example: Example): Promise<EditedRobot> {
  const source = (example.sketch ?? example.source)();
  return robotOf(await client.open(new TextEncoder().encode(source)), source, '');
}

async function judge(robot: EditedRobot, { picture, verdict }: Card, saysVerdict: boolean): Promise<void> {
  const { data, slots } = robot.toData();
  try {
    const answer = await client.check(data);
    if (saysVerdict) {
      verdict.textContent = answer.verdict;
      verdict.dataset.verdict = answer.verdict;
    }
    drawSmall(picture, robot, answer, slots);
  } catch {
    verdict.textContent = 'no answer';
  }
}

/** An isometric picture, far modules first. */
function drawSmall(canvas: HTMLCanvasElement, robot: EditedRobot, answer: Answer, slots: Int32Array): void {
  const context = canvas.getContext('2d')!;
  const loads = answer.has_loads ? moduleLoads({ answer, slots }) : undefined;
  const order = Array.from({ length: robot.count }, (_, slot) => slot)
    .filter((slot) => [0, 3, 4].some((side) => !robot.has(plus(robot.cellAt(slot), DIRECTIONS[side]))))
    .sort((a, b) => depth(robot, a) - depth(robot, b));
  const points = order.flatMap((slot) => {
    const [u, v] = project(robot.cellAt(slot));
    return [
      [u - 0.87, v - 1],
      [u + 0.87, v + 1],
    ];
  });
  const [left, right] = [Math.min(...points.map(([u]) => u)), Math.max(...points.map(([u]) => u))];
  const [top, bottom] = [Math.min(...points.map(([, v]) => v)), Math.max(...points.map(([, v]) => v))];
  const scale = Math.min((canvas.width - 16) / (right - left), (canvas.height - 16) / (bottom - top), 26);
  context.translate(canvas.width / 2, canvas.height / 2);
  context.scale(scale, scale);
  context.translate(-(left + right) / 2, -(top + bottom) / 2);
  context.lineWidth = 0.05;
  context.lineJoin = 'round';
  for (const slot of order) {
    const role = robot.roleAt(slot);
    let colour: Rgb = role === Role.kFixed ? FIXED : UNKNOWN;
    if (answer.verdict === 'unstable') {
      colour = UNSTABLE;
    } else if (loads && role !== Role.kFixed) {
      colour = loads.isBroken[slot] ? brokenColour('paper') : loadColour('paper', loads.ratio[slot]);
    }
    drawCube(context, project(robot.cellAt(slot)), role === Role.kPlanned ? mix(colour, [255, 255, 255], 0.4) : colour);
  }
}

/** Seen from +x, -y and above, as on the stage. */
const project = ([x, y, z]: readonly number[]) => [0.866 * (x + y), 0.5 * (x - y) - z];
const depth = (robot: EditedRobot, slot: number) => {
  const [x, y, z] = robot.cellAt(slot);
  return x - y + z;
};

function drawCube(context: CanvasRenderingContext2D, [u, v]: number[], colour: Rgb): void {
  const face = (points: number[][], shade: Rgb) => {
    context.beginPath();
    points.forEach(([x, y]) => context.lineTo(u + x, v + y));
    context.closePath();
    context.fillStyle = css(shade);
    context.strokeStyle = css(mix(colour, [0, 0, 0], 0.45));
    context.fill();
    context.stroke();
  };
  const [w, h] = [0.866, 0.5];
  face([[-w, -h], [0, -1], [w, -h], [0, 0]], mix(colour, [255, 255, 255], 0.16));
  face([[-w, -h], [0, 0], [0, 1], [-w, h]], mix(colour, [0, 0, 0], 0.06));
  face([[w, -h], [0, 0], [0, 1], [w, h]], mix(colour, [0, 0, 0], 0.22));
}
