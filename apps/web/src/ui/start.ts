// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Output, type LimitLoad } from '../core/types';
import { FIRST_EXAMPLE } from '../model/examples';
import { isLink, readFragment } from '../model/link';
import type { App } from './app';
import type { Collapse } from './collapse';
import { byId, make, reasonOf, tell } from './dom';
import { BROKEN_LINK, openFragment, openText, reportOf } from './files';
import type { Keeper } from './keeper';
import { t } from '../texts';

/** What a page shows first: a link's robot, that of `holdfast view`, what was built before, an example. */

/** What holdfast view puts into the page. */
export interface Start {
  /** The text of the structure's file. */
  structure: string;
  name: string;
  /** The native report, for people, if the page is that of `holdfast check --html`. */
  report?: string;
  /** If the program was asked for it. */
  limit?: LimitLoad | null;
}

let start: Start | null | undefined;

export function readStart(): Start | null {
  start ??= JSON.parse(byId('holdfast-start').textContent ?? 'null') as Start | null;
  return start;
}

/** What the page is asked to show, whatever it is; '' if nothing. */
export const askedFor = () => (isLink(location.hash) ? location.hash : (readStart()?.structure ?? ''));

const encoded = (text: string) => new TextEncoder().encode(text);

/** What was asked for is shown as it is; what was built from it is offered. */
export async function openFirst({ bench }: App, keeper: Keeper, collapse: Collapse): Promise<void> {
  const isLinkOpen = await openFragment(bench).catch(() => {
    tell(BROKEN_LINK, true);
    return false;
  });
  const viewed = readStart();
  if (isLinkOpen) {
    keeper.offer();
  } else if (viewed) {
    await openText(bench, encoded(viewed.structure), viewed.name);
    showReport(viewed);
    if (viewed.limit) {
      collapse.show(viewed.limit);
    }
    keeper.offer();
  } else if (isLinkOpen === false || !keeper.bringBack()) {
    await openText(bench, encoded(FIRST_EXAMPLE.source()), FIRST_EXAMPLE.name);
  }
}

function showReport({ report }: Start): void {
  if (report !== undefined) {
    byId('report-text').textContent = report;
    byId('report-check').textContent = t('Written by holdfast check when this page was made.');
    byId<HTMLDialogElement>('report').showModal();
  }
}

/** Where no picture can be drawn the answer is still given, in words. */
export async function showWithoutPicture(reason: string): Promise<void> {
  const viewed = readStart();
  document.querySelectorAll<HTMLElement>('header nav, header label').forEach((part) => (part.hidden = true));
  const text = make('pre', { tabIndex: 0 }, '…');
  const note = make('p', { className: 'quiet' }, t('This browser cannot draw the robot ({0}); this is its report.', reason));
  document.querySelector('main')!.replaceWith(make('main', { id: 'words' }, note, text));
  try {
    const link = await readFragment(location.hash);
    const source = link ? new TextDecoder().decode(link) : (viewed?.structure ?? FIRST_EXAMPLE.source());
    const own = () => reportOf(source, link ? t('the link') : (viewed?.name ?? FIRST_EXAMPLE.name), Output.kReportText);
    text.textContent = link ? await own() : (viewed?.report ?? (await own()));
  } catch (error) {
    text.textContent = reasonOf(error);
  }
}
