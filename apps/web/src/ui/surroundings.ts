// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { LATTICES } from '../model/lattice';
import { GRAVITY_RANGE, withGravity } from '../model/material';
import { gravityOf, isNothing, isStraightDown, slopeOf, type Slope, type Vector } from '../model/surroundings';
import type { Workbench } from '../model/workbench';
import { byId, make } from './dom';
import { MOST, addNumber, addVector, outside, type Range } from './field';
import { t, word } from '../texts';

/** The forms of lattice, gravity, floor, obstacles and loads; what they show follows the robot. */

const FRICTION: Range = { lowest: 0, highest: MOST };
const MASS: Range = { lowest: 1 / MOST, highest: MOST };

export function makeSurroundings(bench: Workbench): void {
  const select = byId<HTMLSelectElement>('lattice');
  select.append(...LATTICES.map(({ name, title }) => make('option', { value: name }, word(title))));
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
    const strength = Math.hypot(...gravity);
    const fault = strength === 0 ? t('Without gravity nothing rests on anything.') : outside(strength, 'm/s²', GRAVITY_RANGE);
    if (fault) {
      return fault;
    }
    if (isStraightDown(gravity)) {
      bench.surround(t('gravity'), { gravity_m_s2: undefined }, { material: withGravity(material, -gravity[2]) });
    } else {
      bench.surround(t('turning gravity'), { gravity_m_s2: gravity });
    }
    return undefined;
  };
  // A level ground has no downhill side: the one that was chosen is kept for the next slope. And what is turned
  // to and fro keeps its strength to the last digit.
  let lastDownhill = 0;
  let lastStrength = 0;
  const slope = (): Slope => {
    const { angle, downhill, strength } = slopeOf(bench.robot.gravity);
    lastDownhill = angle > 0 && angle < 180 ? downhill : lastDownhill;
    lastStrength = Math.abs(strength - lastStrength) < 1e-9 * strength ? lastStrength : strength;
    return { angle, downhill: lastDownhill, strength: lastStrength };
  };
  const setSlope = (change: Partial<Slope>) => setGravity(gravityOf({ ...slope(), ...change }));
  return [
    addNumber(place, {
      label: t('Slope'),
      unit: '°',
      get: () => slope().angle,
      set: (value = 0) => setSlope({ angle: value }),
    }),
    addNumber(place, {
      label: t('Downhill from +x'),
      unit: '°',
      get: () => slope().downhill,
      set: (value = 0) => {
        lastDownhill = value;
        return setSlope({ downhill: value });
      },
    }),
    addVector(place, { label: t('Gravity'), unit: 'm/s²', get: () => bench.robot.gravity, set: setGravity }),
  ];
}

function supportFields(bench: Workbench): (() => void)[] {
  const place = byId('surroundings');
  const floor = make('input', { type: 'checkbox', id: 'floor' });
  floor.onchange = () => bench.surround(t('the floor'), { support_z: floor.checked ? undefined : null });
  place.append(make('label', { className: 'row' }, t('Floor'), floor));
  return [
    () => (floor.checked = bench.robot.hasFloor),
    addNumber(place, {
      label: t('Floor’s friction'),
      unit: '',
      otherwise: t('no slip'),
      ...FRICTION,
      get: () => bench.robot.surroundings.floor?.friction,
      set: (value) =>
        bench.surround(t('the friction of the floor'), { floor: value === undefined ? undefined : { friction: value } }),
    }),
    addNumber(place, {
      label: t('Obstacles’ friction'),
      unit: '',
      otherwise: t('no slip'),
      ...FRICTION,
      get: () => bench.friction,
      set: (value) => void (bench.friction = value),
    }),
  ];
}

function burdenFields(bench: Workbench): (() => void)[] {
  const place = byId('burden');
  const change = (part: Partial<typeof bench.burden>) => bench.setBurden({ ...bench.burden, ...part });
  const shows = [
    addNumber(place, {
      label: t('Own mass'),
      unit: 'kg',
      otherwise: t('as all'),
      ...MASS,
      get: () => bench.burden.mass,
      set: (mass) => change({ mass }),
    }),
    addVector(place, {
      label: t('Force'),
      unit: 'N',
      get: () => bench.burden.force,
      set: (force) => change({ force }),
    }),
    addVector(place, {
      label: t('Torque'),
      unit: 'N mm',
      get: () => bench.burden.torque,
      set: (torque) => change({ torque }),
    }),
  ];
  const none = make('button', { type: 'button', textContent: t('Nothing: take loads off') });
  none.onclick = () => change({ mass: undefined, force: [0, 0, 0], torque: [0, 0, 0] });
  place.append(none);
  return [...shows, () => (none.disabled = isNothing(bench.burden))];
}
