// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { CoreClient, Cancelled } from '../core/client';
import type { JudgedSteps, StageLoads, StageReport } from '../core/types';
import { Role } from '../model/cell';
import type { Box, EditedRobot } from '../model/edited_robot';
import type { Change } from '../model/history';
import { Recorder } from '../model/recorder';
import { STAGES, Sequence, type StageRobot } from '../model/sequence';
import type { App } from './app';
import { formatRatio, numberText } from './answer_panel';
import { drawBands } from './bands';
import { byId, icon, reasonOf, say, tell, type IconName } from './dom';
import type { Film } from './film';
import { openText, take } from './files';
import { findingOf } from './stage_finding';
import { followTheme } from './theme';
import { counted, t } from '../texts';

/** Steps in time: judges every stage of a robot's sequence, plays it, records another. */

/** A stage is shown for so long, and less if there are many. */
const STAGE_MS = 550;
const WHOLE_MS = 60_000;
/** A changed robot is judged anew when nothing has changed for so long. */
const DELAY_MS = 300;

/** A film has so many at most. */
const FILM_STAGES = 240;

/** The loads of so many stages are kept. */
const STAGES_KNOWN = 8;

/** An order is sought for so long. */
const ORDER_SECONDS = 10;

export class Timeline {
  private readonly client = new CoreClient();
  private judged?: JudgedSteps;
  private sequence?: Sequence;
  private bounds?: Box;
  private recorder?: Recorder;
  /** Which stage of which step is shown: three for each step; undefined: what is built. */
  private at?: number;
  private loads?: StageLoads;
  /** Of the stages around, which are played next; by stage. */
  private readonly known = new Map<number, StageLoads>();
  private isPlaying = false;
  /** When the stage that is played has begun. */
  private begun = 0;
  private timer = 0;
  /** What was asked for is played as soon as it is judged. */
  private isToPlay = false;
  /** Of what the core was asked; only the last question's answer is wanted. */
  private question = 0;

  constructor(private readonly app: App) {
    app.bench.robotListeners.push((what) => this.changed(what));
    app.stage.motions.push((now) => this.animate(now));
    this.button('stage-back', 'stepBack', () => this.step(-1));
    this.button('stages-play', 'play', () => this.toggle());
    this.button('stage-on', 'stepOn', () => this.step(1));
    byId('first-unsafe').onclick = () => this.toFirstUnsafe();
    byId('record').onclick = () => this.record();
    byId('build-on').onclick = () => this.buildOn();
    byId('order').onclick = () => void this.findOrder();
    byId('judge-steps').onclick = () => void this.judge();
    byId('sequence-stop').onclick = () => this.client.cancel();
    byId('save-steps').onclick = () => void take(app, 'json');
    byId<HTMLInputElement>('stage-slider').oninput = (event) => {
      this.pause();
      this.show(Number((event.target as HTMLInputElement).value));
    };
    byId('bands').onclick = (event) => this.pointAt(event);
    app.films.push(() => (this.sequence && (app.mode === 'stage' || !app.fall) ? this.film() : undefined));
    followTheme(() => this.drawBands());
    byId('scale').addEventListener('change', () => this.drawBands());
  }

  toggle(): void {
    if (this.isPlaying) {
      this.pause();
    } else if (this.sequence) {
      const isAtEnd = this.at === undefined || this.at === this.stageCount - 1;
      this.isPlaying = true;
      this.showPlaying();
      this.show(isAtEnd ? 0 : this.at!);
      this.app.stage.draw();
    }
  }

  toFirstUnsafe(): void {
    const first = this.judged?.report.first_unsafe;
    if (first) {
      this.pause();
      this.show(STAGES.length * first.step + STAGES.indexOf(first.stage));
      say(byId('stage-text').textContent ?? '');
    }
  }

  /** Begins to record, or ends it: the robot is then as it was at first, with the steps. */
  record(): void {
    const { bench } = this.app;
    if (!this.recorder) {
      this.buildOn();
      this.recorder = new Recorder(bench.robot);
      this.changed();
      return;
    }
    const { recorder } = this;
    this.recorder = undefined;
    if (recorder.steps.length > 0) {
      bench.history.replace(t('recording {0}', counted(recorder.steps.length, 'step')), recorder.result(bench.robot));
    }
    this.showRecording();
    this.changed();
  }

  /** The robot that is built is in the picture again. */
  private buildOn(): void {
    this.pause();
    this.at = undefined;
    if (this.app.mode === 'stage') {
      this.app.bench.closed = '';
      this.app.setExhibit(undefined);
    }
    this.showPlace();
  }

  private get stageCount(): number {
    return STAGES.length * (this.sequence?.stepCount ?? 0);
  }

  /** The robot is another one: what was judged is not its own any more. */
  private changed(what?: Change): void {
    const { robot, history } = this.app.bench;
    if (this.recorder && what === 'robot') {
      const { steps } = this.recorder;
      this.recorder = undefined;
      tell(t('The recording has ended, as another robot is here; {0} of it are not kept.', counted(steps.length, 'step')));
    }
    this.recorder?.follow(robot, history.isUndoing);
    this.showRecording();
    this.forget();
    clearTimeout(this.timer);
    const { hasSteps } = this;
    byId('order').hidden = robot.count === 0 || this.recorder !== undefined;
    byId('save-steps').hidden = !hasSteps || this.recorder !== undefined;
    byId('judge-steps').hidden = hasSteps || this.recorder !== undefined || !hasPlanned(robot);
    if (hasSteps && !this.recorder) {
      this.timer = window.setTimeout(() => void this.judge(), DELAY_MS);
    }
  }

  private get hasSteps(): boolean {
    const { surroundings, laterSteps } = this.app.bench.robot;
    return (surroundings.steps?.length ?? 0) + laterSteps > 0;
  }

  private forget(): void {
    ++this.question;
    this.client.cancel();
    this.pause();
    this.isToPlay = false;
    byId<HTMLButtonElement>('order').disabled = false;
    this.judged = this.sequence = this.at = this.loads = undefined;
    this.known.clear();
    this.app.bench.closed = '';
    byId('sequence').hidden = true;
    byId('build-on').hidden = true;
    byId('sequence-progress').hidden = true;
    byId('sequence-text').textContent = this.recorder ? recordingText(this.recorder) : '';
  }

  private async judge(): Promise<void> {
    const { robot } = this.app.bench;
    byId('judge-steps').hidden = true;
    const judged = await this.wait(t('Judging every stage …'), () =>
      this.client.judgeSteps(robot.toData(true).data, robot.name, robot.base),
    );
    if (judged) {
      this.open(robot, judged);
    }
  }

  private open(robot: EditedRobot, judged: JudgedSteps): void {
    this.judged = judged;
    this.sequence = new Sequence(robot, judged.transitions);
    this.bounds = this.sequence.bounds();
    byId('sequence').hidden = this.stageCount === 0;
    byId<HTMLInputElement>('stage-slider').max = String(this.stageCount - 1);
    byId('first-unsafe').hidden = judged.report.first_unsafe === null;
    byId('sequence-text').textContent = summary(judged);
    this.showPlace();
    say(summary(judged));
    if (this.isToPlay) {
      this.isToPlay = false;
      this.toggle();
    }
  }

  /** Seeks an order for the modules that are there, and shows the robot grow by it. */
  private async findOrder(): Promise<void> {
    const { bench } = this.app;
    const { robot } = bench;
    this.buildOn();
    this.forget();
    const found = await this.wait(t('Seeking an order, for {0} s at most …', ORDER_SECONDS), () =>
      this.client.findOrder(robot.toData(true).data, ORDER_SECONDS, robot.name, robot.base),
    );
    if (found?.structure) {
      this.isToPlay = await openText(bench, new TextEncoder().encode(found.structure), robot.name);
    } else if (found) {
      byId('sequence-text').textContent = found.text;
      say(found.text);
    }
  }

  /** Says that the core is busy, and in the end why it has no answer. */
  private async wait<Value>(doing: string, ask: () => Promise<Value>): Promise<Value | undefined> {
    const question = ++this.question;
    let text = doing;
    let answer: Value | undefined;
    const show = (isBusy: boolean) => {
      byId('sequence-progress').hidden = !isBusy;
      byId<HTMLButtonElement>('order').disabled = isBusy;
      byId('sequence-text').textContent = text;
    };
    show(true);
    try {
      answer = await ask();
      text = '';
    } catch (error) {
      const reason = reasonOf(error);
      text = error instanceof Cancelled ? t('Stopped.') : reason;
    }
    if (question !== this.question) {
      return undefined;
    }
    show(false);
    byId('judge-steps').hidden = answer !== undefined || !(this.hasSteps || hasPlanned(this.app.bench.robot));
    return answer;
  }

  private step(by: 1 | -1): void {
    this.pause();
    const next = this.at === undefined ? (by > 0 ? 0 : this.stageCount - 1) : this.at + by;
    this.show(Math.min(Math.max(next, 0), this.stageCount - 1));
    say(byId('stage-text').textContent ?? '');
  }

  /** A click on the bands. */
  private pointAt({ offsetX, offsetY }: MouseEvent): void {
    const { clientWidth, clientHeight } = byId('bands');
    const part = (share: number, count: number) => Math.min(Math.max(Math.floor(share * count), 0), count - 1);
    const step = part(offsetX / clientWidth, this.sequence?.stepCount ?? 1);
    this.pause();
    this.show(STAGES.length * step + part(offsetY / clientHeight, STAGES.length));
  }

  /** A stage, at the waypoint where it is at its worst. */
  private show(at: number): void {
    const { sequence, judged } = this;
    if (!sequence || !judged) {
      return;
    }
    this.at = at;
    this.begun = performance.now();
    this.loads = this.known.get(at);
    this.app.bench.closed = t('A stage of the steps is shown: “Back to building” ends that.');
    this.exhibit(this.isMoving ? 0 : (this.report!.waypoint ?? 0));
    this.showPlace();
    if (!this.loads) {
      void this.findLoads(at);
    }
    if (this.isPlaying && at + 1 < this.stageCount) {
      void this.findLoads(at + 1);
    }
  }

  /** Stage by stage, with its loads; of many steps some. */
  private async *film(): Film {
    const { judged, stageCount } = this;
    this.pause();
    for (let i = 0; i < Math.min(stageCount, FILM_STAGES) && judged === this.judged; ++i) {
      const at = stageCount <= FILM_STAGES ? i : Math.round((i * (stageCount - 1)) / (FILM_STAGES - 1));
      this.show(at);
      if (!this.known.has(at)) {
        await this.findLoads(at);
      }
      yield at === stageCount - 1 ? 3 * STAGE_MS : STAGE_MS;
    }
  }

  private get stage(): number {
    return this.at! % STAGES.length;
  }

  private get stepIndex(): number {
    return Math.floor(this.at! / STAGES.length);
  }

  /** Of the stage that is shown. */
  private get report(): StageReport | undefined {
    return this.at === undefined ? undefined : this.reportAt(this.at);
  }

  private reportAt(at: number): StageReport | undefined {
    return this.judged?.report.steps[Math.floor(at / STAGES.length)].stages[STAGES[at % STAGES.length]];
  }

  /** Modules are seen on their way, unless the user wants no motion. */
  private get isMoving(): boolean {
    const isShift = this.isPlaying && STAGES[this.stage] === 'shift';
    return isShift && !matchMedia('(prefers-reduced-motion: reduce)').matches;
  }

  private robotAt(waypoint: number): StageRobot {
    return this.sequence!.robotAt(this.stepIndex, STAGES[this.stage], waypoint);
  }

  private exhibit(waypoint: number): void {
    const robot = this.robotAt(waypoint);
    const { bounds } = this;
    this.app.setExhibit({ mode: 'stage', robot, finding: findingOf(robot, this.report!, this.loads), bounds });
  }

  /**
   * Colours come when the core has found the loads; meanwhile modules are grey. Those of the next stage are
   * found while this one is played.
   */
  private async findLoads(at: number): Promise<void> {
    const { judged } = this;
    try {
      const step = Math.floor(at / STAGES.length);
      const loads = await this.client.stage(step, at % STAGES.length, this.reportAt(at)?.waypoint ?? 0);
      if (judged !== this.judged) {
        return;
      }
      this.known.set(at, loads);
      [...this.known.keys()].slice(0, -STAGES_KNOWN).forEach((old) => this.known.delete(old));
      if (this.at === at) {
        this.loads = loads;
        this.exhibit(this.isMoving ? this.waypointNow(performance.now()) : (this.report!.waypoint ?? 0));
      }
    } catch (error) {
      if (!(error instanceof Cancelled)) {
        tell(reasonOf(error), true);
      }
    }
  }

  private get stageMs(): number {
    return Math.min(STAGE_MS, WHOLE_MS / this.stageCount);
  }

  private waypointNow(now: number): number {
    const last = Math.max(this.sequence!.waypointCount(this.stepIndex) - 1, 0);
    return last * Math.min(Math.max((now - this.begun) / this.stageMs, 0), 1);
  }

  private animate(now: number): boolean {
    if (!this.isPlaying || this.at === undefined) {
      return false;
    }
    if (now - this.begun < this.stageMs) {
      if (this.isMoving && this.sequence!.waypointCount(this.stepIndex) > 0) {
        this.app.moveExhibit(this.robotAt(this.waypointNow(now)));
      }
    } else if (this.at + 1 < this.stageCount) {
      // A core that is behind is waited for: what is played has its colours.
      if (this.known.has(this.at + 1) || !this.client.isBusy) {
        this.show(this.at + 1);
      }
    } else {
      this.pause();
      say(byId('sequence-text').textContent ?? '');
    }
    return this.isPlaying;
  }

  private pause(): void {
    const wasPlaying = this.isPlaying;
    const wasMoving = wasPlaying && this.at !== undefined && this.isMoving;
    this.isPlaying = false;
    if (wasMoving) {
      this.exhibit(this.report!.waypoint ?? 0);
    }
    this.showPlaying();
  }

  private showPlaying(): void {
    const button = byId('stages-play');
    button.replaceChildren(icon(this.isPlaying ? 'pause' : 'play'));
    button.setAttribute('aria-label', this.isPlaying ? t('Pause the steps') : t('Play the steps'));
  }

  /** Where in the sequence the picture is. */
  private showPlace(): void {
    byId('build-on').hidden = this.at === undefined;
    byId<HTMLButtonElement>('stage-back').disabled = this.at === 0;
    byId<HTMLButtonElement>('stage-on').disabled = this.at === this.stageCount - 1;
    const text = this.placeText();
    byId('stage-text').textContent = text;
    const slider = byId<HTMLInputElement>('stage-slider');
    slider.value = String(this.at ?? 0);
    slider.setAttribute('aria-valuetext', text);
    this.drawBands();
  }

  private placeText(): string {
    const { report, judged } = this;
    if (!report || !judged) {
      return t('The robot before the first step.');
    }
    const last = judged.texts.length - 1;
    const names = [t(STAGES[this.stage]), t(report.verdict)] as const;
    return t('Step {0} (of 0 to {1}), {2}: {3}. It does: {4}.', this.stepIndex, last, ...names, judged.texts[this.stepIndex]);
  }

  private drawBands(): void {
    if (this.judged) {
      const ink = getComputedStyle(document.body).color;
      drawBands(byId<HTMLCanvasElement>('bands'), this.judged.report, this.at, this.app.view.scale, ink);
    }
  }

  private showRecording(): void {
    const { recorder } = this;
    const button = byId('record');
    button.setAttribute('aria-pressed', String(recorder !== undefined));
    button.textContent = recorder ? t('End the recording') : t('Record steps');
    if (recorder) {
      byId('sequence-text').textContent = recordingText(recorder);
    }
  }

  private button(id: string, name: IconName, action: () => void): void {
    byId(id).append(icon(name));
    byId(id).onclick = action;
  }
}

const recordingText = ({ steps }: Recorder) =>
  t('Recording: {0}. Every change of the modules is one.', counted(steps.length, 'step'));

function hasPlanned(robot: EditedRobot): boolean {
  return Array.from({ length: robot.count }, (_, slot) => robot.roleAt(slot)).includes(Role.kPlanned);
}

function summary({ report, texts }: JudgedSteps): string {
  const isSafe = ({ stages }: (typeof report.steps)[number]) => STAGES.every((stage) => stages[stage].verdict === 'safe');
  const safe = report.steps.filter(isSafe).length;
  const ratio = report.load_ratio_max === null ? '' : `; ${t('largest load {0}', formatRatio(report.load_ratio_max))}`;
  const margin = report.margin_min_mm === null ? '' : `; ${t('smallest margin {0} mm', numberText(report.margin_min_mm))}`;
  const first = report.first_unsafe ? `; ${t('first unsafe: step {0}, {1}', report.first_unsafe.step, t(report.first_unsafe.stage))}` : '';
  return `${t('{0} of {1} safe in every stage', safe, counted(texts.length, 'step'))}${ratio}${margin}${first}.`;
}
