// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { EditedRobot } from './edited_robot';
import { CUBIC, latticeOf } from './lattice';
import { PARAMETERS } from './material';
import { NO_SURROUNDINGS, type Surroundings } from './surroundings';

/**
 * Robots that were changed here, in the browser's own storage, each under its own name there: closing
 * the page loses nothing, and no page overwrites what was built on another one. All pages of a disk may
 * share one storage, so each entry says what its page was asked to show.
 */

const PREFIX = 'holdfast.kept.';
const TAB = 'holdfast.tab';
/** Robots beyond these are forgotten, the oldest first. */
const KEPT_MAX = 8;
/** In letters; browsers allow about five million for all that a site keeps. */
const LENGTH_MAX = 4_500_000;

export interface KeptRobot {
  id: string;
  /** What the page was asked to show when this was built; see originOf(). */
  origin: string;
  /** In milliseconds since 1970. */
  time: number;
  name: string;
  supportZ: number;
  material: number[];
  modules: number[];
  base: string;
  /** Undefined in entries of pages that knew cubes on a floor only. */
  lattice?: string;
  surroundings?: Surroundings;
  laterSteps?: number;
}

/** What a page is asked to show, a file or a link, in short; '' if nothing. FNV-1a in two halves. */
export function originOf(text: string): string {
  let [a, b] = [0x811c9dc5, 0x1b873593];
  for (let i = 0; i < text.length; ++i) {
    a = Math.imul(a ^ text.charCodeAt(i), 0x01000193);
    b = Math.imul(b ^ text.charCodeAt(text.length - 1 - i), 0x01000193);
  }
  return text === '' ? '' : `${text.length} ${a >>> 0} ${b >>> 0}`;
}

export class Kept {
  constructor(
    /** Survives the tab. */
    private readonly storage: Storage,
    /** Survives a reload of the tab. */
    private readonly tab: Storage,
  ) {}

  /** Undefined where the browser allows no storage. */
  static open(): Kept | undefined {
    try {
      return new Kept(localStorage, sessionStorage);
    } catch {
      return undefined;
    }
  }

  /** False: it is too large. */
  keep(robot: EditedRobot, origin: string): boolean {
    const { id, name, supportZ, base, surroundings, laterSteps } = robot;
    const lattice = robot.lattice.name;
    const [material, modules] = [Array.from(robot.material), Array.from(robot.toModules())];
    const entry: KeptRobot = {
      ...{ id, origin, time: Date.now(), name, supportZ, material, modules, base },
      ...{ lattice, surroundings, laterSteps },
    };
    const text = `${entry.time} ${JSON.stringify(entry)}`;
    const isKept = text.length <= LENGTH_MAX && this.write(PREFIX + id, text);
    if (isKept) {
      this.tab.setItem(TAB, id);
      this.keys().slice(KEPT_MAX).forEach((key) => this.storage.removeItem(key));
    }
    return isKept;
  }

  /** Newest first; what is damaged is left out. */
  list(): KeptRobot[] {
    return this.keys()
      .map((key) => read(this.storage.getItem(key)!))
      .filter((entry) => entry !== undefined);
  }

  /** What this tab has kept last, or else the newest, of those that were built on such a page. */
  last(origin: string): KeptRobot | undefined {
    const list = this.list().filter((entry) => entry.origin === origin);
    return list.find(({ id }) => id === this.tab.getItem(TAB)) ?? list[0];
  }

  /** A robot of its own, or, in the tab that has kept it last, the same. */
  restore(entry: KeptRobot): EditedRobot {
    const { name, supportZ, base, surroundings = NO_SURROUNDINGS, laterSteps = 0 } = entry;
    const lattice = entry.lattice === undefined ? CUBIC : latticeOf(entry.lattice);
    const robot = EditedRobot.from(Int32Array.from(entry.modules), lattice?.of(surroundings.material?.pitch_mm));
    const material = Float64Array.from(entry.material);
    Object.assign(robot, { name, supportZ, base, surroundings, laterSteps, material });
    if (entry.id === this.tab.getItem(TAB)) {
      robot.id = entry.id;
    }
    return robot;
  }

  forgetAll(): void {
    this.keys().forEach((key) => this.storage.removeItem(key));
  }

  /** Newest first: every entry begins with its time. */
  private keys(): string[] {
    const time = (key: string) => Number.parseInt(this.storage.getItem(key)!, 10) || 0;
    return Array.from({ length: this.storage.length }, (_, i) => this.storage.key(i)!)
      .filter((key) => key.startsWith(PREFIX))
      .sort((a, b) => time(b) - time(a));
  }

  /** Older robots make room. */
  private write(key: string, text: string): boolean {
    const others = this.keys().filter((other) => other !== key);
    for (;;) {
      try {
        this.storage.setItem(key, text);
        return true;
      } catch {
        const oldest = others.pop();
        if (!oldest) {
          return false;
        }
        this.storage.removeItem(oldest);
      }
    }
  }
}

function read(text: string): KeptRobot | undefined {
  try {
    const entry = JSON.parse(text.slice(text.indexOf(' '))) as KeptRobot;
    return isKept(entry) ? entry : undefined;
  } catch {
    return undefined;
  }
}

function isKept(entry: KeptRobot): boolean {
  const { id, origin, time, name, supportZ, material, modules, base, lattice, surroundings, laterSteps } = entry;
  return (
    [id, origin, name, base].every((text) => typeof text === 'string') &&
    Number.isFinite(time) &&
    Number.isInteger(supportZ) &&
    material.every(Number.isFinite) &&
    material.length === PARAMETERS.length &&
    modules.every((value, i) => Number.isInteger(value) && (i % 4 < 3 || (value >= 0 && value <= 2))) &&
    modules.length % 4 === 0 &&
    (laterSteps === undefined || Number.isInteger(laterSteps)) &&
    (lattice === undefined || latticeOf(lattice) !== undefined) &&
    (surroundings === undefined || (typeof surroundings === 'object' && surroundings !== null))
  );
}
