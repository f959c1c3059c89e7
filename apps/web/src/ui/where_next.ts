// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Places } from '../core/places';
import type { Trial, Verdict } from '../core/types';
import { ROLE_NAMES, Role, type Cell } from '../model/cell';
import type { Workbench } from '../model/workbench';
import { OBSTACLE, UNKNOWN, loadColour, verdictColour, type Rgb } from '../view/colours';
import { FaceCode, type RobotView } from '../view/robot_view';
import { byId, say } from './dom';
import { t } from '../texts';

/** Robots up to this size are tried at once where the pointer is. */
const TRIAL_COUNT_MAX = 1500;

const CODES: Record<Verdict, FaceCode> = {
  safe: FaceCode.kSafe,
  overload: FaceCode.kOverload,
  unstable: FaceCode.kUnstable,
  undecided: FaceCode.kUndecided,
};

const codeOf = ({ verdict }: Trial) => (verdict === null ? FaceCode.kNone : CODES[verdict]);

/** Where the next module may go: tints free faces, and the ghost of what would be attached. */
export class WhereNext {
  readonly places = new Places();
  /** Modules that would be attached. */
  previewed: readonly Cell[] = [];
  /** The module that would be taken away. */
  private removal?: Cell;
  /** The answer to the robot as it is has come; before that nothing is tried. */
  knowsLoads = false;
  /** Another robot than the one that is built is shown. */
  isOff = false;
  /** Called when what is known of the module that would be attached has changed; undefined: nothing is. */
  onTrial: (trial: Trial | undefined) => void = () => undefined;
  private isShown = false;
  private isTrying = false;
  /** That of the workbench before its last change. */
  private role: Role;

  constructor(
    private readonly bench: Workbench,
    private readonly view: RobotView,
  ) {
    this.role = bench.role;
    bench.toolListeners.push(() => this.toolChanged());
  }

  /** Forgets all: the robot has changed. */
  reset(): void {
    this.knowsLoads = false;
    this.places.reset();
    this.preview([]);
    this.removal = undefined;
  }

  show(isShown: boolean): void {
    this.isShown = isShown;
    if (!isShown) {
      this.places.reset();
    }
    void this.update();
  }

  /** Finds out what is not known of free faces. */
  async update(): Promise<void> {
    const { robot, role } = this.bench;
    const button = byId('faces');
    this.paint();
    button.textContent = t('Where next?');
    byId('face-legend').hidden = !this.isShown;
    if (!this.isShown || !this.knowsLoads) {
      return;
    }
    const places = robot.freePlaces();
    const isDone = await this.places.findAll(robot, places, role, (count) => {
      if (this.isShown && this.bench.robot === robot) {
        button.textContent = `${Math.round((100 * count) / places.length)} %`;
        this.paint();
      }
    });
    if (isDone && this.isShown) {
      button.textContent = t('Where next?');
      const safe = places.filter((place) => this.places.known(place, role)?.verdict === 'safe').length;
      say(t('{0} of {1} free places are safe for one more {2} module', safe, places.length, t(ROLE_NAMES[role])));
    }
  }

  /** Modules that would be attached; coloured when it is known what would come of it. */
  preview(cells: readonly Cell[]): void {
    this.previewed = cells;
    this.showPreview();
    void this.tryPreviewed();
  }

  /** A module that would be taken away, or none. */
  previewRemoval(cell: Cell | undefined): void {
    if (String(cell) !== String(this.removal)) {
      this.removal = cell;
      this.onTrial(this.trial);
      void this.tryRemoval();
    }
  }

  private async tryRemoval(): Promise<void> {
    const { robot } = this.bench;
    // Without its last module there is no robot.
    if (this.isTrying || !this.knowsLoads || robot.count < 2 || robot.count > TRIAL_COUNT_MAX) {
      return;
    }
    this.isTrying = true;
    let isCurrent = true;
    while (isCurrent && this.removal && !this.places.known(this.removal)) {
      isCurrent = (await this.places.findRemoval(robot, this.removal)) !== undefined;
      this.onTrial(this.trial);
    }
    this.isTrying = false;
  }

  /** Draws what is known of free faces. */
  paint(): void {
    const code = (place: Cell) => (this.knowsLoads ? this.faceCode(place) : FaceCode.kWaiting);
    this.view.showFaces(this.isShown && !this.isOff ? code : undefined);
  }

  private toolChanged(): void {
    const isOtherRole = this.role !== this.bench.role;
    this.role = this.bench.role;
    this.preview(this.bench.tool === 'add' || this.bench.tool === 'obstacle' ? this.previewed : []);
    if (isOtherRole) {
      void this.update();
    }
  }

  private showPreview(): void {
    if (this.bench.tool === 'obstacle') {
      const colour = OBSTACLE[this.bench.hold];
      this.view.showGhosts(this.previewed, Role.kExisting, colour, FaceCode.kNone);
      this.onTrial(undefined);
      return;
    }
    const { role } = this.bench;
    const { trial } = this;
    const verdict = trial?.verdict;
    const colour = trial && verdict ? this.colour(verdict, trial.ratio) : UNKNOWN;
    const code = trial && verdict !== 'safe' ? codeOf(trial) : FaceCode.kNone;
    this.view.showGhosts(this.previewed, role, colour, code);
    this.onTrial(trial);
  }

  /** Of the one module that would be attached or taken away, as far as it is known. */
  get trial(): Trial | undefined {
    if (this.bench.tool === 'remove') {
      return this.removal && this.places.known(this.removal);
    }
    const [place, ...others] = this.previewed;
    const isOne = place && others.length === 0 && this.bench.tool === 'add';
    return isOne ? this.places.known(place, this.bench.role) : undefined;
  }

  private colour(verdict: Verdict, ratio: number): Rgb {
    const { scale } = this.view;
    return verdict === 'safe' ? loadColour(scale, Math.max(ratio, 0)) : verdictColour(verdict, scale);
  }

  /** One place at a time, and always where the pointer is now. */
  private async tryPreviewed(): Promise<void> {
    const { bench } = this;
    if (this.isTrying || bench.tool !== 'add' || bench.robot.count === 0 || bench.robot.count > TRIAL_COUNT_MAX) {
      return;
    }
    this.isTrying = true;
    let isCurrent = true;
    while (isCurrent && this.previewed.length === 1 && !this.places.known(this.previewed[0], bench.role)) {
      isCurrent = (await this.places.find(bench.robot, this.previewed[0], bench.role)) !== undefined;
      this.showPreview();
    }
    this.isTrying = false;
  }

  private faceCode(place: Cell): FaceCode {
    if (!this.bench.robot.isFree(place)) {
      return FaceCode.kNone;
    }
    const trial = this.places.known(place, this.bench.role);
    return trial ? codeOf(trial) : FaceCode.kWaiting;
  }
}
