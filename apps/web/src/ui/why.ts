// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Question } from '../core/question';
import type { Answer, RemedyKind, RemedyList, Why } from '../core/types';
import { Role, cellText, type Cell } from '../model/cell';
import { withObstacles } from '../model/surroundings';
import { OBSTACLE, loadColour } from '../view/colours';
import { FaceCode } from '../view/robot_view';
import type { App } from './app';
import { shortRatio } from './chip';
import { byId, make, reasonOf } from './dom';
import { digits, t, type Text } from '../texts';

/** Why a robot does not hold, and single changes that would make it hold; each is done by a click. */

/** Up to here it is asked without a click, when nothing has changed for so long. */
const SMALL_COUNT = 150;
const DELAY_MS = 350;

const WORDS: Record<RemedyKind, { text: Text; title: Text | '' }> = {
  module: { text: 'Attach a module at {0}', title: 'a counterweight, or a brace' },
  prop: { text: 'Put a prop in {0}', title: 'an obstacle below a module, which bears it' },
  fixing: { text: 'Fix the module {0}', title: 'to the ground or a wall' },
  removal: { text: 'Take the module {0} away', title: '' },
};

export class WhyPanel {
  private readonly question = new Question();
  private shown?: Answer;
  private timer = 0;

  constructor(private readonly app: App) {
    app.shownListeners.push(() => this.changed());
    byId('why-ask').onclick = () => void this.ask();
    const text = byId('why-text');
    text.onpointerenter = text.onfocus = () => app.view.light(this.hanging);
    text.onpointerleave = text.onblur = () => app.view.light(undefined);
  }

  /** Slots of the modules that the worst connection alone holds. */
  private hanging?: ReadonlySet<number>;

  private changed(): void {
    const { app } = this;
    const answer = app.isExhibiting || app.finding?.isFirstLook ? undefined : app.finding?.answer;
    if (answer === this.shown) {
      return;
    }
    this.shown = answer;
    this.hanging = undefined;
    this.question.cancel();
    clearTimeout(this.timer);
    app.view.light(undefined);
    byId('why').hidden = answer === undefined || answer.verdict === 'safe';
    byId('why-text').hidden = true;
    byId('why-list').replaceChildren();
    const isSmall = app.bench.robot.count <= SMALL_COUNT;
    byId('why-ask').hidden = isSmall;
    byId('why-ask').textContent = t('Find out');
    if (!byId('why').hidden && isSmall) {
      this.timer = window.setTimeout(() => void this.ask(), DELAY_MS);
    }
  }

  private async ask(): Promise<void> {
    const { app, question } = this;
    const button = byId('why-ask');
    if (question.isBusy) {
      question.cancel();
      button.textContent = t('Find out');
      return;
    }
    button.textContent = t('Trying single changes … Stop');
    const { data, slots } = app.bench.robot.toData();
    try {
      const why = await question.ask((core) => core.why(data));
      if (why) {
        this.show(why, slots);
      }
    } catch (error) {
      byId('why-list').replaceChildren(make('li', {}, reasonOf(error)));
    }
  }

  private show({ why, remedies, hanging }: Why, slots: Int32Array): void {
    byId('why-ask').hidden = true;
    this.hanging = hanging.length > 0 ? new Set(Array.from(hanging, (module) => slots[module])) : undefined;
    const text = byId('why-text');
    text.textContent = why;
    text.hidden = why === '';
    text.tabIndex = this.hanging ? 0 : -1;
    text.classList.toggle('points', this.hanging !== undefined);
    if (!remedies) {
      return;
    }
    const kinds = (Object.keys(WORDS) as RemedyKind[]).filter((kind) => remedies[kind].safe.length > 0);
    const rows = kinds.map((kind) => this.row(kind, remedies[kind]));
    if (remedies.strength_factor !== null) {
      rows.push(make('li', {}, make('span', {}, t('Connections {0} times as strong would hold.', digits(remedies.strength_factor.toFixed(2))))));
    }
    const tried = (Object.keys(WORDS) as RemedyKind[]).reduce((sum, kind) => sum + remedies[kind].tried, 0);
    const none = make('li', {}, t('None of {0} single changes makes it hold.', tried));
    byId('why-list').replaceChildren(...(rows.length > 0 ? rows : [none]));
  }

  private row(kind: RemedyKind, { safe, tried }: RemedyList): HTMLElement {
    const [{ cell, load_ratio_max: ratio }] = safe;
    const { text, title } = WORDS[kind];
    const load = ratio === null ? [] : [make('span', { className: 'quiet' }, t('load {0}', shortRatio(ratio)))];
    const note = `${title && `${t(title)}; `}${t('{0} of {1} that were tried would do', safe.length, tried)}`;
    const button = make('button', { type: 'button', title: note }, t(text, cellText(cell)), ...load);
    button.dataset.remedy = kind;
    button.onpointerenter = button.onfocus = () => this.preview(kind, cell);
    button.onpointerleave = button.onblur = () => this.preview(kind, undefined);
    button.onclick = () => this.put(kind, cell);
    return make('li', {}, button);
  }

  private preview(kind: RemedyKind, cell: Cell | undefined): void {
    const { view } = this.app;
    const isNew = kind === 'module' || kind === 'prop';
    const colour = kind === 'prop' ? OBSTACLE.contact : loadColour(view.scale, 0);
    view.showGhosts(cell && isNew ? [cell] : [], Role.kExisting, colour, FaceCode.kNone);
    view.showCursor(cell);
  }

  private put(kind: RemedyKind, cell: Cell): void {
    const { bench } = this.app;
    this.preview(kind, undefined);
    if (bench.refusesNow()) {
      return;
    }
    if (kind === 'module') {
      bench.edit(t('attaching a module that helps'), [cell], Role.kExisting);
    } else if (kind === 'fixing') {
      bench.edit(t('fixing a module'), [cell], Role.kFixed);
    } else if (kind === 'removal') {
      bench.remove([cell]);
    } else {
      const obstacles = withObstacles(bench.robot.obstacles.obstacles, [cell], 'contact', undefined);
      bench.surround(t('placing a prop'), { obstacles });
    }
  }
}
