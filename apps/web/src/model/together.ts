// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Cell } from './cell';
import type { Lattice } from './lattice';
import type { BodyPart, Pair, Surroundings } from './surroundings';

/** What names several modules, pairs and rigid pieces, where modules come, go and move. */

type Box = { from?: Cell; to?: Cell };

/** Cells of a rigid piece; undefined where its parts are written in a way that the page does not know. */
function cellsOf(body: readonly BodyPart[]): Cell[] | undefined {
  const cells: Cell[] = [];
  for (const part of body) {
    const [from, to] = Array.isArray(part) ? [part as Cell, part as Cell] : [(part as Box).from, (part as Box).to];
    if (!from || !to) {
      return undefined;
    }
    for (let x = from[0]; x <= to[0]; ++x) {
      for (let y = from[1]; y <= to[1]; ++y) {
        for (let z = from[2]; z <= to[2]; ++z) {
          cells.push([x, y, z]);
        }
      }
    }
  }
  return cells;
}

/** What is left of a rigid piece: one cell alone is none. */
export function bodyWithout(body: readonly BodyPart[], gone: ReadonlySet<string>): (readonly BodyPart[])[] {
  const cells = cellsOf(body);
  const left = cells?.filter((cell) => !gone.has(String(cell)));
  return !cells || !left || left.length === cells.length ? [body] : left.length > 1 ? [left] : [];
}

/** Where modules go, by the text of their cell. */
type Targets = ReadonlyMap<string, Cell>;

/** The pair where both modules went; undefined if one of them stays, as they part then. */
function pairMoved(pair: Pair, targets: Targets): Pair | undefined {
  const [a, b] = pair.map((cell) => targets.get(String(cell)));
  return a && b && [a, b];
}

/** What names several modules goes with them where all of them go; else those that go leave it. */
export function togetherMoved({ open, connections, bodies }: Surroundings, targets: Targets, isCopied: boolean): Surroundings {
  const gone = new Set(isCopied ? [] : targets.keys());
  const stays = (pair: Pair) => !pair.some((cell) => gone.has(String(cell)));
  const bodyMoved = (body: readonly BodyPart[]) => {
    const to = cellsOf(body)?.map((cell) => targets.get(String(cell)));
    return to?.every((cell) => cell !== undefined) ? [to as Cell[]] : [];
  };
  return {
    open: open && [...open.filter(stays), ...open.flatMap((pair) => [pairMoved(pair, targets)].filter((one) => one !== undefined))],
    connections: connections && [
      ...connections.filter(({ between }) => stays(between)),
      ...connections.flatMap((one) => {
        const between = pairMoved(one.between, targets);
        return between ? [{ ...one, between }] : [];
      }),
    ],
    bodies: bodies && [...bodies.flatMap((body) => bodyWithout(body, gone)), ...bodies.flatMap(bodyMoved)],
  };
}

/**
 * Lists the pairs of modules that come with their neighbours. `has`: whether a module is there afterwards. Modules that
 * come together are joined to each other, unless their pairs came with them.
 */
export function withJoined(
  surroundings: Surroundings,
  added: readonly Cell[],
  lattice: Lattice,
  has: (cell: Cell) => boolean,
  areTheirsNamed: boolean,
): Surroundings {
  const keyOf = (pair: readonly Cell[]) => pair.map(String).sort().join(' ');
  const listed = surroundings.connections ?? [];
  const known = new Set(listed.map(({ between }) => keyOf(between)));
  const come = new Set(added.map(String));
  const joined: Pair[] = [];
  for (const cell of added) {
    for (const other of lattice.neighbours(cell)) {
      const pair: Pair = [cell, other];
      const isNamed = areTheirsNamed && come.has(String(other));
      if (!isNamed && has(other) && !known.has(keyOf(pair))) {
        known.add(keyOf(pair));
        joined.push(pair);
      }
    }
  }
  return joined.length === 0 ? surroundings : { ...surroundings, connections: [...listed, ...joined.map((between) => ({ between }))] };
}
