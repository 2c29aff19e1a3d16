// SPDX-License-Identifier: MIT
import {short} from "../numbers";
import {inUnit} from "./settings";
import {frequency, quantity, withUnit, type Screen} from "./screen";
import type {Sweep} from "./sweeps";

const small = 500, large = 10;  // parts of the screen's time that a key goes on by

/// The moment of the sweep that is nearest to a point of the screen, where a signal is drawn over another one.
function nearest(screen: Screen, sweep: Sweep, across: number, trace: number, x: number, y: number, shift: number): number {
  let least = Infinity, found = screen.time[0];
  for (let k = 0; k < sweep.times.length; ++k) {
    const away = (screen.toX(sweep.values[across]![k]!) - x) ** 2 + (screen.toY(trace, sweep.values[trace]![k]!) - y) ** 2;
    if (away < least) {
      least = away;
      found = sweep.times[k]! - shift;
    }
  }
  return found;
}

interface Given {
  screen: Screen;
  names: readonly string[];
  units: readonly string[];
  against: number;
  shift: number;  ///< of the newest sweep: the time that is written as 0 [s]
  at: readonly number[];
  move: (cursor: number, time: number) => void;
}

/// What is taken hold of, by mouse, finger and keys: over the time a line, over a signal a point of its way.
export function Handles({screen, names, units, against, shift, at, move}: Given) {
  const {frame} = screen.drawing, [begin, end] = screen.time, {newest} = screen;
  const traces = names.map((_, k) => k).filter((k) => k !== against);
  const within = (time: number) => Math.min(Math.max(time, begin), end);
  const drag = (cursor: number) => (event: PointerEvent) => {
    const handle = event.currentTarget as HTMLElement;
    if (event.type === "pointerdown") handle.setPointerCapture(event.pointerId);
    else if (!handle.hasPointerCapture(event.pointerId)) return;
    const box = handle.parentElement!.getBoundingClientRect(), x = event.clientX - box.left, y = event.clientY - box.top;
    if (against < 0) move(cursor, within(screen.fromX(x)));
    else if (newest && traces.length > 0) move(cursor, nearest(screen, newest, against, traces[0]!, x, y, shift));
  };
  const keys = (cursor: number) => (event: KeyboardEvent) => {
    const size = end - begin, step = event.shiftKey ? size / small * large : size / small;
    const to = ({
      ArrowLeft: at[cursor]! - step, ArrowDown: at[cursor]! - step, ArrowRight: at[cursor]! + step, ArrowUp: at[cursor]! + step,
      PageDown: at[cursor]! - size / large, PageUp: at[cursor]! + size / large, Home: begin, End: end,
    } as Record<string, number>)[event.key];
    if (to === undefined) return;
    event.preventDefault();
    move(cursor, within(to));
  };
  return (
    <>
      {at.map((time, cursor) => {
        const says = `${inUnit(time, "s")}${traces.map((trace, k) => `${k === 0 ? ": " : ", "}${names[trace]} = ${quantity(screen.read(trace, time), units[trace] ?? "")}`).join("")}`;
        const x = against < 0 ? screen.toX(time) : screen.toX(screen.read(against, time));
        const y = against < 0 || traces.length === 0 ? NaN : screen.toY(traces[0]!, screen.read(traces[0]!, time));
        const place = against < 0 ? {left: `${x}px`, top: `${frame.y}px`, height: `${frame.height}px`}
          : Number.isNaN(x) || Number.isNaN(y) ? {left: `${frame.x + 14 + 30 * cursor}px`, top: `${frame.y + 2}px`, height: "24px"}
            : {left: `${x}px`, top: `${y - 12}px`, height: "24px"};
        return <div class="cursor" role="slider" tabIndex={0} data-cursor={"AB"[cursor]} aria-label={`Cursor ${"AB"[cursor]}`} aria-orientation="horizontal"
          aria-valuemin={begin} aria-valuemax={end} aria-valuenow={time} aria-valuetext={says} style={place}
          onPointerDown={drag(cursor)} onPointerMove={drag(cursor)} onKeyDown={keys(cursor)} />;
      })}
    </>
  );
}

/// What the cursors show: Δt, 1/Δt, and of every trace the two values and ΔV.
export function Readings({screen, names, units, at}: Pick<Given, "screen" | "names" | "units" | "at">) {
  const [a, b] = [at[0]!, at[1]!];
  return (
    <table class="readings" aria-label="Readings of the cursors">
      <thead><tr><th /><th>A</th><th>B</th><th>B − A</th></tr></thead>
      <tbody>
        <tr><th scope="row">t</th><td>{inUnit(a, "s")}</td><td>{inUnit(b, "s")}</td><td class="apart">{inUnit(b - a, "s")}</td></tr>
        <tr><th scope="row">1/Δt</th><td /><td /><td class="often">{frequency(1 / (b - a))}</td></tr>
        {names.map((name, k) => {
          const atA = screen.read(k, a), atB = screen.read(k, b);
          const cell = (value: number) => (Number.isNaN(value) ? "–" : short(value));
          return <tr><th scope="row">{withUnit(name, units[k] ?? "")}</th><td>{cell(atA)}</td><td>{cell(atB)}</td><td data-apart={name}>{cell(atB - atA)}</td></tr>;
        })}
      </tbody>
    </table>
  );
}
