// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Role } from '../model/cell';
import type { RobotData } from '../model/edited_robot';
import {
  CoreError,
  type Answer,
  type Breaking,
  type DeformedAnswer,
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
  type Why,
} from './types';
import { unpacked } from './packed';
import type { WorkerCall, WorkerReply } from './worker';
import CoreWorker from './worker?worker&inline';

/** Thrown to who waits for a call that was given up. */
export class Cancelled extends Error {}

/** The core travels in the page as letters for deflated bytes; it is compiled once for all workers. */
async function compileCore(): Promise<WebAssembly.Module> {
  return WebAssembly.compile(await unpacked('holdfast-core').arrayBuffer());
}

export const compiledCore = compileCore();

interface Waiting {
  resolve(value: unknown): void;
  reject(error: Error): void;
}

/** A core in a worker of its own, so that the page never waits. Calls are answered in order. */
export class CoreClient {
  private worker?: Worker;
  private nextId = 0;
  private waiting = new Map<number, Waiting>();

  open(text: Uint8Array, fileName = '', meshPitch = 0): Promise<OpenedDocument> {
    return this.call('open', [text, fileName, meshPitch]);
  }

  check(robot: RobotData, firstLook = false): Promise<Answer> {
    return this.call('check', [robot, firstLook]);
  }

  limit(robot: RobotData, secondsMax: number): Promise<LimitLoad | null> {
    return this.call('limit', [robot, secondsMax]);
  }

  why(robot: RobotData): Promise<Why> {
    return this.call('why', [robot]);
  }

  deformed(robot: RobotData, factor: number): Promise<DeformedAnswer> {
    return this.call('deformed', [robot, factor]);
  }

  reliability(robot: RobotData, scatter: number, together: number, masses: number): Promise<Sureness> {
    return this.call('reliability', [robot, scatter, together, masses]);
  }

  loseOne(robot: RobotData, secondsMax: number): Promise<Losses> {
    return this.call('loseOne', [robot, secondsMax]);
  }

  cascade(robot: RobotData): Promise<Breaking> {
    return this.call('cascade', [robot]);
  }

  tryPlaces(robot: RobotData, places: Int32Array, role: Role): Promise<Trial[]> {
    return this.call('tryPlaces', [robot, places, role]);
  }

  write(robot: RobotData, output: Output, name: string, base: string): Promise<string> {
    return this.call('write', [robot, output, name, base]);
  }

  simulate(robot: RobotData, choice: SimulationChoice): Promise<Trace> {
    return this.call('simulate', [robot, choice]);
  }

  judgeSteps(robot: RobotData, name: string, base: string): Promise<JudgedSteps> {
    return this.call('judgeSteps', [robot, name, base]);
  }

  findOrder(robot: RobotData, seconds: number, name: string, base: string): Promise<FoundOrder> {
    return this.call('findOrder', [robot, seconds, name, base]);
  }

  /** Of the steps that this core has judged last. */
  stage(step: number, stage: number, waypoint: number): Promise<StageLoads> {
    return this.call('stage', [step, stage, waypoint]);
  }

  /** Gives up all calls, whatever the core is at. */
  cancel(): void {
    this.stop(new Cancelled());
  }

  get isBusy(): boolean {
    return this.waiting.size > 0;
  }

  private async call<Value>(name: WorkerCall['name'], values: unknown[]): Promise<Value> {
    const core = await compiledCore;
    const worker = (this.worker ??= this.start(core));
    const id = this.nextId++;
    return new Promise<Value>((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (value: unknown) => void, reject });
      worker.postMessage({ id, name, values } satisfies WorkerCall);
    });
  }

  private start(core: WebAssembly.Module): Worker {
    const worker = new CoreWorker();
    worker.postMessage(core);
    worker.onmessage = (event: MessageEvent<WorkerReply>) => this.receive(event.data);
    worker.onerror = (event) => this.stop(new CoreError(event.message));
    return worker;
  }

  private receive(reply: WorkerReply): void {
    const waiting = this.waiting.get(reply.id);
    this.waiting.delete(reply.id);
    if (reply.refusal !== undefined) {
      waiting?.reject(new CoreError(reply.refusal));
    } else if (reply.fault !== undefined) {
      waiting?.reject(new CoreError(explain(reply.fault)));
      this.stop(new Cancelled());
    } else {
      waiting?.resolve(reply.value);
    }
  }

  private stop(error: Error): void {
    this.worker?.terminate();
    this.worker = undefined;
    const waiting = [...this.waiting.values()];
    this.waiting.clear();
    waiting.forEach(({ reject }) => reject(error));
  }
}

/** In words for the user: why a core has stopped. */
export function explain(fault: string): string {
  return /memory|unreachable|allocation/i.test(fault)
    ? 'too large for the memory that a page has; holdfast check may still answer'
    : fault;
}
