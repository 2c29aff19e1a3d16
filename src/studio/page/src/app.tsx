// SPDX-License-Identifier: MIT
import {useEffect, useMemo, useRef, useState} from "preact/hooks";

import type {Advanced, Answer, Diagnostic, Drawn, Held, Opened, Overloads, Patched, Read, Saved} from "./answers";
import {Findings, Pots, short, type Mode, type Pot} from "./controls";
import {carried, Machine, Stopped} from "./machine";
import {colourOf, Scope} from "./scope";
import {fromFragment, save, toFragment, type SharedFile} from "./share";
import {Traces} from "./traces";

const examples = JSON.parse(carried("examples")) as SharedFile[];
const opening = JSON.parse(carried("opening")) as SharedFile;

const mostRows = 20_000;  // that the scope remembers
const rowsAFrame = 12;
const speeds = [0.001, 0.01, 0.1, 0.2, 0.5, 1, 2, 5, 10, 100, Infinity];

/// First those of the diagram's own elements that do something, last what composites are made of.
function inOrder(pots: Pot[]): Pot[] {
  const sleeps = (pot: Pot) => pot.value === 0 || !Number.isFinite(pot.value) || /\.(noise_bandwidth|seed|segments)$/.test(pot.name);
  const rank = (pot: Pot) => 2 * (pot.name.split(".").length - 2) + (sleeps(pot) ? 1 : 0);
  return pots.map((pot, place) => ({pot, place})).sort((a, b) => rank(a.pot) - rank(b.pot) || a.place - b.place).map(({pot}) => pot);
}

/// What stands on the screen of a machine that is held.
interface Shown {
  mode: Mode;
  time: number;
  lamps: {signal: string; value: number}[];
  meter: {name: string; value: number; unit: string};
  drawn: number;
}

const runs = (mode: Mode) => mode === "operate" || mode === "repeat";

const dark: Shown = {mode: "initial", time: 0, lamps: [], meter: {name: "", value: NaN, unit: ""}, drawn: 0};

export function App() {
  const machine = useMemo(() => new Machine(), []);
  const [state, setState] = useState<"starting" | "ready" | "failed">("starting");
  const [file, setFile] = useState<SharedFile>(opening);
  const [written, setWritten] = useState(opening.text);
  const [findings, setFindings] = useState<Diagnostic[]>([]);
  const [remarks, setRemarks] = useState<string[]>([]);
  const [about, setAbout] = useState({kind: "", title: ""});
  const [picture, setPicture] = useState("");
  const [linkage, setLinkage] = useState("");
  const [held, setHeld] = useState<Held | undefined>();
  const [pots, setPots] = useState<Pot[]>([]);
  const [shown, setShown] = useState<Shown>(dark);
  const [speed, setSpeed] = useState(1);
  const [traced, setTraced] = useState<string[]>([]);
  const [against, setAgainst] = useState("");
  const [persists, setPersists] = useState(false);
  const [gain, setGain] = useState("1e5");
  const [busy, setBusy] = useState(false);
  const editor = useRef<HTMLTextAreaElement>(null);
  const traces = useMemo(() => new Traces(traced, mostRows), [traced]);

  // What the loop of frames reads: the newest of what the page shows.
  const now = useRef({shown, speed, traces, traced, persists, held, asking: false, saved: "", patched: "", begun: 0,
    mechanism: undefined as SharedFile | undefined, moved: 0, asked: "", opens: 0, opening: 0, turned: new Map<string, string>()});
  Object.assign(now.current, {shown, speed, traces, traced, persists, held});

  const show = (change: Partial<Shown>) => {
    now.current.shown = {...now.current.shown, ...change};
    setShown(now.current.shown);
  };

  /// The findings of an answer that is none; whether it is one.
  const good = (answer: Answer): boolean => {
    if (!answer.ok) setFindings(answer.diagnostics ?? []);
    return answer.ok;
  };

  async function meter(name: string): Promise<void> {
    if (!now.current.held || name === "") return;
    const read = await machine.ask<Read>("console.read", name);
    if (read.ok) show({meter: {name, value: read.numbers[0]!, unit: read.units[0]!}});
  }

  async function lamps(): Promise<void> {
    const lit = await machine.ask<Overloads>("console.overloads");
    if (lit.ok) show({lamps: lit.signals.map((signal, k) => ({signal, value: lit.numbers[k]!}))});
  }

  /// Reads a text and sets the machine up: at its initial condition. Where it is wrong, the machine before stays.
  /// The newest call wins; meanwhile the machine stands.
  async function open(next: SharedFile, how: {gain?: string; restore?: string; turned?: Map<string, string>} = {}): Promise<void> {
    const mine = ++now.current.opens;
    ++now.current.opening;
    try {
      await openAs(next, how, () => mine === now.current.opens);
    } catch (error) {
      if (!(error instanceof Stopped)) throw error;
    } finally {
      --now.current.opening;
    }
  }

  async function openAs(next: SharedFile, how: {gain?: string; restore?: string; turned?: Map<string, string>}, isNewest: () => boolean): Promise<void> {
    setFindings([]);
    now.current.asked = next.text;
    const opened = await machine.ask<Opened>("open", next.text, next.name);
    if (!isNewest() || !good(opened)) return;
    const theme = {theme: "auto"};
    let diagram = next.text;
    const said: string[] = [];
    let drawnLinkage = "";
    if (opened.kind === "mechanism") {
      const patched = await machine.ask<Patched>("patch", next.text, {gain: how.gain ?? gain}, next.name);
      if (!isNewest() || !good(patched)) return;
      diagram = patched.text;
      if (patched.judgement) said.push(patched.judgement);
      const drawn = await machine.ask<Drawn>("draw", next.text, theme, next.name);
      if (drawn.ok) drawnLinkage = drawn.svg;
    }
    if (!isNewest()) return;
    const set = await machine.ask<Held>("console.open", diagram, next.name);
    if (!isNewest() || !good(set)) return;
    const turned = how.turned ?? new Map<string, string>();
    for (const [pot, value] of turned) await machine.ask("console.turn", pot, value);
    const drawn = await machine.ask<Drawn>("draw", diagram, theme, next.name);
    const values = await machine.ask<Read>("console.read", ...set.pots);
    const mode: Mode = how.restore ? "hold" : "initial";
    if (how.restore) await machine.ask("console.restore", how.restore);
    else await machine.ask("console.setMode", mode);
    if (!isNewest()) return;
    now.current.patched = diagram;
    now.current.turned = turned;
    now.current.saved = how.restore ?? "";
    now.current.mechanism = opened.kind === "mechanism" ? next : undefined;
    setFile(next);
    setAbout({kind: opened.kind, title: opened.title});
    setLinkage(drawnLinkage);
    setPicture(drawn.ok ? drawn.svg : "");
    setHeld(set);
    setPots(inOrder(set.pots.map((name, k) => ({name, value: values.numbers[k]!, unit: values.units[k] ?? ""}))));
    // of a mechanism the way of its second moving point, else the first outputs over the time
    const way = opened.kind === "mechanism" ? set.outputs.slice(2, 4) : [];
    setTraced(way.length === 2 ? way : set.outputs.slice(0, 4));
    setAgainst(way.length === 2 ? way[0]! : "");
    setRemarks(said);
    now.current.held = set;
    show({...dark, mode, time: set.time, drawn: now.current.shown.drawn + 1});
    traces.clear();
  }

  async function press(mode: Mode): Promise<void> {
    let time = now.current.shown.time;
    if (mode === "initial") {  // the clock too begins again, with the pots as they are turned
      const set = await machine.ask<Held>("console.open", now.current.patched, file.name);
      if (!good(set)) return;
      for (const [pot, value] of now.current.turned) await machine.ask("console.turn", pot, value);
      time = set.time;
      if (!now.current.persists) now.current.traces.clear();
    }
    // A diagram with a timeline sets its modes itself: then the page lets it run, or not.
    const set = await machine.ask("console.setMode", mode);
    if (!set.ok && !/timeline/.test(set.diagnostics?.[0]?.what ?? "")) {
      good(set);
      return;
    }
    show({mode, time, drawn: now.current.shown.drawn + 1});
    await lamps();
    await meter(now.current.shown.meter.name);
  }

  /// Initial condition and a run, again and again.
  async function repeat(): Promise<void> {
    const span = machineSpan();
    if (!good(await machine.ask("console.repeat", span / 20, span))) return;
    setFindings([]);
    show({mode: "repeat", drawn: now.current.shown.drawn + 1});
  }

  async function turn(name: string, value: number): Promise<void> {
    const before = pots;
    setPots((all) => all.map((pot) => (pot.name === name ? {...pot, value} : pot)));
    const unit = pots.find((pot) => pot.name === name)?.unit ?? "";
    const number = Number.isFinite(value) ? String(value) : short(value);
    const quantity = unit && !/^(machine unit|1)$/.test(unit) ? `${number} ${unit}` : number;
    const turned = await machine.ask("console.turn", name, quantity);
    if (!turned.ok) {
      setPots(before);
      good(turned);
    } else {
      setFindings([]);
      now.current.turned.set(name, quantity);
      if (!runs(now.current.shown.mode)) {
        await lamps();
        await meter(now.current.shown.meter.name);
      }
    }
  }

  /// Ends whatever the engine does; the machine stands where it was last saved.
  async function stop(): Promise<void> {
    const {saved, turned} = now.current;
    await machine.restart();
    setBusy(false);
    now.current.asking = false;
    await open(file, {restore: saved, turned: new Map(turned)});
    setRemarks((said) => [...said, "stopped: the machine stands where it last was whole"]);
  }

  async function frame(seconds: number): Promise<void> {
    const {speed: pace, traces: into, traced: names} = now.current;
    const span = Math.max(machineSpan(), 1e-9);
    const duration = pace === Infinity ? span / 50 : seconds * pace;
    const went = await machine.ask<Advanced>("console.advance", duration, names, rowsAFrame);
    if (!went.ok) {
      good(went);
      show({mode: "hold", drawn: now.current.shown.drawn + 1});
      await machine.ask("console.setMode", "hold");
      return;
    }
    into.add(went.numbers, now.current.persists);
    show({time: went.time, drawn: now.current.shown.drawn + 1});
    if (now.current.mechanism && performance.now() - now.current.moved > 60) {
      now.current.moved = performance.now();
      const {name, text} = now.current.mechanism;
      const drawn = await machine.ask<Drawn>("draw", text, {theme: "auto", time: went.time % span}, name);
      if (drawn.ok) setLinkage(drawn.svg);
    }
    if (went.warnings.length > 0) setRemarks(went.warnings.map((warning) => warning.what));
  }

  /// How long the file says that a run lasts [s].
  const machineSpan = () => now.current.begun || 1;

  useEffect(() => {
    let ended = false, last = performance.now(), second = 0;
    machine.start().then(async () => {
      setState("ready");
      const shared = await fromFragment(location.hash);
      const first = shared ?? opening;
      setWritten(first.text);
      await open(first);
    }, () => setState("failed"));
    const look = async (at: number, seconds: number) => {
      await frame(seconds);
      if (at - second < 300) return;
      second = at;
      await lamps();
      await meter(now.current.shown.meter.name);
      const saved = await machine.ask<Saved>("console.save");
      if (saved.ok) now.current.saved = saved.state;
    };
    const step = (at: number) => {
      if (ended) return;
      requestAnimationFrame(step);
      const current = now.current;
      if (current.asking || current.opening > 0) {
        setBusy(at - last > 700);
        return;
      }
      setBusy(false);
      const seconds = Math.min((at - last) / 1000, 0.1);
      last = at;
      if (!current.held || !runs(current.shown.mode)) return;
      current.asking = true;
      look(at, seconds).catch((error) => {
        if (!(error instanceof Stopped)) throw error;
      }).finally(() => { current.asking = false; });
    };
    requestAnimationFrame(step);
    return () => { ended = true; };
  }, []);

  useEffect(() => {
    const span = Number(/^\s*until\s*=\s*([0-9.eE+-]+)/m.exec(now.current.patched)?.[1]);
    now.current.begun = span > 0 ? span : 1;
  }, [held]);

  // What is written is looked at as soon as the writer rests.
  useEffect(() => {
    if (state !== "ready") return;
    if (written === file.text) {
      setFindings([]);
      return;
    }
    const later = setTimeout(() => {
      if (written !== now.current.asked) void open({name: file.name, text: written});
    }, 400);
    return () => clearTimeout(later);
  }, [written, state]);

  function goTo(line: number, column: number): void {
    const lines = written.split("\n");
    const at = lines.slice(0, line - 1).reduce((sum, text) => sum + text.length + 1, 0) + Math.max(column - 1, 0);
    editor.current?.focus();
    editor.current?.setSelectionRange(at, at + Math.max(1, (lines[line - 1] ?? "").length - Math.max(column - 1, 0)));
  }

  async function pick(event: Event): Promise<void> {
    const chosen = (event.target as HTMLInputElement).files?.[0];
    if (!chosen) return;
    const next = {name: chosen.name, text: await chosen.text()};
    setWritten(next.text);
    await open(next);
  }

  function choose(name: string): void {
    const example = examples.find((one) => one.name === name);
    if (!example) return;
    setWritten(example.text);
    void open(example);
  }

  async function share(): Promise<void> {
    location.hash = await toFragment({name: file.name, text: written});
    await navigator.clipboard?.writeText(location.href).catch(() => undefined);
    setRemarks(["the link in the address bar holds the file"]);
  }

  function keys(event: KeyboardEvent): void {
    if ((event.target as HTMLElement).matches("input, textarea, select")) return;
    const press_ = {i: "initial", o: "operate", h: "hold"}[event.key] as Mode | undefined;
    if (event.key === " ") {
      event.preventDefault();
      void press(runs(shown.mode) ? "hold" : "operate");
    } else if (press_) {
      void press(press_);
    } else if (event.key === "r") {
      void repeat();
    }
  }
  useEffect(() => {
    addEventListener("keydown", keys);
    return () => removeEventListener("keydown", keys);
  });

  const channels = held ? [...new Set([...held.outputs, ...held.signals])] : [];
  const trace = (name: string, on: boolean) => setTraced(on ? [...traced, name] : traced.filter((one) => one !== name));

  if (state === "failed") return <p class="failed">This browser cannot run the engine: it needs WebAssembly with exceptions (Firefox 100, Chrome 95, Safari 15.2, or later).</p>;
  return (
    <>
      <header>
        <h1>Oblique <span class="quiet">{about.title}</span></h1>
        <label>Example <select aria-label="Examples" onChange={(event) => choose((event.target as HTMLSelectElement).value)} value={file.name}>
          <option value="">…</option>
          {examples.map((one) => <option value={one.name}>{one.name.replace(/\.toml$/, "").replaceAll("/", ": ")}</option>)}
        </select></label>
        <label class="button">Open <input type="file" accept=".toml" onChange={(event) => void pick(event)} /></label>
        <button onClick={() => save(file.name.split("/").pop() || "machine.toml", written, "text/plain")}>Save</button>
        <button onClick={() => void share()}>Link</button>
        <span class="state" data-state={state}>{state === "starting" ? "the engine starts …" : busy ? "computing …" : ""}</span>
        <button class="stop" disabled={!busy} onClick={() => void stop()}>Stop</button>
      </header>
      <main>
        <section class="text" aria-label="File">
          <textarea ref={editor} spellcheck={false} aria-label="Text of the file" value={written} onInput={(event) => setWritten((event.target as HTMLTextAreaElement).value)} />
          {findings.length > 0 && <Findings of={findings} goTo={goTo} />}
          {remarks.map((remark) => <p class="remark">{remark}</p>)}
        </section>
        <section class="machine">
          {linkage && <div class="picture linkage" dangerouslySetInnerHTML={{__html: linkage}} />}
          <div class="picture schematic" dangerouslySetInnerHTML={{__html: picture}} />
        </section>
        <section class="desk" aria-label="Console">
          <div class="modes" role="group" aria-label="Mode of operation">
            {(["initial", "operate", "hold"] as const).map((mode) => (
              <button aria-pressed={shown.mode === mode} disabled={!held} title={`key ${mode[0]}`} onClick={() => void press(mode)}>{{initial: "IC", operate: "OP", hold: "HOLD"}[mode]}</button>
            ))}
            <button aria-pressed={shown.mode === "repeat"} disabled={!held} title="key r" onClick={() => void repeat()}>REP</button>
            <output class="time" aria-label="Time of the machine">t = {short(shown.time)} s</output>
            <label>speed <select value={String(speed)} onChange={(event) => setSpeed(Number((event.target as HTMLSelectElement).value))}>
              {speeds.map((one) => <option value={String(one)}>{one === Infinity ? "as fast as it goes" : `${one} ×`}</option>)}
            </select></label>
            {about.kind === "mechanism" && <label>gain <input class="gain" type="text" value={gain} onChange={(event) => {
              const asked = (event.target as HTMLInputElement).value;
              setGain(asked);
              void open(file, {gain: asked});
            }} /></label>}
          </div>
          <div class="lamps" role="status" aria-label="Overloads">
            {shown.lamps.length === 0 ? <span class="lamp">no overload</span> : shown.lamps.slice(0, 8).map((lamp) => <span class="lamp lit">{lamp.signal} {short(lamp.value)}</span>)}
          </div>
          <Scope traces={traces} against={against} drawn={shown.drawn} height={280} />
          <div class="channels">
            <label>over <select aria-label="What the traces are drawn against" value={against} onChange={(event) => {
              const name = (event.target as HTMLSelectElement).value;
              setAgainst(name);
              if (name && !traced.includes(name)) trace(name, true);
            }}>
              <option value="">t</option>
              {channels.map((name) => <option value={name}>{name}</option>)}
            </select></label>
            <label>trace <select aria-label="Add a trace" value="" onChange={(event) => trace((event.target as HTMLSelectElement).value, true)}>
              <option value="">add …</option>
              {channels.filter((name) => !traced.includes(name)).map((name) => <option value={name}>{name}</option>)}
            </select></label>
            {traced.map((name, k) => <button class="trace" style={{borderColor: colourOf(k)}} aria-label={`Take ${name} off the scope`} onClick={() => trace(name, false)}>{name} ×</button>)}
            <label><input type="checkbox" checked={persists} onChange={(event) => setPersists((event.target as HTMLInputElement).checked)} /> persistence</label>
            <button onClick={() => save("traces.csv", traces.csv(), "text/csv")}>CSV</button>
          </div>
          <div class="meter">
            <label>voltmeter <select aria-label="What the voltmeter shows" value={shown.meter.name} onChange={(event) => void meter((event.target as HTMLSelectElement).value)}>
              <option value="">…</option>
              {channels.map((name) => <option value={name}>{name}</option>)}
            </select></label>
            <output aria-label="Voltmeter">{shown.meter.name && `${short(shown.meter.value)} ${shown.meter.unit}`}</output>
          </div>
          <Pots pots={pots} turn={(name, value) => void turn(name, value)} />
        </section>
      </main>
    </>
  );
}
