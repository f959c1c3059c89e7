// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import VOCABULARY from 'virtual:vocabulary';
import { CoreClient, Cancelled } from '../core/client';
import { LogEvent, type Choice, type Trace } from '../core/types';
import { Role } from '../model/cell';
import { UNKNOWN, UNSTABLE, css, loadColour, brokenColour, mix, type Rgb } from '../view/colours';
import { Packets } from '../view/packets';
import { moduleLoads, type ModuleLoads } from '../view/robot_view';
import type { App } from './app';
import { formatRatio } from './answer_panel';
import { byId, icon, make, reasonOf, say, tell, type IconName } from './dom';
import { digits, t, word, type Text } from '../texts';

/** Plays what the modules tell each other until every one of them knows the verdict. */

/** By agent::Phase, as the vocabulary's phases. */
const PHASE_COLOURS: Rgb[] = [
  [150, 156, 164], [86, 156, 196], [70, 120, 190], [64, 148, 140], [120, 160, 90],
  [190, 160, 70], [226, 130, 60], [190, 100, 150], [150, 90, 180], [90, 100, 110],
];
const MEANINGS: Text[] = ['link: greeting, acknowledgement', 'wave', 'order, down the tree', 'report, up the tree', 'vector between neighbours', 'planned module'];
const MEANING_COLOURS: Rgb[] = [
  [150, 156, 164], [47, 128, 206], [232, 108, 28], [32, 150, 90], [176, 78, 190], [205, 160, 0],
];
const DIM: Rgb = [140, 145, 152];
const SPEEDS = [0.01, 0.05, 0.1, 0.25, 0.5, 1, 2, 5, 20];
const SPEED_FIRST = 0.25;
const EVENT_INTEGERS = 4;

interface Moment {
  phases: Int8Array;
  verdicts: Int8Array;
  packets: number;
  iterations: number;
  /** What the root has ordered last. */
  order: number;
}

export class Player {
  private readonly client = new CoreClient();
  private readonly packets = new Packets();
  trace?: Trace;
  private slots: Int32Array = new Int32Array(0);
  /** The module in each slot; those from agentCount on are planned. */
  private moduleOf = new Int32Array(0);
  private agentCount = 0;
  /** The first that the root orders: one order to it for each step. */
  private rootChild = -1;
  private allKnow = false;
  private loads?: ModuleLoads;
  private time = 0;
  private end = 0;
  private isPlaying = false;
  private lastFrame = 0;
  private durationMax = 0;
  /** Times at which step-on stops: orders of the root, changes of phase. */
  private stops: number[] = [];
  private phaseStops: number[] = [];
  private readonly cursor = { next: 0 };
  private moment: Moment = this.begin(0);

  constructor(private readonly app: App) {
    app.stage.scene.add(this.packets.points);
    app.stage.motions.push((now) => this.animate(now));
    app.bench.robotListeners.push(() => this.close());
    app.exhibitListeners.push(() => this.close());
    app.fallListeners.push(() => app.isToppled && this.trace && this.close());
    byId('simulate').onclick = () => void this.run();
    this.button('phase-back', 'phaseBack', () => this.jump(this.phaseStops, -1));
    this.button('step-back', 'stepBack', () => this.jump(this.stops, -1));
    this.button('play', 'play', () => this.toggle());
    this.button('step-on', 'stepOn', () => this.jump(this.stops, 1));
    this.button('phase-on', 'phaseOn', () => this.jump(this.phaseStops, 1));
    byId<HTMLInputElement>('time').oninput = (event) => {
      this.pause();
      this.show((Number((event.target as HTMLInputElement).value) / 10_000) * this.end);
    };
    offer('method', VOCABULARY.methods);
    offer('link', VOCABULARY.links);
    const options = SPEEDS.map((speed) =>
      make('option', { value: String(speed), textContent: `${digits(String(speed))} ×`, selected: speed === SPEED_FIRST }),
    );
    byId('speed').append(...options);
    const legend = MEANINGS.map((text, i) => {
      const swatch = make('span', { className: 'swatch round' });
      swatch.style.backgroundColor = css(MEANING_COLOURS[i]);
      return make('li', {}, swatch, t(text));
    });
    byId('packet-legend').append(...legend);
  }

  /** The robot has changed, or another one is shown: what was played is not its own. */
  close(): void {
    this.client.cancel();
    this.pause();
    this.trace = undefined;
    this.app.view.paintOver = undefined;
    this.packets.clear();
    byId('player').hidden = true;
    byId('simulate').textContent = t('Let the robot find out');
  }

  toggle(): void {
    if (!this.trace) {
      void this.run();
    } else if (this.isPlaying) {
      this.pause();
    } else {
      this.play();
    }
  }

  step(direction: 1 | -1): void {
    this.jump(this.stops, direction);
  }

  private async run(): Promise<void> {
    const { app } = this;
    if (app.bench.refusesNow()) {
      return;
    }
    if (this.client.isBusy) {
      this.close();
      return;
    }
    app.stopTopple();
    this.close();
    byId('simulate').textContent = t('Stop the simulation');
    const value = (id: string) => Number(byId<HTMLSelectElement>(id).value);
    const { data, slots } = app.bench.robot.toData();
    try {
      const choice = { method: value('method'), link: value('link'), seed: 1, lossPerMille: 0 };
      const trace = await this.client.simulate(data, choice);
      this.open(trace, slots);
    } catch (error) {
      if (!(error instanceof Cancelled)) {
        tell(reasonOf(error), true);
      }
    }
    byId('simulate').textContent = this.trace ? t('Once more') : t('Let the robot find out');
  }

  private open(trace: Trace, slots: Int32Array): void {
    const { app } = this;
    app.stopTopple();
    this.trace = trace;
    this.slots = slots;
    this.moduleOf = new Int32Array(slots.length);
    slots.forEach((slot, module) => (this.moduleOf[slot] = module));
    this.agentCount = slots.filter((slot) => app.bench.robot.roleAt(slot) !== Role.kPlanned).length;
    const answer = app.finding?.answer;
    this.loads = answer?.has_loads ? moduleLoads({ answer, slots: app.finding!.slots }) : undefined;
    const { times, events } = trace;
    this.end = 0;
    this.durationMax = 0;
    const stops = new Set<number>([0]);
    const phases = new Set<number>([0]);
    this.rootChild = -1;
    let phase = 0;
    for (let i = 0; 2 * i < times.length; ++i) {
      this.end = Math.max(this.end, times[2 * i] + times[2 * i + 1]);
      this.durationMax = Math.max(this.durationMax, times[2 * i + 1]);
      const [kind, from, to] = events.subarray(EVENT_INTEGERS * i, EVENT_INTEGERS * i + 3);
      if (kind === LogEvent.kOrder && from === trace.root && this.rootChild < 0) {
        this.rootChild = to;
      }
      if (kind === LogEvent.kOrder && from === trace.root && this.rootChild === to) {
        stops.add(times[2 * i]);
      } else if (kind === LogEvent.kPhase && to > phase) {
        phase = to;
        phases.add(times[2 * i]);
        stops.add(times[2 * i]);
      }
    }
    const ordered = (set: Set<number>) => [...set, this.end].sort((a, b) => a - b);
    this.stops = ordered(stops);
    this.phaseStops = ordered(phases);
    this.drawTimeline();
    byId('player').hidden = false;
    byId('trace-result').textContent = this.result(trace);
    byId('player').scrollIntoView({ block: 'nearest' });
    this.app.view.paintOver = (slot) => this.colour(slot);
    this.show(0);
    this.play();
  }

  private result(trace: Trace): string {
    const ratio = trace.load_ratio_max === null ? '' : `, ${t('load ratio {0}', formatRatio(trace.load_ratio_max))}`;
    const time = trace.simulated_s === null ? '' : `${digits(trace.simulated_s.toFixed(2))} s, `;
    const agree = trace.all_modules_agree ? t('all modules agree') : t('not all modules agree');
    const cut = trace.is_complete ? '' : ` ${t('Only the first million events are played.')}`;
    const counts = [trace.rounds, trace.messages, trace.iterations] as const;
    return t('The robot\'s own verdict: {0}; {1}. {2}{3} rounds, {4} packets, {5} iterations.', `${word(trace.verdict)}${ratio}`, agree, time, ...counts) + cut;
  }

  private play(): void {
    if (this.time >= this.end) {
      this.show(0);
    }
    this.isPlaying = true;
    this.lastFrame = performance.now();
    this.showPlaying();
    this.app.stage.draw();
  }

  private pause(): void {
    this.isPlaying = false;
    this.showPlaying();
  }

  private showPlaying(): void {
    const button = byId('play');
    button.replaceChildren(icon(this.isPlaying ? 'pause' : 'play'));
    button.setAttribute('aria-label', this.isPlaying ? t('Pause') : t('Play'));
  }

  private animate(now: number): boolean {
    if (!this.isPlaying || !this.trace) {
      return false;
    }
    const ticks = this.trace.ticks_per_second || 20;
    const speed = Number(byId<HTMLSelectElement>('speed').value);
    const next = this.time + ((now - this.lastFrame) / 1000) * ticks * speed;
    this.lastFrame = now;
    this.show(Math.min(next, this.end), false);
    if (next >= this.end) {
      this.pause();
      say(byId('trace-result').textContent ?? '');
    }
    return this.isPlaying;
  }

  private jump(stops: number[], direction: 1 | -1): void {
    if (!this.trace) {
      return;
    }
    this.pause();
    const next =
      direction > 0
        ? stops.find((stop) => stop > this.time)
        : [...stops].reverse().find((stop) => stop < this.time);
    this.show(next ?? (direction > 0 ? this.end : 0));
    say(byId('moment').textContent ?? '');
  }

  /** State and packets at a time. */
  private show(time: number, draws = true): void {
    const trace = this.trace;
    if (!trace) {
      return;
    }
    if (time < this.time || this.cursor.next === 0) {
      this.moment = this.begin(this.slots.length);
      this.cursor.next = 0;
    }
    this.time = time;
    this.advance(trace, time);
    this.showMoment(trace);
    this.placePackets(trace, time);
    this.app.view.paint();
    if (draws) {
      this.app.stage.draw();
    }
  }

  private begin(count: number): Moment {
    return { phases: new Int8Array(count).fill(-1), verdicts: new Int8Array(count), packets: 0, iterations: 0, order: 0 };
  }

  private advance(trace: Trace, time: number): void {
    const { moment, cursor } = this;
    const { events, times } = trace;
    while (2 * cursor.next < times.length && times[2 * cursor.next] <= time) {
      const [kind, a, b, c] = events.subarray(EVENT_INTEGERS * cursor.next, EVENT_INTEGERS * (cursor.next + 1));
      if (kind === LogEvent.kPacket) {
        ++moment.packets;
      } else if (kind === LogEvent.kPhase) {
        moment.phases[a] = b;
      } else if (kind === LogEvent.kVerdict) {
        moment.verdicts[a] = b;
      } else if (kind === LogEvent.kOrder && a === trace.root && b === this.rootChild) {
        moment.order = c;
        moment.iterations += trace.orders[c].is_iteration ? 1 : 0;
      }
      ++cursor.next;
    }
  }

  private placePackets(trace: Trace, time: number): void {
    const { events, times } = trace;
    const { robot } = this.app.bench;
    this.packets.clear();
    for (let i = this.cursor.next - 1; i >= 0 && times[2 * i] >= time - this.durationMax; --i) {
      const at = EVENT_INTEGERS * i;
      const share = (time - times[2 * i]) / Math.max(times[2 * i + 1], 1);
      if (events[at] === LogEvent.kPacket && share <= 1) {
        const from = robot.placeAt(this.slots[events[at + 1]]);
        const to = robot.placeAt(this.slots[events[at + 2]]);
        const [x, y, z] = from.map((value, k) => value + (to[k] - value) * (0.15 + 0.7 * share));
        this.packets.add(x, y, z, MEANING_COLOURS[events[at + 3]]);
      }
    }
    this.packets.update();
  }

  private showMoment(trace: Trace): void {
    const { moment } = this;
    const agents = this.agentCount;
    const knowing = moment.verdicts.reduce((sum, verdict) => sum + (verdict > 0 ? 1 : 0), 0);
    this.allKnow = knowing >= agents;
    const phase = Math.max(...moment.phases, 0);
    const time = trace.ticks_per_second > 0 ? `${digits((this.time / trace.ticks_per_second).toFixed(3))} s` : t('round {0}', Math.floor(this.time));
    const order = moment.order > 0 ? [t('order: {0}', trace.orders[moment.order].text)] : [];
    const counts = [t('iteration {0}', moment.iterations), t('{0} packets', moment.packets), t('{0} of {1} know the verdict', knowing, agents)];
    byId('moment').textContent = [time, word(VOCABULARY.phases[phase]), ...counts, ...order].join(' · ');
    byId<HTMLInputElement>('time').value = String(Math.round((10_000 * this.time) / Math.max(this.end, 1)));
  }

  /** Modules are dim, then in the colour of their phase, in the end in that of what they know. */
  private colour(slot: number): Rgb | undefined {
    const module = this.moduleOf[slot];
    const { moment, app } = this;
    const isPlanned = module >= this.agentCount;
    if (isPlanned ? !this.allKnow : moment.verdicts[module] === 0) {
      const phase = isPlanned ? -1 : moment.phases[module];
      return phase < 0 ? DIM : mix(PHASE_COLOURS[phase], [255, 255, 255], 0.25);
    }
    if (this.trace?.verdict === 'unstable') {
      return UNSTABLE;
    }
    if (!this.loads) {
      return UNKNOWN;
    }
    const { scale } = app.view;
    return this.loads.isBroken[slot] ? brokenColour(scale) : loadColour(scale, this.loads.ratio[slot]);
  }

  private drawTimeline(): void {
    const canvas = byId<HTMLCanvasElement>('timeline');
    const context = canvas.getContext('2d')!;
    context.clearRect(0, 0, canvas.width, canvas.height);
    this.phaseStops.slice(0, -1).forEach((begin, i) => {
      const x = (begin / this.end) * canvas.width;
      const width = ((this.phaseStops[i + 1] - begin) / this.end) * canvas.width;
      context.fillStyle = css(PHASE_COLOURS[i]);
      context.fillRect(x, 0, Math.max(width, 1), canvas.height);
    });
  }

  private button(id: string, name: IconName, action: () => void): void {
    byId(id).append(icon(name));
    byId(id).onclick = action;
  }
}

/** Fills a list to choose from. */
function offer(id: string, choices: readonly Choice[]): void {
  byId(id).append(...choices.map(({ value, text }) => make('option', { value: String(value), textContent: word(text) })));
}
