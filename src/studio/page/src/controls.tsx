// SPDX-License-Identifier: MIT
import {useState} from "preact/hooks";

import type {Diagnostic} from "./answers";

export type Mode = "initial" | "operate" | "hold" | "repeat";

/// A number to six digits, as files write it: an infinite one is "inf".
export function short(value: number): string {
  if (Number.isFinite(value)) return String(Number(value.toPrecision(6)));
  return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

/// What the engine found, by lines; a click leads there.
export function Findings({of, goTo}: {of: Diagnostic[]; goTo: (line: number, column: number) => void}) {
  return (
    <ul class="findings" role="alert">
      {of.map((finding) => (
        <li>
          {finding.line > 0 && <button class="link" onClick={() => goTo(finding.line, finding.column)}>line {finding.line}</button>} {finding.what}
          {finding.expected && <>; expected {finding.expected}</>}
          {finding.remedy && <div class="remedy">{finding.remedy}</div>}
        </li>
      ))}
    </ul>
  );
}

export interface Pot {
  name: string;
  value: number;
  unit: string;
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
      <label for={`pot-${pot.name}`}>{pot.name}</label>
      <input type="range" aria-label={`${pot.name}, dragged`} disabled={!slides} min={low} max={high} step={(high - low) / 400} value={slides ? pot.value : 0}
        onInput={(event) => turn(pot.name, Number((event.target as HTMLInputElement).value))} />
      <input id={`pot-${pot.name}`} type="text" inputMode="decimal" value={short(pot.value)} onChange={typed} />
      <span class="unit">{/^(machine unit|1)$/.test(pot.unit) ? "" : pot.unit}</span>
    </div>
  );
}

export function Pots({pots, turn}: {pots: Pot[]; turn: (name: string, value: number) => void}) {
  const [filter, setFilter] = useState("");
  const most = 40;
  const found = pots.filter((pot) => pot.name.toLowerCase().includes(filter.toLowerCase()));
  return (
    <section class="pots" aria-label="Potentiometers">
      <input type="search" placeholder={`find one of ${pots.length} pots`} aria-label="Find a pot" value={filter}
        onInput={(event) => setFilter((event.target as HTMLInputElement).value)} />
      {found.slice(0, most).map((pot) => <Knob key={pot.name} pot={pot} turn={turn} />)}
      {found.length > most && <p class="quiet">and {found.length - most} more: find them by name</p>}
    </section>
  );
}
