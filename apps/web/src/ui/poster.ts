// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { LOAD_STEPS, css, loadColour, stepColours, type Rgb } from '../view/colours';
import type { App } from './app';
import { byId } from './dom';
import { inLight } from './theme';
import { digits, t } from '../texts';

/** The picture as one takes it away: on a ground, with its name, the verdict and what the colours mean. */

/** So many pixels for each of the picture on the page. */
const SCALE = 2;
const MARGIN = 18;

export function drawPoster(app: App, scaleOf: (ratio: number, width: number) => number = () => SCALE): HTMLCanvasElement {
  const { canvas, ratio } = app.stage.picture(scaleOf);
  const poster = document.createElement('canvas');
  [poster.width, poster.height] = [canvas.width, canvas.height];
  const context = poster.getContext('2d')!;
  const style = getComputedStyle(document.documentElement);
  const [ink, quiet, paper] = ['--ink', '--quiet', '--paper'].map((name) => style.getPropertyValue(name));
  context.fillStyle = paper;
  context.fillRect(0, 0, poster.width, poster.height);
  context.drawImage(canvas, 0, 0);
  app.stage.draw();
  context.scale(ratio, ratio);
  const width = poster.width / ratio;
  const write = (text: string, size: number, y: number, colour: string, isBold = false) => {
    context.font = `${isBold ? 650 : 400} ${size}px ${style.fontFamily}`;
    context.fillStyle = colour;
    context.fillText(text, MARGIN, y, width - 2 * MARGIN);
  };
  const word = byId('verdict-word');
  write([...word.childNodes].map((part) => part.textContent).join('  '), 24, MARGIN + 20, getComputedStyle(word).color, true);
  write(byId('chip-numbers').textContent ?? '', 14, MARGIN + 42, ink);
  const { robot } = app;
  const edges = new Set(robot.lattice.stretch).size > 1 ? robot.lattice.stretch : [1];
  const size = edges.map((edge) => digits(String(Number((edge * robot.pitchMm).toPrecision(6))))).join(' × ');
  write([robot.name, t('1 module = {0} mm', size), 'holdfast'].filter(Boolean).join(' · '), 13, poster.height / ratio - MARGIN, quiet);
  if (!app.view.losses && !app.view.hasOwnColours) {
    drawLegend(context, app, poster.height / ratio - MARGIN - 54, quiet);
  }
  return poster;
}

export const makePoster = (app: App): Promise<Blob | null> => new Promise((done) => drawPoster(app).toBlob(done));

/** What is printed is the poster, in light, as a canvas of WebGL may be empty there. */
export function printPoster(app: App): void {
  window.addEventListener('beforeprint', () => inLight(() => byId('printed').replaceChildren(drawPoster(app))));
  window.addEventListener('afterprint', () => byId('printed').replaceChildren());
}

const STEP_WIDTH = 46;

/** Steps, or a bar without them, with what their borders stand for. */
function drawLegend(context: CanvasRenderingContext2D, { view }: App, top: number, ink: string): void {
  const isOfSteps = view.subject === 'connections';
  const bar: Rgb[] = isOfSteps ? stepColours(view.scale) : Array.from({ length: 40 }, (_, i) => loadColour(view.scale, (i + 0.5) / 40));
  const ticks = isOfSteps ? ['0', ...LOAD_STEPS.map((most) => (most === Infinity ? '' : digits(String(most))))] : ['0', '1'];
  const whole = isOfSteps ? STEP_WIDTH * bar.length : 4 * STEP_WIDTH;
  const part = whole / bar.length;
  bar.forEach((colour, i) => {
    context.fillStyle = css(colour);
    context.fillRect(MARGIN + i * part, top, Math.ceil(part), 10);
  });
  context.fillStyle = ink;
  context.font = context.font.replace(/\d+px/, '12px');
  ticks.forEach((text, i) => context.fillText(text, MARGIN + (i * whole) / (isOfSteps ? bar.length : 1) - (i > 0 ? 4 : 0), top + 24));
  context.fillText(t('share of the connection’s strength'), MARGIN + whole + 14, top + 10);
}
