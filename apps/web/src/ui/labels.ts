// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Finding } from '../core/judge';
import { LOAD_FIELDS } from '../core/types';
import type { EditedRobot } from '../model/edited_robot';
import type { RobotView } from '../view/robot_view';
import type { Stage } from '../view/stage';
import { connectionText, formatRatio } from './answer_panel';
import { byId, make } from './dom';

/** Texts that stand in the picture: the load ratio of the worst connection, beside its collar. */
export function placeLabels(stage: Stage, view: RobotView, robot: EditedRobot, finding: Finding | undefined): void {
  const labels = byId('labels');
  const { worst } = view;
  const answer = finding?.answer;
  if (worst === undefined || !answer || view.hasOwnColours) {
    labels.replaceChildren();
    return;
  }
  const at = view.isCutAway(worst) ? undefined : stage.project(view.connectionPoint(worst));
  const label = (labels.firstElementChild ?? make('span')) as HTMLElement;
  label.textContent = formatRatio(answer.loads[LOAD_FIELDS * worst]);
  label.className = answer.broken.includes(worst) ? 'label breaks' : 'label';
  label.title = connectionText(robot, finding, worst);
  label.hidden = !at;
  if (at) {
    label.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
  }
  if (!label.parentElement) {
    labels.replaceChildren(label);
  }
}
