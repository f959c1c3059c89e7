// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Judge, type Finding } from '../core/judge';
import { MOTION_FIELDS } from '../core/types';
import { equal, type Cell } from '../model/cell';
import { widen, type Box, type EditedRobot } from '../model/edited_robot';
import type { Change } from '../model/history';
import type { Place } from '../model/lattice';
import type { Workbench } from '../model/workbench';
import type { ScaleName } from '../view/colours';
import { FacetView } from '../view/facets';
import { Ground } from '../view/ground';
import { LoadView } from '../view/loads';
import { ObstacleView } from '../view/obstacles';
import { RobotView } from '../view/robot_view';
import { Stage } from '../view/stage';
import { showDetails, showFaceLegend, showFacetLegend, showFinding, showLegend } from './answer_panel';
import { byId, clearErrors, say } from './dom';
import { placeLabels } from './labels';
import { followTheme, setTheme } from './theme';
import { Toppling, topples } from './toppling';
import { WhereNext } from './where_next';

/** The largest displacement is drawn as up to so many cells. */
const DRAWN_CELLS_MAX = 1.5;
/** A changed robot is shown without its answer if that takes longer. */
const LATE_MS = 80;

/** In pixels of the canvas; where there is little room the tools stand below it. */
function coveredByTools(): number {
  const tools = byId('toolbar');
  return getComputedStyle(tools).position === 'absolute' ? tools.offsetHeight : 0;
}

/** What is shown in place of the robot that is built: a moment of a sequence. */
export interface Exhibit {
  robot: EditedRobot;
  finding: Finding;
  /** Of all moments of the sequence. */
  bounds?: Readonly<Box>;
}

/** Of modules, and of obstacles as far from them as they are large; further ones would hide the robot. */
function boundsOf(robot: EditedRobot): Box | undefined {
  const own = robot.bounds();
  if (!own) {
    return undefined;
  }
  const reach = Math.max(4, ...own.high.map((high, k) => high - own.low[k]));
  const box: Box = { low: [...own.low], high: [...own.high] };
  const near = (place: Place) =>
    place.map((value, k) => Math.min(Math.max(value, own.low[k] - reach), own.high[k] + reach)) as unknown as Place;
  for (const { from, to, cells } of robot.obstacles.obstacles) {
    (cells ?? [from!, to!]).forEach((cell) => widen(box, near(robot.lattice.place(cell))));
  }
  return box;
}

/** The picture of what is on the workbench, and the answer to it. */
export class App {
  readonly stage = new Stage(byId<HTMLCanvasElement>('canvas'), coveredByTools);
  readonly view = new RobotView(this.stage);
  readonly whereNext: WhereNext;
  /** Of the robot that is built. */
  finding?: Finding;
  private exhibit?: Exhibit;
  /** Called before something else is shown than the robot that is built. */
  readonly exhibitListeners: (() => void)[] = [];
  private readonly ground = new Ground();
  private readonly obstacles = new ObstacleView();
  private readonly facets = new FacetView();
  private readonly loads = new LoadView();
  private readonly toppling = new Toppling(this.stage, this.ground, () => {
    byId('topple').textContent = this.isToppled ? 'Stand it up' : 'Let it topple';
  });
  private readonly judge = new Judge((finding) => this.found(finding));
  private lateShow = 0;
  private wasUnstable = false;
  private pointedCell?: Cell;
  private pointedSide?: number;

  constructor(readonly bench: Workbench) {
    this.whereNext = new WhereNext(bench, this.view);
    bench.robotListeners.push((what) => this.changed(what));
    this.stage.robot.add(this.loads.group);
    this.stage.scene.add(this.ground.group, this.obstacles.group, this.facets.mesh);
    this.stage.followers.push(() =>
      placeLabels(this.stage, this.view, this.robot, this.isToppled ? undefined : this.shown),
    );
    followTheme(() => this.setTheme());
  }

  /** The robot in the picture. */
  get robot(): EditedRobot {
    return this.exhibit?.robot ?? this.bench.robot;
  }

  get isExhibiting(): boolean {
    return this.exhibit !== undefined;
  }

  /** Shows something else than what is built, until that changes; undefined: what is built. */
  setExhibit(exhibit: Exhibit | undefined): void {
    if (exhibit || this.exhibit) {
      this.toppling.stop();
      const isFirst = !this.exhibit;
      if (isFirst) {
        this.exhibitListeners.forEach((tell) => tell());
        this.straighten();
      }
      this.exhibit = exhibit;
      this.offer();
      this.view.point([]);
      this.whereNext.preview([]);
      byId('topple').hidden = exhibit !== undefined || !this.canTopple;
      this.showRobot();
      this.showPointed();
      if (isFirst && exhibit?.bounds && !this.stage.holds(exhibit.bounds.low, exhibit.bounds.high)) {
        this.see(true);
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

  setScale(scale: ScaleName): void {
    this.view.scale = scale;
    showLegend(scale);
    showFaceLegend(scale);
    this.setTheme();
  }

  /** Gives up the loads that are being worked out. */
  stop(): void {
    this.judge.stop();
  }

  see(keepsSide = false): void {
    const box = this.exhibit?.bounds ?? boundsOf(this.robot);
    const { low, high } = box ?? { low: [-2, -2, 0], high: [2, 2, 1] };
    this.stage.fit(low, high, keepsSide);
  }

  /** What is under the pointer; `side` is a connection's. */
  point(cell: Cell | undefined, side?: number): void {
    const { pointedCell } = this;
    const isSame = (cell && pointedCell ? equal(cell, pointedCell) : cell === pointedCell) && side === this.pointedSide;
    if (!isSame) {
      this.pointedCell = cell;
      this.pointedSide = side;
      this.showPointed();
    }
  }

  moveCursor(cell: Cell | undefined): void {
    this.bench.cursor = cell;
    this.view.showCursor(cell);
    this.point(cell);
    if (cell) {
      this.stopTopple();
      say(showDetails(this.robot, this.shown, cell, undefined) + this.whereNext.trialText(cell));
    }
  }

  setExaggeration(share: number): number {
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

  startTopple(): void {
    if (this.finding?.answer && !this.exhibit) {
      this.toppling.start(this.bench.robot, this.finding.answer);
    }
  }

  /** Upright again; false if it was. */
  stopTopple(): boolean {
    const { isToppled } = this;
    this.toppling.stop();
    return isToppled;
  }

  /** It falls or lies: nothing is where it is built. */
  get isToppled(): boolean {
    return this.toppling.isToppled;
  }

  toggleTopple(): void {
    if (!this.stopTopple()) {
      this.startTopple();
    }
  }

  /** Everything is drawn anew for a changed robot. */
  private changed(what: Change): void {
    const { robot, history } = this.bench;
    this.toppling.stop();
    this.exhibit = undefined;
    this.offer();
    // Colours of the robot as it was are not this one's, however soon its answer comes.
    this.view.paintOver = undefined;
    this.view.point([]);
    this.pointedCell = undefined;
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
    byId('topple').hidden = !this.canTopple || this.exhibit !== undefined;
    if (this.canTopple && !wasUnstable && !matchMedia('(prefers-reduced-motion: reduce)').matches) {
      this.startTopple();
    }
  }

  /** Of the robot in the picture. */
  private get shown(): Finding | undefined {
    return this.exhibit ? this.exhibit.finding : this.finding;
  }

  private get canTopple(): boolean {
    return this.finding?.answer !== undefined && topples(this.finding.answer);
  }

  private showRobot(): void {
    const { robot, shown: finding } = this;
    const judged = finding?.answer && { answer: finding.answer, slots: finding.slots };
    this.view.show(robot, judged);
    showFinding(robot, finding);
    const bounds = robot.bounds() ?? { low: [0, 0, 0], high: [0, 0, 0] };
    const middle: [number, number] = [
      (bounds.low[0] + bounds.high[0]) / 2,
      (bounds.low[1] + bounds.high[1]) / 2,
    ];
    const reach = Math.max(bounds.high[0] - bounds.low[0], bounds.high[1] - bounds.low[1]) + 10;
    this.ground.place(robot.floorHeight, middle, reach, robot.hasFloor);
    this.ground.show(robot, finding?.answer?.stability);
    this.obstacles.show(robot);
    this.loads.show(robot);
    this.facets.show(robot, judged);
    showFacetLegend(robot, finding);
    if (!this.exhibit) {
      this.whereNext.paint();
    }
    this.stage.draw();
  }

  private showPointed(): void {
    const { view, robot, pointedCell, pointedSide } = this;
    const slot = pointedCell && robot.slot(pointedCell);
    const isSeam = slot !== undefined && pointedSide !== undefined;
    const other = isSeam ? robot.slot(robot.lattice.neighbour(pointedCell!, pointedSide)) : undefined;
    view.point([slot, other].filter((one) => one !== undefined));
    showDetails(robot, this.shown, pointedCell, pointedSide);
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
    setTheme(this.view, this.ground, [this.obstacles, this.loads]);
    this.showRobot();
  }
}
