// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { fromLetters } from './letters';

/** What an element of the page holds as letters for deflated bytes; vite.config.ts writes them. */
export function unpacked(id: string): Response {
  const { textContent, dataset } = document.getElementById(id)!;
  const bytes = fromLetters(textContent!, Number(dataset.size));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw')));
}
