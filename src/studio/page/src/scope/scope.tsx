// SPDX-License-Identifier: MIT
import {useEffect, useRef, useState} from "preact/hooks";

import {runs, useShown, type Session} from "../session";
import {save} from "../share";
import {Handles, Readings} from "./cursors";
import {colourOf, paint, toSvg, type Theme} from "./drawing";
import {Grounds, OwnScales} from "./grounds";
import {screenOf, type Given, type Screen} from "./screen";
import {everyRun, inUnit, scaleSteps, timeSteps, type ScopeSettings, type Slope, type TriggerMode} from "./settings";
import {csvOf} from "./sweeps";

const height = 320;
const saved = {width: 900, height: 480};  // a picture in a file
const oftenEnough = 250;                  // ms between two changes of what is read aloud

const darkly = matchMedia("(prefers-color-scheme: dark)");
const themeNow = (): Theme => (darkly.matches ? "dark" : "light");

/// What stands on the screen, in a picture of this size.
function given(session: Session, cursors: readonly number[], width: number, height: number): Given {
  const {traced, against, scope} = session.shown, {oscilloscope} = session;
  const isOver = traced.length > 1 && traced.includes(against);
  const {sweeps, fromTrigger, length, status} = oscilloscope.onScreen;
  return {names: traced, units: oscilloscope.units, sweeps, against: isOver ? traced.indexOf(against) : -1, length, fromTrigger, settings: scope, cursors, status, width, height};
}

/// The beam, with the cursors over it.
function Beam({session, cursors, move, keep}: {session: Session; cursors: readonly number[]; move: (cursor: number, time: number) => void; keep: (screen: Screen) => void}) {
  const place = useRef<HTMLDivElement>(null), canvas = useRef<HTMLCanvasElement>(null);
  const [width, setWidth] = useState(0);
  const [theme, setTheme] = useState<Theme>(themeNow);
  const said = useRef({at: 0, title: ""});
  useShown(session, (shown) => shown.drawn);
  useShown(session, (shown) => shown.scope);
  useShown(session, (shown) => shown.against);
  useShown(session, (shown) => shown.persists);
  const mode = useShown(session, (shown) => shown.mode);

  useEffect(() => {
    const watch = new ResizeObserver(() => setWidth(place.current!.clientWidth));
    watch.observe(place.current!);
    const turn = () => setTheme(themeNow());
    darkly.addEventListener("change", turn);
    return () => {
      watch.disconnect();
      darkly.removeEventListener("change", turn);
    };
  }, []);

  const begin = performance.now();
  const shows = given(session, cursors, width, height);
  const screen = width > 0 ? screenOf(shows) : undefined;
  const shift = shows.fromTrigger ? screen?.newest?.zero ?? 0 : 0;
  const laidOut = performance.now() - begin;
  useEffect(() => {
    if (!screen) return;
    const painting = performance.now();
    paint(screen.drawing, canvas.current!, theme, devicePixelRatio);
    keep(screen);
    const now = performance.now();
    place.current!.dataset.took = (laidOut + now - painting).toFixed(2);
    // What is read aloud does not change with every frame.
    if (runs(mode) && now - said.current.at < oftenEnough && said.current.title === screen.drawing.title) return;
    said.current = {at: now, title: screen.drawing.title};
    canvas.current!.setAttribute("aria-label", `${screen.drawing.title}. ${screen.drawing.description}`);
  });
  return (
    <div class="screen" ref={place} data-sweeps={shows.sweeps.length} data-status={shows.status}>
      <canvas ref={canvas} role="img" style={{width: "100%", height: `${height}px`}} />
      {screen && <Grounds session={session} screen={screen} names={shows.names} units={shows.units} />}
      {screen && cursors.length > 0 && <Handles screen={screen} names={shows.names} units={shows.units} against={shows.against} shift={shift} at={cursors} move={move} />}
    </div>
  );
}

/// The table beside the cursors, a few times a second.
function CursorTable({session, cursors}: {session: Session; cursors: readonly number[]}) {
  const [, again] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => again((count) => count + 1), oftenEnough);
    return () => clearInterval(timer);
  }, []);
  const shows = given(session, cursors, saved.width, saved.height);
  return <Readings screen={screenOf(shows)} names={shows.names} units={shows.units} at={cursors} />;
}

function Channels({session, save: keep}: {session: Session; save: (kind: "csv" | "svg" | "png") => void}) {
  const traced = useShown(session, (shown) => shown.traced);
  const against = useShown(session, (shown) => shown.against);
  const persists = useShown(session, (shown) => shown.persists);
  useShown(session, (shown) => shown.held);
  const {channels} = session;
  return (
    <div class="channels">
      <label>over <select aria-label="What the traces are drawn against" value={against} onChange={(event) => {
        const name = (event.target as HTMLSelectElement).value;
        if (name && !traced.includes(name)) session.trace([...traced, name], name);
        else session.set({against: name});
      }}>
        <option value="">t</option>
        {channels.map((name) => <option value={name}>{name}</option>)}
      </select></label>
      <label>trace <select aria-label="Add a trace" value="" onChange={(event) => session.trace([...traced, (event.target as HTMLSelectElement).value])}>
        <option value="">add …</option>
        {channels.filter((name) => !traced.includes(name)).map((name) => <option value={name}>{name}</option>)}
      </select></label>
      {traced.map((name, k) => <button class="trace" style={{borderColor: colourOf(k, themeNow())}} aria-label={`Take ${name} off the scope`}
        onClick={() => session.trace(traced.filter((one) => one !== name))}>{name} ×</button>)}
      <label><input type="checkbox" checked={persists} onChange={(event) => session.set({persists: (event.target as HTMLInputElement).checked})} /> persistence</label>
      <button onClick={() => keep("csv")}>CSV</button>
      <button onClick={() => keep("svg")}>SVG</button>
      <button onClick={() => keep("png")}>PNG</button>
    </div>
  );
}

/// Time base, scale, trigger.
function Settings({session}: {session: Session}) {
  const scope = useShown(session, (shown) => shown.scope);
  const traced = useShown(session, (shown) => shown.traced);
  const against = useShown(session, (shown) => shown.against);
  const held = useShown(session, (shown) => shown.held);
  const set = (change: Partial<ScopeSettings>) => session.set({scope: {...session.shown.scope, ...change}, drawn: session.shown.drawn + 1});
  const number = (event: Event, take: (value: number) => void) => {
    const written = (event.target as HTMLInputElement).value.trim(), value = Number(written);
    if (written !== "" && Number.isFinite(value)) take(value);
    else (event.target as HTMLInputElement).value = String(scope.level);
  };
  const upright = traced.filter((name) => name !== against || traced.length === 1);
  const triggers = scope.source !== "" && scope.source !== everyRun;
  return (
    <div class="channels scope-settings">
      <label>time <select aria-label="Time base" value={String(scope.base)} onChange={(event) => set({base: Number((event.target as HTMLSelectElement).value)})}>
        <option value="0">automatic</option>
        {timeSteps.map((one) => <option value={String(one)}>{inUnit(one, "s")} a division</option>)}
      </select></label>
      <label>scale <select aria-label="Vertical scale" value={String(scope.volts)} onChange={(event) => set({volts: Number((event.target as HTMLSelectElement).value)})}>
        <option value="0">automatic</option>
        {scaleSteps.map((one) => <option value={String(one)}>{one} a division</option>)}
      </select></label>
      {scope.volts > 0 && <label>centre <input class="level" type="text" inputMode="decimal" aria-label="Middle of the screen" value={String(scope.centre)} onChange={(event) => number(event, (centre) => set({centre}))} /></label>}
      <label>trigger <select aria-label="Trigger" value={scope.source} disabled={!held} onChange={(event) => set({source: (event.target as HTMLSelectElement).value})}>
        <option value="">none</option>
        <option value={everyRun}>each run (REP)</option>
        {session.channels.map((name) => <option value={name}>{name}</option>)}
      </select></label>
      {triggers && (
        <>
          <label>slope <select aria-label="Slope" value={scope.slope} onChange={(event) => set({slope: (event.target as HTMLSelectElement).value as Slope})}>
            <option value="rising">rising</option>
            <option value="falling">falling</option>
            <option value="either">either</option>
          </select></label>
          <label>level <input class="level" type="text" inputMode="decimal" aria-label="Level" value={String(scope.level)} onChange={(event) => number(event, (level) => set({level}))} /></label>
          <label>sweep <select aria-label="Trigger mode" value={scope.mode} onChange={(event) => set({mode: (event.target as HTMLSelectElement).value as TriggerMode})}>
            <option value="auto">auto</option>
            <option value="normal">normal</option>
            <option value="single">single</option>
          </select></label>
          {scope.mode === "single" && <button onClick={() => set({armed: scope.armed + 1})}>Arm</button>}
        </>
      )}
      <label><input type="checkbox" checked={scope.cursors} onChange={(event) => set({cursors: (event.target as HTMLInputElement).checked})} /> cursors</label>
      {upright.length > 0 && <OwnScales session={session} names={upright} theme={themeNow()} />}
    </div>
  );
}

export function Scope({session}: {session: Session}) {
  const wanted = useShown(session, (shown) => shown.scope.cursors);
  const source = useShown(session, (shown) => shown.scope.source);
  const [at, setAt] = useState<readonly number[]>([]);
  const screen = useRef<Screen>();
  // They begin at a quarter and three quarters of what the screen shows.
  useEffect(() => {
    const [begin, end] = screen.current?.time ?? [0, 1];
    setAt(wanted ? [begin + (end - begin) / 4, begin + (end - begin) * 3 / 4] : []);
  }, [wanted, source]);

  function keep(kind: "csv" | "svg" | "png"): void {
    const shows = given(session, at, saved.width, saved.height);
    if (kind === "csv") return save("traces.csv", csvOf(shows.names, shows.sweeps, shows.fromTrigger), "text/csv");
    const {drawing} = screenOf(shows);
    drawing.title = `${session.shown.title || "Oblique"} – ${drawing.title}`;
    if (kind === "svg") return save("scope.svg", toSvg(drawing, "light"), "image/svg+xml");
    const canvas = document.createElement("canvas");
    paint(drawing, canvas, "light", 2);
    canvas.toBlob((blob) => blob && save("scope.png", blob, "image/png"), "image/png");
  }

  return (
    <section class="scope" aria-label="Oscilloscope">
      <Beam session={session} cursors={at} keep={(one) => { screen.current = one; }}
        move={(cursor, time) => setAt((before) => before.map((one, k) => (k === cursor ? time : one)))} />
      {at.length > 0 && <CursorTable session={session} cursors={at} />}
      <Settings session={session} />
      <Channels session={session} save={keep} />
    </section>
  );
}
