// SPDX-License-Identifier: MIT
// The oscilloscope's way to the machine: its trigger is a probe of the engine, which finds the moment between the steps of the
// solver however fast the machine runs; the free beam is what every frame brings.
import type {Answer, Read} from "../answers";
import {runs, type Session, type Shown} from "../session";
import {freeSweeps, runSweeps, sweepOf, type Sweep} from "./sweeps";
import {divisionsAcross, everyRun, inUnit} from "./settings";

interface Taken extends Answer {
  traces: {begin: number; rows: number; ended: boolean}[];
}
interface Probe extends Answer {
  probe: number;
}

const rowsOfSweep = 600;
const fewestRows = 4, mostRows = 500;   // of the free beam in a frame
const rowsOfScreen = 1000;              // and over the screen, where a frame is the shorter part of it
const persistent = 16;                  // sweeps that are kept where they persist
const patience = 500;                   // ms without a trigger after which the beam runs free, if it may

export const isTriggered = (source: string) => source !== "" && source !== everyRun;

export interface OnScreen {
  sweeps: readonly Sweep[];
  fromTrigger: boolean;
  length: number;  ///< [s]; 0: all that there is
  status: string;
}

/// The beam on its way over the screen, before it what it has left of the sweep before: sweeps have the same rows.
function written(running: Sweep, before: Sweep): Sweep {
  const from = running.times.length, shift = running.zero - before.zero;
  const times = before.times.slice(from).map((time) => time + shift);
  return {
    zero: running.zero,
    times: Float64Array.of(...running.times, running.times[from - 1]!, ...times),
    values: running.values.map((column, k) => Float64Array.of(...column, NaN, ...before.values[k]!.slice(from))),
  };
}

export class Instrument {
  units: readonly string[] = [];

  private sweeps: Sweep[] = [];
  private running: Sweep | undefined;
  private probe: number | undefined;
  private refusal = "";
  private arms = 0;        // the newest call of `arm`
  private triggered = 0;   // ms, when a sweep has begun last
  private before: Pick<Shown, "scope" | "traced" | "speed" | "held"> | undefined;

  constructor(private readonly session: Session) {
    session.subscribe(() => this.follow());
  }

  /// How long a sweep is [s]; 0: all that there is.
  get length(): number {
    const {scope, repeats} = this.session.shown;
    if (scope.base > 0) return scope.base * divisionsAcross;
    if (scope.source === "") return 0;
    return scope.source === everyRun && repeats ? repeats.operate : this.session.span;
  }

  /// How many rows of the free beam so much of the machine's time takes.
  rows(duration: number): number {
    return Math.min(mostRows, Math.max(fewestRows, Math.ceil(rowsOfScreen * duration / (this.length || this.session.span))));
  }

  /// How far a frame may go: the free beam misses nothing that is wider than a row.
  get farthest(): number {
    return isTriggered(this.session.shown.scope.source) ? Infinity : this.length || this.session.span;
  }

  /// The machine is another one, or begins again: probes are gone.
  async opened(): Promise<void> {
    const {scope, persists} = this.session.shown;
    this.probe = undefined;
    if (!persists) this.clear();
    else if (this.running) this.sweeps.push(this.running);
    this.running = undefined;
    if (isTriggered(scope.source) && !this.session.channels.includes(scope.source))
      this.session.set({scope: {...scope, source: "", level: 0}});
    await this.arm();
  }

  /// Asks for what was recorded while the machine went on.
  async went(): Promise<void> {
    const {probe, session} = this;
    if (probe === undefined) return;
    const taken = await session.machine.ask<Taken>("console.takeTraces", probe);
    if (!taken.ok || probe !== this.probe) return;
    const width = session.shown.traced.length + 1;
    let at = 0;
    const known = this.running?.zero;
    this.running = undefined;
    for (const {begin, rows, ended} of taken.traces) {
      const sweep = sweepOf(taken.numbers.subarray(at * width, (at + rows) * width), width, begin);
      at += rows;
      if (begin !== known) this.triggered = performance.now();
      if (rows === 0) continue;
      if (ended) this.sweeps.push(sweep);
      else this.running = sweep;
    }
    this.sweeps = this.sweeps.slice(session.shown.persists ? -persistent : -1);
  }

  get onScreen(): OnScreen {
    const {scope, mode, repeats, persists} = this.session.shown, {traces} = this.session, {length} = this;
    const free = (status: string) => ({sweeps: freeSweeps(traces, length || Infinity), fromTrigger: false, length, status});
    if (scope.source === "") return free(traces.rows > 1 ? `rows ${inUnit(Number(this.apart.toPrecision(2)), "s")} apart` : "");
    if (scope.source === everyRun)
      return {sweeps: runSweeps(traces, repeats, length, persists ? persistent : 1), fromTrigger: true, length, status: "triggered by each run"};
    if (this.refusal) return free(this.refusal);
    const sweeps = this.running ? [...this.sweeps, this.running] : this.sweeps;
    const waits = performance.now() - this.triggered > patience && !this.running;
    if (scope.mode === "auto" && waits && runs(mode) && (sweeps.length === 0 || this.isLate())) return free("auto: no trigger");
    const begin = sweeps.at(-1)?.zero;
    const status = this.isDone ? `single: done, at t = ${inUnit(begin!, "s")}`
      : begin === undefined ? "waits for the trigger" : `triggered at t = ${inUnit(begin, "s")}`;
    return {sweeps: persists ? sweeps : this.running && this.sweeps.length > 0 ? [written(this.running, this.sweeps.at(-1)!)] : sweeps.slice(-1), fromTrigger: true, length, status};
  }

  /// Between the last two rows of the free beam [s].
  private get apart(): number {
    const {traces} = this.session;
    return Math.abs(traces.at(0, traces.rows - 1) - traces.at(0, traces.rows - 2));
  }

  /// A single sweep that is over waits for being armed again.
  get isDone(): boolean {
    return this.session.shown.scope.mode === "single" && this.sweeps.length > 0 && !this.running;
  }

  clear(): void {
    this.sweeps = [];
    this.running = undefined;
  }

  /// Whether the last sweep ended so long ago that others should have followed.
  private isLate(): boolean {
    const last = this.sweeps.at(-1);
    return last !== undefined && this.session.shown.time > last.zero + 3 * this.length;
  }

  /// What is set otherwise is armed anew.
  private follow(): void {
    const {scope, traced, speed, held} = this.session.shown, {before} = this;
    const isSame = before && before.scope.source === scope.source && before.scope.level === scope.level && before.scope.slope === scope.slope
      && before.scope.mode === scope.mode && before.scope.base === scope.base && before.scope.armed === scope.armed
      && before.traced === traced && before.speed === speed && before.held === held;
    if (isSame) return;
    this.before = {scope, traced, speed, held};
    if (before?.held !== held) return;  // `opened` comes
    this.clear();
    void this.arm().catch(() => undefined);  // a machine that was stopped is opened again
  }

  private async arm(): Promise<void> {
    const mine = ++this.arms, {session, probe: old} = this;
    const {scope, traced, speed, held} = session.shown, {machine} = session;
    this.probe = undefined;
    this.refusal = "";
    if (!held) return;
    if (old !== undefined) void machine.ask("console.removeProbe", old).catch(() => undefined);
    const reading = machine.ask<Read>("console.read", ...traced);
    this.triggered = performance.now();
    if (isTriggered(scope.source) && traced.length > 0) {
      const {length} = this;
      // Of what a frame passes in one go two sweeps are as many as anybody sees.
      const aFrame = speed === Infinity ? length : speed / 60;
      const set = await machine.ask<Probe>("console.setProbe", traced, {interval: length / rowsOfSweep, length, trigger: scope.source,
        level: scope.level, slope: scope.slope, hold_off: aFrame > 2 * length ? aFrame / 2 : 0, ...(scope.mode === "single" ? {most: 1} : {})});
      if (mine !== this.arms) {
        if (set.ok) void machine.ask("console.removeProbe", set.probe).catch(() => undefined);
        return;
      }
      if (set.ok) this.probe = set.probe;
      else this.refusal = set.diagnostics?.[0]?.what ?? "the trigger cannot be set";
    }
    const read = await reading;
    if (mine !== this.arms) return;
    this.units = read.ok ? read.units : [];
    session.set({drawn: session.shown.drawn + 1});
  }
}
