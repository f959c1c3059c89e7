// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Role } from '../model/cell';
import type { RobotData } from '../model/edited_robot';
import {
  CoreError,
  FACET_FIELDS,
  FACET_INTEGERS,
  LOAD_FIELDS,
  type Answer,
  type Breaking,
  type DeformedAnswer,
  type Failure,
  type FoundOrder,
  type JudgedSteps,
  type LimitLoad,
  type Losses,
  type OpenedDocument,
  type Output,
  type SimulationChoice,
  type StageLoads,
  type Sureness,
  type Trace,
  type Trial,
  type Verdict,
  type Vocabulary,
  type Why,
} from './types';

/**
 * The C++ core in its own memory; core/core.cpp is the other side. It needs eight functions of its
 * host, all of them below: a clock, and a place for the last words of a broken check.
 */

const HEADER_INTEGERS = 10;
const MODULE_INTEGERS = 4;
const EVENTS_KEPT_THOUSANDS = 1000;
/** Of each connection in a stage. */
const STAGE_INTEGERS = 4;

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  holdfast_vocabulary(): void;
  holdfast_input(size: number): number;
  holdfast_open(): void;
  holdfast_check(): void;
  holdfast_limit(): void;
  holdfast_why(): void;
  holdfast_deformed(): void;
  holdfast_reliability(): void;
  holdfast_lose_one(): void;
  holdfast_cascade(): void;
  holdfast_try_places(): void;
  holdfast_write(): void;
  holdfast_simulate(): void;
  holdfast_judge_steps(): void;
  holdfast_find_order(): void;
  holdfast_stage(): void;
  holdfast_text(): number;
  holdfast_text_size(): number;
  holdfast_integers(): number;
  holdfast_integers_size(): number;
  holdfast_numbers(): number;
  holdfast_numbers_size(): number;
}

interface Reply {
  text: string;
  integers: Int32Array<ArrayBuffer>;
  numbers: Float64Array<ArrayBuffer>;
}

type Call =
  | 'vocabulary' | 'open' | 'check' | 'limit' | 'try_places' | 'write' | 'simulate' | 'judge_steps' | 'find_order'
  | 'stage' | 'why' | 'deformed' | 'reliability' | 'lose_one' | 'cascade';

export class Core {
  private constructor(private readonly exports: Exports) {}

  static async create(core: WebAssembly.Module): Promise<Core> {
    let words = '';
    let exports: Exports | undefined = undefined;
    const view = () => new DataView(exports!.memory.buffer);
    const done = () => 0;
    const wasi = {
      clock_time_get: (_clock: number, _precision: bigint, at: number) => {
        view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
        return 0;
      },
      proc_exit: (code: number) => {
        throw new Error(`the core has stopped with ${code}: ${words}`);
      },
      fd_write: (_file: number, vectors: number, count: number, written: number) => {
        let size = 0;
        for (let i = 0; i < count; ++i) {
          const at = view().getUint32(vectors + 8 * i, true);
          const length = view().getUint32(vectors + 8 * i + 4, true);
          words += new TextDecoder().decode(new Uint8Array(exports!.memory.buffer, at, length));
          size += length;
        }
        view().setUint32(written, size, true);
        return 0;
      },
      fd_read: done,
      fd_close: done,
      fd_seek: done,
      environ_get: done,
      environ_sizes_get: (count: number, size: number) => {
        view().setUint32(count, 0, true);
        view().setUint32(size, 0, true);
        return 0;
      },
    };
    const instance = await WebAssembly.instantiate(core, {
      env: { emscripten_notify_memory_growth: () => undefined },
      wasi_snapshot_preview1: wasi,
    });
    exports = instance.exports as unknown as Exports;
    exports._initialize();
    return new Core(exports);
  }

  vocabulary(): Vocabulary {
    return JSON.parse(this.call('vocabulary', new Uint8Array()).text) as Vocabulary;
  }

  /** Reads a file of any format; the ending of its name says which where its first letters do not, and the edge of a module in the unit of a mesh. Throws CoreError. */
  open(text: Uint8Array, fileName = '', meshPitch = 0): OpenedDocument {
    const ending = /\.[^. \0]*$/.exec(fileName)?.[0].toLowerCase() ?? '';
    const before = new TextEncoder().encode(`${ending} ${meshPitch}\0`);
    const input = new Uint8Array(before.length + text.length);
    input.set(before);
    input.set(text, before.length);
    const reply = this.call('open', input);
    const head = JSON.parse(reply.text) as Omit<OpenedDocument, 'modules' | 'material'>;
    return { ...head, modules: reply.integers, material: reply.numbers };
  }

  /** The verdict; `firstLook`: of the rigid body alone. Throws CoreError. */
  check(robot: RobotData, firstLook: boolean): Answer {
    return answerOf(this.call('check', request(robot, [firstLook ? 1 : 0])));
  }

  /** The verdict in the deformed shape, under a factor of all loads. Throws CoreError. */
  deformed(robot: RobotData, factor: number): DeformedAnswer {
    return answerOf(this.call('deformed', request(robot, [Math.round(1000 * factor)]))) as DeformedAnswer;
  }

  /** What the worst connection carries, and what would make the robot hold. Throws CoreError. */
  why(robot: RobotData): Why {
    const { text, integers } = this.call('why', request(robot, []));
    return { ...(JSON.parse(text) as Omit<Why, 'hanging'>), hanging: integers };
  }

  /** How sure it is, where each strength scatters by a share of itself, all together, and each mass. Throws CoreError. */
  reliability(robot: RobotData, scatter: number, together: number, masses = 0): Sureness {
    const options = [scatter, together, masses].map((share) => Math.round(1000 * share));
    return JSON.parse(this.call('reliability', request(robot, options)).text) as Sureness;
  }

  /** What follows from the loss of each single part. Throws CoreError. */
  loseOne(robot: RobotData, secondsMax: number): Losses {
    return JSON.parse(this.call('lose_one', request(robot, [secondsMax])).text) as Losses;
  }

  /** What follows the break. Throws CoreError. */
  cascade(robot: RobotData): Breaking {
    const { text, integers, numbers } = this.call('cascade', request(robot, []));
    const head = JSON.parse(text) as Omit<Breaking, 'bodies' | 'centres' | 'poses'>;
    const centreSize = 3 * (integers.reduce((most, body) => Math.max(most, body), -1) + 1);
    return { ...head, bodies: integers, centres: numbers.slice(0, centreSize), poses: numbers.slice(centreSize) };
  }

  /** The limit load; null if it is not found in time. Throws CoreError. */
  limit(robot: RobotData, secondsMax: number): LimitLoad | null {
    return JSON.parse(this.call('limit', request(robot, [secondsMax])).text) as LimitLoad | null;
  }

  /** What the verdict would be with one more module of a role, for each place (x, y, z). */
  tryPlaces(robot: RobotData, places: Int32Array, role: Role): Trial[] {
    const tail = new Uint8Array(places.buffer, places.byteOffset, places.byteLength);
    const reply = this.call('try_places', request(robot, [role], tail));
    const verdicts = JSON.parse(reply.text) as (Verdict | null)[];
    return verdicts.map((verdict, i) => ({
      verdict,
      ratio: reply.numbers[2 * i],
      marginMm: reply.numbers[2 * i + 1],
    }));
  }

  /** A document, picture or report; `base` is the text of the file it began with. */
  write(robot: RobotData, output: Output, name: string, base: string): string {
    return this.call('write', documentRequest(robot, output, name, base)).text;
  }

  /** Judges every stage of every step of a document as write() makes it, and remembers them. Throws CoreError. */
  judgeSteps(robot: RobotData, name: string, base: string): JudgedSteps {
    const { text, integers } = this.call('judge_steps', documentRequest(robot, 0, name, base));
    return { ...(JSON.parse(text) as Pick<JudgedSteps, 'report' | 'texts'>), transitions: integers };
  }

  /** In which order can the modules be attached, so that it is safe all the way? Throws CoreError. */
  findOrder(robot: RobotData, seconds: number, name: string, base: string): FoundOrder {
    return JSON.parse(this.call('find_order', documentRequest(robot, seconds, name, base)).text) as FoundOrder;
  }

  /** The loads in a stage of the steps that were judged last. */
  stage(step: number, stage: number, waypoint: number): StageLoads {
    const { text, integers, numbers } = this.call('stage', new Uint8Array(Int32Array.of(step, stage, waypoint).buffer));
    const connectionsAt = 1 + 3 * integers[0];
    const rows = (integers.length - connectionsAt) / STAGE_INTEGERS;
    const row = (i: number) => integers.subarray(connectionsAt + STAGE_INTEGERS * i, connectionsAt + STAGE_INTEGERS * (i + 1));
    const all = Array.from({ length: rows }, (_, i) => row(i));
    return {
      ...(JSON.parse(text) as Pick<StageLoads, 'stabilities' | 'contact_model'>),
      cells: integers.slice(1, connectionsAt),
      connections: Int32Array.from(all.flatMap((one) => [...one.subarray(0, 3)])),
      broken: Int32Array.from(all.flatMap((one, i) => (one[3] ? [i] : []))),
      loads: numbers,
    };
  }

  simulate(robot: RobotData, choice: SimulationChoice): Trace {
    const options = [choice.method, choice.link, choice.seed, choice.lossPerMille];
    const reply = this.call('simulate', request(robot, [...options, EVENTS_KEPT_THOUSANDS]));
    return { ...(JSON.parse(reply.text) as Trace), events: reply.integers, times: reply.numbers };
  }

  private call(name: Call, input: Uint8Array): Reply {
    const core = this.exports;
    const at = core.holdfast_input(input.length);
    new Uint8Array(core.memory.buffer, at, input.length).set(input);
    core[`holdfast_${name}`]();
    const buffer = core.memory.buffer as ArrayBuffer;
    const text = new Uint8Array(buffer, core.holdfast_text(), core.holdfast_text_size());
    const integers = core.holdfast_integers_size();
    const numbers = core.holdfast_numbers_size();
    const reply = {
      text: new TextDecoder().decode(text),
      integers: new Int32Array(buffer, integers ? core.holdfast_integers() : 0, integers).slice(),
      numbers: new Float64Array(buffer, numbers ? core.holdfast_numbers() : 0, numbers).slice(),
    };
    if (reply.text.startsWith('{"error":')) {
      const { message, where } = (JSON.parse(reply.text) as { error: Failure }).error;
      throw new CoreError(where ? `${where}: ${message}` : message);
    }
    return reply;
  }
}

/** The bytes of assessment_reply() in core/core.cpp. */
function answerOf(reply: Reply): Answer {
  const { integers, numbers, text } = reply;
  const [connections, broken, facets] = integers;
  const head = JSON.parse(text) as Answer;
  const loads = head.has_loads ? LOAD_FIELDS * connections : 0;
  const forces = loads + FACET_FIELDS * facets;
  const brokenAt = 3 + 3 * connections;
  const facetsAt = brokenAt + broken;
  return {
    ...head,
    connections: integers.subarray(3, brokenAt),
    broken: integers.subarray(brokenAt, facetsAt),
    facets: integers.subarray(facetsAt, facetsAt + FACET_INTEGERS * facets),
    limits: integers.subarray(facetsAt + FACET_INTEGERS * facets),
    loads: numbers.subarray(0, loads),
    facetForces: numbers.subarray(loads, forces),
    displacements: numbers.subarray(forces),
  };
}

/** A request about a document; `base` is the text of the file it began with. */
function documentRequest(robot: RobotData, option: number, name: string, base: string): Uint8Array {
  const encoder = new TextEncoder();
  return request(robot, [option, encoder.encode(name).length], encoder.encode(name + base));
}

/** The bytes of core/request.hpp. */
function request(robot: RobotData, options: number[], tail?: Uint8Array): Uint8Array {
  const { material, modules } = robot;
  const more = new TextEncoder().encode(robot.more);
  const headerBytes = 4 * HEADER_INTEGERS + 8 * material.length;
  const moreAt = headerBytes + 4 * modules.length;
  // The tail may be numbers, which begin at a whole word.
  const tailAt = moreAt + 4 * Math.ceil(more.length / 4);
  const bytes = new Uint8Array(tailAt + (tail?.length ?? 0));
  const header = new Int32Array(bytes.buffer, 0, HEADER_INTEGERS);
  header.set([modules.length / MODULE_INTEGERS, robot.supportZ, more.length, ...options]);
  new Float64Array(bytes.buffer, 4 * HEADER_INTEGERS, material.length).set(material);
  new Int32Array(bytes.buffer, headerBytes, modules.length).set(modules);
  bytes.set(more, moreAt);
  if (tail) {
    bytes.set(tail, tailAt);
  }
  return bytes;
}
