// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

/** What a reader has chosen for this page wherever it is opened: its theme, its projection. Robots are kept elsewhere. */

const PREFIX = 'holdfast.setting.';

/** The choice that was made last; the first of the choices where none was, or the browser keeps nothing. */
export function recall<T extends string>(name: string, choices: readonly T[]): T {
  try {
    const kept = localStorage.getItem(PREFIX + name);
    return choices.find((choice) => choice === kept) ?? choices[0];
  } catch {
    return choices[0];
  }
}

/** Where the browser keeps nothing the choice lasts as long as the page. */
export function remember(name: string, choice: string): void {
  try {
    localStorage.setItem(PREFIX + name, choice);
  } catch {
    // It has been applied all the same.
  }
}
