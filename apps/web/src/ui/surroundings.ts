// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { LATTICES } from '../model/lattice';
import { withGravity } from '../model/material';
import { gravityOf, isNothing, isStraightDown, slopeOf, type Slope, type Vector } from '../model/surroundings';
import type { Workbench } from '../model/workbench';
import { byId, make, tell } from './dom';

/** The forms of lattice, gravity, floor, obstacles and loads; what they show follows the robot. */

const shown = (value: number | undefined) => (value === undefined ? '' : String(Number(value.toPrecision(6))));

/** Undefined for an empty text; what is no number is told, and the form shows again what is so. */
function numberOf(text: string, show: () => void): number | undefined | 'wrong' {
  const value = Number(text.trim().replace(',', '.'));
  if (Number.isFinite(value)) {
    return text.trim() === '' ? undefined : value;
  }
  tell(`“${text}” is no number`, true);
  show();
  return 'wrong';
}

interface Field {
  label: string;
  unit: string;
  /** Text in an empty field: what holds then. */
  otherwise?: string;
  get(): number | undefined;
  set(value: number | undefined): void;
}

interface VectorField {
  label: string;
  unit: string;
  get(): Vector;
  set(value: Vector): void;
}

function input(show: () => void, set: (value: number | undefined) => void): HTMLInputElement {
  const element = make('input', { type: 'text', inputMode: 'decimal' });
  element.onchange = () => {
    const value = numberOf(element.value, show);
    if (value !== 'wrong') {
      set(value);
      show();
    }
  };
  return element;
}

/** A row with one number; returns what shows it anew. */
function addField(place: HTMLElement, field: Field): () => void {
  const show = () => (element.value = shown(field.get()));
  const element = input(show, field.set);
  element.placeholder = field.otherwise ?? '';
  place.append(make('label', { className: 'row' }, field.label, make('span', { className: 'field' }, element, field.unit)));
  return show;
}

/** A row with three numbers. */
function addVector(place: HTMLElement, field: VectorField): () => void {
  const show = () => elements.forEach((element, i) => (element.value = shown(field.get()[i])));
  const elements = [0, 1, 2].map((i) => {
    const set = (value: number | undefined) =>
      field.set(field.get().map((old, k) => (k === i ? (value ?? 0) : old)) as unknown as Vector);
    const element = input(show, set);
    element.ariaLabel = `${field.label} ${'xyz'[i]}`;
    return element;
  });
  const text = make('span', {}, `${field.label}, ${field.unit}`);
  place.append(make('div', { className: 'row' }, text, make('span', { className: 'vector' }, ...elements)));
  return show;
}

export function makeSurroundings(bench: Workbench): void {
  const select = byId<HTMLSelectElement>('lattice');
  select.append(...LATTICES.map(({ name, title }) => make('option', { value: name }, title)));
  select.onchange = () => bench.setLattice(select.value);
  const shows = [...gravityFields(bench), ...supportFields(bench)];
  const showAll = () => {
    select.value = bench.robot.lattice.name;
    shows.forEach((show) => show());
  };
  bench.robotListeners.push((what) => what !== 'cells' && showAll());
  showAll();
  const showBurden = burdenFields(bench);
  const section = byId('burden-section');
  const follow = () => {
    section.hidden = bench.tool !== 'load';
    showBurden.forEach((show) => show());
  };
  bench.toolListeners.push(follow);
  follow();
}

function gravityFields(bench: Workbench): (() => void)[] {
  const place = byId('surroundings');
  const setGravity = (gravity: Vector) => {
    const { material } = bench.robot;
    if (isStraightDown(gravity)) {
      bench.surround('gravity', { gravity_m_s2: undefined }, { material: withGravity(material, -gravity[2]) });
    } else {
      bench.surround('turning gravity', { gravity_m_s2: gravity });
    }
  };
  const setSlope = (change: Partial<Slope>) =>
    setGravity(gravityOf({ ...slopeOf(bench.robot.gravity), downhill: lastDownhill, ...change }));
  // A level ground has no downhill side: the one that was chosen is kept for the next slope.
  let lastDownhill = 0;
  return [
    addField(place, {
      label: 'Slope',
      unit: '°',
      get: () => slopeOf(bench.robot.gravity).angle,
      set: (value = 0) => setSlope({ angle: value }),
    }),
    addField(place, {
      label: 'Downhill from +x',
      unit: '°',
      get: () => {
        const { angle, downhill } = slopeOf(bench.robot.gravity);
        return (lastDownhill = angle > 0 && angle < 180 ? downhill : lastDownhill);
      },
      set: (value = 0) => {
        lastDownhill = value;
        setSlope({ downhill: value });
      },
    }),
    addVector(place, { label: 'Gravity', unit: 'm/s²', get: () => bench.robot.gravity, set: setGravity }),
  ];
}

function supportFields(bench: Workbench): (() => void)[] {
  const place = byId('surroundings');
  const floor = make('input', { type: 'checkbox', id: 'floor' });
  floor.onchange = () => bench.surround('the floor', { support_z: floor.checked ? undefined : null });
  place.append(make('label', { className: 'row' }, 'Floor', floor));
  const friction = (set: (value: number | undefined) => void) => (value: number | undefined) => {
    if (value !== undefined && value < 0) {
      tell('friction is 0 or more', true);
    } else {
      set(value);
    }
  };
  return [
    () => (floor.checked = bench.robot.hasFloor),
    addField(place, {
      label: 'Floor’s friction',
      unit: '',
      otherwise: 'no slip',
      get: () => bench.robot.surroundings.floor?.friction,
      set: friction((value) =>
        bench.surround('the friction of the floor', { floor: value === undefined ? undefined : { friction: value } }),
      ),
    }),
    addField(place, {
      label: 'Obstacles’ friction',
      unit: '',
      otherwise: 'no slip',
      get: () => bench.friction,
      set: friction((value) => (bench.friction = value)),
    }),
  ];
}

function burdenFields(bench: Workbench): (() => void)[] {
  const place = byId('burden');
  const change = (part: Partial<typeof bench.burden>) => bench.setBurden({ ...bench.burden, ...part });
  const shows = [
    addField(place, {
      label: 'Own mass',
      unit: 'kg',
      otherwise: 'as all',
      get: () => bench.burden.mass,
      set: (mass) => (mass !== undefined && mass <= 0 ? tell('a mass is more than 0', true) : change({ mass })),
    }),
    addVector(place, {
      label: 'Force',
      unit: 'N',
      get: () => bench.burden.force,
      set: (force) => change({ force }),
    }),
    addVector(place, {
      label: 'Torque',
      unit: 'N mm',
      get: () => bench.burden.torque,
      set: (torque) => change({ torque }),
    }),
  ];
  const none = make('button', { type: 'button', textContent: 'Nothing: take loads off' });
  none.onclick = () => change({ mass: undefined, force: [0, 0, 0], torque: [0, 0, 0] });
  place.append(none);
  return [...shows, () => (none.disabled = isNothing(bench.burden))];
}
