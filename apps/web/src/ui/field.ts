// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Vector } from '../model/surroundings';
import { make } from './dom';
import { digits, t } from '../texts';

/** Fields for numbers. What cannot be is refused where it was typed, in words, and nothing is changed. */

export interface Range {
  lowest: number;
  highest: number;
}

/** Of numbers that the core takes; beyond it products leave the range of double. */
export const MOST = 1e12;
const ANY: Range = { lowest: -MOST, highest: MOST };

interface Field<Value> extends Partial<Range> {
  label: string;
  unit: string;
  get(): Value;
  /** Why it is refused, in words, or nothing. */
  set(value: Value): string | void;
}

export interface NumberField extends Field<number | undefined> {
  /** Text in an empty field: what holds then. */
  otherwise?: string;
  isWhole?: boolean;
  /** Of the digits that are shown. */
  digits?: number;
}

/** 1e12, not thirteen digits. */
const short = (value: number) => digits(Math.abs(value) < 1e6 ? String(value) : value.toExponential().replace('+', ''));

/** Why a number is refused, if it is. */
export function outside(value: number, unit: string, { lowest, highest }: Range = ANY): string | undefined {
  const isFine = value >= lowest && value <= highest;
  return isFine ? undefined : t('{0} is not possible: expected {1} to {2}{3}.', short(value), short(lowest), short(highest), unit && ` ${unit}`);
}

function faultOf(text: string, { lowest, highest, isWhole, unit }: Partial<NumberField>): string | undefined {
  const value = numberOf(text);
  if (value === undefined) {
    return undefined;
  }
  if (!Number.isFinite(value)) {
    return t('“{0}” is not a number.', text);
  }
  return isWhole && !Number.isInteger(value)
    ? t('{0} is not a whole number.', digits(String(value)))
    : outside(value, unit ?? '', { lowest: lowest ?? ANY.lowest, highest: highest ?? ANY.highest });
}

/** Undefined for an empty text. */
const numberOf = (text: string) => (text.trim() === '' ? undefined : Number(text.trim().replace(',', '.')));

const shown = (value: number | undefined, precision = 6) =>
  value === undefined ? '' : digits(String(Number(value.toPrecision(precision)) + 0));

let faults = 0;

/** Inputs and a place for what is wrong with them; `set` gets a number of one of them, with its index. */
function makeInputs(count: number, field: Partial<NumberField>, set: (value: number | undefined, i: number) => string | void) {
  const note = make('p', { className: 'fault', id: `fault-${++faults}`, hidden: true, role: 'alert' });
  const inputs = Array.from({ length: count }, () => make('input', { type: 'text', inputMode: 'decimal' }));
  const mark = (wrong: HTMLInputElement | undefined, text: string) => {
    note.textContent = text;
    note.hidden = text === '';
    inputs.forEach((input) => {
      input.ariaInvalid = input === wrong ? 'true' : null;
      input.setAttribute('aria-describedby', input === wrong ? note.id : '');
    });
  };
  inputs.forEach((input, i) => {
    input.onchange = () => {
      const fault = faultOf(input.value, field) ?? set(numberOf(input.value), i);
      mark(fault ? input : undefined, fault || '');
    };
  });
  const show = (values: readonly (number | undefined)[]) => {
    inputs.forEach((input, i) => (input.value = shown(values[i], field.digits)));
    mark(undefined, '');
  };
  return { inputs, note, show };
}

/** A row with one number; returns what shows it anew. */
export function addNumber(place: HTMLElement, field: NumberField): () => void {
  const row = make('label', { className: 'row' }, field.label);
  const show = () => all([field.get()]);
  const { inputs, note, show: all } = makeInputs(1, field, (value) => field.set(value) || show());
  inputs[0].placeholder = field.otherwise ?? '';
  row.append(make('span', { className: 'field' }, inputs[0], field.unit));
  place.append(row, note);
  return show;
}

/** A row with three numbers. */
export function addVector(place: HTMLElement, field: Field<Vector>): () => void {
  const row = make('div', { className: 'row' }, make('span', {}, `${field.label}, ${field.unit}`));
  const show = () => all(field.get());
  const { inputs, note, show: all } = makeInputs(3, { unit: field.unit }, (value = 0, i) =>
    field.set(field.get().map((old, k) => (k === i ? value : old)) as unknown as Vector) || show(),
  );
  inputs.forEach((input, i) => (input.ariaLabel = `${field.label} ${'xyz'[i]}`));
  row.append(make('span', { className: 'vector' }, ...inputs));
  place.append(row, note);
  return show;
}
