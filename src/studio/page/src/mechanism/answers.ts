// SPDX-License-Identifier: MIT
// What the engine gives of mechanisms, as live_mechanism.h, mechanism_study.h and live_comparison.h say it.
import type {Answer} from "../answers";

export interface OpenedMechanism extends Answer {
  title: string;
  unit: string;
  size: number;
  span: number;
  closed: boolean;
  drive: {name: string; slide: boolean} | null;
  points: {name: string; fixed: boolean}[];
  width: number;
  height: number;
  svg: string;
}

export interface Position extends Answer {
  time: number;
  drive: number;
  status: "ok" | "dead-centre" | "open";
  svg: string;
  analog?: boolean;
  away?: number;
  worst?: string;
  suggested?: number;
}

export interface Nearest extends Answer {
  time: number;
  drive: number;
  distance: number;
}

export interface DraggedAnswer extends Answer {
  text: string;
  changed: {name: string; before: number; after: number}[];
  drive: number;
  sketch_moved: boolean;
  svg: string;
}

export interface Met {
  kind: "limit" | "return" | "change" | "infinity" | "lost";
  what: string;
  group: string;
  time: number | null;
  drive: number;
}

export interface Events extends Answer {
  events: Met[];
  from: number;
  to: number;
}

export interface Mode {
  selected: boolean;
  points: Record<string, [number, number]>;
  svg?: string;
  text?: string;
  why?: string;
}

export interface Modes extends Answer {
  groups: {name: string; class: number; complete: boolean; modes: Mode[]}[];
}

export interface Splits extends Answer {
  splits: {legs: string[]; worth: number; flips: number | null}[];
}

export interface Loops extends Answer {
  rows: number;
  columns: string[];
  signals: string[];
  split: string[];
  slower: number;
  bandwidth: number;
  outer: string[];
  growing: number;
  rightmost: {real: number; imaginary: number; time: number; drive: number; signal: string} | null;
  no_rest: string | null;
}

export interface ComparedRun {
  gain: number;
  max_error: number;
  rms_error: number;
  static: number | null;
  lag: number | null;
  solver: number | null;
  worst: string;
  steps: number;
  overloads: number;
  stable: boolean;
  off_branch: boolean;
}

export interface Compared extends Answer {
  runs: ComparedRun[];
  order: number | null;
  floor: number | null;
  svg: string;
}
