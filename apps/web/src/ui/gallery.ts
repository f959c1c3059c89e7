// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { CoreClient } from '../core/client';
import type { Answer } from '../core/types';
import { Role } from '../model/cell';
import type { EditedRobot } from '../model/edited_robot';
import type { Challenge } from '../model/challenges';
import { GALLERY, type Example } from '../model/examples';
import { dot, type Lattice, type Place } from '../model/lattice';
import type { Workbench } from '../model/workbench';
import { FIXED, UNKNOWN, UNSTABLE, brokenColour, css, loadColour, mix, type Rgb } from '../view/colours';
import { cellFaces } from '../view/polyhedron';
import { moduleLoads } from '../view/robot_view';
import { challengeButtons } from './challenges';
import { byId, make } from './dom';
import { openText, robotOf } from './files';
import { nameOf, whenOf, type Keeper } from './keeper';
import { t, word } from '../texts';

/** The gallery: a small picture of each example in the colours of its answer. */

const WIDTH = 132;
const HEIGHT = 92;
/** Larger robots have no picture: it would take seconds. */
const PICTURE_COUNT_MAX = 2000;

const client = new CoreClient();
let isFilled = false;

export function openGallery(bench: Workbench, keeper: Keeper, begin: (challenge: Challenge) => void): void {
  const dialog = byId<HTMLDialogElement>('gallery');
  byId('challenges').replaceChildren(...challengeButtons(begin));
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
      const title = example.title.length === 1 ? '' : word(example.title);
      const made = card(dialog, title, word(example.text), open);
      made.button.dataset.example = example.name;
      void exampleRobot(example).then((robot) => judge(robot, made, !example.sketch));
      return made.button;
    });
    byId('gallery-list').append(section(word(group.title), cards));
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
  const forget = make('button', { type: 'button', textContent: t('Forget these') });
  forget.onclick = () => {
    keeper.forgetAll();
    showKept(dialog, keeper);
  };
  place.replaceChildren(...section(t('Built here, kept in this browser'), cards).children, forget);
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
      verdict.textContent = t(answer.verdict);
      verdict.dataset.verdict = answer.verdict;
    }
    drawSmall(picture, robot, answer, slots);
  } catch {
    verdict.textContent = t('no answer');
  }
}

/** An isometric picture, far modules first. */
function drawSmall(canvas: HTMLCanvasElement, robot: EditedRobot, answer: Answer, slots: Int32Array): void {
  const context = canvas.getContext('2d')!;
  const loads = answer.has_loads ? moduleLoads({ answer, slots }) : undefined;
  const { lattice } = robot;
  const seen = lattice.units.flatMap((unit, side) => (dot(unit, EYE) > 0 && side < lattice.directionCount ? [side] : []));
  const isSeen = (slot: number) => seen.some((side) => !robot.has(lattice.neighbour(robot.cellAt(slot), side)));
  const order = Array.from({ length: robot.count }, (_, slot) => slot)
    .filter((slot) => lattice.shape !== 'cube' || isSeen(slot))
    .sort((a, b) => dot(robot.placeAt(a), EYE) - dot(robot.placeAt(b), EYE));
  const points = order.flatMap((slot) => {
    const [u, v] = project(robot.placeAt(slot));
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
  const draw = cellDrawer(context, lattice);
  for (const slot of order) {
    const role = robot.roleAt(slot);
    let colour: Rgb = role === Role.kFixed ? FIXED : UNKNOWN;
    if (answer.verdict === 'unstable') {
      colour = UNSTABLE;
    } else if (loads && role !== Role.kFixed) {
      colour = loads.isBroken[slot] ? brokenColour('paper') : loadColour('paper', loads.ratio[slot]);
    }
    draw(robot.placeAt(slot), role === Role.kPlanned ? mix(colour, [255, 255, 255], 0.4) : colour);
  }
}

/** Seen from +x, -y and above, as on the stage. */
const EYE: Place = [1, -1, 1];
const project = ([x, y, z]: Place): [number, number] => [0.866 * (x + y), 0.5 * (x - y) - z];

const WHITE: Rgb = [255, 255, 255];
const BLACK: Rgb = [0, 0, 0];

/** Lighter above, darker to the right. */
function shaded(colour: Rgb, [x, y, z]: Place): Rgb {
  return z > 0.5 ? mix(colour, WHITE, 0.16) : mix(colour, BLACK, 0.06 + 0.08 * (x + y + 1));
}

/** Draws a module at a place: a circle for what is round, else the sides of its cell that are seen. */
function cellDrawer(context: CanvasRenderingContext2D, lattice: Lattice): (place: Place, colour: Rgb) => void {
  const isRound = lattice.shape === 'sphere';
  const faces = cellFaces(lattice)
    .map((corners, wall) => ({ corners, normal: lattice.walls[wall].normal }))
    .filter(({ normal }) => dot(normal, EYE) > 0);
  return (place, colour) => {
    const [u, v] = project(place);
    context.strokeStyle = css(mix(colour, BLACK, 0.45));
    const paint = (shade: Rgb) => {
      context.closePath();
      context.fillStyle = css(shade);
      context.fill();
      context.stroke();
    };
    if (isRound) {
      context.beginPath();
      context.arc(u, v, 0.61, 0, 2 * Math.PI);
      paint(colour);
      return;
    }
    for (const { corners, normal } of faces) {
      context.beginPath();
      for (const [x, y] of corners.map(project)) {
        context.lineTo(u + x, v + y);
      }
      paint(shaded(colour, normal));
    }
  };
}
