// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { LOAD_FIELDS, type Answer } from '../core/types';
import type { App } from './app';
import { connectionText, numberText } from './answer_panel';
import { byId, make } from './dom';
import { t, type Text } from '../texts';

/** What every connection of the robot in the picture carries, as a table; a row goes where its connection is. */

const COLUMNS: readonly [title: Text, unit: string, field: number, decimals: number][] = [
  ['Load', '', 0, 3],
  ['Axial', 'N', 1, 2],
  ['Bending', 'N mm', 2, 0],
  ['Shear', 'N', 3, 2],
  ['Torsion', 'N mm', 4, 1],
];
/** So many rows are made at once. */
const ROWS = 60;

export class ConnectionTable {
  private field = 0;
  private isAscending = false;
  private rows = ROWS;
  private shown?: Answer;

  constructor(private readonly app: App) {
    const details = byId<HTMLDetailsElement>('connections');
    details.ontoggle = () => this.show();
    byId('connections-more').onclick = () => {
      this.rows += 4 * ROWS;
      this.show();
    };
    app.shownListeners.push(() => this.changed());
  }

  private changed(): void {
    const answer = this.app.shown?.answer;
    if (answer === this.shown) {
      return;
    }
    this.shown = answer;
    this.rows = ROWS;
    const count = answer?.has_loads ? answer.connections.length / 3 : 0;
    const breaks = answer && answer.verdict !== 'unstable' ? answer.broken.length : 0;
    byId('connections-count').textContent = breaks > 0 ? t('{0} of {1} break', breaks, count) : String(count);
    byId('connections').hidden = count === 0;
    this.show();
  }

  private sortBy(field: number): void {
    this.isAscending = field === this.field && !this.isAscending;
    this.field = field;
    this.show();
  }

  private show(): void {
    const answer = this.shown;
    if (!byId<HTMLDetailsElement>('connections').open || !answer?.has_loads) {
      byId('connections-table').replaceChildren();
      return;
    }
    const order = this.order(answer);
    const more = byId('connections-more');
    more.hidden = order.length <= this.rows;
    more.textContent = t('More of {0}', order.length);
    const isBroken = new Set(answer.broken);
    const body = Array.from(order.subarray(0, this.rows), (i) => this.row(answer, i, isBroken.has(i)));
    byId('connections-table').replaceChildren(this.head(), make('tbody', {}, ...body));
  }

  /** Forces are sorted by their size, loads as they are. */
  private order({ loads, connections }: Answer): Uint32Array {
    const { field } = this;
    const value = (i: number) => (field === 0 ? loads[LOAD_FIELDS * i] : Math.abs(loads[LOAD_FIELDS * i + field]));
    const sign = this.isAscending ? 1 : -1;
    return Uint32Array.from({ length: connections.length / 3 }, (_, i) => i).sort((a, b) => sign * (value(a) - value(b)) || a - b);
  }

  private head(): HTMLElement {
    const cells = COLUMNS.map(([title, unit, field]) => {
      const button = make('button', { type: 'button' }, unit ? `${t(title)} ${unit}` : t(title));
      button.onclick = () => this.sortBy(field);
      const cell = make('th', { scope: 'col' }, button);
      if (field === this.field) {
        cell.ariaSort = this.isAscending ? 'ascending' : 'descending';
        button.append(this.isAscending ? ' ↑' : ' ↓');
      }
      return cell;
    });
    return make('thead', {}, make('tr', {}, make('th', { scope: 'col' }, t('Between')), ...cells));
  }

  private row(answer: Answer, index: number, isBroken: boolean): HTMLElement {
    const { robot, shown } = this.app;
    const button = make('button', { type: 'button' }, connectionText(robot, shown!, index));
    const values = COLUMNS.map(([, , field, decimals]) => numberText(answer.loads[LOAD_FIELDS * index + field], decimals));
    const row = make('tr', {}, make('th', { scope: 'row' }, button), ...values.map((text) => make('td', {}, text)));
    row.className = isBroken ? 'breaks' : '';
    row.onclick = () => this.app.seeConnection(index);
    return row;
  }
}
