// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { ROLE_NAMES, Role, type Cell } from './cell';
import { History, type Change, type Wanted } from './history';
import { EditedRobot, type Settings } from './edited_robot';
import { latticeOf } from './lattice';
import { Selection } from './selection';
import {
  isNothing, tidied, withBurden, withObstacles, withoutObstacle, type Burden, type Hold, type Obstacle, type Surroundings,
} from './surroundings';
import { t, word } from '../texts';

export type Tool = 'look' | 'select' | 'add' | 'remove' | 'paint' | 'obstacle' | 'load';

/** No more modules than this in one row. */
export const ROW_MAX = 100;

const touches = (robot: EditedRobot, cell: Cell) =>
  robot.count === 0 || robot.lattice.neighbours(cell).some((other) => robot.has(other));

/** Whether the tool may put something there: modules touch the robot; obstacles may stand anywhere. */
export const mayBe = ({ robot, tool }: Workbench, cell: Cell) =>
  robot.isFree(cell) && (tool === 'obstacle' || touches(robot, cell));

/** What is built, with which tool and where: the page's state, without its picture and the answer. */
export class Workbench {
  readonly history = new History(
    new EditedRobot(),
    (what, chosen = []) => {
      this.selection.follow();
      this.robotListeners.forEach((tell) => tell(what));
      if (chosen.length > 0) {
        this.selection.set(chosen);
      }
    },
    () => this.selection.cells,
  );
  readonly selection = new Selection(this);
  tool: Tool = 'add';
  /** Of the modules that are attached or painted. */
  role = Role.kExisting;
  /** Of the obstacles that are placed. */
  hold: Hold = 'contact';
  /** Undefined: no slip. */
  friction?: number;
  /** What is put on modules. */
  burden: Burden = { force: [0, 0, -2], torque: [0, 0, 0] };
  /** Where the keyboard is. */
  cursor?: Cell;
  /** Why nothing can be built now; '' if it can. */
  closed = '';
  /** Called after every change of the robot. */
  readonly robotListeners: ((what: Change) => void)[] = [];
  /** Called after every choice of a tool, or of what it attaches. */
  readonly toolListeners: (() => void)[] = [];

  /** `refuse` hears why an edit was not done. */
  constructor(readonly refuse: (reason: string) => void) {}

  get robot(): EditedRobot {
    return this.history.robot;
  }

  setTool(tool: Tool, role = this.role): void {
    this.tool = tool;
    this.role = role;
    this.toolListeners.forEach((tell) => tell());
  }

  /** Another role to attach, or to paint if that is the tool; what is selected takes it at once. */
  setRole(role: Role): void {
    const isKept = this.tool === 'paint' || this.tool === 'select';
    this.setTool(isKept ? this.tool : 'add', role);
    if (this.tool === 'select') {
      this.paint(this.selection.cells);
    }
  }

  setHold(hold: Hold): void {
    this.hold = hold;
    this.setTool('obstacle');
  }

  setBurden(burden: Burden): void {
    this.burden = burden;
    this.setTool('load');
  }

  /** Puts the same cells, as an undoable step, into another lattice. */
  setLattice(name: string): void {
    const lattice = latticeOf(name);
    if (lattice && lattice.name !== this.robot.lattice.name) {
      this.history.replace(t('another lattice: {0}', word(lattice.title)), this.robot.inLattice(lattice));
    }
  }

  /** Changes some of what surrounds the robot, and other settings with it. */
  surround(label: string, change: Surroundings, settings: Partial<Settings> = {}): void {
    performance.mark('edit');
    this.history.configure(label, { ...settings, surroundings: tidied({ ...this.robot.surroundings, ...change }) });
  }

  /** Sets cells to a role, or empties them. */
  edit(label: string, cells: readonly Cell[], role: Role | undefined, surroundings?: Surroundings): void {
    this.change(label, cells.map((cell) => ({ cell, role })), surroundings);
  }

  /** The same with a role for each cell; false if it was not done. */
  change(label: string, wanted: readonly Wanted[], surroundings?: Surroundings): boolean {
    performance.mark('edit');
    try {
      return this.history.edit(label, wanted, surroundings && { surroundings });
    } catch (error) {
      this.refuse(error instanceof Error ? error.message : String(error));
      return false;
    }
  }

  /** Says why nothing can be done with what is built now, if that is so. */
  refusesNow(): boolean {
    if (this.closed !== '') {
      this.refuse(this.closed);
    }
    return this.closed !== '';
  }

  /** Uses the tool on cells. */
  use(cells: readonly Cell[]): void {
    if (cells.length === 0 || this.refusesNow()) {
      return;
    }
    if (this.tool === 'add') {
      const free = cells.filter((cell) => !this.robot.has(cell) && !this.robot.obstacles.has(cell));
      this.edit(t('attaching {0}', cells.length), free, this.role);
    } else if (this.tool === 'remove') {
      this.remove(cells);
    } else if (this.tool === 'obstacle') {
      this.block(cells.filter((cell) => !this.robot.has(cell) && !this.robot.obstacles.has(cell)));
    } else if (this.tool === 'load') {
      this.load(cells.filter((cell) => this.robot.has(cell)));
    } else if (this.tool === 'paint') {
      this.paint(cells.filter((cell) => this.robot.has(cell)));
    } else if (this.tool === 'select') {
      this.selection.toggle(cells);
    }
  }

  private paint(cells: readonly Cell[]): void {
    if (cells.length > 0 && !this.refusesNow()) {
      this.edit(t('painting {0} {1}', cells.length, t(ROLE_NAMES[this.role])), cells, this.role);
    }
  }

  /** Modules and obstacles. */
  remove(cells: readonly Cell[]): void {
    if (this.refusesNow()) {
      return;
    }
    const { surroundings, obstacles } = this.robot;
    const blocked = cells.filter((cell) => obstacles.has(cell));
    const left = blocked.reduce((list: readonly Obstacle[], cell) => withoutObstacle(list, cell), obstacles.obstacles);
    const change = blocked.length > 0 ? tidied({ ...surroundings, obstacles: left }) : undefined;
    this.edit(t('removing {0}', cells.length), cells.filter((cell) => this.robot.has(cell)), undefined, change);
  }

  private block(cells: readonly Cell[]): void {
    if (cells.length > 0) {
      const { obstacles } = this.robot.obstacles;
      const list = withObstacles(obstacles, cells, this.hold, this.friction);
      this.surround(cells.length === 1 ? t('placing an obstacle') : t('placing {0} obstacles', cells.length), { obstacles: list });
    }
  }

  load(cells: readonly Cell[]): void {
    const { burden } = this;
    const label = isNothing(burden) ? t('taking the load off {0}', cells.length) : t('loading {0}', cells.length);
    this.history.configure(label, { surroundings: withBurden(this.robot.surroundings, cells, burden) });
  }
}
