// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { Judge, type Finding } from '../core/judge';
import { Places, TRIAL_COUNT_MAX } from '../core/places';
import { Kind, LOAD_FIELDS, VERDICTS, type Cell, type Trial } from '../core/types';
import { History, type Change } from '../model/history';
import { DIRECTIONS, PITCH_INDEX, Robot, plus } from '../model/robot';
import { UNKNOWN, brokenColour, hex, loadColour, mix, verdictColour, type Rgb, type ScaleName } from '../view/colours';
import { Ground } from '../view/ground';
import { FaceCode, RobotView } from '../view/robot_view';
import { Stage } from '../view/stage';
import { Topple } from '../view/topple';
import { connectionText, formatRatio, showDetails, showFaceLegend, showFinding, showLegend } from './answer_panel';
import { byId, clearErrors, make, say } from './dom';

const codeOf = ({ verdict }: Trial) => (verdict < 0 ? FaceCode.kNone : ((verdict + 1) as FaceCode));

export type Tool = 'look' | 'add' | 'remove' | 'paint';

export const KIND_NAMES = ['existing', 'planned', 'fixed'] as const;

/** The largest displacement is drawn as up to so many cells. */
const DRAWN_CELLS_MAX = 1.5;
/** A changed robot is shown without its answer if that takes longer. */
const LATE_MS = 80;
/** No more modules than this in one row. */
export const ROW_MAX = 100;

/** In pixels of the canvas; where there is little room the tools stand below it. */
function coveredByTools(): number {
  const tools = byId('toolbar');
  return getComputedStyle(tools).position === 'absolute' ? tools.offsetHeight : 0;
}

/** The page's state and what can be done to it. Everything that happens ends in changed(). */
export class App {
  readonly stage = new Stage(byId<HTMLCanvasElement>('canvas'), coveredByTools);
  readonly view = new RobotView(this.stage);
  readonly ground = new Ground();
  readonly history = new History(new Robot(), (what) => this.changed(what));
  readonly places = new Places();
  private readonly judge = new Judge((finding) => this.found(finding));
  finding?: Finding;
  tool: Tool = 'add';
  kind = Kind.kExisting;
  /** Where the keyboard is. */
  cursor?: Cell;
  private showsFaces = false;
  private wasUnstable = false;
  private previewed: readonly Cell[] = [];
  private isTrying = false;
  private lateShow = 0;
  private topple?: { motion: Topple; begun: number };
  private pointedCell?: Cell;
  private pointedSide?: number;
  /** Called after every change of the robot. */
  robotListeners: ((what: Change) => void)[] = [];
  /** Called after every choice of a tool, or of what it attaches. */
  toolListeners: (() => void)[] = [];

  constructor() {
    this.stage.scene.add(this.ground.group);
    this.stage.beforeFrame = (now) => this.animate(now);
    this.stage.afterFrame = () => this.placeLabels();
    this.setTheme();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.setTheme());
  }

  get robot(): Robot {
    return this.history.robot;
  }

  edit(label: string, cells: readonly Cell[], kind: Kind | undefined): void {
    performance.mark('edit');
    try {
      this.history.edit(label, cells, kind);
    } catch (error) {
      say(error instanceof Error ? error.message : String(error));
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

  setTool(tool: Tool, kind = this.kind): void {
    const isOtherKind = kind !== this.kind;
    this.tool = tool;
    this.kind = kind;
    this.preview(tool === 'add' ? this.previewed : []);
    if (isOtherKind) {
      void this.updateFaces();
    }
    this.toolListeners.forEach((listener) => listener());
  }

  setScale(scale: ScaleName): void {
    this.view.scale = scale;
    showLegend(scale);
    showFaceLegend(scale);
    this.setTheme();
  }

  stop(): void {
    this.judge.stop();
  }

  see(keepsSide = false): void {
    const bounds = this.robot.bounds() ?? { low: [-2, -2, 0] as Cell, high: [2, 2, 1] as Cell };
    this.stage.fit(bounds.low, bounds.high, keepsSide);
  }

  /** What is under the pointer; `side` is a connection's. */
  point(cell: Cell | undefined, side?: number): void {
    const isSame = String(cell) === String(this.pointedCell) && side === this.pointedSide;
    if (!isSame) {
      this.pointedCell = cell;
      this.pointedSide = side;
      this.showPointed();
    }
  }

  moveCursor(cell: Cell | undefined): void {
    this.cursor = cell;
    this.view.showCursor(cell);
    this.point(cell);
    if (cell) {
      say(showDetails(this.robot, this.finding, cell, undefined) + this.trialText(cell));
    }
  }

  /** Modules that would be attached; coloured when it is known what would come of it. */
  preview(cells: readonly Cell[]): void {
    this.previewed = cells;
    this.showPreview();
    void this.tryPreviewed();
  }

  setShowsFaces(isShown: boolean): void {
    this.showsFaces = isShown;
    if (!isShown) {
      this.places.reset();
    }
    void this.updateFaces();
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

  get canTopple(): boolean {
    return this.finding?.answer?.verdict === 'unstable' && this.finding.answer.stability.edge !== null;
  }

  startTopple(): void {
    const edge = this.finding?.answer?.stability.edge;
    if (this.canTopple && edge) {
      const pitch = this.robot.material[PITCH_INDEX];
      const scaled = edge.map(([x, y]) => [x / pitch, y / pitch]) as [[number, number], [number, number]];
      this.topple = { motion: new Topple(this.robot, scaled), begun: performance.now() };
      this.stage.draw();
    }
  }

  /** Upright again. */
  stopTopple(): void {
    this.topple = undefined;
    this.stage.robot.matrixAutoUpdate = true;
    this.stage.robot.updateMatrix();
    this.ground.follow(undefined);
    this.stage.draw();
  }

  /** Everything is drawn anew for a changed robot. */
  private changed(what: Change): void {
    this.stopTopple();
    this.places.reset();
    this.view.point([]);
    this.pointedCell = undefined;
    this.preview([]);
    this.finding = undefined;
    clearTimeout(this.lateShow);
    if (this.robot.count === 0) {
      this.found({ slots: new Int32Array(0) });
    } else {
      this.lateShow = window.setTimeout(() => this.showRobot(), LATE_MS);
      this.judge.ask(this.robot);
    }
    if (what === 'robot') {
      this.see();
    }
    // Before the first robot there was none that an error could be about.
    if (what === 'robot' && (this.history.canUndo || this.history.canRedo)) {
      clearErrors();
    }
    this.robotListeners.forEach((listener) => listener(what));
  }

  private found(finding: Finding): void {
    clearTimeout(this.lateShow);
    const { wasUnstable } = this;
    this.wasUnstable = finding.answer?.verdict === 'unstable';
    this.finding = finding;
    this.stage.isReady = true;
    this.showRobot();
    performance.mark('shown');
    this.showPointed();
    byId('progress').hidden = !finding.isFirstLook || finding.answer?.verdict === 'unstable';
    byId('topple').hidden = !this.canTopple;
    if (this.canTopple && !wasUnstable && !matchMedia('(prefers-reduced-motion: reduce)').matches) {
      this.startTopple();
    }
    void this.updateFaces();
  }

  private showRobot(): void {
    const { robot, finding } = this;
    const judged = finding?.answer && { answer: finding.answer, slots: finding.slots };
    this.view.show(robot, judged);
    showFinding(robot, finding);
    const bounds = robot.bounds() ?? { low: [0, 0, 0], high: [0, 0, 0] };
    const middle: [number, number] = [
      (bounds.low[0] + bounds.high[0]) / 2,
      (bounds.low[1] + bounds.high[1]) / 2,
    ];
    const reach = Math.max(bounds.high[0] - bounds.low[0], bounds.high[1] - bounds.low[1]) + 10;
    this.ground.place(robot.supportZ - 0.5, middle, reach);
    this.ground.show(finding?.answer?.stability, robot.material[PITCH_INDEX], this.massHeight());
    this.paintFaces();
    this.stage.draw();
  }

  /** Of the centre of mass above the ground, in cells. */
  private massHeight(): number {
    let sum = 0;
    for (let slot = 0; slot < this.robot.count; ++slot) {
      sum += this.robot.cellAt(slot)[2];
    }
    return sum / Math.max(this.robot.count, 1) - this.robot.supportZ + 0.5;
  }

  private showPreview(): void {
    const [place, ...others] = this.previewed;
    const { kind } = this;
    const trial = place && others.length === 0 ? this.places.known(place, kind) : undefined;
    const isKnown = trial !== undefined && trial.verdict >= 0;
    const code = isKnown && VERDICTS[trial.verdict] !== 'safe' ? codeOf(trial) : FaceCode.kNone;
    this.view.showGhosts(this.previewed, kind, isKnown ? this.trialColour(trial) : UNKNOWN, code);
  }

  /** One place at a time, and always where the pointer is now. */
  private async tryPreviewed(): Promise<void> {
    if (this.isTrying || this.robot.count === 0 || this.robot.count > TRIAL_COUNT_MAX) {
      return;
    }
    this.isTrying = true;
    let isCurrent = true;
    while (isCurrent && this.previewed.length === 1 && !this.places.known(this.previewed[0], this.kind)) {
      isCurrent = (await this.places.find(this.robot, this.previewed[0], this.kind)) !== undefined;
      this.showPreview();
    }
    this.isTrying = false;
  }

  private showPointed(): void {
    const { view, robot } = this;
    const slot = this.pointedCell && robot.slot(this.pointedCell);
    const side = this.pointedSide === undefined ? undefined : DIRECTIONS[this.pointedSide];
    const other = slot !== undefined && side ? robot.slot(plus(this.pointedCell!, side)) : undefined;
    view.point([slot, other].filter((one) => one !== undefined));
    showDetails(robot, this.finding, this.pointedCell, this.pointedSide);
  }

  private get knowsLoads(): boolean {
    return this.finding?.answer !== undefined && !this.finding.isFirstLook;
  }

  /** Draws what is known of free faces. */
  private paintFaces(): void {
    const code = (place: Cell) => (this.knowsLoads ? this.faceCode(place) : FaceCode.kWaiting);
    this.view.showFaces(this.showsFaces ? code : undefined);
  }

  /** Finds out what is not known of free faces. */
  private async updateFaces(): Promise<void> {
    const { robot, kind } = this;
    const button = byId('faces');
    this.paintFaces();
    button.textContent = 'Where next?';
    byId('face-legend').hidden = !this.showsFaces;
    if (!this.showsFaces || !this.knowsLoads) {
      return;
    }
    const places = robot.freePlaces();
    const isDone = await this.places.findAll(robot, places, kind, (count) => {
      if (this.showsFaces && this.robot === robot) {
        button.textContent = `${Math.round((100 * count) / places.length)} %`;
        this.paintFaces();
      }
    });
    if (isDone && this.showsFaces) {
      button.textContent = 'Where next?';
      const safe = places.filter((place) => this.places.known(place, kind)?.verdict === 0).length;
      say(`${safe} of ${places.length} free places are safe for one more ${KIND_NAMES[kind]} module`);
    }
  }

  private faceCode(place: Cell): FaceCode {
    if (place[2] < this.robot.supportZ) {
      return FaceCode.kNone;
    }
    const trial = this.places.known(place, this.kind);
    if (!trial) {
      return FaceCode.kWaiting;
    }
    return codeOf(trial);
  }

  private trialColour(trial: Trial): Rgb {
    const verdict = VERDICTS[trial.verdict];
    return verdict === 'safe'
      ? loadColour(this.view.scale, Math.max(trial.ratio, 0))
      : verdictColour(verdict, this.view.scale);
  }

  private trialText(cell: Cell): string {
    const trial = this.robot.has(cell) ? undefined : this.places.known(cell, this.kind);
    return trial && trial.verdict >= 0 ? `, would be ${VERDICTS[trial.verdict]}` : '';
  }

  /** Draws the largest displacement as DRAWN_CELLS_MAX. */
  private exaggerationMax(): number {
    const { displacements } = this.finding?.answer ?? {};
    let largest = 0;
    for (let i = 0; displacements && i < displacements.length; i += 6) {
      largest = Math.max(largest, Math.hypot(displacements[i], displacements[i + 1], displacements[i + 2]));
    }
    const pitch = this.robot.material[PITCH_INDEX];
    return largest > 0 ? Math.max(10, (DRAWN_CELLS_MAX * pitch) / largest) : 10;
  }

  private animate(now: number): boolean {
    let isMoving = false;
    if (this.topple) {
      const seconds = (now - this.topple.begun) / 1000;
      if (this.topple.motion.isOver(seconds)) {
        this.stopTopple();
      } else {
        this.stage.robot.matrixAutoUpdate = false;
        this.stage.robot.matrix.copy(this.topple.motion.matrix(Math.max(seconds, 0)));
        this.ground.follow(this.stage.robot.matrix);
        isMoving = true;
      }
    }
    return this.moreMotion(now) || isMoving;
  }

  /** Of the trace player; true while it plays. */
  moreMotion: (now: number) => boolean = () => false;

  /** Texts that stand in the picture. */
  private placeLabels(): void {
    const labels = byId('labels');
    const { worst } = this.view;
    const { finding } = this;
    if (worst === undefined || !finding?.answer || this.topple || this.view.paintOver) {
      labels.replaceChildren();
      return;
    }
    const at = this.stage.project(this.view.connectionPoint(worst));
    const ratio = finding.answer.loads[LOAD_FIELDS * worst];
    const label = (labels.firstElementChild ?? make('span')) as HTMLElement;
    label.textContent = formatRatio(ratio);
    label.className = ratio >= 1 - 1e-9 ? 'label breaks' : 'label';
    label.title = connectionText(this.robot, finding, worst);
    label.hidden = !at;
    if (at) {
      label.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
    }
    if (!label.parentElement) {
      labels.replaceChildren(label);
    }
  }

  private setTheme(): void {
    const isDark = matchMedia('(prefers-color-scheme: dark)').matches;
    const ink: Rgb = isDark ? [236, 238, 240] : [28, 32, 38];
    const { scale } = this.view;
    const codes = [
      loadColour(scale, 0),
      brokenColour(scale),
      verdictColour('unstable', scale),
      UNKNOWN,
      mix(UNKNOWN, isDark ? [0, 0, 0] : [255, 255, 255], 0.6),
    ];
    this.view.setTheme(ink, codes);
    this.ground.colours = {
      ink: isDark ? [0.62, 0.66, 0.7] : [0.36, 0.41, 0.46],
      polygon: isDark ? 0x2f6178 : 0x9cc3d1,
      outline: isDark ? 0x7fb4c9 : 0x3f6b7d,
      mass: hex(ink),
      warn: isDark ? 0xd08be8 : 0x8e3fb2,
    };
    this.showRobot();
  }
}
