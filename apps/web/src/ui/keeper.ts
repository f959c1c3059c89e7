// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { EditedRobot } from '../model/edited_robot';
import { Kept, originOf, type KeptRobot } from '../model/kept';
import type { Workbench } from '../model/workbench';
import { addMessage, make, reasonOf, tell } from './dom';
import { askedFor } from './start';
import { counted, locale, t } from '../texts';

/** So long after a change it is kept, and longer if it is large; at once when the page goes away. */
const DELAY_MS = 300;
const DELAY_PER_MODULE_MS = 0.03;

/** Keeps every robot that is changed, and brings it back. */
export class Keeper {
  private readonly kept = Kept.open();
  /** Changed and not kept yet. */
  private pending?: EditedRobot;
  private timer = 0;
  private isFull = false;

  constructor(private readonly bench: Workbench) {
    bench.robotListeners.push((what) => (what === 'robot' ? this.flush() : this.changed()));
    window.addEventListener('pagehide', () => this.flush());
    document.addEventListener('visibilitychange', () => this.flush());
    window.addEventListener('beforeunload', (event) => {
      this.flush();
      if (bench.robot.isEdited && (this.isFull || !this.kept)) {
        event.preventDefault();
      }
    });
  }

  /** The robot on the page is not as it was opened. */
  changed(): void {
    this.pending = this.bench.robot;
    clearTimeout(this.timer);
    const delay = DELAY_MS + DELAY_PER_MODULE_MS * this.pending.count;
    this.timer = window.setTimeout(() => this.flush(), delay);
  }

  /** The robot that was built last where nothing else is asked for. */
  bringBack(): boolean {
    const entry = this.kept?.last(originOf(askedFor()));
    const isBack = entry !== undefined && this.open(entry);
    if (isBack) {
      tell(t('Back where you left off: {0}. “New” begins afresh, the gallery has examples.', nameOf(entry)));
    }
    return isBack;
  }

  /** What was built from the file or link that is shown, if it is another robot now. */
  offer(): void {
    const entry = this.kept?.last(originOf(askedFor()));
    if (entry) {
      const button = make('button', { type: 'button', textContent: t('Bring it back') });
      const message = addMessage(t('You changed this structure here on {0}.', whenOf(entry)), false, button);
      button.onclick = () => {
        message.remove();
        this.open(entry);
      };
    }
  }

  list(): KeptRobot[] {
    return this.kept?.list() ?? [];
  }

  restore(entry: KeptRobot): EditedRobot {
    return this.kept!.restore(entry);
  }

  open(entry: KeptRobot): boolean {
    try {
      this.bench.history.replace(t('bringing back {0}', nameOf(entry)), this.restore(entry));
      return true;
    } catch (error) {
      tell(reasonOf(error), true);
      return false;
    }
  }

  forgetAll(): void {
    this.kept?.forgetAll();
  }

  private flush(): void {
    clearTimeout(this.timer);
    const robot = this.pending;
    this.pending = undefined;
    if (!robot || robot.count === 0 || !this.kept) {
      return;
    }
    const wasFull = this.isFull;
    this.isFull = !this.kept.keep(robot, originOf(askedFor()));
    if (this.isFull && !wasFull) {
      tell(t('Too large to be kept when the page is closed: save it as a file.'));
    }
  }
}

export const nameOf = ({ name, modules }: KeptRobot) =>
  name || t('a structure of {0}', counted(modules.length / 4, 'module'));

export const whenOf = ({ time }: KeptRobot) =>
  new Date(time).toLocaleString(locale, { dateStyle: 'medium', timeStyle: 'short' });
