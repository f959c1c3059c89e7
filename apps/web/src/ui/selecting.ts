// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Selection } from '../model/selection';
import type { App } from './app';
import { byId, make, say } from './dom';
import { counted, t } from '../texts';

/** What is selected: rims in the picture, and what may be done with all of it at once. */
export class SelectionPanel {
  private readonly direction = byId<HTMLSelectElement>('select-direction');

  constructor(private readonly app: App) {
    const { selection, robotListeners, toolListeners } = app.bench;
    const deeds: Record<string, (selection: Selection) => void> = {
      all: (one) => one.all(),
      layer: (one) => one.layer(),
      connected: (one) => one.connected(),
      box: (one) => one.box(),
      none: (one) => one.clear(),
      move: (one) => one.move(Number(this.direction.value)),
      copy: (one) => one.copy(Number(this.direction.value)),
      turn: (one) => one.turn(),
      'mirror-x': (one) => one.mirror('x'),
      'mirror-y': (one) => one.mirror('y'),
      fill: (one) => one.fill(),
      load: (one) => one.load(),
      remove: (one) => one.remove(),
    };
    for (const [name, deed] of Object.entries(deeds)) {
      byId<HTMLButtonElement>(`select-${name}`).onclick = () => deed(selection);
    }
    selection.listeners.push(() => this.showChosen());
    toolListeners.push(() => this.show());
    robotListeners.push(() => this.show());
    app.shownListeners.push(() => this.mark());
    this.show();
  }

  private showChosen(): void {
    this.mark();
    this.show();
    say(this.text);
  }

  private get text(): string {
    const { length } = this.app.bench.selection.cells;
    return length === 0 ? t('Nothing is selected.') : t('{0} selected.', counted(length, 'module'));
  }

  /** Nothing of the robot that is built is chosen in another one. */
  private mark(): void {
    const { bench, mode, view } = this.app;
    const cells = mode === 'build' ? bench.selection.cells : [];
    view.select(new Set(cells.map((cell) => bench.robot.slot(cell)!)));
  }

  private show(): void {
    const { bench } = this.app;
    const { cells } = bench.selection;
    byId('selecting').hidden = bench.tool !== 'select' && cells.length === 0;
    byId('select-text').textContent = this.text;
    document.querySelectorAll<HTMLButtonElement>('#selecting [data-chosen] button').forEach((button) => (button.disabled = cells.length === 0));
    this.offerDirections();
  }

  private offerDirections(): void {
    const sides = sidesOf(this.app);
    if ([...this.direction.options].map((option) => option.text).join() !== sides.join()) {
      this.direction.replaceChildren(...sides.map((side, i) => make('option', { value: String(i) }, side)));
    }
  }
}

/** Names of the directions of neighbours. */
const sidesOf = ({ bench: { robot: { lattice } } }: App) => lattice.sides.slice(0, lattice.directionCount);
