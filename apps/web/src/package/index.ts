// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Cell } from '../model/cell';
import { Role } from '../model/cell';
import type { RobotData } from '../model/edited_robot';
import { Core } from '../core/wasm';
import { CoreError, Output, type FoundOrder, type LimitLoad, type Losses, type StepsReport, type Sureness, type Verdict } from '../core/types';

export type { Cell } from '../model/cell';
export type { FoundOrder, LimitLoad, Losses, StageReport, StepsReport, Sureness, Verdict } from '../core/types';

/** What cannot be read, or is no robot; its message is meant for people. */
export { CoreError as HoldfastError } from '../core/types';

/** The cells of a robot of Blinky Blocks, or a structure in any format that `holdfast check` reads: JSON as an object, or a file's text or bytes. */
export type Structure = readonly Cell[] | object | string | Uint8Array;

/** A connection of a report; forces in N, torques in N mm. */
export interface ConnectionReport {
  a: Cell;
  b: Cell;
  load_ratio: number;
  [key: string]: unknown;
}

/** What `holdfast check --json` writes; docs/formats.md has all keys. */
export interface CheckReport {
  verdict: Verdict;
  reasons: string[];
  overload: { load_ratio_max: number | null; [key: string]: unknown };
  connections: ConnectionReport[];
  [key: string]: unknown;
}

/** What would come of one more module. */
export interface TriedCell {
  cell: Cell;
  /** Null where no module can be. */
  verdict: Verdict | null;
  /** Null where no load is known, as for a robot that topples. */
  load_ratio_max: number | null;
  /** From the centre of mass to the nearest edge of the support polygon; null for a robot that is held. */
  margin_mm: number | null;
}

interface Opened extends RobotData {
  name: string;
  text: string;
}

const numberOrNull = (value: number) => (Number.isFinite(value) ? value : null);

/**
 * Predicts whether a modular robot holds. Calls answer when they are done: a page that must not wait loads this in a
 * worker. All may throw HoldfastError.
 */
export class Holdfast {
  private constructor(private readonly core: Core) {}

  /** From the compiled core; load() is the usual way. */
  static async create(core: WebAssembly.Module): Promise<Holdfast> {
    return new Holdfast(await Core.create(core));
  }

  /** Whether a structure holds with its planned modules attached. */
  check(structure: Structure): CheckReport {
    return JSON.parse(this.write(structure, Output.kReportJson)) as CheckReport;
  }

  /** The same for people to read. */
  text(structure: Structure): string {
    return this.write(structure, Output.kReportText);
  }

  /** The structure with its loads as SVG. */
  picture(structure: Structure): string {
    return this.write(structure, Output.kSvg);
  }

  /** The structure as holdfast JSON or VisibleSim XML. */
  convert(structure: Structure, format: 'json' | 'xml'): string {
    return this.write(structure, format === 'json' ? Output.kJson : Output.kXml);
  }

  /** The verdict with one more module, in each of the cells in turn. Asked again, the same structure answers faster. */
  tryCells(structure: Structure, cells: readonly Cell[]): TriedCell[] {
    const trials = this.core.tryPlaces(this.open(structure), Int32Array.from(cells.flat()), Role.kPlanned);
    return trials.map(({ verdict, ratio, marginMm }, i) => ({
      cell: cells[i],
      verdict,
      load_ratio_max: numberOrNull(ratio),
      margin_mm: numberOrNull(marginMm),
    }));
  }

  /** Whether every stage of every step of a structure's plan is safe. */
  steps(structure: Structure): StepsReport {
    const opened = this.open(structure);
    return this.core.judgeSteps(opened, opened.name, opened.text).report;
  }

  /** In which order the modules can be attached, so that it is safe all the way. */
  order(target: Structure, seconds = 30): FoundOrder {
    const opened = this.open(target);
    return this.core.findOrder(opened, seconds, opened.name, opened.text);
  }

  /** The largest factor of all loads that any forces could balance; null if it is not found in time. */
  limitLoad(structure: Structure, seconds = 30): LimitLoad | null {
    return this.core.limit(this.open(structure), seconds);
  }

  /** How sure it is that every connection holds where strengths scatter by a share, each by itself and all together, and masses. */
  reliability(structure: Structure, scatter: number, together = 0, masses = 0): Sureness {
    return this.core.reliability(this.open(structure), scatter, together, masses);
  }

  /** What follows from the loss of any single connection, module or foot. */
  loseOne(structure: Structure, seconds = 30): Losses {
    return this.core.loseOne(this.open(structure), seconds);
  }

  private write(structure: Structure, output: Output): string {
    const opened = this.open(structure);
    return this.core.write(opened, output, opened.name, opened.text);
  }

  private open(structure: Structure): Opened {
    const bytes =
      structure instanceof Uint8Array
        ? structure
        : new TextEncoder().encode(typeof structure === 'string' ? structure : JSON.stringify(structure));
    const { name, modules, material, support_z, more, base } = this.core.open(bytes);
    const text = base || new TextDecoder().decode(bytes);
    return { name: name || 'robot', modules, material, supportZ: support_z, more, text };
  }
}

/** Loads the core that comes with the package, or another one. */
export async function load(core?: BufferSource | WebAssembly.Module): Promise<Holdfast> {
  if (core instanceof WebAssembly.Module) {
    return Holdfast.create(core);
  }
  return Holdfast.create(await WebAssembly.compile(core ?? (await ownCore())));
}

async function ownCore(): Promise<BufferSource> {
  const url = new URL(/* @vite-ignore */ './holdfast_core.wasm', import.meta.url);
  if (url.protocol === 'file:') {
    const { readFile } = await import('node:fs/promises');
    return readFile(url);
  }
  const response = await fetch(url);
  if (!response.ok) {
    throw new CoreError(`${url.href}: ${response.status} ${response.statusText}`);
  }
  return response.arrayBuffer();
}
