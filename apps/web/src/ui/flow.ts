// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Finding } from '../core/judge';
import { LOAD_FIELDS } from '../core/types';
import { Role, cellText } from '../model/cell';
import { FLOW_FIELDS, wayToGround, type FlowName, type Way } from '../model/flow';
import { t } from '../texts';
import { FacetState, facetAt, facetCount } from '../view/facets';
import { ReactionView, reactionsOf, type Reaction } from '../view/reactions';
import { connectionText, numberText } from './answer_panel';
import type { App } from './app';
import { byId, make } from './dom';

/** How forces flow from the worst connection, or from what is pinned, to the ground, and what the ground does. */

const NAMES = Object.keys(FLOW_FIELDS) as FlowName[];
const UNITS: Record<FlowName, string> = { N: 'N', V: 'N', M: 'N mm', T: 'N mm' };
/** Further ones would hide each other: labels of the way, and of reactions. */
const LABELS_MAX = 14;

const numberOf = (name: FlowName, value: number) => numberText(value, name === 'N' || name === 'V' ? 2 : name === 'M' ? 0 : 1);

export class FlowPanel {
  /** What is shown; undefined: no flow. */
  private name?: FlowName;
  private way?: Way;
  private reactions: Reaction[] = [];
  private readonly arrows = new ReactionView();

  constructor(private readonly app: App) {
    document.querySelectorAll<HTMLElement>('[data-flow]').forEach((button) => {
      const name = button.dataset.flow as FlowName;
      button.onclick = () => this.choose(this.name === name ? undefined : name);
    });
    app.stage.scene.add(this.arrows.mesh);
    app.addInked(this.arrows);
    app.shownListeners.push(() => this.show());
    app.pointed.pinListeners.push(() => this.show());
    app.stage.followers.push(() => this.placeLabels());
  }

  /** N, V, M, T, and none again. */
  next(): void {
    this.choose(NAMES[this.name ? NAMES.indexOf(this.name) + 1 : 0]);
  }

  private choose(name: FlowName | undefined): void {
    this.name = name;
    document.querySelectorAll<HTMLElement>('[data-flow]').forEach((button) => {
      button.setAttribute('aria-pressed', String(button.dataset.flow === name));
    });
    this.app.view.flow = name && { connections: [], field: FLOW_FIELDS[name] };
    this.app.lookThrough();
  }

  /** The way and its numbers, where loads are known and modules are where they are built. */
  private show(): void {
    const { app, name } = this;
    byId('flow').hidden = name === undefined;
    const finding = app.shown;
    const isKnown = name !== undefined && finding?.answer?.has_loads === true && finding.answer.verdict !== 'unstable' && !app.isToppled;
    this.way = isKnown ? this.find(finding) : undefined;
    this.reactions = isKnown ? reactionsOf(app.robot, finding.answer!, finding.slots) : [];
    this.arrows.show(this.reactions);
    if (name) {
      app.view.flow = { connections: this.way?.connections ?? [], field: FLOW_FIELDS[name] };
      byId('flow-text').textContent = this.text(finding, name);
      byId('flow-table').replaceChildren(...(this.way && finding ? this.rows(finding, this.way) : []));
    }
    this.placeLabels();
    app.stage.draw();
  }

  private find(finding: Finding): Way | undefined {
    const { robot, pointed, view } = this.app;
    const picked = pointed.isPinned ? pointed.cell : undefined;
    const answer = finding.answer!;
    const { slots } = finding;
    const held = new Set<number>();
    for (let i = 0; i < facetCount(answer); ++i) {
      const { module, state } = facetAt(answer, i);
      if (state !== FacetState.kOpen && state !== FacetState.kUnknown) {
        held.add(module);
      }
    }
    const stands = (module: number) => held.has(module) || robot.roleAt(slots[module]) === Role.kFixed;
    const module = picked ? slots.indexOf(robot.slot(picked) ?? -1) : -1;
    const from = module >= 0 ? { module } : view.worst !== undefined ? { connection: view.worst } : undefined;
    return from && wayToGround(answer, slots.length, LOAD_FIELDS, from, stands);
  }

  private text(finding: Finding | undefined, name: FlowName): string {
    const { way, app } = this;
    if (!way || !finding?.answer) {
      return t('No loads are known, or none flow to the ground.');
    }
    const cell = (module: number) => cellText(app.robot.cellAt(finding.slots[module]));
    if (way.connections.length === 0) {
      return t('{0} stands on the ground itself.', cell(way.foot));
    }
    const { loads } = finding.answer;
    const values = way.connections.map((i) => loads[LOAD_FIELDS * i + FLOW_FIELDS[name]]);
    const most = values.reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a));
    const from = connectionText(app.robot, finding, way.connections[0]);
    return t('From {0} to the ground below {1}: the widest ribbon is {2} {3}.', from, cell(way.foot), numberOf(name, most), UNITS[name]);
  }

  private rows(finding: Finding, { connections }: Way): HTMLElement[] {
    const head = [t('Between'), ...NAMES.map((name) => `${name} (${UNITS[name]})`)].map((text) => make('th', { scope: 'col' }, text));
    const body = connections.map((i) => {
      const values = NAMES.map((name) => numberOf(name, finding.answer!.loads[LOAD_FIELDS * i + FLOW_FIELDS[name]]));
      const button = make('button', { type: 'button' }, connectionText(this.app.robot, finding, i));
      button.onclick = () => this.app.stage.flyTo(this.app.view.connectionPoint(i));
      return make('tr', {}, make('th', { scope: 'row' }, button), ...values.map((text) => make('td', {}, text)));
    });
    return [make('thead', {}, make('tr', {}, ...head)), make('tbody', {}, ...body)];
  }

  /** Numbers beside the ribbons and the arrows. */
  private placeLabels(): void {
    const { app, name, way } = this;
    const answer = app.shown?.answer;
    const ofWay = name && way && answer && app.view.areBarsShown
      ? way.connections.slice(0, LABELS_MAX).map((i) => ({
          at: app.view.connectionPoint(i),
          text: numberOf(name, answer.loads[LOAD_FIELDS * i + FLOW_FIELDS[name]]),
        }))
      : [];
    const ofGround = this.reactions.slice(0, LABELS_MAX).map(({ place, force }) => ({ at: place, text: `${numberOf('N', force.length())} N` }));
    const labels = [...ofWay, ...(app.isElsewhere ? [] : ofGround)].flatMap(({ at, text }) => {
      const point = app.stage.project(at);
      const label = make('span', { className: 'label small' }, text);
      if (point) {
        label.style.transform = `translate(${point.x.toFixed(1)}px, ${point.y.toFixed(1)}px)`;
      }
      return point ? [label] : [];
    });
    byId('flow-labels').replaceChildren(...labels);
  }
}
