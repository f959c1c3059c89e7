// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Output } from '../core/types';
import { linkFragment } from '../model/link';
import { remember } from '../model/settings';
import type { Workbench } from '../model/workbench';
import { language, t } from '../texts';
import { byId, tell } from './dom';
import { write } from './files';

/** Beyond this, in letters, some browsers cut an address. */
const ADDRESS_MAX = 1_000_000;

/** What the page opens anew to show what it shows now; undefined: it is too large for an address. */
async function fragmentOf(bench: Workbench): Promise<string | undefined> {
  const isAsOpened = !bench.robot.isEdited && !bench.history.canUndo && !bench.history.canRedo;
  if (isAsOpened || bench.robot.count === 0) {
    return isAsOpened ? location.hash : '';
  }
  const fragment = await linkFragment(await write(bench, Output.kJson));
  return fragment.length > ADDRESS_MAX ? undefined : fragment;
}

/** The choice of a language. The page begins anew in it, with the robot as it is and nothing to undo. */
export function offerLanguages(bench: Workbench): void {
  const select = byId<HTMLSelectElement>('language');
  select.value = language;
  select.onchange = async () => {
    const fragment = await fragmentOf(bench).catch(() => undefined);
    if (fragment === undefined) {
      select.value = language;
      tell(t('too large to go along into another language: save it first, then choose New'), true);
      return;
    }
    remember('language', select.value);
    bench.robot.isEdited = false;
    location.assign(`?lang=${select.value}${fragment}`);
  };
}
