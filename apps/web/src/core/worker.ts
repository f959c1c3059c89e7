// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { CoreError } from './types';
import { Core } from './wasm';

/** Runs the core beside the page. First message: the compiled core. Then calls, one at a time. */

export interface WorkerCall {
  id: number;
  name:
    | 'open' | 'check' | 'limit' | 'tryPlaces' | 'write' | 'simulate' | 'judgeSteps' | 'findOrder' | 'stage' | 'why'
    | 'deformed' | 'reliability' | 'loseOne' | 'cascade';
  values: unknown[];
}

export interface WorkerReply {
  id: number;
  value?: unknown;
  /** For the user; the core goes on. */
  refusal?: string;
  /** The core has stopped and must be started again. */
  fault?: string;
}

let core: Promise<Core> | undefined;

/** What is handed over instead of copied. */
function buffersOf(value: unknown): ArrayBuffer[] {
  const parts = typeof value === 'object' && value !== null ? Object.values(value) : [];
  const buffers = parts.filter(ArrayBuffer.isView).map((view) => view.buffer as ArrayBuffer);
  return [...new Set(buffers)];
}

self.onmessage = async (event: MessageEvent<WebAssembly.Module | WorkerCall>) => {
  if (event.data instanceof WebAssembly.Module) {
    core = Core.create(event.data);
    return;
  }
  const { id, name, values } = event.data;
  try {
    const run = (await core!)[name] as (...values: unknown[]) => unknown;
    const value = run.apply(await core!, values);
    self.postMessage({ id, value } satisfies WorkerReply, { transfer: buffersOf(value) });
  } catch (error) {
    const message = error instanceof Error ? error.message : String(error);
    const reply = error instanceof CoreError ? { refusal: message } : { fault: message };
    self.postMessage({ id, ...reply } satisfies WorkerReply);
  }
};
