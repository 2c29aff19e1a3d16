// SPDX-License-Identifier: MIT
// The screen of the scope as a drawing: axes, sweeps, cursors, and all of it in words.
import {dashOf, widthOf, type Drawing, type Frame, type Label, type Line} from "./drawing";
import {divisionsAcross, divisionsUp, fitted, inUnit, niceStep, type OwnScale, placeInWords, type ScopeSettings} from "./settings";
import {valueAt, type Sweep} from "./sweeps";
import {short} from "../numbers";

export interface Given {
  names: readonly string[];
  units: readonly string[];
  sweeps: readonly Sweep[];
  against: number;              ///< the trace that is the x axis; -1: the time
  length: number;               ///< [s] of a sweep; 0: all that there is
  fromTrigger: boolean;         ///< the time counts from the trigger
  settings: ScopeSettings;
  cursors: readonly number[];   ///< [s], as they are written at the axis
  status: string;
  width: number;
  height: number;
}

export interface Screen {
  drawing: Drawing;
  toX: (value: number) => number;    ///< [px]
  toY: (trace: number, value: number) => number;
  fromX: (pixel: number) => number;
  /// The traces with a scale of their own.
  own: readonly {trace: number; scale: OwnScale}[];
  time: [number, number];            ///< what the screen shows, as it is written at the axis [s]
  newest: Sweep | undefined;
  /// A trace at a time as it is written at the axis: of the newest sweep that has come there; NaN where none has.
  read: (trace: number, time: number) => number;
}

const plain = (unit: string) => (unit === "1" ? "" : unit);
export const withUnit = (name: string, unit: string) => (plain(unit) ? `${name} [${plain(unit)}]` : name);
export const quantity = (value: number, unit: string) => `${short(value)}${plain(unit) ? ` ${plain(unit)}` : ""}`;

export function rangeOf(columns: readonly Float64Array[]): [number, number] {
  let low = Infinity, high = -Infinity;
  for (const column of columns) {
    for (const value of column) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return [low, high];
}

/// With room around it; of what is constant so much that the rounding of its last digits is no curve.
export function roomAround([low, high]: [number, number]): [number, number] {
  if (!(low <= high)) return [-1, 1];
  const size = Math.max(Math.abs(low), Math.abs(high)), more = high - low > 1e-9 * size ? 0.06 * (high - low) : 0.1 * Math.max(size, 1e-3);
  return [low - more, high + more];
}

/// A line over the time as few points as are seen: of each column of pixels the first, the least, the greatest and the
/// last.
export function thinned(times: Float64Array, values: Float64Array, toX: (t: number) => number, toY: (v: number) => number): number[] {
  const points: number[] = [];
  if (times.length <= 1500) {
    for (let k = 0; k < times.length; ++k) points.push(toX(times[k]!), toY(values[k]!));
    return points;
  }
  let k = 0;
  while (k < times.length) {
    const column = Math.floor(toX(times[k]!));
    let low = k, high = k, last = k;
    const first = k;
    for (; k < times.length && Math.floor(toX(times[k]!)) === column; ++k) {
      if (values[k]! < values[low]!) low = k;
      if (values[k]! > values[high]!) high = k;
      last = k;
    }
    let before = -1;
    for (const at of [first, Math.min(low, high), Math.max(low, high), last]) {
      if (at === before) continue;
      points.push(toX(times[at]!), toY(values[at]!));
      before = at;
    }
  }
  return points;
}

/// A way over the plane without the points that are nearer than half a pixel to the one before.
function way(xs: Float64Array, ys: Float64Array, toX: (v: number) => number, toY: (v: number) => number): number[] {
  const points: number[] = [];
  let x = NaN, y = NaN;
  for (let k = 0; k < xs.length; ++k) {
    const nextX = toX(xs[k]!), nextY = toY(ys[k]!);
    if (k + 1 < xs.length && Math.abs(nextX - x) + Math.abs(nextY - y) < 0.5) continue;
    points.push(x = nextX, y = nextY);
  }
  return points;
}

const timeUnits: [number, string][] = [[1, "s"], [1e-3, "ms"], [1e-6, "µs"], [1e-9, "ns"]];

function ticks(low: number, high: number, step: number): number[] {
  const all: number[] = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && all.length < 50; ++k) all.push(k * step);
  return all;
}

export function screenOf(given: Given): Screen {
  const {names, units, sweeps, against, settings, width, height, cursors, length} = given;
  const newest = sweeps.at(-1);
  const shownTraces = names.map((_, k) => k).filter((k) => k !== against);
  const overSignal = against >= 0;

  // what time the screen shows
  let [begin, end] = [0, length];
  if (!given.fromTrigger) {
    const last = newest ? newest.times[newest.times.length - 1]! : 0;
    const first = sweeps.reduce((least, sweep) => Math.min(least, sweep.times[0] ?? least), newest?.times[0] ?? 0);
    [begin, end] = length > 0 ? [Math.max(last - length, 0), Math.max(last, length)] : [first, last > first ? last : first + 1];
  }
  const own = shownTraces.flatMap((trace) => {
    const scale = settings.own.get(names[trace]!);
    return scale ? [{trace, scale}] : [];
  });
  const alike = shownTraces.filter((trace) => !own.some((one) => one.trace === trace));
  // the numbers at the left are of those that are drawn alike; without any, of the first one
  const numbered = alike[0] ?? shownTraces[0];
  const ownInk = alike.length === 0 && own.length > 0 ? own[0]!.trace : undefined;
  const screenful = ({volts, position}: OwnScale): [number, number] => [(-divisionsUp / 2 - position) * volts, (divisionsUp / 2 - position) * volts];
  const fixed: [number, number] = [settings.centre - settings.volts * divisionsUp / 2, settings.centre + settings.volts * divisionsUp / 2];
  const inSight = roomAround(rangeOf(sweeps.flatMap((sweep) => alike.map((trace) => sweep.values[trace]!))));
  const [low, high] = ownInk !== undefined ? screenful(own[0]!.scale) : settings.volts > 0 ? fixed : own.length > 0 ? screenful(fitted(inSight)) : inSight;
  const yStep = own.length > 0 ? (high - low) / divisionsUp : settings.volts > 0 ? settings.volts : niceStep(high - low, divisionsUp);
  const [left, right] = !overSignal ? [begin, end] : settings.volts > 0 ? fixed : roomAround(rangeOf(sweeps.map((sweep) => sweep.values[against]!)));
  const xStep = overSignal ? (settings.volts > 0 ? settings.volts : niceStep(right - left, 8))
    : length > 0 ? length / divisionsAcross : niceStep(right - left, divisionsAcross);

  // room for what is written
  const size = 12;
  const [timeScale, timeUnit] = overSignal ? timeUnits[0]! : timeUnits.find(([scale]) => right - left >= 0.5 * scale) ?? timeUnits.at(-1)!;
  const asText = (value: number, step: number) => short(Number((Math.round(value / step) * step).toPrecision(9))).replace("-", "−");
  // where traces have scales of their own the lines are those of the divisions
  const yTicks = own.length > 0 ? Array.from({length: divisionsUp + 1}, (_, k) => low + k * yStep) : ticks(low, high, yStep), xTicks = ticks(left, right, xStep);
  const atTick = (tick: number) => (own.length > 0 ? short(Number((Math.abs(tick) < 1e-9 * yStep ? 0 : tick).toPrecision(6))).replace("-", "−") : asText(tick, yStep));
  const common = new Set(alike.map((trace) => plain(units[trace] ?? "")));
  const yUnit = common.size === 1 ? [...common][0]! : "";
  const labels: Label[] = [], lines: Line[] = [];
  let row = 0, at = 8;
  for (const trace of shownTraces) {
    const scale = settings.own.get(names[trace]!);
    const text = withUnit(names[trace]!, units[trace] ?? "") + (scale ? `, ${short(scale.volts)} a division` : "");
    const wide = 26 + widthOf(text, size) + 14;
    if (at > 8 && at + wide > width) {
      ++row;
      at = 8;
    }
    labels.push({x: at + 26, y: 15 + 16 * row, text, anchor: "start", ink: "ink", size});
    labels.push({x: at + 22, y: 15 + 16 * row, text: "━━", anchor: "end", ink: trace, size});
    at += wide;
  }
  const apart = cursors.length === 2 ? cursors[1]! - cursors[0]! : NaN;
  if (cursors.length === 2) {
    const text = `Δt = ${inUnit(apart, "s")}, 1/Δt = ${frequency(1 / apart)}`;
    if (at + widthOf(text, size) > width - 14) ++row;
    labels.push({x: width - 14, y: 15 + 16 * row, text, anchor: "end", ink: "ink", size});
  }
  const top = 28 + 16 * row;
  const widest = Math.max(0, ...yTicks.map((tick) => widthOf(atTick(tick), size)));
  const frame: Frame = {x: Math.ceil(26 + widest), y: top, width: 0, height: Math.max(height - top - 42, 40)};
  frame.width = Math.max(width - frame.x - 14, 40);
  const toX = (value: number) => frame.x + (value - left) / (right - left) * frame.width;
  const toY = (trace: number, value: number) => {
    const scale = settings.own.get(names[trace]!);
    const [least, most] = scale ? screenful(scale) : [low, high];
    return frame.y + frame.height - (value - least) / (most - least) * frame.height;
  };
  const fromX = (pixel: number) => left + (pixel - frame.x) / frame.width * (right - left);

  let clear = -Infinity;
  for (const tick of xTicks) {
    lines.push({points: [toX(tick), frame.y, toX(tick), frame.y + frame.height], ink: "faint", width: 1, opacity: 1});
    const text = asText(tick / timeScale, xStep / timeScale), half = widthOf(text, size) / 2;
    if (toX(tick) - half < clear || toX(tick) + half > width) continue;
    clear = toX(tick) + half + 6;
    labels.push({x: toX(tick), y: frame.y + frame.height + 15, text, anchor: "middle", ink: "ink", size});
  }
  for (const tick of yTicks) {
    const y = toY(numbered ?? -1, tick);
    lines.push({points: [frame.x, y, frame.x + frame.width, y], ink: "faint", width: 1, opacity: 1});
    labels.push({x: frame.x - 5, y: y + 4, text: atTick(tick), anchor: "end", ink: ownInk ?? "ink", size});
  }
  // where the zero of each is; beyond the screen at its edge
  for (const {trace} of own) {
    const y = toY(trace, 0), bottom = frame.y + frame.height;
    labels.push({x: frame.x + 2, y: Math.min(Math.max(y, frame.y + 8), bottom - 4) + 4, text: y < frame.y ? "▴" : y > bottom ? "▾" : "▸", anchor: "start", ink: trace, size: 14, halo: true});
  }
  const xLabel = overSignal ? withUnit(names[against]!, units[against] ?? "") : `${given.fromTrigger ? "t from the trigger" : "t"} [${timeUnit}]`;
  labels.push({x: frame.x, y: frame.y + frame.height + 34, text: xLabel, anchor: "start", ink: "ink", size});
  labels.push({x: 14, y: frame.y + frame.height / 2, text: ownInk !== undefined ? withUnit(names[ownInk]!, units[ownInk] ?? "") : yUnit ? `[${yUnit}]` : alike.length === 1 ? names[alike[0]!]! : alike.length > 1 ? "in the unit of each" : "",
    anchor: "middle", ink: ownInk ?? "ink", size, upwards: true});
  if (given.status) labels.push({x: frame.x + frame.width, y: frame.y + frame.height + 34, text: given.status, anchor: "end", ink: "quiet", size: 11});

  // sweeps: the older, the fainter
  sweeps.forEach((sweep, k) => {
    const age = sweeps.length - 1 - k, opacity = age === 0 ? 1 : Math.max(0.1, 0.6 * 0.8 ** (age - 1));
    const zero = given.fromTrigger ? sweep.zero : 0;
    for (const trace of shownTraces) {
      const up = (value: number) => toY(trace, value);
      const points = overSignal ? way(sweep.values[against]!, sweep.values[trace]!, toX, up)
        : thinned(sweep.times, sweep.values[trace]!, (t) => toX(t - zero), up);
      lines.push({points, ink: trace, width: age === 0 ? 1.7 : 1.2, opacity, dash: dashOf(trace)});
    }
  });

  const discs: Drawing["discs"] = [];
  const words: string[] = [];
  const read = (trace: number, time: number) => {
    for (let k = sweeps.length - 1; k >= 0; --k) {
      const value = valueAt(sweeps[k]!, trace, given.fromTrigger ? time + sweeps[k]!.zero : time);
      if (!Number.isNaN(value)) return value;
    }
    return NaN;
  };
  const triggering = shownTraces.find((trace) => names[trace] === settings.source);
  if (given.fromTrigger && triggering !== undefined && !overSignal) {
    const y = Math.min(Math.max(toY(triggering, settings.level), frame.y), frame.y + frame.height);
    labels.push({x: frame.x + frame.width + 12, y: y + 4, text: "◂", anchor: "end", ink: triggering, size: 14});
  }
  cursors.forEach((time, k) => {
    const name = "AB"[k]!;
    if (!overSignal) {
      lines.push({points: [toX(time), frame.y, toX(time), frame.y + frame.height], ink: "ink", width: 1, opacity: 0.8, dash: k === 0 ? [6, 3] : [2, 3]});
      labels.push({x: toX(time) + (toX(time) > frame.x + frame.width - 16 ? -4 : 4), y: frame.y + 13, text: name, anchor: toX(time) > frame.x + frame.width - 16 ? "end" : "start", ink: "ink", size, halo: true});
    }
    const values = shownTraces.map((trace) => read(trace, time));
    const across = overSignal ? read(against, time) : time;
    values.forEach((value, v) => {
      if (Number.isNaN(value) || Number.isNaN(across)) return;
      const y = toY(shownTraces[v]!, value);
      discs.push({x: toX(across), y, radius: 3.5, ink: shownTraces[v]!});
      if (overSignal && v === 0) labels.push({x: toX(across) + 6, y: y - 5, text: name, anchor: "start", ink: "ink", size, halo: true});
    });
    words.push(`cursor ${name} at ${inUnit(time, "s")}: ${shownTraces.map((trace, v) => `${names[trace]} ${Number.isNaN(values[v]!) ? "not reached" : `= ${quantity(values[v]!, units[trace] ?? "")}`}`).join(", ")}`);
  });
  if (cursors.length === 2) words.push(`Δt = ${inUnit(apart, "s")}, 1/Δt = ${frequency(1 / apart)}`);

  const ranges = shownTraces.map((trace) => {
    const [least, most] = rangeOf(sweeps.map((sweep) => sweep.values[trace]!));
    return `${names[trace]} ${least <= most ? `from ${quantity(least, "")} to ${quantity(most, units[trace] ?? "")}` : "without a value yet"}`;
  });
  const over = overSignal ? names[against]! : given.fromTrigger ? "the time from the trigger" : "the time";
  const description = [
    `${ranges.join("; ") || "no trace"}`,
    overSignal ? `${names[against]} across, from ${short(left)} to ${quantity(right, units[against] ?? "")}` : `time from ${inUnit(left, "s")} to ${inUnit(right, "s")}`,
    alike.length > 0 || own.length === 0 ? `screen from ${short(low)} to ${quantity(high, yUnit)}` : "",
    ...own.map(({trace, scale}) => `${names[trace]} ${quantity(scale.volts, units[trace] ?? "")} a division, its zero ${placeInWords(scale.position)}`),
    sweeps.length > 1 ? `${sweeps.length} sweeps, the older fainter` : "",
    given.status, ...words,
  ].filter(Boolean).join(". ") + ".";
  const title = `Oscilloscope: ${shownTraces.map((trace) => names[trace]).join(", ") || "nothing"} over ${over}`;
  return {drawing: {width, height, title, description, frame, lines, discs, labels}, toX, toY, fromX, own, time: [begin, end], newest, read};
}

/// "50 Hz", with its sign.
export function frequency(value: number): string {
  if (!Number.isFinite(value)) return "∞";
  const size = Math.abs(value);
  const [scale, prefix] = size >= 1e6 ? [1e6, "M"] : size >= 1e3 ? [1e3, "k"] : size >= 1 || size === 0 ? [1, ""] : [1e-3, "m"];
  return `${Number((value / Number(scale)).toPrecision(6))} ${prefix}Hz`;
}
