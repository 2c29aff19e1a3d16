// SPDX-License-Identifier: MIT
import {useState} from "preact/hooks";

import {besideNumber, short} from "./numbers";
import {runs, useShown, type Pot, type Session} from "./session";
import {Pointed} from "./voltages/voltages";

const speeds = [0, 0.001, 0.01, 0.1, 0.2, 0.5, 1, 2, 5, 10, 100, Infinity];

/// IC, OP, HOLD, REP, and how fast.
export function Modes({session}: {session: Session}) {
  const mode = useShown(session, (shown) => shown.mode);
  const time = useShown(session, (shown) => shown.time);
  const speed = useShown(session, (shown) => shown.speed);
  const kind = useShown(session, (shown) => shown.kind);
  const gain = useShown(session, (shown) => shown.gain);
  const held = useShown(session, (shown) => shown.held);
  return (
    <div class="modes" role="group" aria-label="Mode of operation">
      {(["initial", "operate", "hold"] as const).map((one) => (
        <button aria-pressed={mode === one} disabled={!held} title={`key ${one[0]}`} onClick={() => void session.press(one)}>{{initial: "IC", operate: "OP", hold: "HOLD"}[one]}</button>
      ))}
      <button aria-pressed={mode === "repeat"} disabled={!held} title="key r" onClick={() => void session.repeat()}>REP</button>
      <output class="time" aria-label="Time of the machine">t = {short(time)} s</output>
      <label>speed <select value={String(speed)} onChange={(event) => session.set({speed: Number((event.target as HTMLSelectElement).value)})}>
        {speeds.map((one) => <option value={String(one)}>{one === 0 ? "frozen" : one === Infinity ? "as fast as it goes" : `${one} ×`}</option>)}
      </select></label>
      {kind === "mechanism" && <label>gain <input class="gain" type="text" value={gain} onChange={(event) => {
        const asked = (event.target as HTMLInputElement).value;
        session.set({gain: asked});
        void session.open(session.shown.file, {gain: asked});
      }} /></label>}
    </div>
  );
}

/// The keys of the console, where nothing is written.
export function keysOf(session: Session, event: KeyboardEvent): void {
  if ((event.target as HTMLElement).matches("input, textarea, select")) return;
  const mode = ({i: "initial", o: "operate", h: "hold"} as const)[event.key];
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === " ") {
    event.preventDefault();
    void session.press(runs(session.shown.mode) ? "hold" : "operate");
  } else if (mode) {
    void session.press(mode);
  } else if (event.key === "r") {
    void session.repeat();
  }
}

export function Lamps({session}: {session: Session}) {
  const lamps = useShown(session, (shown) => shown.lamps);
  return (
    <div class="lamps" role="status" aria-label="Overloads">
      {lamps.length === 0 ? <span class="lamp">no overload</span> : lamps.slice(0, 8).map((lamp) => <span class="lamp lit">{lamp.signal} {short(lamp.value)}</span>)}
    </div>
  );
}

export function Meter({session}: {session: Session}) {
  const meter = useShown(session, (shown) => shown.meter);
  const pointed = useShown(session, (shown) => shown.pointed);
  useShown(session, (shown) => shown.held);
  return (
    <div class="meter">
      <label>voltmeter <select aria-label="What the voltmeter shows" value={meter.name} onChange={(event) => void session.meter((event.target as HTMLSelectElement).value)}>
        <option value="">…</option>
        {session.channels.map((name) => <option value={name}>{name}</option>)}
      </select></label>
      <output aria-label="Voltmeter">{pointed ? <Pointed session={session} /> : meter.name && `${short(meter.value)} ${meter.unit}`}</output>
    </div>
  );
}

/// A knob: dragged over a factor of ten to each side, typed, or turned by the arrow keys.
function Knob({pot, turn}: {pot: Pot; turn: (name: string, value: number) => void}) {
  const [centre, setCentre] = useState(pot.value);
  const slides = Number.isFinite(centre);
  const size = slides ? Math.abs(centre) : 1, low = centre === 0 ? -1 : centre > 0 ? 0 : -2 * size, high = centre === 0 ? 1 : centre > 0 ? 2 * size : 0;
  const typed = (event: Event) => {
    const written = (event.target as HTMLInputElement).value.trim();
    const value = /^[+-]?inf$/.test(written) ? (written.startsWith("-") ? -Infinity : Infinity) : Number(written);
    if (written === "" || Number.isNaN(value)) return;
    setCentre(value);
    turn(pot.name, value);
  };
  return (
    <div class="knob">
      <label for={`pot-${pot.name}`}>{pot.name.split(/(?<=[._])/).map((part) => <>{part}<wbr /></>)}</label>
      <input type="range" aria-label={`${pot.name}, dragged`} disabled={!slides} min={low} max={high} step={(high - low) / 400} value={slides ? pot.value : 0}
        onInput={(event) => turn(pot.name, Number((event.target as HTMLInputElement).value))} />
      <input id={`pot-${pot.name}`} type="text" inputMode="decimal" value={short(pot.value)} onChange={typed} />
      <span class="unit">{besideNumber(pot.unit)}</span>
    </div>
  );
}

const narrow = matchMedia("(max-width: 700px)");

export function Pots({session}: {session: Session}) {
  const pots = useShown(session, (shown) => shown.pots);
  const [filter, setFilter] = useState("");
  const most = narrow.matches ? 8 : 40;
  const found = pots.filter((pot) => pot.name.toLowerCase().includes(filter.toLowerCase()));
  return (
    <section class="pots" aria-label="Potentiometers">
      <input type="search" placeholder={`find one of ${pots.length} pots`} aria-label="Find a pot" value={filter}
        onInput={(event) => setFilter((event.target as HTMLInputElement).value)} />
      {found.slice(0, most).map((pot) => <Knob key={pot.name} pot={pot} turn={(name, value) => void session.turn(name, value)} />)}
      {found.length > most && <p class="quiet">and {found.length - most} more: find them by name</p>}
    </section>
  );
}
