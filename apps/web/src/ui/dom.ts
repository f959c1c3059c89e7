// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { t, word } from '../texts';

/** The element with an id, which index.html has. */
export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (!element) {
    throw new Error(`index.html has no #${id}`);
  }
  return element as T;
}

type Child = Node | string;

/** A new element. Text is text, never markup. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** Why something was not done, in words. */
export const reasonOf = (error: unknown): string => word(error instanceof Error ? error.message : String(error));

export function download(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  make('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

const SHOWN_MS = 7000;

/** A message below the others, until it is closed; `more` stands beside its text. */
export function addMessage(text: string, isError = false, ...more: HTMLElement[]): HTMLElement {
  const close = make('button', { type: 'button', className: 'close', ariaLabel: t('Close') });
  const className = isError ? 'message error' : 'message';
  const message = make('div', { className }, make('p', {}, text), ...more, close);
  close.append(icon('close'));
  close.onclick = () => message.remove();
  byId('messages').append(message);
  return message;
}

/** A message for a while; one that is an error stays until it is closed or another one comes. */
export function tell(text: string, isError = false, shownMs = isError ? Infinity : SHOWN_MS): HTMLElement {
  const messages = byId('messages');
  messages.replaceChildren(...(isError ? [] : messages.querySelectorAll('.error')));
  const message = addMessage(text, isError);
  if (shownMs < Infinity) {
    setTimeout(() => message.remove(), shownMs);
  }
  return message;
}

/** Errors are about what was there before. */
export function clearErrors(): void {
  byId('messages').querySelectorAll('.error').forEach((message) => message.remove());
}

/** For who listens: the state of what the keyboard's cursor is on. */
export function say(text: string): void {
  byId('spoken').textContent = text;
}

const ICONS = {
  close: 'M5 5l10 10M15 5L5 15',
  undo: 'M8 5L4 9l4 4M4 9h8a4 4 0 0 1 0 8h-2',
  redo: 'M12 5l4 4-4 4M16 9H8a4 4 0 0 0 0 8h2',
  fit: 'M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4',
  look: 'M2.5 10S5.500 4.800 10 4.800 17.500 10 17.500 10 14.500 15.200 10 15.200 2.500 10 2.500 10zM10 8a2 2 0 1 1 0 4 2 2 0 0 1 0-4z',
  select: 'M3 6V3h3M9 3h2M14 3h3v3M17 9v2M17 14v3h-3M11 17H9M6 17H3v-3M3 11V9M7 7h6v6H7z',
  add: 'M10 4v12M4 10h12',
  remove: 'M4 10h12',
  paint: 'M4 16l1-4 8-8 3 3-8 8-4 1zM11.500 5.500l3 3',
  obstacle: 'M3 6h14v9H3zM3 10.500h14M10 6v4.500M6.500 10.500V15M13.500 10.500V15',
  load: 'M10 3v9M6.500 8.500L10 12l3.500-3.500M4 16h12',
  play: 'M6 4l10 6-10 6z',
  pause: 'M6 4v12M14 4v12',
  stepOn: 'M5 4l7 6-7 6zM15 4v12',
  stepBack: 'M15 4l-7 6 7 6zM5 4v12',
  phaseOn: 'M3 4l6 6-6 6zM10 4l6 6-6 6zM18 4v12',
  phaseBack: 'M17 4l-6 6 6 6zM10 4l-6 6 6 6zM2 4v12',
} as const;

export type IconName = keyof typeof ICONS;

export function icon(name: IconName): SVGElement {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 20 20');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  path.setAttribute('d', ICONS[name]);
  svg.append(path);
  return svg;
}

/** Lines of a report under one of its heads, without the head and the blanks before them. */
export const reportLines = (text: string, head: string) => text.replace(new RegExp(`^ +(${head} +)?`, 'gm'), '').trim();
