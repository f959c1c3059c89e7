// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { StepsReport, Verdict } from '../core/types';
import { STAGES } from '../model/sequence';
import { css, verdictColour, type ScaleName } from '../view/colours';

/** From harmless to bad. */
const SEVERITY: readonly Verdict[] = ['safe', 'undecided', 'overload', 'unstable'];
/** Height of each verdict as a share of its band, so that colour is not all that tells. */
const HEIGHTS: Record<Verdict, number> = { safe: 0.35, undecided: 0.6, overload: 0.9, unstable: 0.9 };

const worse = (a: Verdict, b: Verdict) => (SEVERITY.indexOf(a) > SEVERITY.indexOf(b) ? a : b);

/** A band for each stage, from left to right by step; where several steps share a pixel it shows the worst. */
export function drawBands(canvas: HTMLCanvasElement, report: StepsReport, at: number | undefined, scale: ScaleName, ink: string): void {
  const context = canvas.getContext('2d')!;
  const { width, height } = canvas;
  const count = report.steps.length;
  const band = height / STAGES.length;
  context.clearRect(0, 0, width, height);
  STAGES.forEach((stage, row) => {
    const columns = new Map<number, { verdict: Verdict; end: number }>();
    report.steps.forEach(({ stages }, step) => {
      const column = Math.floor((step * width) / count);
      const end = Math.max(Math.floor(((step + 1) * width) / count), column + 1);
      const known = columns.get(column);
      const { verdict } = stages[stage];
      columns.set(column, { verdict: known ? worse(known.verdict, verdict) : verdict, end });
    });
    for (const [column, { verdict, end }] of columns) {
      const bar = band * HEIGHTS[verdict];
      const gap = end - column > 4 ? 1 : 0;
      context.fillStyle = css(verdictColour(verdict, scale));
      context.fillRect(column, (row + 1) * band - bar, end - column - gap, bar);
    }
  });
  if (at !== undefined) {
    const left = (Math.floor(at / STAGES.length) * width) / count;
    context.strokeStyle = ink;
    context.lineWidth = 2;
    context.strokeRect(left + 1, (at % STAGES.length) * band + 1, Math.max(width / count, 4) - 2, band - 2);
  }
}
