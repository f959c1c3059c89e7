// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { GIFEncoder, applyPalette, quantize } from 'gifenc';
import { t } from '../texts';
import type { App } from './app';
import { tell } from './dom';
import { drawPoster } from './poster';

/** A fall, or the steps, as a moving picture. */

/** Each moment is drawn when it is asked for; what comes is how long it lasts, in ms. */
export type Film = AsyncGenerator<number>;

const WIDTH = 640;
const COLOURS = 128;

/** Draws every moment as the poster is, with the verdict and the legend; throws where nothing moves. */
export async function gifOf(app: App): Promise<Blob> {
  const film = app.films.map((begin) => begin()).find((one) => one !== undefined);
  if (!film) {
    throw new Error(t('nothing moves: let it break or topple, or show its steps, then save it'));
  }
  const note = tell(t('drawing what moves …'), false, Infinity);
  const gif = GIFEncoder();
  try {
    for await (const delay of film) {
      const canvas = drawPoster(app, (ratio, width) => Math.min(1, WIDTH / (ratio * width)));
      const { width, height } = canvas;
      const { data } = canvas.getContext('2d')!.getImageData(0, 0, width, height);
      const palette = quantize(data, COLOURS);
      gif.writeFrame(applyPalette(data, palette), width, height, { palette, delay, repeat: 0 });
      // The page goes on.
      await new Promise((done) => setTimeout(done));
    }
  } finally {
    note.remove();
  }
  gif.finish();
  return new Blob([gif.bytes()], { type: 'image/gif' });
}
