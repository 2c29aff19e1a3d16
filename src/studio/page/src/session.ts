// SPDX-License-Identifier: MIT
// The machine that the page holds, and all that the page shows of it: one snapshot, and what may be done to it. The rooms
// of the page only show the snapshot and call what stands here.
import {useEffect, useReducer} from "preact/hooks";

import type {Advanced, Answer, Checked, Diagnostic, Drawn, Exchanged, Held, Lesson, Opened, Overloads, Patched, Read, Saved} from "./answers";
import {carried} from "./carried";
import {Machine, Stopped, unpacked} from "./machine";
import {short} from "./numbers";
import {drawing, type Patch, ready, usualGain} from "./patch";
import {Instrument} from "./scope/instrument";
import {atFirst, type ScopeSettings} from "./scope/settings";
import type {Repeats} from "./scope/sweeps";
import {fromFragment, type SharedFile} from "./share";
import {Traces} from "./traces";
import {Levels} from "./voltages/levels";

const opening = JSON.parse(carried("opening")) as SharedFile;

const mostRows = 20_000;  // that the scope remembers
const shortFrame = 0.005, longFrame = 0.01;  // [s] that the engine takes for a frame as fast as it goes
const restOfWriter = 400;  // ms after which what was written is looked at

export type Mode = "initial" | "operate" | "hold" | "repeat";
export const runs = (mode: Mode) => mode === "operate" || mode === "repeat";

export interface Pot {
  name: string;
  value: number;
  unit: string;
}

export interface Shown {
  engine: "starting" | "ready" | "failed";
  busy: boolean;
  examples: SharedFile[];     ///< none until they are unpacked
  file: SharedFile;           ///< the one that the machine is of
  written: string;            ///< what stands in the editor
  findings: Diagnostic[];
  remarks: string[];
  kind: "" | "diagram" | "mechanism";
  title: string;
  lesson: Lesson | null;      ///< of the diagram
  diagram: string;            ///< what runs: the file, or the patch of a mechanism
  schematic: string;          ///< SVG
  gain: string;               ///< of the patch
  split: readonly string[];   ///< of its triad; empty: the one worth the most
  held: Held | undefined;
  pots: Pot[];
  mode: Mode;
  time: number;
  speed: number;              ///< seconds of the machine a second; 0: frozen, Infinity: as fast as it goes
  lamps: {signal: string; value: number}[];
  meter: {name: string; value: number; unit: string};
  pointed: {element: string; signals: readonly string[]} | undefined;  ///< in the schematic
  levels: number;             ///< counts up where the voltages are others
  values: ReadonlyMap<string, number>;  ///< of the signals that are watched
  traced: string[];
  against: string;            ///< what the traces are drawn over; empty: the time
  persists: boolean;
  scope: ScopeSettings;
  repeats: Repeats | undefined;
  drawn: number;              ///< counts up where the traces have something new
}

/// A room of the page that lives with the machine.
export interface Companion {
  /// The machine is another one, or begins again.
  opened?(): Promise<void>;
  /// Called while the machine goes on; what it asks at once is of the frame's end.
  went?(): Promise<void>;
}

export interface Opening {
  gain?: string;
  split?: readonly string[];
  force?: boolean;            ///< patches what is unstable, too
  restore?: string;
  turned?: ReadonlyMap<string, string>;
  keeps?: boolean;                ///< a machine of the same file goes on from where it stands
}

/// First those of the diagram's own elements that do something, last what composites are made of.
function inOrder(pots: Pot[]): Pot[] {
  const sleeps = (pot: Pot) => pot.value === 0 || !Number.isFinite(pot.value) || /\.(noise_bandwidth|seed|segments)$/.test(pot.name);
  const rank = (pot: Pot) => 2 * (pot.name.split(".").length - 2) + (sleeps(pot) ? 1 : 0);
  return pots.map((pot, place) => ({pot, place})).sort((a, b) => rank(a.pot) - rank(b.pot) || a.place - b.place).map(({pot}) => pot);
}

export class Session {
  readonly machine = new Machine();
  shown: Shown = {
    engine: "starting", busy: false, examples: [], file: opening, written: opening.text, findings: [], remarks: [], kind: "", title: "", lesson: null, diagram: "", schematic: "",
    gain: usualGain, split: [], held: undefined, pots: [], mode: "initial", time: 0, speed: 1, lamps: [], meter: {name: "", value: NaN, unit: ""}, pointed: undefined, levels: 0, values: new Map(),
    traced: [], against: "", persists: false, scope: atFirst, repeats: undefined, drawn: 0,
  };
  traces = new Traces([], mostRows);
  readonly companions = new Set<Companion>();
  readonly oscilloscope: Instrument;
  readonly levels: Levels;
  /// The file that what is written belongs to, right or wrong.
  source: SharedFile = opening;
  /// Blocks, before and now, that were renamed since the machine that runs was taken.
  renamed: [string, string][] = [];
  /// What was written last by hand.
  typed: string | undefined;
  /// Resolves once the first file was opened.
  readonly ready: Promise<void>;

  private readonly listeners = new Set<() => void>();
  private readonly watches = new Set<readonly string[]>();
  private turned: ReadonlyMap<string, string> = new Map();
  private turning: Promise<unknown> = Promise.resolve();  // the last turn of a pot
  private saved = "";         // the state that the machine comes back to
  private asked = "";         // the text that was looked at last
  private loads = 0;          // what was put on the page last: a file, or what is typed
  private opens = 0;          // the newest call of `open`
  private opening = 0;        // how much is done in turn, when no frame goes on
  private asking = false;     // a frame is
  private framing: Promise<unknown> = Promise.resolve();  // the last frame
  private pressed = Promise.resolve();  // the last button has done its work
  private until = 0;          // [s] of a diagram's run, where its file may say so by an expression
  private stride = 0;         // [s] of a frame as fast as it goes
  private later: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    this.companions.add(this.oscilloscope = new Instrument(this)).add(this.levels = new Levels(this));
    this.ready = this.begin();
  }

  set(change: Partial<Shown>): void {
    this.shown = {...this.shown, ...change};
    for (const listener of this.listeners) listener();
  }

  subscribe(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => { this.listeners.delete(listener); };
  }

  /// Reads these signals in every frame, into `values`, until what it gives is called.
  watch(names: readonly string[]): () => void {
    this.watches.add(names);
    void this.look().catch(ignoreStops);
    return () => { this.watches.delete(names); };
  }

  /// How long the file says that a run lasts [s].
  get span(): number {
    if (this.until > 0) return this.until;
    const until = Number(/^\s*until\s*=\s*([0-9.eE+-]+)/m.exec(this.shown.diagram)?.[1]);
    return until > 0 ? until : 1;
  }

  /// All that can be traced or measured.
  get channels(): string[] {
    const {held} = this.shown;
    return held ? [...new Set([...held.outputs, ...held.signals])] : [];
  }

  /// Takes what is written; it is looked at as soon as the writer rests.
  write(written: string): void {
    ++this.loads;
    this.typed = written;
    this.set({written});
    clearTimeout(this.later);
    if (written === this.shown.file.text) {
      this.asked = written;
      this.set({findings: []});
      return;
    }
    this.later = setTimeout(() => {
      if (this.shown.written !== this.asked) void this.open({...this.source, text: this.shown.written}, {keeps: true});
    }, restOfWriter);
  }

  /// Puts a file in place of the one before, as soon as it is read, if nothing else has come meanwhile.
  async load(file: SharedFile | Promise<SharedFile>): Promise<boolean> {
    const mine = ++this.loads;
    const next = file instanceof Promise ? await file : file;
    if (mine !== this.loads) return false;
    clearTimeout(this.later);
    this.source = next;
    this.typed = undefined;
    this.set({written: next.text});
    return this.open(next);
  }

  /// Puts the machine away.
  clear(): Promise<void> {
    ++this.opens;
    return this.inTurn(async () => {
      this.turned = new Map();
      this.saved = "";
      this.set({file: {name: "", text: ""}, held: undefined, kind: "", title: "", lesson: null, diagram: "", schematic: "", pots: [], lamps: [], remarks: [], mode: "initial", time: 0,
        meter: {name: "", value: NaN, unit: ""}, values: new Map()});
      this.trace([]);
    });
  }

  /// Reads a text and sets the machine up: at its initial condition. Where it is wrong, the machine before stays.
  /// One is opened after the other, and none that is not the newest any more; meanwhile the machine stands. Whether it was
  /// taken.
  async open(next: SharedFile, how: Opening = {}): Promise<boolean> {
    const mine = ++this.opens;
    let taken = false;
    await this.inTurn(async () => {
      const isNewest = () => mine === this.opens;
      if (isNewest()) taken = await this.openAs(next, how, isNewest);
      // what came with a file that was not taken is taken back
      if (!taken && (next.files?.length || next.blocks?.length)) await this.putBeside(this.shown.file);
    });
    return taken;
  }

  /// A button that is pressed before the one before has done its work waits.
  press(mode: Mode): Promise<void> {
    return this.inTurn(() => this.change(mode));
  }

  private async change(mode: Mode): Promise<void> {
    if (!this.shown.held) return;
    let begun: number | undefined;
    if (mode === "initial") {  // the clock too begins again, with the pots as they are turned
      const set = await this.machine.ask<Held>("console.open", this.shown.diagram, this.shown.file.name);
      if (!this.good(set)) return;
      for (const [pot, value] of this.turned) await this.machine.ask("console.turn", pot, value);
      begun = set.time;
      if (!this.shown.persists) this.traces.clear();
      this.set({held: set});
      await this.tell();
    }
    // A diagram with a timeline sets its modes itself: then the page lets it run, or not.
    const set = await this.machine.ask<Held>("console.setMode", mode);
    if (!set.ok && !/timeline/.test(set.diagnostics?.[0]?.what ?? "")) {
      this.good(set);
      return;
    }
    this.set({mode, time: set.ok ? set.time : begun ?? this.shown.time, repeats: undefined, drawn: this.shown.drawn + 1});
    await this.lookAtAll();
  }

  /// Initial condition and a run, again and again.
  repeat(): Promise<void> {
    return this.inTurn(() => this.beginRepeating());
  }

  private async beginRepeating(): Promise<void> {
    const initial = this.span / 20, operate = this.span;
    const set = await this.machine.ask<Held>("console.repeat", initial, operate);
    if (!this.good(set)) return;
    this.set({mode: "repeat", findings: [], repeats: {since: set.time, initial, operate}, drawn: this.shown.drawn + 1});
  }

  /// No frame goes on meanwhile.
  private inTurn(work: () => Promise<void>): Promise<void> {
    const done = this.pressed.then(async () => {
      ++this.opening;
      try {
        await this.framing;
        await work();
      } catch (error) {
        ignoreStops(error);
      } finally {
        --this.opening;
      }
    });
    this.pressed = done.catch(() => undefined);
    return done;
  }

  /// Has the machine stand where it is after so long in operation [s], of which it has been `since`: it goes on until
  /// then, from its beginning where that is over.
  goTo(time: number, since: number): Promise<void> {
    return this.inTurn(() => this.standAt(time, since));
  }

  private async standAt(time: number, since: number): Promise<void> {
    const {machine} = this;
    let from = since;
    if (time < from) {
      const set = await machine.ask<Held>("console.open", this.shown.diagram, this.shown.file.name);
      if (!this.good(set)) return;
      for (const [pot, value] of this.turned) await machine.ask("console.turn", pot, value);
      from = set.time;
      this.set({held: set});
      await this.tell();
    }
    await machine.ask("console.setMode", "operate");
    const went = await machine.ask<Advanced>("console.advance", time - from, this.shown.traced, this.oscilloscope.rows(time - from));
    await machine.ask("console.setMode", "hold");
    if (!this.good(went)) return;
    this.traces.add(went.numbers, this.shown.persists);
    this.set({mode: "hold", time: went.time, repeats: undefined, drawn: this.shown.drawn + 1});
    await this.lookAtAll();
  }

  /// Operates for so long [s], and holds.
  async advance(duration: number): Promise<Advanced | undefined> {
    let went: Advanced | undefined;
    await this.inTurn(async () => {
      await this.machine.ask("console.setMode", "operate");
      went = await this.machine.ask<Advanced>("console.advance", duration, [], 1);
      await this.machine.ask("console.setMode", "hold");
      this.set({mode: "hold", time: went.ok ? went.time : this.shown.time, repeats: undefined, drawn: this.shown.drawn + 1});
      await this.lookAtAll();
    });
    return went;
  }

  /// Turns a pot of the machine; whether it could be.
  turn(name: string, value: number): Promise<boolean> {
    const done = this.turnTo(name, value);
    this.turning = done.catch(() => undefined);
    return done;
  }

  private async turnTo(name: string, value: number): Promise<boolean> {
    if (this.opening > 0) await this.pressed;  // the pot may be another machine's then
    const {pots, held} = this.shown;
    const unit = pots.find((pot) => pot.name === name)?.unit ?? "";
    this.set({pots: pots.map((pot) => (pot.name === name ? {...pot, value} : pot))});
    const number = Number.isFinite(value) ? String(value) : short(value);
    const quantity = unit && !/^(machine unit|1)$/.test(unit) ? `${number} ${unit}` : number;
    const turned = await this.machine.ask("console.turn", name, quantity);
    if (held !== this.shown.held) return turned.ok;
    if (!turned.ok) {
      this.set({pots});
      return this.good(turned);
    }
    this.set({findings: []});
    this.turned = new Map([...this.turned, [name, quantity]]);
    if (!runs(this.shown.mode)) await this.lookAtAll();
    return true;
  }

  /// Begins the file again with these settings, as texts with units.
  async setFor(settings: readonly {name: string; value: string}[]): Promise<void> {
    await this.open(this.shown.file, {turned: new Map(settings.map(({name, value}) => [name, value]))});
  }

  /// What a step of the lesson, or without a number its question, expects, held against a run with the pots as they are
  /// turned; nothing where it could not be run.
  async checkLesson(step?: number, answer?: {name: string; value: string}): Promise<Checked | undefined> {
    await this.turning;
    const set = Object.fromEntries(answer ? [...this.turned, [answer.name, answer.value]] : this.turned);
    const checked = await this.machine.ask<Checked>("check", this.shown.diagram, step === undefined ? {set} : {step, set}, this.shown.file.name);
    if (!this.good(checked)) return undefined;
    this.set({findings: []});
    return checked;
  }

  async meter(name: string): Promise<void> {
    if (name === "") return this.set({meter: {name, value: NaN, unit: ""}});
    if (!this.shown.held) return;
    const read = await this.machine.ask<Read>("console.read", name);
    if (read.ok) this.set({meter: {name, value: read.numbers[0]!, unit: read.units[0]!}});
  }

  trace(traced: string[], against = this.shown.against): void {
    this.traces = new Traces(traced, mostRows);
    this.set({traced, against: traced.includes(against) ? against : "", drawn: this.shown.drawn + 1});
  }

  /// Ends whatever the engine does; the machine stands where it was last saved.
  async stop(): Promise<void> {
    const {saved, turned} = this;
    await this.machine.restart();
    this.asking = false;
    this.set({busy: false});
    if (this.shown.held) await this.open(this.shown.file, {restore: saved, turned});
    this.set({remarks: [...this.shown.remarks, "stopped: the machine stands where it last was whole"]});
  }

  /// The findings of an answer that is none; whether it is one.
  good(answer: Answer): boolean {
    if (!answer.ok) this.set({findings: answer.diagnostics ?? []});
    return answer.ok;
  }

  private async begin(): Promise<void> {
    const starting = this.machine.start();
    void starting.then(async () => this.set({examples: await unpacked(carried("examples"), "application/json").json()}), () => undefined);
    const first = this.load(starting.then(async () => {
      this.set({engine: "ready"});
      this.frames();
      return await fromFragment(location.hash) ?? opening;
    }));
    try {
      await starting;
    } catch {
      first.catch(() => undefined);  // for the same reason
      this.set({engine: "failed"});
      return;
    }
    await first;
  }

  /// What a file needs beside it: whether it could be had.
  private async putBeside({files, blocks}: SharedFile): Promise<boolean> {
    for (const {name, text} of files ?? []) if (!this.good(await this.machine.ask("putFile", name, text))) return false;
    for (const {name, text} of blocks ?? []) if (!this.good(await this.machine.ask("putBlock", name, text))) return false;
    return true;
  }

  private async openAs(next: SharedFile, how: Opening, isNewest: () => boolean): Promise<boolean> {
    const {machine} = this;
    this.set({findings: []});
    this.asked = next.text;
    if (!(await this.putBeside(next))) return false;
    const opened = await machine.ask<Opened>("open", next.text, next.name);
    if (!isNewest() || !this.good(opened)) return false;
    const gain = how.gain ?? this.shown.gain;
    const split = how.split ?? (next.name === this.shown.file.name ? this.shown.split : []);
    let diagram = next.text, schematic = "";  // a diagram is drawn by its patch panel
    const remarks: string[] = [];
    if (opened.kind === "mechanism") {
      const patch = (split.length === 0 ? await ready(next, gain) : undefined) ?? await this.patch(next, {gain, split, force: how.force ?? false}, isNewest);
      if (!patch) return false;
      ({diagram, schematic} = patch);
      if (patch.judgement) remarks.push(`as patched, ${patch.judgement}`);
    }
    if (!isNewest()) return false;
    // from here on the engine changes: to the end
    if (how.keeps && this.shown.held && opened.kind === "diagram" && this.shown.kind === "diagram" && this.shown.file.name === next.name) {
      const went = await this.exchange(next, opened);
      if (went !== undefined) return went;
      remarks.push("the timeline is another one: the machine begins anew");
    }
    const held = await machine.ask<Held>("console.open", diagram, next.name);
    if (!this.good(held)) return false;
    const turned = new Map<string, string>();
    for (const [pot, value] of how.turned ?? []) if (this.good(await machine.ask("console.turn", pot, value))) turned.set(pot, value);
    const values = await machine.ask<Read>("console.read", ...held.pots);
    const mode: Mode = how.restore ? "hold" : "initial";
    if (how.restore) this.good(await machine.ask("console.restore", how.restore));
    const stands = await machine.ask<Held>("console.setMode", mode);
    this.turned = turned;
    this.until = opened.kind === "diagram" ? opened.until : 0;
    this.renamed = [];
    this.saved = how.restore ?? "";
    // of a mechanism the way of its second moving point, else the first outputs over the time
    const way = opened.kind === "mechanism" ? held.outputs.slice(2, 4) : [];
    const isWay = way.length === 2;
    this.set({
      file: next, lesson: opened.lesson ?? null, kind: opened.kind, title: opened.title, gain, split, diagram, schematic, held, remarks, mode, time: stands.ok ? stands.time : held.time, lamps: [], repeats: undefined,
      pots: inOrder(held.pots.map((name, k) => ({name, value: values.numbers[k]!, unit: values.units[k] ?? ""}))),
      meter: {name: "", value: NaN, unit: ""}, values: new Map(),
    });
    this.trace(isWay ? way : held.outputs.slice(0, 4), isWay ? way[0]! : "");
    this.stride = this.span / 50;
    await this.tell();
    await this.look();
    await this.lookAtLamps();
    return true;
  }

  /// The patch of a mechanism, and its picture; nothing where there is none, or something newer has come.
  private async patch(file: SharedFile, how: object, isNewest: () => boolean): Promise<Patch | undefined> {
    const patched = await this.machine.ask<Patched>("patch", file.text, how, file.name);
    if (!isNewest() || !this.good(patched)) return undefined;
    const drawn = await this.machine.ask<Drawn>("draw", patched.text, drawing, file.name);
    return {diagram: patched.text, judgement: patched.judgement, schematic: drawn.ok ? drawn.svg : ""};
  }

  /// The machine goes on as another one; nothing where its timeline forbids.
  private async exchange(next: SharedFile, opened: Opened): Promise<boolean | undefined> {
    const {machine, renamed} = this;
    const held = await machine.ask<Exchanged>("console.exchange", next.text, renamed, next.name);
    if (!held.ok && /timeline/.test(held.diagnostics?.[0]?.what ?? "")) return undefined;
    if (!this.good(held)) return false;
    if (this.renamed === renamed) this.renamed = [];
    this.until = opened.until;
    const usual = this.shown.held?.outputs.slice(0, 4) ?? [];
    this.turned = new Map(Object.entries(held.turned));
    const isInitial = this.shown.mode === "initial";
    if (isInitial) {  // nothing has happened yet that could go on
      await machine.ask("console.open", next.text, next.name);
      for (const [pot, value] of this.turned) await machine.ask("console.turn", pot, value);
      await machine.ask("console.setMode", "initial");
    }
    const values = await machine.ask<Read>("console.read", ...held.pots);
    const saved = await machine.ask<Saved>("console.save");
    this.saved = saved.ok ? saved.state : "";
    this.set({
      file: next, kind: "diagram", title: opened.title, lesson: opened.lesson ?? null, diagram: next.text, held, remarks: [], time: isInitial ? 0 : held.time,
      pots: inOrder(held.pots.map((name, k) => ({name, value: values.numbers[k]!, unit: values.units[k] ?? ""}))),
    });
    const all = new Set(this.channels), now = (name: string) => renamed.find(([old]) => old === name)?.[1] ?? name;
    const {traced, against, meter} = this.shown;
    const left = traced.map(now).filter((name) => all.has(name));
    const shown = traced.join("\n") === usual.join("\n") ? held.outputs.slice(0, 4) : left;  // what was chosen stays
    const {scope} = this.shown;
    if (renamed.length > 0 && scope.own.size > 0) this.set({scope: {...scope, own: new Map([...scope.own].map(([name, scale]) => [now(name), scale]))}});
    if (shown.join("\n") !== traced.join("\n")) this.trace(shown, now(against));
    if (meter.name && !all.has(now(meter.name))) this.set({meter: {name: "", value: NaN, unit: ""}});
    else if (meter.name !== now(meter.name)) this.set({meter: {...meter, name: now(meter.name)}});
    await this.tell();
    await this.lookAtAll();
    return true;
  }

  /// Tells the rooms that the machine is another one.
  private async tell(): Promise<void> {
    for (const companion of this.companions) await companion.opened?.();
  }

  private async lookAtLamps(): Promise<void> {
    const lit = await this.machine.ask<Overloads>("console.overloads");
    if (lit.ok) this.set({lamps: lit.signals.map((signal, k) => ({signal, value: lit.numbers[k]!}))});
  }

  /// Reads what is watched; names that this machine has not are passed over.
  private async look(): Promise<void> {
    const all = new Set(this.channels);
    const names = [...new Set([...this.watches].flat())].filter((name) => all.has(name));
    if (names.length === 0) return;
    const read = await this.machine.ask<Read>("console.read", ...names);
    if (read.ok) this.set({values: new Map(names.map((name, k) => [name, read.numbers[k]!]))});
  }

  private async lookAtAll(): Promise<void> {
    await this.lookAtLamps();
    await this.meter(this.shown.meter.name);
    await this.look();
    for (const companion of this.companions) await companion.went?.();
    if (this.shown.mode === "hold") await this.save();
  }

  /// Keeps the state that the machine comes back to.
  private async save(): Promise<void> {
    const saved = await this.machine.ask<Saved>("console.save");
    if (saved.ok) this.saved = saved.state;
  }

  private async frame(seconds: number): Promise<void> {
    const {speed, traced, persists} = this.shown;
    const {traces} = this;
    const duration = speed === Infinity ? Math.min(this.stride, this.oscilloscope.farthest) : seconds * speed;
    const advancing = this.machine.ask<Advanced>("console.advance", duration, traced, this.oscilloscope.rows(duration));
    const [went] = await Promise.all([advancing, ...[...this.companions].map((companion) => companion.went?.())]);
    if (speed === Infinity && went.seconds < shortFrame) this.stride = Math.min(2 * this.stride, this.oscilloscope.farthest);
    if (speed === Infinity && went.seconds > longFrame) this.stride /= 2;
    if (!went.ok) {
      this.good(went);
      await this.machine.ask("console.setMode", "hold");
      this.set({mode: "hold", drawn: this.shown.drawn + 1});
      return;
    }
    traces.add(went.numbers, persists);
    this.set({time: went.time, drawn: this.shown.drawn + 1});
    await this.look();
    if (went.warnings.length > 0) this.set({remarks: went.warnings.map((warning) => warning.what)});
  }

  /// A frame of the page goes on by so much of the machine's time, where it runs.
  private frames(): void {
    let last = performance.now(), second = 0;
    const whole = async (at: number, seconds: number) => {
      await this.frame(seconds);
      if (at - second < 300) return;
      second = at;
      await this.lookAtLamps();
      await this.meter(this.shown.meter.name);
      await this.save();
    };
    const step = (at: number) => {
      requestAnimationFrame(step);
      const busy = (this.asking || this.opening > 0) && at - last > 700;
      if (busy !== this.shown.busy) this.set({busy});
      if (this.asking || this.opening > 0) return;
      const seconds = Math.min((at - last) / 1000, 0.1);
      last = at;
      if (!this.shown.held || !runs(this.shown.mode) || this.shown.speed === 0) return;
      this.asking = true;
      this.framing = whole(at, seconds).catch(ignoreStops).finally(() => { this.asking = false; });
    };
    requestAnimationFrame(step);
  }
}

function ignoreStops(error: unknown): void {
  if (!(error instanceof Stopped)) throw error;
}

/// A part of what a session shows; the component is drawn anew when the part is another one.
export function useShown<Part>(session: Session, part: (shown: Shown) => Part): Part {
  const [, again] = useReducer<number, void>((count) => count + 1, 0);
  const current = part(session.shown);
  useEffect(() => {
    let before = current;
    const look = () => {
      const now = part(session.shown);
      if (!Object.is(now, before)) again();
      before = now;
    };
    look();
    return session.subscribe(look);
  }, [session]);
  return current;
}
