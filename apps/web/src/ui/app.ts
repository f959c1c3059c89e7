// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Vector3 } from 'three';
import { Judge, type Finding } from '../core/judge';
import { MOTION_FIELDS } from '../core/types';
import type { Cell } from '../model/cell';
import type { EditedRobot } from '../model/edited_robot';
import type { Change } from '../model/history';
import type { Place } from '../model/lattice';
import { mayBe, type Workbench } from '../model/workbench';
import type { ScaleName, Subject } from '../view/colours';
import { RobotView, type Losses } from '../view/robot_view';
import type { Section } from '../view/section';
import { OBLIQUE, Stage } from '../view/stage';
import { connectionText, showDetails, showFaceLegend, showFacetLegend, showFinding, showLegend } from './answer_panel';
import { showChip, trialText } from './chip';
import { byId, clearErrors, make, reasonOf, say, tell } from './dom';
import { boundsOf, coveredParts, type Exhibit, type Mode } from './exhibit';
import type { Film } from './film';
import { placeLabels } from './labels';
import { Pointed } from './pointed';
import { Scenery } from './scenery';
import { followTheme } from './theme';
import { Toppling } from './toppling';
import { WhereNext } from './where_next';

/** The largest displacement is drawn as up to so many cells. */
const DRAWN_CELLS_MAX = 1.5;
/** A changed robot is shown without its answer if that takes longer. */
const LATE_MS = 80;

/** The picture of what is on the workbench, and the answer to it. */
export class App {
  readonly stage = new Stage(byId<HTMLCanvasElement>('canvas'), coveredParts);
  readonly view = new RobotView(this.stage);
  readonly whereNext: WhereNext;
  /** Of the robot that is built. */
  finding?: Finding;
  private exhibit?: Exhibit;
  /** Called before something else is shown than what is built, with what: one mode at a time. */
  readonly exhibitListeners: ((mode: Mode) => void)[] = [];
  readonly scenery = new Scenery(this.stage);
  readonly toppling = new Toppling(this.stage, this.view, this.scenery.ground, () => this.fallListeners.forEach((tell) => tell()));
  /** Called when a fall is asked for, begins or ends. */
  readonly fallListeners: (() => void)[] = [];
  readonly pointed = new Pointed(this.stage, () => this.showPointed());
  private readonly judge = new Judge((finding) => this.found(finding));
  private lateShow = 0;
  private wasUnstable = false;
  private noted = '';

  constructor(readonly bench: Workbench) {
    this.whereNext = new WhereNext(bench, this.view);
    this.whereNext.onTrial = () => this.showTrial();
    bench.toolListeners.push(() => this.unpin());
    bench.robotListeners.push((what) => this.changed(what));
    this.stage.followers.push(() =>
      placeLabels(this.stage, this.view, this.robot, this.isToppled ? undefined : this.shown),
    );
    followTheme(() => this.setTheme());
    this.setTheme();
  }

  /** The robot in the picture. */
  get robot(): EditedRobot {
    return this.exhibit?.robot ?? this.bench.robot;
  }

  get mode(): Mode {
    return this.exhibit?.mode ?? 'build';
  }

  get isExhibiting(): boolean {
    return this.exhibit !== undefined;
  }

  /** Modules are drawn elsewhere than where they are built, and stay so. */
  get isElsewhere(): boolean {
    return this.isToppled || (this.isExhibiting && this.view.exaggeration > 0);
  }

  /** Shows something else than what is built, until that changes; undefined: what is built. */
  setExhibit(exhibit: Exhibit | undefined): void {
    if (exhibit || this.exhibit) {
      this.toppling.stop();
      const isFirst = exhibit !== undefined && this.mode !== exhibit.mode;
      if (isFirst) {
        this.exhibitListeners.forEach((tell) => tell(exhibit.mode));
        this.straighten();
      }
      this.exhibit = exhibit;
      this.view.exaggeration = exhibit?.exaggeration ?? 0;
      this.unpin();
      this.offer();
      this.view.point([]);
      this.whereNext.preview([]);
      this.showRobot();
      this.showPointed();
      if (isFirst && exhibit?.bounds && !this.stage.holds(exhibit.bounds.low, exhibit.bounds.high)) {
        this.stage.fit(exhibit.bounds.low, exhibit.bounds.high);
      }
    }
  }

  /** What is about the robot that is built is off while another one is shown. */
  private offer(): void {
    this.whereNext.isOff = this.isExhibiting;
    document.querySelectorAll<HTMLElement>('[data-built]').forEach((part) => (part.inert = this.isExhibiting));
  }

  /** Another moment of what is shown, its modules in the same slots: only the picture changes. */
  moveExhibit(robot: EditedRobot): void {
    if (this.exhibit) {
      const { finding } = this.exhibit;
      this.exhibit = { ...this.exhibit, robot };
      this.view.show(robot, finding.answer && { answer: finding.answer, slots: finding.slots });
    }
  }

  /** In which colours, and on what, loads are shown. */
  setColours(scale: ScaleName, subject: Subject): void {
    this.view.scale = scale;
    this.view.subject = subject;
    showLegend(scale, subject, this.view.losses !== undefined);
    showFaceLegend(scale);
    this.setTheme();
  }

  /** What may move: each begins its film, or has none now. */
  readonly films: (() => Film | undefined)[] = [];

  /** Another thing in the colour of writing. */
  addInked(one: { setInk(ink: number): void }): void {
    this.scenery.addInked(one);
    this.setTheme();
  }

  /** Called when something else is shown, or something else is known of it. */
  readonly shownListeners: (() => void)[] = [];

  /** What else is known of the robot that is built, beside its verdict. */
  set note(text: string) {
    if (text !== this.noted) {
      this.noted = text;
      this.showTrial();
    }
  }

  /** Colours of what follows from losses, in place of those of loads. */
  showLosses(fatal: Losses | undefined): void {
    this.view.losses = fatal;
    showLegend(this.view.scale, this.view.subject, fatal !== undefined);
    this.view.paint();
  }

  /** Cuts the robot open; undefined: it is whole. */
  setSection(section: Section | undefined): void {
    this.view.section = section;
    this.stopTopple();
    this.showRobot();
  }

  /** Loads inside the robot are seen, through its modules. */
  lookThrough(isOn: boolean = this.view.xray): void {
    this.stopTopple();
    this.view.xray = isOn;
    this.showRobot();
  }

  /** Gives up the loads that are being worked out. */
  stop(): void {
    this.judge.stop();
  }

  /** All of it, from a side; undefined: from where it is seen now. */
  see(from: Place | undefined = OBLIQUE): void {
    const box = this.exhibit?.bounds ?? boundsOf(this.robot);
    const { low, high } = box ?? { low: [-2, -2, 0], high: [2, 2, 1] };
    this.stage.fit(low, high, from);
  }

  /** What is under the pointer, at a point of the window; `side` is a connection's. */
  point(cell: Cell | undefined, side?: number, x?: number, y?: number): void {
    this.pointed.point(cell, side, x, y);
  }

  /** Keeps the numbers of a module, or of its connection at a side, in the picture. */
  pin(cell: Cell, side?: number): void {
    this.pointed.pin(this.robot, cell, side);
  }

  /** False if nothing was pinned. */
  unpin(): boolean {
    return this.pointed.unpin();
  }

  /** Pins the worst connection, and goes where it is seen. */
  seeWorst(): void {
    const { worst } = this.view;
    if (worst !== undefined) {
      this.seeConnection(worst);
    }
  }

  /** Pins a connection of the robot in the picture, and goes where it is seen. */
  seeConnection(index: number): void {
    const { robot, shown } = this;
    const { connections } = shown!.answer!;
    this.straighten();
    this.stopTopple();
    this.pin(robot.cellAt(shown!.slots[connections[3 * index]]), connections[3 * index + 2]);
    this.stage.flyTo(this.view.connectionPoint(index));
    say(`${connectionText(robot, shown!, index)}: ${byId('details').innerText}`);
  }

  moveCursor(cell: Cell | undefined): void {
    this.unpin();
    this.bench.cursor = cell;
    this.view.showCursor(cell);
    this.point(cell);
    if (!cell) {
      return this.whereNext.preview([]);
    }
    this.stopTopple();
    const isGhost = this.bench.tool === 'add' && !this.exhibit && mayBe(this.bench, cell);
    this.whereNext.preview(isGhost ? [cell] : []);
    this.whereNext.previewRemoval(this.bench.tool === 'remove' && !this.exhibit && this.robot.has(cell) ? cell : undefined);
    const at = this.stage.project(new Vector3().fromArray(this.robot.lattice.place(cell)));
    const box = this.stage.canvas.getBoundingClientRect();
    this.pointed.tip.move((at?.x ?? 0) + box.left, (at?.y ?? 0) + box.top);
    this.sayCursor();
  }

  /** For who listens: what is at the cursor, or would come of a module there. */
  private sayCursor(): void {
    const { trial } = this.whereNext;
    const { cursor } = this.bench;
    if (cursor) {
      const text = showDetails(this.robot, this.shown, cursor, undefined);
      this.showPointed();
      say(trial ? `${text}; ${trialText(trial, this.finding?.answer)}` : text);
    }
  }

  setExaggeration(share: number): number {
    if (share > 0) {
      this.stopTopple();
    }
    const factor = share === 0 ? 0 : this.exaggerationMax() ** share;
    this.view.exaggeration = factor;
    return factor;
  }

  /** Back to the shape without load. */
  straighten(): void {
    const slider = byId<HTMLInputElement>('exaggeration');
    slider.value = '0';
    slider.dispatchEvent(new Event('input'));
  }

  async startTopple(): Promise<void> {
    if (this.fall) {
      this.straighten();
      await this.toppling.start(this.bench.robot, this.finding!).catch((error: unknown) => {
        tell(reasonOf(error), true);
      });
    }
  }

  /** Upright again; false if it was. */
  stopTopple(): boolean {
    const { isToppled, toppling } = this;
    const isFalling = isToppled || toppling.isAsking;
    toppling.stop();
    if (isToppled) {
      this.view.paint();
    }
    return isFalling;
  }

  /** It falls or lies: nothing is where it is built. */
  get isToppled(): boolean {
    return this.toppling.isToppled;
  }

  toggleTopple(): void {
    if (!this.stopTopple()) {
      void this.startTopple();
    }
  }

  /** Everything is drawn anew for a changed robot. */
  private changed(what: Change): void {
    const { robot, history } = this.bench;
    this.toppling.stop();
    this.view.exaggeration = this.exhibit ? 0 : this.view.exaggeration;
    this.exhibit = undefined;
    this.offer();
    // Colours of the robot as it was are not this one's, however soon its answer comes.
    this.view.paintOver = undefined;
    this.unpin();
    this.view.point([]);
    this.pointed.cell = undefined;
    this.whereNext.reset();
    this.finding = undefined;
    clearTimeout(this.lateShow);
    if (robot.count === 0) {
      this.found({ slots: new Int32Array(0) });
    } else {
      this.lateShow = window.setTimeout(() => this.showRobot(), LATE_MS);
      this.judge.ask(robot);
    }
    this.stage.setGravity(robot.gravity);
    if (what === 'robot') {
      this.see();
    }
    // Before the first robot there was none that an error could be about.
    if (what === 'robot' && (history.canUndo || history.canRedo)) {
      clearErrors();
    }
  }

  private found(finding: Finding): void {
    const { answer, isFirstLook } = finding;
    clearTimeout(this.lateShow);
    this.finding = finding;
    this.whereNext.knowsLoads = answer !== undefined && !isFirstLook;
    this.stage.isReady = true;
    this.showRobot();
    performance.mark('shown');
    this.showPointed();
    byId('progress').hidden = !isFirstLook || answer?.verdict === 'unstable';
    this.showToppling();
    void this.whereNext.update();
  }

  /** A robot that begins to topple is shown toppling, unless its user wants no motion. */
  private showToppling(): void {
    const { wasUnstable } = this;
    const answer = this.finding?.answer;
    this.wasUnstable = answer?.verdict === 'unstable';
    if (this.fall === 'topples' && !wasUnstable && !matchMedia('(prefers-reduced-motion: reduce)').matches) {
      void this.startTopple();
    }
  }

  /** Of the robot in the picture. */
  get shown(): Finding | undefined {
    return this.exhibit ? this.exhibit.finding : this.finding;
  }

  /** How the robot that is built comes down, if it does and nothing else is shown. */
  get fall(): 'topples' | 'breaks' | undefined {
    const answer = this.exhibit ? undefined : this.finding?.answer;
    const breaks = answer?.verdict === 'overload' && !this.finding?.isFirstLook;
    return answer?.verdict === 'unstable' ? 'topples' : breaks ? 'breaks' : undefined;
  }

  private showRobot(): void {
    const { robot, shown: finding } = this;
    const judged = finding?.answer && { answer: finding.answer, slots: finding.slots };
    this.view.show(robot, judged, this.isToppled);
    showFinding(robot, finding);
    this.showTrial();
    this.shownListeners.forEach((tell) => tell());
    this.scenery.show(robot, finding);
    showFacetLegend(robot, finding);
    if (!this.exhibit) {
      this.whereNext.paint();
    }
    this.stage.draw();
  }

  private showPointed(): void {
    const { view, robot, pointed: { cell, side, isPinned, tip } } = this;
    const slot = cell && robot.slot(cell);
    const isSeam = slot !== undefined && side !== undefined;
    const other = isSeam ? robot.slot(robot.lattice.neighbour(cell!, side)) : undefined;
    view.point([slot, other].filter((one) => one !== undefined));
    showDetails(robot, this.shown, cell, side);
    const { trial } = this.whereNext;
    const details = byId('details');
    if (trial) {
      const would = make('p', { className: 'would' }, trialText(trial, this.finding?.answer));
      would.dataset.verdict = trial.verdict ?? '';
      details.prepend(would);
    }
    // Who builds looks at the robot, and at the connection that is near.
    details.classList.toggle('brief', this.bench.tool !== 'look' && !isPinned);
    tip.show(details.childElementCount > 0);
  }

  /** What the ghost would come to. */
  private showTrial(): void {
    const { trial } = this.whereNext;
    showChip(this.robot, this.shown, this.exhibit ? undefined : trial, this.exhibit ? '' : this.noted);
    this.showPointed();
    if (trial && this.bench.cursor) {
      this.sayCursor();
    }
  }

  /** Draws the largest displacement as DRAWN_CELLS_MAX. */
  private exaggerationMax(): number {
    const { displacements } = this.finding?.answer ?? {};
    let largest = 0;
    for (let i = 0; displacements && i < displacements.length; i += MOTION_FIELDS) {
      largest = Math.max(largest, Math.hypot(displacements[i], displacements[i + 1], displacements[i + 2]));
    }
    return largest > 0 ? Math.max(10, (DRAWN_CELLS_MAX * this.bench.robot.pitchMm) / largest) : 10;
  }

  private setTheme(): void {
    this.scenery.setTheme(this.view);
    this.showRobot();
  }
}
