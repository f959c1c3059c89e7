// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { App } from './app';
import { byId, reportLines } from './dom';
import type { Film } from './film';
import { t } from '../texts';

/** What the user touches of a fall: a robot that topples, or breaks and its pieces fall. */
export class BreakingPanel {
  constructor(private readonly app: App) {
    const { toppling } = app;
    byId('topple').onclick = () => app.toggleTopple();
    byId('fall-again').onclick = () => toppling.play();
    byId('fall-slowly').onclick = () => {
      toppling.isSlow = !toppling.isSlow;
      byId('fall-slowly').setAttribute('aria-pressed', String(toppling.isSlow));
    };
    app.films.push(() => (app.fall ? this.film() : undefined));
    app.shownListeners.push(() => this.show());
    app.fallListeners.push(() => this.show());
  }

  private async *film(): Film {
    const { app } = this;
    if (!app.isToppled) {
      await app.startTopple();
    }
    yield* app.toppling.moments();
  }

  private show(): void {
    const { toppling, fall } = this.app;
    byId('breaking').hidden = fall === undefined;
    if (fall) {
      const { isToppled, isAsking, pieces } = toppling;
      const [begin, end] = fall === 'topples' ? ([t('Let it topple'), t('Stand it up')] as const) : ([t('Let it break'), t('Put it together again')] as const);
      byId('breaking-title').textContent = fall === 'topples' ? t('The fall') : t('After the break');
      byId('topple').textContent = isToppled ? end : isAsking ? t('Judging what is left … Stop') : begin;
      byId('breaking-text').textContent = pieces ? reportLines(pieces.breaking.text, 'cascade') : '';
      byId('fall-shown').hidden = !isToppled;
    }
  }
}
