// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

/** What is used of gifenc, which has no types of its own. */
declare module 'gifenc' {
  export type Palette = number[][];
  /** Up to so many colours of pixels as RGBA bytes. */
  export function quantize(pixels: Uint8ClampedArray, count: number): Palette;
  export function applyPalette(pixels: Uint8ClampedArray, palette: Palette): Uint8Array;
  export function GIFEncoder(): {
    /** `delay` in ms; `repeat` 0: for ever. */
    writeFrame(indices: Uint8Array, width: number, height: number, options: { palette: Palette; delay: number; repeat?: number }): void;
    finish(): void;
    bytes(): Uint8Array<ArrayBuffer>;
  };
}
