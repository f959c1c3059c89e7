// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Finding } from '../core/judge';
import type { Answer, Trial } from '../core/types';
import type { EditedRobot } from '../model/edited_robot';
import { headline, numberText } from './answer_panel';
import { byId } from './dom';
import { t } from '../texts';

/**
 * The verdict over the picture, always in sight: a word, a gauge of the largest load from 0 by 1 to what is
 * most, and what one more module would make of both.
 */

/** The gauge is linear up to the strength, which is always at the same place, and logarithmic beyond it. */
const STRENGTH_AT = 0.6;
const WIDTH = 180;
/** What the right end stands for, at least. */
const MOST = 2;

const at = (ratio: number, most: number) =>
  WIDTH * (ratio <= 1 ? STRENGTH_AT * Math.max(ratio, 0) : STRENGTH_AT + (1 - STRENGTH_AT) * (Math.log(ratio) / Math.log(most)));

/** The next of 2, 5, 10, 20, ... that is not below any of the ratios. */
function roundUp(...ratios: number[]): number {
  const most = Math.max(MOST, ...ratios);
  const power = 10 ** Math.floor(Math.log10(most));
  return power * [1, 2, 5, 10].find((step) => step * power >= most)!;
}

export const shortRatio = (ratio: number) => (ratio <= 0 ? '0' : numberText(ratio, ratio < 10 ? 2 : 1));

/** What is known of the largest load; nothing where it says nothing. */
const ratioOf = (answer: Answer | undefined) =>
  answer && answer.verdict !== 'unstable' ? (answer.load_ratio_max ?? undefined) : undefined;

const WOULD = { safe: 'would hold', overload: 'would break', unstable: 'would topple', undecided: 'not certain' } as const;

/** "1.20 → 0.94": what something is, and what it would be. */
const change = (from: string | undefined, to: string | undefined) =>
  [from, to].filter((text, i) => text !== undefined && (i === 0 || text !== from)).join(' → ');

/** The largest load and the margin in numbers, and what a ghost would make of them. */
function numbers(answer: Answer | undefined, trial: Trial | undefined): string[] {
  const ratio = ratioOf(answer);
  const margin = answer?.stability.margin_mm ?? undefined;
  const isTried = trial !== undefined && trial.verdict !== null;
  const load = change(ratio === undefined ? undefined : shortRatio(ratio), isTried && trial.ratio >= 0 ? shortRatio(trial.ratio) : undefined);
  const spare = margin === undefined ? '' : change(numberText(margin, 1), isTried ? numberText(trial.marginMm, 1) : undefined);
  return [...(load && trial?.verdict !== 'unstable' ? [t('load {0}', load)] : []), ...(spare ? [t('margin {0} mm', spare)] : [])];
}

/** What a ghost would come to, in words and numbers. */
export const trialText = (trial: Trial, answer: Answer | undefined) =>
  trial.verdict === null ? (trial.refusal ?? t('no such module can be here')) : [t(WOULD[trial.verdict]), ...numbers(answer, trial)].join(', ');

/** `note` stands behind the numbers. */
export function showChip(robot: EditedRobot, finding: Finding | undefined, trial?: Trial, note = ''): void {
  const answer = finding?.answer;
  const [, , state] = headline(robot, finding);
  const ratio = ratioOf(answer);
  const would = trial?.verdict && trial.verdict !== 'unstable' && trial.ratio >= 0 ? trial.ratio : undefined;
  const gauge = byId('gauge');
  gauge.toggleAttribute('hidden', ratio === undefined && would === undefined);
  const most = roundUp(ratio ?? 0, would ?? 0);
  const part = (name: string) => gauge.querySelector<SVGElement>(`.${name}`)!;
  part('fill').setAttribute('width', String(at(ratio ?? 0, most)));
  part('ghost').toggleAttribute('hidden', would === undefined);
  part('ghost').setAttribute('transform', `translate(${at(would ?? 0, most).toFixed(1)} 0)`);
  part('ghost').dataset.verdict = trial?.verdict ?? '';
  part('most').textContent = String(most);
  const broken = ratio === undefined ? 0 : answer!.broken.length;
  const breaks = broken > 0 ? [t('{0} of {1} break', broken, answer!.connections.length / 3)] : [];
  byId('chip-numbers').textContent = finding?.problem ?? [...numbers(answer, trial), ...breaks, ...(note ? [note] : [])].join(' · ');
  byId('verdict').dataset.verdict = state;
}
