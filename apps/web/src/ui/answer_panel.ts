// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import VOCABULARY from 'virtual:vocabulary';
import type { Finding } from '../core/judge';
import { FACET_INTEGERS, LOAD_FIELDS, type Answer } from '../core/types';
import { ROLE_NAMES, Role, cellText, type Cell } from '../model/cell';
import type { EditedRobot } from '../model/edited_robot';
import { holdOf, obstacleText, type Vector } from '../model/surroundings';
import {
  FIXED, LOAD_STEPS, UNKNOWN, UNSTABLE, brokenColour, css, loadColour, stepColours, type Rgb, type ScaleName, type Subject,
} from '../view/colours';
import { FACET_LOOKS, FacetState, facetAt, facetCount } from '../view/facets';
import { byId, make } from './dom';
import { digits, locale, t, word } from '../texts';

/** The answer in words and numbers, the legend, and what is under the pointer. */

const WORDS = {
  safe: ['Safe', 'it holds'],
  overload: ['Overload', 'it breaks'],
  unstable: ['Unstable', 'it topples'],
  undecided: ['Undecided', 'not certain'],
} as const;

/** Below this a number is rounding. */
const NOTHING = 1e-9;

/** With a number of decimals, and at least two digits that say something. */
export function numberText(value: number, decimals = 2): string {
  if (Math.abs(value) < NOTHING) {
    return '0';
  }
  return digits(Math.abs(value) < 10 ** (1 - decimals) ? String(Number(value.toPrecision(2))) : value.toFixed(decimals));
}

/** A share of a connection's strength; where it is pressed together, none is used. */
export const formatRatio = (ratio: number) => (ratio < NOTHING ? t('nothing pulls') : numberText(ratio, 3));

/** "(2,1,2)-(3,1,2)" */
export function connectionText(robot: EditedRobot, finding: Finding, index: number): string {
  const { connections } = finding.answer!;
  const cell = (end: number) => cellText(robot.cellAt(finding.slots[connections[3 * index + end]]));
  return `${cell(0)}-${cell(1)}`;
}

export function showFinding(robot: EditedRobot, finding: Finding | undefined): void {
  const answer = finding?.answer;
  const [verdict, meaning] = headline(robot, finding);
  byId('verdict-word').replaceChildren(verdict, ...(meaning ? [make('small', {}, meaning)] : []));
  byId('verdict-reason').textContent = reason(robot, finding);
  byId('figures').replaceChildren(
    ...figures(robot, finding, answer).flatMap(([name, value, title]) => [
      make('dt', {}, name),
      make('dd', { title: title ?? '' }, value),
    ]),
  );
}

/** The verdict in two words, and what it is marked as. */
export function headline(robot: EditedRobot, finding: Finding | undefined): [string, string, string] {
  if (robot.count === 0) {
    return [t('Empty'), '', 'none'];
  }
  if (finding?.isFirstLook && finding.answer!.stability.stable) {
    return [t('Stable'), t('loads to come'), 'undecided'];
  }
  if (finding?.answer) {
    const { verdict, stability } = finding.answer;
    const [name, meaning] = WORDS[verdict];
    const falls = verdict === 'unstable' && stability.rule === 'contact-forces';
    return [t(name), t(falls ? 'it falls' : meaning), verdict];
  }
  return finding?.problem ? [t('No answer'), '', 'none'] : ['…', '', 'none'];
}

function reason(robot: EditedRobot, finding: Finding | undefined): string {
  if (robot.count === 0) {
    return t('Click the ground to put down the first module.');
  }
  if (finding?.isFirstLook) {
    const { stable, rule } = finding.answer!.stability;
    const [yes, no] =
      rule === 'contact-forces'
        ? ([t('Contact forces can hold it.'), t('No contact forces balance the loads, or nothing is to spare.')] as const)
        : ([t('The centre of mass is above the support polygon.'), t('The centre of mass is not above the support polygon.')] as const);
    return stable === null ? t('Whether it stays is not certain yet.') : stable ? yes : no;
  }
  const sentences = finding?.answer?.reasons.map((text) => `${text[0].toUpperCase()}${text.slice(1)}.`);
  return finding?.problem ?? sentences?.join(' ') ?? '';
}

function formatTime(seconds: number): string {
  const ms = 1000 * seconds;
  return digits(ms < 10 ? `${ms.toPrecision(2)} ms` : ms < 1000 ? `${ms.toFixed(0)} ms` : `${seconds.toFixed(1)} s`);
}

type Figure = [name: string, value: string, title?: string];

function figures(robot: EditedRobot, finding: Finding | undefined, answer: Answer | undefined): Figure[] {
  const list: Figure[] = [];
  if (answer?.load_ratio_max != null && answer.verdict !== 'unstable') {
    const at = answer.worst === null ? '' : `  ${connectionText(robot, finding!, answer.worst)}`;
    list.push([t('Largest load'), formatRatio(answer.load_ratio_max) + at, t('share of the strength')]);
  }
  if (answer?.weight_factor != null && answer.verdict !== 'unstable') {
    const text = t('{0} times this weight', numberText(answer.weight_factor));
    list.push([t('First break at'), text]);
  }
  if (answer) {
    list.push(...stabilityFigures(robot, answer));
  }
  if (answer?.second_order) {
    list.push([t('Second order'), answer.second_order, t('whether linear theory suffices, by the factor of all loads at which it would buckle')]);
  }
  list.push([t('Modules'), countText(robot)]);
  if (answer?.has_loads) {
    list.push([t('Contact'), word(answer.contact_model)]);
  }
  if (answer?.has_loads && answer.seconds > 0) {
    list.push([t('Solved in'), formatTime(answer.seconds)]);
  }
  return list;
}

function stabilityFigures(robot: EditedRobot, { stability }: Answer): Figure[] {
  const { margin_mm: margin, rule, rigid } = stability;
  const list: Figure[] = [];
  if (rule !== 'contact-forces') {
    const held = robot.obstacles.obstacles.some((one) => holdOf(one) === 'bonded') ? t('held fast') : t('held by a fixed module');
    const text = margin === null ? held : `${numberText(margin)} mm`;
    list.push([t('Margin'), text, t('from the centre of mass to the nearest edge of the support polygon')]);
  } else {
    list.push([t('Rigid body'), word(rigid.answer), t('whether contact forces can hold it as one rigid body')]);
  }
  if (rigid.tilt_margin_deg !== null && !robot.isPlain) {
    list.push([t('Tilt to spare'), `${numberText(rigid.tilt_margin_deg)}°`, t('by which gravity may turn, in any direction')]);
  }
  if (rigid.friction_needed !== null && rule === 'contact-forces') {
    list.push([t('Friction needed'), numberText(rigid.friction_needed, 3), t('of a rigid body, at the most favourable contact forces; the elastic forces may take more')]);
  }
  return list;
}

function countText(robot: EditedRobot): string {
  const counts = [0, 0, 0];
  for (let slot = 0; slot < robot.count; ++slot) {
    ++counts[robot.roleAt(slot)];
  }
  const parts = counts.map((count, i) => `${count.toLocaleString(locale)} ${t(ROLE_NAMES[i])}`);
  return parts.filter((_, i) => counts[i] > 0).join(', ') || t('none');
}

export function showLegend(scale: ScaleName, subject: Subject, isOfLosses = false): void {
  const entry = (className: string, colour: string, text: string) => {
    const swatch = make('span', { className: `swatch ${className}` });
    swatch.style.backgroundColor = colour;
    return make('li', {}, swatch, text);
  };
  const ofLoads = () => (subject === 'connections' ? stepLegend(scale) : shareLegend(scale));
  const loads = isOfLosses ? [lossLegend(scale)] : ofLoads();
  const list = make(
    'ul',
    { className: 'swatches' },
    ...(subject === 'modules' ? [entry('broken', css(brokenColour(scale)), t('breaks'))] : []),
    entry('fixed', css(FIXED), t('fixed')),
    entry('', css(UNSTABLE), t('topples')),
    entry('planned', css(UNKNOWN), t('planned')),
  );
  byId('legend').replaceChildren(...loads, list);
}

/** The steps of a connection's load, with their bounds between them. */
function stepLegend(scale: ScaleName): HTMLElement[] {
  const colours = stepColours(scale);
  const bar = make('div', { className: 'steps' });
  colours.forEach((colour, i) => {
    const step = make('span', { className: LOAD_STEPS[i] > 1 ? 'breaks' : '' });
    step.style.backgroundColor = css(colour);
    bar.append(step);
  });
  const ticks = ['0', ...LOAD_STEPS.map((most) => (most === Infinity ? t('more') : digits(String(most))))];
  return [bar, make('div', { className: 'ticks' }, ...ticks.map((text) => make('span', {}, text)))];
}

const lossLegend = (scale: ScaleName) => {
  const entry = (colour: Rgb, text: string) => {
    const swatch = make('span', { className: 'swatch' });
    swatch.style.backgroundColor = css(colour);
    return make('li', {}, swatch, text);
  };
  return make(
    'ul',
    { className: 'swatches' },
    entry(brokenColour(scale), t('it does not hold without this module or connection')),
    entry(loadColour(scale, 0), t('it holds without this connection')),
  );
};

/** The colours of modules, without steps. */
function shareLegend(scale: ScaleName): HTMLElement[] {
  const bar = make('div', { className: 'bar-scale' });
  const stops = Array.from({ length: 21 }, (_, i) => `${css(loadColour(scale, i / 20))} ${5 * i}%`);
  bar.style.background = `linear-gradient(to right, ${stops.join(', ')})`;
  return [bar, make('div', { className: 'ticks' }, ...['0', '0.25', '0.5', '0.75', '1'].map((tick) => make('span', {}, digits(tick))))];
}

/** How many facets do what, and what they look like. */
export function showFacetLegend(robot: EditedRobot, finding: Finding | undefined): void {
  const answer = finding?.answer;
  const counts = FACET_LOOKS.map(() => 0);
  for (let i = 0; answer && !robot.isPlain && i < facetCount(answer); ++i) {
    ++counts[facetAt(answer, i).state];
  }
  const entries = FACET_LOOKS.flatMap(({ text, colour, isFilled }, state) => {
    const swatch = make('span', { className: `swatch facet ${text}` });
    swatch.style.borderColor = css(colour);
    swatch.style.backgroundColor = isFilled ? css(colour) : 'transparent';
    return counts[state] > 0 ? [make('li', {}, swatch, `${word(text)} (${counts[state]})`)] : [];
  });
  const list = byId('facet-legend');
  list.hidden = entries.length === 0;
  list.replaceChildren(make('li', {}, t('Facets that touch:')), ...entries);
}

/** What free faces say, with the marks that the shader draws. */
export function showFaceLegend(scale: ScaleName): void {
  const entry = (mark: string, colour: Rgb, text: string) => {
    const swatch = make('span', { className: `swatch mark ${mark}` });
    swatch.style.backgroundColor = css(colour);
    return make('li', {}, swatch, text);
  };
  byId('face-legend').replaceChildren(
    make('li', {}, t('One more there:')),
    entry('plain', loadColour(scale, 0), t('safe')),
    entry('cross', brokenColour(scale), t('breaks')),
    entry('rising', UNSTABLE, t('topples')),
    entry('circle', UNKNOWN, t('not certain')),
  );
}

/** One line for each connection of a module; the pointed one is marked. Empty where there is nothing to say. */
export function showDetails(
  robot: EditedRobot,
  finding: Finding | undefined,
  cell: Cell | undefined,
  side: number | undefined,
): string {
  const panel = byId('details');
  const slot = cell && robot.slot(cell);
  const obstacle = cell && robot.obstacles.find(cell);
  if (cell && obstacle !== undefined) {
    const text = obstacleText(cell, robot.obstacles.obstacles[obstacle]);
    panel.replaceChildren(make('p', { className: 'cell' }, text));
    return text;
  }
  if (!cell || slot === undefined) {
    panel.replaceChildren();
    return cell ? `${cellText(cell)}: ${t('empty')}` : '';
  }
  const title = `${cellText(cell)}, ${t(ROLE_NAMES[robot.roleAt(slot)])}${
    robot.hasFloor && cell[2] === robot.supportZ && robot.roleAt(slot) !== Role.kFixed ? `, ${t('on the ground')}` : ''
  }`;
  const more = [...ownTexts(robot, cell), ...facetTexts(robot, finding, slot)];
  const rows = finding?.answer?.has_loads ? connectionRows(robot, finding, slot) : [];
  const table = make('table');
  if (rows.length > 0) {
    const head = make('tr', {}, ...(['to', 'load', 'axial', 'bending'] as const).map((text) => make('th', { scope: 'col' }, t(text))));
    table.append(make('thead', {}, head));
    const body = make('tbody');
    for (const row of rows) {
      const line = make(
        'tr',
        {},
        make('th', { scope: 'row' }, robot.lattice.sides[row.side]),
        ...[formatRatio(row.ratio) + row.limit, `${numberText(row.axial)} N`, `${numberText(row.bending, 0)} N mm`].map((text) => make('td', {}, text)),
      );
      line.className = row.side === side ? 'pointed' : row.isBroken ? 'breaks' : '';
      body.append(line);
    }
    table.append(body);
  }
  const notes = more.map((text) => make('p', { className: 'quiet' }, text));
  panel.replaceChildren(make('p', { className: 'cell' }, title), ...notes, ...(rows.length > 0 ? [table] : []));
  const worst = rows.length > 0 ? `, ${t('largest load {0}', formatRatio(Math.max(...rows.map((r) => r.ratio))))}` : '';
  return [title, ...more].join('; ') + worst;
}

/** What was put on a module. */
function ownTexts({ ownLoads }: EditedRobot, cell: Cell): string[] {
  const key = String(cell);
  const own = ownLoads.modules.get(key);
  const load = ownLoads.loads.get(key);
  const vector = (name: string, value: Vector | undefined, unit: string) =>
    value?.some((one) => one !== 0) ? [`${name} (${value.map((one) => digits(String(one))).join(locale === 'fr' ? ' ; ' : ', ')}) ${unit}`] : [];
  return [
    ...(own?.kind === undefined ? [] : [own.kind]),
    ...(own?.mass_kg === undefined ? [] : [t('mass {0} kg', digits(String(own.mass_kg)))]),
    ...vector(t('force'), load?.force_n, 'N'),
    ...vector(t('torque'), load?.torque_nmm, 'N mm'),
  ];
}

/** Facets by slot. Made once for each answer. */
const facetsAt = new WeakMap<Answer, Map<number, number[]>>();

function facetsOf({ slots }: Finding, answer: Answer): Map<number, number[]> {
  const known = facetsAt.get(answer) ?? new Map<number, number[]>();
  for (let i = 0; !facetsAt.has(answer) && i < facetCount(answer); ++i) {
    const slot = slots[answer.facets[FACET_INTEGERS * i]];
    known.set(slot, [...(known.get(slot) ?? []), i]);
  }
  facetsAt.set(answer, known);
  return known;
}

/** What the facets of a module do. */
function facetTexts(robot: EditedRobot, finding: Finding | undefined, slot: number): string[] {
  const answer = finding?.answer;
  if (!answer || robot.isPlain) {
    return [];
  }
  return (facetsOf(finding, answer).get(slot) ?? []).map((i) => {
    const { direction, state, push, slide } = facetAt(answer, i);
    const isIdle = state === FacetState.kUnknown || state === FacetState.kOpen;
    const force = isIdle ? '' : `, ${push < 0 ? t('pulled with {0} N', numberText(-push)) : t('pressed with {0} N', numberText(push))}`;
    const friction = slide === undefined ? '' : `, ${t('{0} % of its friction', (100 * slide).toFixed(0))}`;
    return t('facet {0} {1}', robot.lattice.sides[direction], word(FACET_LOOKS[state].text)) + force + friction;
  });
}

/** The connection at each side of each slot, by index; -1: none. Made once for each answer. */
const connectionsAt = new WeakMap<Answer, Int32Array>();

function sidesOf({ slots }: Finding, answer: Answer, directionCount: number): Int32Array {
  const known = connectionsAt.get(answer);
  if (known) {
    return known;
  }
  const sides = new Int32Array(directionCount * slots.length).fill(-1);
  const { connections } = answer;
  for (let i = 0; 3 * i < connections.length; ++i) {
    const direction = connections[3 * i + 2];
    sides[directionCount * slots[connections[3 * i]] + direction] = i;
    sides[directionCount * slots[connections[3 * i + 1]] + (direction ^ 1)] = i;
  }
  connectionsAt.set(answer, sides);
  return sides;
}

function connectionRows({ lattice }: EditedRobot, finding: Finding, slot: number) {
  const rows: { side: number; ratio: number; limit: string; axial: number; bending: number; isBroken: boolean }[] = [];
  const answer = finding.answer!;
  const sides = sidesOf(finding, answer, lattice.directionCount);
  for (let side = 0; side < lattice.directionCount; ++side) {
    const i = sides[lattice.directionCount * slot + side];
    if (i >= 0) {
      const [ratio, axial, bending] = answer.loads.subarray(LOAD_FIELDS * i, LOAD_FIELDS * i + 3);
      const limit = answer.limits.length > 0 ? ` ${word(VOCABULARY.limits[answer.limits[i]])}` : '';
      rows.push({ side, ratio, limit, axial, bending, isBroken: answer.broken.includes(i) });
    }
  }
  return rows;
}
