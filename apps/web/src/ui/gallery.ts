// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { CoreClient } from '../core/client';
import { Kind, type Answer } from '../core/types';
import { GALLERY, type Example } from '../model/examples';
import { DIRECTIONS, plus, type Robot } from '../model/robot';
import { FIXED, UNKNOWN, UNSTABLE, brokenColour, css, loadColour, mix, type Rgb } from '../view/colours';
import { moduleLoads } from '../view/robot_view';
import type { App } from './app';
import { byId, make } from './dom';
import { openText, robotOf } from './files';

/** The gallery: a small picture of each example in the colours of its answer. */

const WIDTH = 132;
const HEIGHT = 92;

const client = new CoreClient();
let isFilled = false;

export function openGallery(app: App): void {
  const dialog = byId<HTMLDialogElement>('gallery');
  if (!isFilled) {
    isFilled = true;
    fill(app, dialog);
  }
  dialog.showModal();
}

function fill(app: App, dialog: HTMLDialogElement): void {
  for (const group of GALLERY) {
    const list = make('div', { className: 'cards' });
    for (const example of group.examples) {
      list.append(card(app, dialog, example));
    }
    byId('gallery-list').append(make('section', {}, make('h3', {}, group.title), list));
  }
}

function card(app: App, dialog: HTMLDialogElement, example: Example): HTMLButtonElement {
  const picture = make('canvas', { width: 2 * WIDTH, height: 2 * HEIGHT });
  const verdict = make('span', { className: 'card-verdict' });
  const title = example.title.length === 1 ? [] : [make('span', { className: 'card-title' }, example.title)];
  const button = make('button', { type: 'button', className: 'card' }, picture, verdict, ...title, example.text);
  button.dataset.example = example.name;
  button.onclick = () => {
    dialog.close();
    void openText(app, new TextEncoder().encode(example.source()), example.name);
  };
  void judge(example, picture, verdict);
  return button;
}

async function judge(example: Example, picture: HTMLCanvasElement, verdict: HTMLElement): Promise<void> {
  const source = (example.sketch ?? example.source)();
  const robot = robotOf(await client.open(new TextEncoder().encode(source)), source, '');
  const { data, slots } = robot.toData();
  const answer = await client.check(data);
  if (!example.sketch) {
    verdict.textContent = answer.verdict;
    verdict.dataset.verdict = answer.verdict;
  }
  drawSmall(picture, robot, answer, slots);
}

/** An isometric picture, far modules first. */
function drawSmall(canvas: HTMLCanvasElement, robot: Robot, answer: Answer, slots: Int32Array): void {
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
    const kind = robot.kindAt(slot);
    let colour: Rgb = kind === Kind.kFixed ? FIXED : UNKNOWN;
    if (answer.verdict === 'unstable') {
      colour = UNSTABLE;
    } else if (loads && kind !== Kind.kFixed) {
      colour = loads.isBroken[slot] ? brokenColour('paper') : loadColour('paper', loads.ratio[slot]);
    }
    drawCube(context, project(robot.cellAt(slot)), kind === Kind.kPlanned ? mix(colour, [255, 255, 255], 0.4) : colour);
  }
}

/** Seen from +x, -y and above, as on the stage. */
const project = ([x, y, z]: readonly number[]) => [0.866 * (x + y), 0.5 * (x - y) - z];
const depth = (robot: Robot, slot: number) => {
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
