// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { ROLE_NAMES, Role, type Cell } from './cell';
import { History, type Change } from './history';
import { EditedRobot } from './edited_robot';

export type Tool = 'look' | 'add' | 'remove' | 'paint';

/** No more modules than this in one row. */
export const ROW_MAX = 100;

/** What is built, with which tool and where: the page's state, without its picture and the answer. */
export class Workbench {
  readonly history = new History(new EditedRobot(), (what) => this.robotListeners.forEach((tell) => tell(what)));
  tool: Tool = 'add';
  /** Of the modules that are attached or painted. */
  role = Role.kExisting;
  /** Where the keyboard is. */
  cursor?: Cell;
  /** Called after every change of the robot. */
  readonly robotListeners: ((what: Change) => void)[] = [];
  /** Called after every choice of a tool, or of what it attaches. */
  readonly toolListeners: (() => void)[] = [];

  /** `refuse` hears why an edit was not done. */
  constructor(private readonly refuse: (reason: string) => void) {}

  get robot(): EditedRobot {
    return this.history.robot;
  }

  setTool(tool: Tool, role = this.role): void {
    this.tool = tool;
    this.role = role;
    this.toolListeners.forEach((tell) => tell());
  }

  /** Another role to attach, or to paint if that is the tool. */
  setRole(role: Role): void {
    this.setTool(this.tool === 'paint' ? 'paint' : 'add', role);
  }

  /** Sets cells to a role, or empties them. */
  edit(label: string, cells: readonly Cell[], role: Role | undefined): void {
    performance.mark('edit');
    try {
      this.history.edit(label, cells, role);
    } catch (error) {
      this.refuse(error instanceof Error ? error.message : String(error));
    }
  }

  /** Uses the tool on cells. */
  use(cells: readonly Cell[]): void {
    const role = ROLE_NAMES[this.role];
    if (this.tool === 'add') {
      this.edit(`attaching ${cells.length}`, cells.filter((cell) => !this.robot.has(cell)), this.role);
    } else if (this.tool === 'remove') {
      this.edit(`removing ${cells.length}`, cells, undefined);
    } else if (this.tool === 'paint') {
      this.edit(`painting ${cells.length} ${role}`, cells.filter((cell) => this.robot.has(cell)), this.role);
    }
  }
}
