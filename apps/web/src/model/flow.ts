// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Answer } from '../core/types';

/** The way that forces take from a connection, or a module, to the ground. */

/** What may flow, by its letter: fields of Answer.loads. */
export const FLOW_FIELDS = { N: 1, V: 3, M: 2, T: 4 } as const;

export type FlowName = keyof typeof FLOW_FIELDS;

export interface Way {
  /** Connections by index, from where it begins to the ground; none where that stands on the ground itself. */
  connections: number[];
  /** The module that stands there. */
  foot: number;
}

/** Connections by module, those with larger load ratios first. */
function neighbours({ connections, loads }: Answer, count: number, fields: number): number[][] {
  const by: number[][] = Array.from({ length: count }, () => []);
  for (let i = 0; 3 * i < connections.length; ++i) {
    by[connections[3 * i]].push(i);
    by[connections[3 * i + 1]].push(i);
  }
  by.forEach((list) => list.sort((a, b) => loads[fields * b] - loads[fields * a]));
  return by;
}

/**
 * The shortest way through connections from a connection, which it contains, or from a module to one that stands;
 * modules are those of the answer. Undefined where none stands, or none that is reached.
 */
export function wayToGround(
  answer: Answer,
  count: number,
  fields: number,
  from: { connection: number } | { module: number },
  stands: (module: number) => boolean,
): Way | undefined {
  const { connections } = answer;
  const by = neighbours(answer, count, fields);
  const begins = 'module' in from ? [from.module] : [connections[3 * from.connection], connections[3 * from.connection + 1]];
  const first = 'module' in from ? -1 : from.connection;
  /** By module: the connection through which it was reached; -1 where the way begins. */
  const through = new Map<number, number>(begins.map((module) => [module, -1]));
  const other = (connection: number, module: number) => connections[3 * connection] + connections[3 * connection + 1] - module;
  const queue = [...begins];
  for (let next = 0; next < queue.length; ++next) {
    const module = queue[next];
    if (stands(module)) {
      const way: number[] = [];
      for (let at = module; through.get(at)! >= 0; at = other(through.get(at)!, at)) {
        way.unshift(through.get(at)!);
      }
      return { connections: first >= 0 ? [first, ...way] : way, foot: module };
    }
    for (const connection of by[module]) {
      const beyond = other(connection, module);
      if (connection !== first && !through.has(beyond)) {
        through.set(beyond, connection);
        queue.push(beyond);
      }
    }
  }
  return undefined;
}
