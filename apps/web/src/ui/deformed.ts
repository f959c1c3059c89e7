// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Question } from '../core/question';
import type { App } from './app';
import { byId, make, reasonOf } from './dom';
import { numberText } from './answer_panel';
import { digits, t } from '../texts';

/** The equilibrium in the deformed shape, true to scale, under a factor of all loads that a slider gives. */

const DELAY_MS = 80;
const WHOLE = 100;

export class DeformedPanel {
  private readonly question = new Question();
  private timer = 0;

  constructor(private readonly app: App) {
    byId('deform').onclick = () => (this.isOpen ? this.close() : this.open());
    byId('load-factor').oninput = () => this.later();
    app.bench.robotListeners.push(() => this.forget());
    app.exhibitListeners.push((mode) => mode !== 'deformed' && this.forget());
  }

  private get isOpen(): boolean {
    return !byId('deformed').hidden;
  }

  private open(): void {
    if (this.app.bench.refusesNow()) {
      return;
    }
    byId<HTMLInputElement>('load-factor').value = String(WHOLE);
    this.show(true);
    this.later();
  }

  private close(): void {
    this.forget();
    if (this.app.mode === 'deformed') {
      this.app.bench.closed = '';
      this.app.setExhibit(undefined);
    }
  }

  /** Another robot, or something else is shown: the picture is not of the deformed shape any more. */
  private forget(): void {
    this.question.cancel();
    clearTimeout(this.timer);
    this.show(false);
  }

  private show(isShown: boolean): void {
    byId('deformed').hidden = !isShown;
    byId('deform').textContent = isShown ? t('Back to the straight shape') : t('True to scale');
    byId('deformed-text').textContent = '';
  }

  private later(): void {
    byId('load-factor-value').textContent = `${digits(this.factor.toFixed(2))} ×`;
    byId('deformed-text').textContent = '…';
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.ask(), DELAY_MS);
  }

  private get factor(): number {
    return Number(byId<HTMLInputElement>('load-factor').value) / WHOLE;
  }

  private async ask(): Promise<void> {
    const { app, factor } = this;
    const { robot } = app.bench;
    const { data, slots } = robot.toData();
    const text = byId('deformed-text');
    try {
      const answer = await this.question.ask((core) => core.deformed(data, factor));
      if (!answer) {
        return;
      }
      app.bench.closed = t('The deformed shape is shown: “Back to the straight shape” ends that.');
      app.setExhibit({ mode: 'deformed', robot, finding: { answer, slots }, exaggeration: 1 });
      const reached = answer.factor !== null && answer.factor < 1 ? ` ${t('Shown: {0} times the loads, the last that it bears.', numberText(answer.factor * factor))}` : '';
      text.textContent = `${sentence(answer.reasons)}${reached}`;
    } catch (error) {
      text.replaceChildren(make('span', { className: 'fault' }, reasonOf(error)));
    }
  }
}

const sentence = (reasons: readonly string[]) => reasons.map((one) => `${one[0].toUpperCase()}${one.slice(1)}.`).join(' ');
