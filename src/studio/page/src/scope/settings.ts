// SPDX-License-Identifier: MIT
// What is set at the oscilloscope.

export type Slope = "rising" | "falling" | "either";

/// auto: without a trigger for a while the beam runs free; normal: it waits; single: one sweep, until it is armed again.
export type TriggerMode = "auto" | "normal" | "single";

/// The scale of one trace.
export interface OwnScale {
  volts: number;     ///< units a division
  position: number;  ///< of its zero: divisions above the middle of the screen
}

export interface ScopeSettings {
  base: number;      ///< seconds a division, of ten; 0: automatic
  volts: number;     ///< units a division, of eight, of the traces without a scale of their own; 0: automatic
  centre: number;    ///< what stands in the middle of the screen, where `volts` is set
  own: ReadonlyMap<string, OwnScale>;
  source: string;    ///< of the trigger: a signal or an output; `runs`; empty: none, the beam runs free
  level: number;     ///< in its unit
  slope: Slope;
  mode: TriggerMode;
  armed: number;     ///< counts up where a single sweep is asked for again
  cursors: boolean;
}

/// The trigger that each run of the repetitive operation gives.
export const everyRun = "\u0000run";

export const divisionsAcross = 10;
export const divisionsUp = 8;

export const atFirst: ScopeSettings = {base: 0, volts: 0, centre: 0, own: new Map(), source: "", level: 0, slope: "rising", mode: "auto", armed: 0, cursors: false};

/// 1, 2 and 5 times powers of ten, from `low` to `high`.
export function steps(low: number, high: number): number[] {
  const all: number[] = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power) {
    for (const digit of [1, 2, 5]) {
      const step = Number(`${digit}e${power}`);
      if (step >= low && step <= high) all.push(step);
    }
  }
  return all;
}

export const timeSteps = steps(1e-6, 10), scaleSteps = steps(1e-6, 100);

/// The step of 1, 2 or 5 times a power of ten that divides so much into `most` parts at the most.
export function niceStep(size: number, most: number): number {
  const rough = size / most, power = 10 ** Math.floor(Math.log10(rough));
  return (rough <= power ? 1 : rough <= 2 * power ? 2 : rough <= 5 * power ? 5 : 10) * power;
}

/// A scale of whole divisions that a range has room on.
export function fitted([low, high]: readonly [number, number]): OwnScale {
  const volts = niceStep(high - low, divisionsUp - 1);
  return {volts, position: -Math.round((low + high) / 2 / volts)};
}

/// "1.5 divisions above the middle".
export function placeInWords(position: number): string {
  if (position === 0) return "in the middle";
  return `${Math.abs(position)} ${Math.abs(position) === 1 ? "division" : "divisions"} ${position > 0 ? "above" : "below"} the middle`;
}

const prefixes: [number, string][] = [[1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];

/// "20 ms": with the prefix of the unit that leaves the fewest zeros.
export function inUnit(value: number, unit: string): string {
  const size = Math.abs(value);
  const [scale, prefix] = size === 0 || size >= 1 ? prefixes[0]! : prefixes.find(([scale]) => size >= scale * 0.999_999) ?? prefixes.at(-1)!;
  return `${Number((value / scale).toPrecision(6))} ${prefix}${unit}`;
}
