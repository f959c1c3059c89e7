// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { recall } from '../model/settings';
import { GALLERY_TEXTS } from './gallery';
import { PAGE_TEXTS } from './page';
import { SAID_TEXTS } from './said';

/** The page's texts in the reader's language; each is known by its English words. */

const FRENCH = { ...PAGE_TEXTS, ...SAID_TEXTS, ...GALLERY_TEXTS } as const;

export type Text = keyof typeof FRENCH;

export const LANGUAGES = ['en', 'fr'] as const;

/** Tests read the page in it: what is in the table stands in brackets, so what is not is seen. */
const PSEUDO = 'pseudo';

/** That of the address (`?lang=fr`), else the one chosen last, else the browser's. */
function languageNow(): string {
  const asked = new URLSearchParams(globalThis.location?.search).get('lang');
  const own = globalThis.navigator?.language.startsWith('fr') ? (['fr', 'en'] as const) : LANGUAGES;
  return [...LANGUAGES, PSEUDO].find((one) => one === asked) ?? recall('language', own);
}

export const language = languageNow();

const isFrench = language === 'fr';

/** No line ends before a mark that stands apart from its word. */
const spaced = (text: string) => text.replace(/ ([?!:;»])/g, '\u00a0$1').replace('« ', '«\u00a0');

/** A text with values in the places of {0}, {1}, ... */
export function t(text: Text, ...values: (string | number)[]): string {
  const words = isFrench ? spaced(FRENCH[text]) : text;
  const filled = words.replace(/\{(\d)\}/g, (_, i: string) => String(values[Number(i)]));
  return language === PSEUDO ? `⟦${filled}⟧` : filled;
}

/** A text that is known only when the page runs: as it is where the table has none, as of what the core says. */
export const word = (text: string): string => (text in FRENCH ? t(text as Text) : text);

/** A number of things with their noun: 1 step, 2 steps. */
export function counted(count: number, one: 'step' | 'module'): string {
  const isOne = isFrench ? count < 2 : count === 1;
  return t(`{0} ${one}${isOne ? '' : 's'}`, count);
}

/** Digits with the decimal mark of the language. */
export const digits = (number: string): string => (isFrench ? number.replace('.', ',') : number);

/** Of whole numbers, and of dates. */
export const locale = isFrench ? 'fr' : 'en';

const ATTRIBUTES = ['title', 'aria-label', 'aria-roledescription', 'placeholder'];

/** Puts what index.html says into the language. */
export function translatePage(root: HTMLElement): void {
  document.documentElement.lang = locale;
  const nodes = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
  while (nodes.nextNode()) {
    const node = nodes.currentNode as globalThis.Text;
    const text = node.data.trim();
    if (text && !node.parentElement!.closest('script, style, option[lang]')) {
      node.data = node.data.replace(text, () => word(text));
    }
  }
  for (const name of ATTRIBUTES) {
    root.querySelectorAll(`[${name}]`).forEach((one) => one.setAttribute(name, word(one.getAttribute(name)!)));
  }
}
