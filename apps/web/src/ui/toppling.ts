// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Finding } from '../core/judge';
import { Question } from '../core/question';
import { MOTION_FIELDS } from '../core/types';
import { widen, type Box, type EditedRobot } from '../model/edited_robot';
import { UNSTABLE } from '../view/colours';
import type { Ground } from '../view/ground';
import { FallingPieces } from '../view/pieces';
import type { RobotView } from '../view/robot_view';
import type { Stage } from '../view/stage';

/** What breaks is looked at before it falls. */
const LOOK_SECONDS = 0.7;
const SLOWLY = 0.2;
/** A fall takes a few tenths of a second: its film is slower. */
const FILM_SPEED = 0.25;
/** Of a film: each moment, and the last one. */
const MOMENT_SECONDS = 0.07;
const END_SECONDS = 1.5;
/** Where no floor ends a fall, pieces leave the picture so many cells below the robot. */
const DEPTH_CELLS = 6;

/** Lets a robot topple, or break and its pieces fall; what has fallen lies until it is stood up. */
export class Toppling {
  private readonly question = new Question();
  private playing?: { pieces: FallingPieces; seconds: number; last: number };
  /** Rounds of the fall whose modules have its colour. */
  private begun = 0;
  isSlow = false;
  /** While its moments are drawn one by one. */
  private isHeld = false;

  constructor(
    private readonly stage: Stage,
    private readonly view: RobotView,
    private readonly ground: Ground,
    private readonly tell: () => void,
  ) {
    stage.motions.push((now) => this.move(now));
  }

  /** It falls or lies. */
  get isToppled(): boolean {
    return this.playing !== undefined;
  }

  get isAsking(): boolean {
    return this.question.isBusy;
  }

  get pieces(): FallingPieces | undefined {
    return this.playing?.pieces;
  }

  /** Asks the core what falls, and shows it, unless it is stopped before. Throws CoreError. */
  async start(robot: EditedRobot, finding: Finding): Promise<void> {
    const { data, slots } = robot.toData();
    const asked = this.question.ask((core) => core.cascade(data));
    this.tell();
    const breaking = await asked.finally(() => this.tell());
    if (breaking) {
      const pieces = new FallingPieces(robot, slots, breaking);
      this.playing = { pieces, seconds: 0, last: 0 };
      // Whoever else moves or colours modules ends that.
      this.tell();
      this.view.show(robot, { answer: finding.answer!, slots: finding.slots }, true);
      this.view.exaggeration = 1;
      this.keepInPicture(robot, slots, pieces);
      this.play();
    }
  }

  /** From the beginning; where nothing may move the end alone. */
  play(): void {
    const { playing } = this;
    if (playing) {
      const isStill = matchMedia('(prefers-reduced-motion: reduce)').matches;
      const { breaking, seconds } = playing.pieces;
      const hasBroken = breaking.cascade.rounds[0]?.broken.length > 0;
      playing.seconds = isStill ? seconds : hasBroken ? -LOOK_SECONDS : 0;
      playing.last = performance.now();
      this.draw();
    }
  }

  /** Draws the fall moment by moment, until it is stopped; gives how long each lasts, in ms. */
  *moments(): Generator<number> {
    const { playing } = this;
    this.isHeld = true;
    try {
      const end = playing?.pieces.seconds ?? 0;
      for (let moment = 0, at = 0; playing && playing === this.playing && at < end; ++moment) {
        at = Math.min(moment * MOMENT_SECONDS * FILM_SPEED, end);
        playing.seconds = at;
        this.draw();
        yield 1000 * (moment === 0 ? LOOK_SECONDS : at < end ? MOMENT_SECONDS : END_SECONDS);
      }
    } finally {
      this.isHeld = false;
    }
  }

  /** Upright again; colours follow with the view's paint(). */
  stop(): void {
    this.question.cancel();
    if (this.playing) {
      this.playing = undefined;
      this.begun = 0;
      this.view.paintOver = undefined;
      this.view.exaggeration = 0;
      this.view.pose(undefined);
      this.ground.follow(undefined);
      this.stage.draw();
    }
    this.tell();
  }

  /** The camera steps back where the robot would leave the picture. */
  private keepInPicture(robot: EditedRobot, slots: Int32Array, pieces: FallingPieces): void {
    const { low, high } = robot.bounds()!;
    const box: Box = { low: [...low], high: [...high] };
    const motions = pieces.at(pieces.seconds);
    for (const slot of slots) {
      const [x, y, z] = robot.placeAt(slot).map((value, k) => value + motions[MOTION_FIELDS * slot + k] / robot.pitchMm);
      widen(box, [x, y, Math.max(z, low[2] - DEPTH_CELLS)]);
    }
    if (!this.stage.holds(box.low, box.high)) {
      this.stage.fit(box.low, box.high);
    }
  }

  private move(now: number): boolean {
    const { playing } = this;
    if (!playing || this.isHeld || playing.seconds >= playing.pieces.seconds) {
      return false;
    }
    playing.seconds += (Math.max(now - playing.last, 0) / 1000) * (this.isSlow ? SLOWLY : 1);
    playing.last = now;
    this.draw();
    return true;
  }

  private draw(): void {
    const { pieces, seconds } = this.playing!;
    const { view } = this;
    view.pose(pieces.at(seconds));
    this.ground.follow(pieces.whole(seconds));
    const begun = pieces.begun(seconds);
    if (begun !== this.begun) {
      this.begun = begun;
      const fallen = pieces.fallen(begun);
      view.paintOver = fallen.size > 0 ? (slot) => (fallen.has(slot) ? UNSTABLE : undefined) : undefined;
      view.paint();
    }
  }
}
