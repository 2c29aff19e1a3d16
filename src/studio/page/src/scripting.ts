// SPDX-License-Identifier: MIT
// What the page offers to scripts as `globalThis.oblique`: every function promises, and rejects with the finding in words.
import type {Advanced, Answer, Column, Read} from "./answers";
import type {Session} from "./session";

interface Ran extends Answer {
  columns: Column[];
  rows: number;
}

function refuse(answer: Answer): never {
  throw new Error((answer.diagnostics ?? []).map((finding) => finding.message).join("\n") || "the engine gave no answer");
}

const stopped: Advanced = {ok: false, numbers: new Float64Array(0), time: NaN, complete: false, rows: 0, seconds: 0, warnings: []};

function good<Given extends Answer>(answer: Given): Given {
  return answer.ok ? answer : refuse(answer);
}

function rowsOf(numbers: Float64Array, width: number): number[][] {
  return Array.from({length: width > 0 ? numbers.length / width : 0}, (_, row) => Array.from(numbers.subarray(row * width, (row + 1) * width)));
}

export function scripting(session: Session) {
  const {machine} = session;
  return {
    /// Puts a text in place of the one on the page: {kind, title, outputs: [names], signals, pots}.
    async open(text: string, name = "script.toml") {
      await session.ready;
      if (!(await session.load({name, text: String(text)}))) refuse({ok: false, diagnostics: session.shown.findings, numbers: new Float64Array(0)});
      const {kind, title, held} = session.shown;
      return {kind, title, outputs: held!.outputs, signals: held!.signals, pots: held!.pots};
    },
    /// Runs a diagram (without one: what the page runs) as `oblique run` does, beside the machine that is held:
    /// {columns: [{name, unit}], rows: [[number]]}, the time first.
    async run(text?: string, options: object = {}) {
      await session.ready;
      const {columns, numbers} = good(await machine.ask<Ran>("run", text ?? session.shown.diagram, options, "script.toml"));
      return {columns, rows: rowsOf(numbers, columns.length)};
    },
    /// Turns a pot of the machine that is held.
    async turn(name: string, value: number) {
      await session.ready;
      if (!(await session.turn(name, Number(value)))) refuse({ok: false, diagnostics: session.shown.findings, numbers: new Float64Array(0)});
    },
    /// The value of a signal, an output or a pot.
    async read(name: string): Promise<number> {
      await session.ready;
      return good(await machine.ask<Read>("console.read", name)).numbers[0]!;
    },
    /// "initial", "operate" or "hold".
    async mode(mode: "initial" | "operate" | "hold") {
      await session.ready;
      await session.press(mode);
    },
    /// Operates for so long [s] and holds: the time then.
    async advance(duration: number): Promise<number> {
      await session.ready;
      return good(await session.advance(Number(duration)) ?? stopped).time;
    },
  };
}
