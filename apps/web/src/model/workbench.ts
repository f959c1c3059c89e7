// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { KIND_NAMES, Kind, type Cell } from './cell';
import { History, type Change } from './history';
import { Robot } from './robot';

export type Tool = 'look' | 'add' | 'remove' | 'paint';

/** No more modules than this in one row. */
export const ROW_MAX = 100;

/** What is built, with which tool and where: the page's state, without its picture and the answer. */
export class Workbench {
  readonly history = new History(new Robot(), (what) => this.robotListeners.forEach((tell) => tell(what)));
  tool: Tool = 'add';
  /** Of the modules that are attached or painted. */
  kind = Kind.kExisting;
  /** Where the keyboard is. */
  cursor?: Cell;
  /** Called after every change of the robot. */
  readonly robotListeners: ((what: Change) => void)[] = [];
  /** Called after every choice of a tool, or of what it attaches. */
  readonly toolListeners: (() => void)[] = [];

  /** `refuse` hears why an edit was not done. */
  constructor(private readonly refuse: (reason: string) => void) {}

  get robot(): Robot {
    return this.history.robot;
  }

  setTool(tool: Tool, kind = this.kind): void {
    this.tool = tool;
    this.kind = kind;
    this.toolListeners.forEach((tell) => tell());
  }

  /** Another kind to attach, or to paint if that is the tool. */
  setKind(kind: Kind): void {
    this.setTool(this.tool === 'paint' ? 'paint' : 'add', kind);
  }

  /** Sets cells to a kind, or empties them. */
  edit(label: string, cells: readonly Cell[], kind: Kind | undefined): void {
    performance.mark('edit');
    try {
      this.history.edit(label, cells, kind);
    } catch (error) {
      this.refuse(error instanceof Error ? error.message : String(error));
    }
  }

  /** Uses the tool on cells. */
  use(cells: readonly Cell[]): void {
    const kind = KIND_NAMES[this.kind];
    if (this.tool === 'add') {
      this.edit(`attaching ${cells.length}`, cells.filter((cell) => !this.robot.has(cell)), this.kind);
    } else if (this.tool === 'remove') {
      this.edit(`removing ${cells.length}`, cells, undefined);
    } else if (this.tool === 'paint') {
      this.edit(`painting ${cells.length} ${kind}`, cells.filter((cell) => this.robot.has(cell)), this.kind);
    }
  }
}
