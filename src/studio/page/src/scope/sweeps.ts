// SPDX-License-Identifier: MIT
// What the scope shows: sweeps, the newest last.
import type {Traces} from "../traces";

export interface Sweep {
  zero: number;            ///< the time of the machine that is written as 0 [s]
  times: Float64Array;     ///< [s]
  values: Float64Array[];  ///< of each name, one for each time
}

/// Rows of numbers, the time first, as a sweep.
export function sweepOf(numbers: Float64Array, width: number, zero: number): Sweep {
  const rows = numbers.length / width;
  const column = (c: number) => Float64Array.from({length: rows}, (_, row) => numbers[row * width + c]!);
  return {zero, times: column(0), values: Array.from({length: width - 1}, (_, c) => column(1 + c))};
}

/// The rows from one to another as a sweep.
function cut(traces: Traces, from: number, to: number, zero: number): Sweep {
  return {zero, times: traces.column(0, from, to), values: traces.names.map((_, c) => traces.column(1 + c, from, to))};
}

/// The free beam: each run since the machine began, the last `length` seconds of it.
export function freeSweeps(traces: Traces, length: number): Sweep[] {
  return traces.runs().map(({from, to}) => {
    const begin = traces.at(0, to - 1) - length;
    let first = from;
    if (traces.at(0, from) < begin) {  // times grow within a run; one row more, so that the beam comes from the edge
      let low = from, high = to - 1;
      while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (traces.at(0, middle) < begin) low = middle;
        else high = middle;
      }
      first = low;
    }
    return cut(traces, first, to, 0);
  });
}

export interface Repeats {
  since: number;    ///< [s]
  initial: number;  ///< [s] in initial condition
  operate: number;  ///< [s]
}

/// What the machine does from each beginning of operation on: where it repeats, and where its clock began again.
export function runSweeps(traces: Traces, repeats: Repeats | undefined, length: number, most: number): Sweep[] {
  const sweeps: Sweep[] = [];
  const add = (from: number, to: number, zero: number) => {
    let end = to;
    while (end > from && traces.at(0, end - 1) > zero + length) --end;
    if (end > from) sweeps.push(cut(traces, from, end, zero));
  };
  for (const {from, to} of traces.runs()) {
    if (!repeats || traces.at(0, to - 1) < repeats.since) {
      add(from, to, traces.at(0, from));
      continue;
    }
    const period = repeats.initial + repeats.operate;
    let begin = from, of = -1;
    for (let row = from; row <= to; ++row) {
      const into = row < to ? (traces.at(0, row) - repeats.since) / period : NaN;
      const run = row < to ? Math.floor(into + 1e-12) : -1;
      if (run === of && row < to) continue;
      if (of >= 0) {
        const zero = repeats.since + of * period + repeats.initial;
        while (begin < row && traces.at(0, begin) < zero) ++begin;  // in initial condition the beam is dark
        if (begin < row) add(begin, row, zero);
      }
      begin = row;
      of = run;
    }
  }
  return sweeps.slice(-most);
}

/// A value at a time, between the rows beside it; NaN outside.
export function valueAt(sweep: Sweep, trace: number, time: number): number {
  const {times} = sweep, values = sweep.values[trace]!;
  if (times.length === 0 || !(time >= times[0]! && time <= times[times.length - 1]!)) return NaN;
  let low = 0, high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle]! <= time) low = middle;
    else high = middle;
  }
  const step = times[high]! - times[low]!;
  return step > 0 ? values[low]! + (values[high]! - values[low]!) * (time - times[low]!) / step : values[high]!;
}

/// As a table: of triggered sweeps the time from the trigger.
export function csvOf(names: readonly string[], sweeps: readonly Sweep[], numbered: boolean): string {
  const quoted = (name: string) => (/[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name);
  const lines = [[...(numbered ? ["sweep"] : []), "t", ...names].map(quoted).join(",")];
  sweeps.forEach(({zero, times, values}, sweep) => {
    for (let row = 0; row < times.length; ++row) {
      if (values.length > 0 && values.every((column) => Number.isNaN(column[row]!))) continue;  // between two beams
      lines.push([...(numbered ? [sweep + 1] : []), times[row]! - zero, ...values.map((column) => column[row]!)].join(","));
    }
  });
  return lines.join("\n") + "\n";
}

