// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

/** A structure in the fragment of a link: holdfast JSON, deflated, as base64url. */

const PREFIX = '#s=';
/** Nothing that was made by linkFragment() is larger; a bomb is. */
const BYTES_MAX = 64 << 20;

async function through(bytes: Uint8Array<ArrayBuffer>, transform: GenericTransformStream) {
  const reader = new Blob([bytes]).stream().pipeThrough(transform as ReadableWritablePair).getReader();
  const parts: Uint8Array[] = [];
  let size = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    const piece = part.value as Uint8Array;
    parts.push(piece);
    size += piece.length;
    if (size > BYTES_MAX) {
      await reader.cancel();
      throw new RangeError('the link holds more than 64 MiB');
    }
  }
  const all = new Uint8Array(size);
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

export async function linkFragment(json: string): Promise<string> {
  const compact = new TextEncoder().encode(JSON.stringify(JSON.parse(json)));
  const bytes = await through(compact, new CompressionStream('deflate-raw'));
  let text = '';
  for (const byte of bytes) {
    text += String.fromCharCode(byte);
  }
  return PREFIX + btoa(text).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

export const isLink = (fragment: string) => fragment.startsWith(PREFIX);

/** The bytes of the structure; undefined if the fragment is none of ours. Throws if it is broken. */
export async function readFragment(fragment: string): Promise<Uint8Array | undefined> {
  if (!isLink(fragment)) {
    return undefined;
  }
  const text = fragment.slice(PREFIX.length).replaceAll('-', '+').replaceAll('_', '/');
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return through(bytes, new DecompressionStream('deflate-raw'));
}
