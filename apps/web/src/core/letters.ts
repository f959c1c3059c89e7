// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

/**
 * Bytes as letters of a text in the page, 13 or 14 bits in two of them as basE91 does [Henke 2000]: 1.23 letters
 * for a byte, where base64 takes 1.33. The letters are all that ASCII has but ", \ and <, so that no string
 * literal and no script has to escape them.
 */

const LETTERS = Array.from({ length: 94 }, (_, i) => 33 + i).filter((code) => !'"\\<'.includes(String.fromCharCode(code)));
const BASE = LETTERS.length;
/** Two letters tell so many numbers from each other: those of 13 bits, and some of 14. */
const SPARE = BASE * BASE - 2 ** 13;

export function toLetters(bytes: Uint8Array): string {
  const codes = new Uint8Array(Math.ceil((bytes.length * 16) / 13) + 2);
  let [count, held, bits] = [0, 0, 0];
  const put = (value: number) => {
    codes[count++] = LETTERS[value % BASE];
    codes[count++] = LETTERS[Math.floor(value / BASE)];
  };
  for (const byte of bytes) {
    held |= byte << bits;
    bits += 8;
    if (bits > 13) {
      const taken = (held & 8191) < SPARE ? 14 : 13;
      put(held & (2 ** taken - 1));
      held >>>= taken;
      bits -= taken;
    }
  }
  if (bits > 0) {
    put(held);
  }
  return new TextDecoder().decode(codes.subarray(0, count));
}

/** `size`: of the bytes that were written. */
export function fromLetters(text: string, size: number): Uint8Array<ArrayBuffer> {
  const values = new Int16Array(128);
  LETTERS.forEach((code, value) => (values[code] = value));
  const bytes = new Uint8Array(size);
  let [count, held, bits] = [0, 0, 0];
  for (let i = 0; i < text.length; i += 2) {
    const value = values[text.charCodeAt(i)] + BASE * values[text.charCodeAt(i + 1)];
    held |= value << bits;
    bits += (value & 8191) < SPARE ? 14 : 13;
    for (; bits > 7 && count < size; bits -= 8) {
      bytes[count++] = held & 255;
      held >>>= 8;
    }
  }
  return bytes;
}
