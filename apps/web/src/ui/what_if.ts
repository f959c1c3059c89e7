// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Question } from '../core/question';
import type { Losses } from '../core/types';
import { equal, type Cell } from '../model/cell';
import type { App } from './app';
import { byId, reasonOf, reportLines, tell } from './dom';
import { digits, t } from '../texts';

/** How sure it is where strengths scatter, and what follows from the loss of each single part. */

const DELAY_MS = 120;
/** Of each strength, without which nothing is asked, of all together, of each mass. */
const SLIDERS = ['scatter', 'scatter-common', 'scatter-mass'] as const;
/** Losses that are not judged by then are undecided. */
const LOSS_SECONDS = 30;

/** The probability that every connection holds, beside the verdict, for a scatter that a slider gives. */
export class Sure {
  private readonly question = new Question();
  private timer = 0;

  constructor(private readonly app: App) {
    for (const slider of SLIDERS.map(byId)) {
      slider.oninput = () => this.changed();
    }
    app.bench.robotListeners.push(() => this.changed());
  }

  private changed(): void {
    const shares = SLIDERS.map((id) => Number(byId<HTMLInputElement>(id).value) / 100);
    SLIDERS.forEach((id, i) => (byId(`${id}-value`).textContent = `±${Math.round(100 * shares[i])} %`));
    this.question.cancel();
    this.app.note = '';
    byId('sure-text').textContent = '';
    clearTimeout(this.timer);
    if (shares[0] > 0 && this.app.bench.robot.count > 0) {
      this.timer = window.setTimeout(() => void this.ask(shares), DELAY_MS);
    }
  }

  private async ask([own, common, masses]: number[]): Promise<void> {
    const { data } = this.app.bench.robot.toData();
    try {
      const sure = await this.question.ask((core) => core.reliability(data, own, common, masses));
      if (sure) {
        byId('sure-text').textContent = reportLines(sure.text, 'reliability');
        this.app.note = sure.holds === null ? '' : probabilityText(sure.holds, sure.fails!);
      }
    } catch (error) {
      byId('sure-text').textContent = reasonOf(error);
    }
  }
}

const short = (share: number) => digits(String(Number(share.toPrecision(2))));

/** Of the smaller of both, as its digits are those that say something. */
const probabilityText = (holds: number, fails: number) =>
  fails < 0.01 ? t('fails with p = {0}', short(fails)) : t('holds with p = {0}', short(holds));

/** Colours of connections and modules by what follows from their loss. */
export class LossPanel {
  private readonly question = new Question();

  constructor(private readonly app: App) {
    byId('lose').onclick = () => void this.ask();
    app.bench.robotListeners.push(() => this.forget());
    app.exhibitListeners.push(() => this.hide());
  }

  private forget(): void {
    this.question.cancel();
    byId('lose').textContent = t('Try the loss of each part');
    byId('lose-text').textContent = '';
    this.hide();
  }

  /** Loads are shown again. */
  private hide(): void {
    this.app.showLosses(undefined);
    byId('lose').setAttribute('aria-pressed', 'false');
  }

  private async ask(): Promise<void> {
    const { app, question } = this;
    const button = byId('lose');
    if (button.getAttribute('aria-pressed') === 'true' || question.isBusy) {
      this.forget();
      return;
    }
    button.textContent = t('Trying … Stop');
    const { data } = app.bench.robot.toData();
    try {
      const losses = await question.ask((core) => core.loseOne(data, LOSS_SECONDS));
      if (losses) {
        this.show(losses);
      }
    } catch (error) {
      this.forget();
      tell(reasonOf(error), true);
    }
  }

  private show({ lose_one: found, text }: Losses): void {
    const { finding, bench: { robot } } = this.app;
    byId('lose-text').textContent = reportLines(text, 'lose one');
    const isTried = finding?.answer?.verdict === 'safe';
    byId('lose').textContent = isTried ? t('Back to loads') : t('Try the loss of each part');
    byId('lose').setAttribute('aria-pressed', String(isTried));
    if (!isTried) {
      return;
    }
    const { connections } = finding.answer!;
    const isOf = (a: Cell, b: Cell) => (one: { a?: Cell; b?: Cell }) =>
      one.a !== undefined && ((equal(one.a, a) && equal(one.b!, b)) || (equal(one.a, b) && equal(one.b!, a)));
    const joints = found.fatal.filter(({ a }) => a);
    const fatal = new Set<number>();
    for (let i = 0; joints.length > 0 && 3 * i < connections.length; ++i) {
      const [a, b] = [0, 1].map((end) => robot.cellAt(finding.slots[connections[3 * i + end]]));
      if (joints.some(isOf(a, b))) {
        fatal.add(i);
      }
    }
    const slots = found.fatal.flatMap(({ module }) => (module ? [robot.slot(module)!] : []));
    this.app.showLosses({ connections: fatal, modules: new Set(slots) });
  }
}
