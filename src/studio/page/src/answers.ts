// SPDX-License-Identifier: MIT
// What the engine gives, as src/studio/engine/engine.h and live_console.h say it.

export interface Diagnostic {
  file: string;
  line: number;
  column: number;
  what: string;
  expected: string;
  remedy: string;
  message: string;
}

export interface Answer {
  ok: boolean;
  error?: string;
  diagnostics?: Diagnostic[];
  numbers: Float64Array;
}

export interface Column {
  name: string;
  unit: string;
}

export interface LessonStep {
  do: string;
  guess: string;
  set: {name: string; value: string}[];
  see: string;
  checked: boolean;
}

export interface Lesson {
  title: string;
  text: string;
  steps: LessonStep[];
  question: {ask: string; answer: string; hint: string} | null;
}

export interface Checked extends Answer {
  met: boolean;
  checks: {what: string; actual: number; value: number; within: number; met: boolean}[];
}

export interface Opened extends Answer {
  kind: "diagram" | "mechanism";
  title: string;
  until: number;
  outputs: Column[];
  signals: string[];
  lesson: Lesson | null;
  unit: string;
}

export interface Patched extends Answer {
  text: string;
  judgement: string;
}

export interface Drawn extends Answer {
  svg: string;
}

export interface Held extends Answer {
  time: number;
  outputs: string[];
  signals: string[];
  pots: string[];
}

export interface Exchanged extends Held {
  turned: Record<string, string>;
}

export interface Advanced extends Answer {
  time: number;
  complete: boolean;
  rows: number;
  seconds: number;
  warnings: Diagnostic[];
}

export interface Read extends Answer {
  units: string[];
}

export interface Overloads extends Answer {
  signals: string[];
}

export interface Saved extends Answer {
  state: string;
}

/// What the page asks its worker for, and what comes back.
export interface Question {
  id: number;
  verb: string;
  given: unknown[];
}
export interface Reply {
  id: number;
  answer: Answer;
}
