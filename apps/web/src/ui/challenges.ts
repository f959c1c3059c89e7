// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Attempt, CHALLENGES, fileOf, type Challenge } from '../model/challenges';
import { GoalView } from '../view/goals';
import type { App } from './app';
import { shortRatio } from './chip';
import { byId, make, say } from './dom';
import { openText } from './files';
import { counted, t, word } from '../texts';

/** What a puzzle asks for, which of it is done, and the next one. */

const STORE = 'holdfast.challenges';

/** Those that were solved in this browser; none where nothing may be kept. */
function solvedOnes(): Set<string> {
  try {
    return new Set(JSON.parse(localStorage.getItem(STORE) ?? '[]') as string[]);
  } catch {
    return new Set();
  }
}

export class ChallengePanel {
  private attempt?: Attempt;
  private isOpening = false;
  private isSolved = false;
  private readonly goals = new GoalView();

  constructor(private readonly app: App) {
    app.stage.scene.add(this.goals.lines);
    app.shownListeners.push(() => this.show());
    app.bench.robotListeners.push((what) => {
      if (what === 'robot' && !this.isOpening) {
        this.end();
      }
    });
    byId('challenge-again').onclick = () => void this.begin(this.attempt!.challenge);
    byId('challenge-end').onclick = () => this.end();
    byId('challenge-next').onclick = () => void this.begin(CHALLENGES[(CHALLENGES.indexOf(this.attempt!.challenge) + 1) % CHALLENGES.length]);
  }

  async begin(challenge: Challenge): Promise<void> {
    this.isOpening = true;
    const { bench } = this.app;
    const isOpen = await openText(bench, new TextEncoder().encode(fileOf(challenge)), word(challenge.title)).finally(() => (this.isOpening = false));
    if (isOpen) {
      this.isSolved = false;
      this.attempt = new Attempt(challenge, bench.robot);
      byId('challenge-title').textContent = t('Challenge {0} of {1}: {2}', CHALLENGES.indexOf(challenge) + 1, CHALLENGES.length, word(challenge.title));
      byId('challenge-text').textContent = word(challenge.text);
      this.show();
      say(`${byId('challenge-title').textContent}. ${word(challenge.text)}`);
    }
  }

  private end(): void {
    this.attempt = undefined;
    this.show();
  }

  private show(): void {
    const { app, attempt } = this;
    const { robot } = app.bench;
    byId('challenge').hidden = attempt === undefined;
    this.goals.show(robot.lattice, (attempt?.challenge.reach ?? []).filter((cell) => !robot.has(cell)));
    app.stage.draw();
    const answer = app.finding && !app.finding.isFirstLook ? app.finding.answer : undefined;
    if (!attempt || app.mode !== 'build') {
      return;
    }
    const conditions = attempt.conditions(robot, answer);
    byId('challenge-list').replaceChildren(
      ...conditions.map(({ text, isMet }) => make('li', { className: isMet ? 'met' : '' }, make('span', { className: 'unseen' }, isMet ? t('done: ') : t('open: ')), text)),
    );
    const wasSolved = this.isSolved;
    this.isSolved = answer !== undefined && conditions.every(({ isMet }) => isMet);
    byId('challenge-done').hidden = !this.isSolved;
    if (this.isSolved) {
      const ratio = answer!.load_ratio_max;
      const count = counted(robot.count, 'module');
      byId('challenge-done').textContent = `${ratio ? t('Solved, with {0}; the largest load is {1}.', count, shortRatio(ratio)) : t('Solved, with {0}.', count)} ${t('Save has a link to your solution.')}`;
      this.keep(attempt.challenge.id);
    }
    if (this.isSolved && !wasSolved) {
      say(byId('challenge-done').textContent!);
    }
  }

  private keep(id: string): void {
    try {
      localStorage.setItem(STORE, JSON.stringify([...solvedOnes().add(id)]));
    } catch {
      // It is solved all the same.
    }
  }
}

/** A row of buttons, by name; what was solved has a tick. */
export function challengeButtons(begin: (challenge: Challenge) => void): HTMLElement[] {
  const solved = solvedOnes();
  return CHALLENGES.map((challenge, i) => {
    const button = make('button', { type: 'button', className: solved.has(challenge.id) ? 'met' : '' }, `${i + 1} ${word(challenge.title)}`);
    button.dataset.challenge = challenge.id;
    button.onclick = () => begin(challenge);
    return button;
  });
}
