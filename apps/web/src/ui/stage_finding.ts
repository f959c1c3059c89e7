// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Finding } from '../core/judge';
import type { Answer, StageLoads, StageReport } from '../core/types';
import { cellText, equal, type Cell } from '../model/cell';
import type { EditedRobot } from '../model/edited_robot';

/** A stage of a step as an answer, for what shows answers. */

const NO_NUMBERS = new Int32Array(0);

/** What the panel shows of a stage: its verdict, and the loads as far as they are known. */
export function findingOf(robot: EditedRobot, report: StageReport, loads: StageLoads | undefined): Finding {
  const cells = loads?.cells ?? NO_NUMBERS;
  const slots = Int32Array.from({ length: cells.length / 3 }, (_, i) => {
    const cell: Cell = [cells[3 * i], cells[3 * i + 1], cells[3 * i + 2]];
    const slot = robot.slot(cell);
    if (slot === undefined) {
      throw new Error(`the core has a module in ${cellText(cell)}, the page has none`);
    }
    return slot;
  });
  const answer: Answer = {
    verdict: report.verdict,
    reasons: report.reasons,
    stability: loads?.stabilities[0] ?? unknownStability(report),
    load_ratio_max: report.load_ratio_max,
    worst: loads ? worstOf(robot, report, loads, slots) : null,
    weight_factor: null,
    contact_model: loads?.contact_model ?? '',
    solves: 0,
    second_order: null,
    facet_half_mm: 0,
    has_loads: (loads?.loads.length ?? 0) > 0,
    seconds: 0,
    connections: loads?.connections ?? NO_NUMBERS,
    broken: loads?.broken ?? NO_NUMBERS,
    loads: loads?.loads ?? new Float64Array(0),
    facets: NO_NUMBERS,
    limits: NO_NUMBERS,
    facetForces: new Float64Array(0),
    displacements: new Float64Array(0),
  };
  return { answer, slots };
}

/** The connection that the report names; null if it is one to what moves. */
function worstOf(robot: EditedRobot, { at }: StageReport, { connections }: StageLoads, slots: Int32Array): number | null {
  for (let i = 0; at && 3 * i < connections.length; ++i) {
    const [a, b] = [0, 1].map((end) => robot.cellAt(slots[connections[3 * i + end]]));
    if ((equal(a, at[0]) && equal(b, at[1])) || (equal(a, at[1]) && equal(b, at[0]))) {
      return i;
    }
  }
  return null;
}

const unknownStability = ({ verdict, margin_mm }: StageReport): Answer['stability'] => ({
  rule: 'polygon',
  stable: verdict !== 'unstable',
  margin_mm,
  edge: null,
  centre_of_mass: [0, 0, 0],
  polygon: [],
  rigid: { answer: 'undecided', friction_needed: null, tilt_margin_deg: null, motion: null },
});
