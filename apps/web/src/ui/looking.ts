// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Place } from '../model/lattice';
import { recall, remember } from '../model/settings';
import { OBLIQUE } from '../view/stage';
import type { Section } from '../view/section';
import type { App } from './app';
import { byId, say } from './dom';
import { chooseTheme } from './theme';
import { digits, t } from '../texts';

/** How the robot is looked at: from which side, cut open, through its modules, before an audience. */

/** Straight down nothing is up in the picture: a hair beside it y is. */
const SIDES: Record<string, Place> = { oblique: OBLIQUE, front: [0, -1, 0], right: [1, 0, 0], top: [0, -1e-4, 1] };

const PROJECTIONS = ['perspective', 'orthographic'] as const;

/** By what is cut away: all that is above a plane, before it, or to its right. */
const CUTS: Record<string, Pick<Section, 'axis' | 'sense'>> = {
  above: { axis: 2, sense: 1 },
  front: { axis: 1, sense: -1 },
  right: { axis: 0, sense: 1 },
};

/** Returns what the keys do. */
export function makeLooking(app: App): Record<string, () => void> {
  new Cut(app);
  followAxes(app);
  const seeFrom = (name: string) => app.see(SIDES[name]);
  document.querySelectorAll<HTMLElement>('[data-from]').forEach((one) => {
    one.onclick = () => seeFrom(one.dataset.from!);
  });
  const toggle = (id: string, change: (isOn: boolean) => void) => {
    const button = byId(id);
    const act = () => {
      const isOn = button.getAttribute('aria-pressed') !== 'true';
      button.setAttribute('aria-pressed', String(isOn));
      change(isOn);
    };
    button.onclick = act;
    return act;
  };
  const presenting = toggle('present', present);
  const project = toggle('parallel', (isOn) => {
    app.stage.isParallel = isOn;
    remember('projection', isOn ? 'orthographic' : 'perspective');
  });
  if (recall('projection', PROJECTIONS) === 'orthographic') {
    project();
  }
  chooseTheme(byId('theme'));
  byId('present-end').onclick = presenting;
  embed(app);
  return {
    x: toggle('xray', (isOn) => app.lookThrough(isOn)),
    m: presenting,
    5: project,
    6: () => seeFrom('oblique'),
    7: () => seeFrom('front'),
    8: () => seeFrom('right'),
    9: () => seeFrom('top'),
  };
}

/** In another page (`?embed`): the picture and its verdict, to turn and to point at, and a way to the whole page. */
function embed({ bench }: App): void {
  const whole = new URL(location.href);
  if (whole.searchParams.has('embed')) {
    whole.searchParams.delete('embed');
    byId<HTMLAnchorElement>('embed-open').href = whole.href;
    document.body.classList.add('embedded');
    bench.setTool('look');
  }
}

/** For an audience: the picture alone, its verdict and labels twice as large. */
function present(isOn: boolean): void {
  document.body.classList.toggle('presenting', isOn);
  if (isOn) {
    say(t('the picture alone; M brings the rest back'));
  }
}

/** A slider along an axis that opens the robot. */
class Cut {
  private readonly side = byId<HTMLSelectElement>('cut');
  private readonly slider = byId<HTMLInputElement>('cut-at');

  constructor(private readonly app: App) {
    this.side.onchange = () => {
      this.slider.hidden = !(this.side.value in CUTS);
      this.range();
      this.slider.value = String((Number(this.slider.min) + Number(this.slider.max)) / 2);
      this.change();
    };
    this.slider.oninput = () => this.change();
    app.shownListeners.push(() => this.range());
  }

  /** From where all is shown to where one layer is. */
  private range(): void {
    const cut = CUTS[this.side.value];
    const bounds = this.app.robot.bounds();
    if (cut && bounds) {
      this.slider.min = String(bounds.low[cut.axis]);
      this.slider.max = String(bounds.high[cut.axis]);
      // The plane stays within a robot that has become smaller.
      if (this.app.view.section && this.app.view.section.at !== Number(this.slider.value)) {
        this.change();
      }
    }
  }

  private change(): void {
    const cut = CUTS[this.side.value];
    const value = Number(this.slider.value);
    this.app.setSection(cut && { ...cut, at: value });
    byId('cut-value').textContent = cut ? `${'xyz'[cut.axis]} ${cut.sense > 0 ? '≤' : '≥'} ${digits(value.toFixed(1))}` : '';
  }
}

/** The directions of x, y and z in a corner of the picture. */
function followAxes({ stage }: App): void {
  const arrows = ['x', 'y', 'z'].map((name) => byId(`axis-${name}`));
  stage.followers.push(() => {
    const { elements } = stage.camera.matrixWorldInverse;
    arrows.forEach((arrow, k) => {
      const [right, up] = [elements[4 * k], elements[4 * k + 1]];
      arrow.querySelector('line')!.setAttribute('x2', (20 * right).toFixed(1));
      arrow.querySelector('line')!.setAttribute('y2', (-20 * up).toFixed(1));
      arrow.querySelector('text')!.setAttribute('transform', `translate(${(26 * right).toFixed(1)} ${(4 - 26 * up).toFixed(1)})`);
    });
  });
}
