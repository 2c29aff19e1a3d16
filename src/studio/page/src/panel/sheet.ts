// SPDX-License-Identifier: MIT
// What the engine gives of a patch panel, as src/studio/engine/patching.h says it, and what lies where in it.
import type {Answer} from "../answers";

export type At = [number, number];

export interface Wire {
  port: string;
  term: number;
  text: string;
  signal: string;
  weight: number;
  at: At | null;
}

export interface Element {
  name: string;
  type: string;
  label: string;
  known: boolean;
  is_composite: boolean;
  place: At;
  placed: boolean;
  body: [number, number, number, number] | null;
  settings: Record<string, string>;
  wires: Wire[];
  open: {port: string; at: At}[];
  outputs: {signal: string; at: At}[];
}

export interface Sheet extends Answer {
  svg: string;
  origin: At;
  blocks: Element[];
  moved: {name: string; at: At}[];
  lost: string[];
  shown: {name: string; signal: string}[];
  title: string;
  until: string;
}

export interface Kind {
  name: string;
  title: string;
  summary: string;
  doc: string;
  is_composite: boolean;
  inputs: {name: string; sum: boolean; optional: boolean; doc: string}[];
  outputs: {name: string; doc: string}[];
  parameters: {name: string; default: string; unit: string; range: string; doc: string}[];
  svg: string;
}

export interface Kinds extends Answer {
  blocks: Kind[];
}

export interface Edited extends Answer {
  text: string;
  added: string;
  renamed: [string, string][];
}

/// One step of an edit, as the engine takes it.
export type Step = {do: string} & Record<string, unknown>;

export const placeUnit = 16;  // px, of a [layout]

/// What may be taken hold of.
export type Grip =
  | {what: "block"; block: string}
  | {what: "output"; block: string; signal: string}
  | {what: "input"; block: string; port: string; term: number | null};  ///< null: nothing is wired there

const near = 12;  // px from a pin

/// What lies at a point of the picture: pins before bodies. `wanted` says which pins count.
export function gripAt(sheet: Sheet, [x, y]: At, wanted: "any" | "inputs" | "outputs" = "any"): Grip | undefined {
  let best: Grip | undefined, distance = Infinity;
  const look = (at: At, side: number, grip: Grip) => {
    const away = Math.hypot(Math.max(0, Math.abs(x - at[0] - side * near / 2) - near / 2), y - at[1]);
    if (away < near * 0.75 && away < distance) [best, distance] = [grip, away];
  };
  for (const block of sheet.blocks) {
    if (wanted !== "outputs") {
      for (const wire of block.wires) if (wire.at) look(wire.at, -1, {what: "input", block: block.name, port: wire.port, term: wire.term});
      for (const open of block.open) look(open.at, -1, {what: "input", block: block.name, port: open.port, term: null});
    }
    if (wanted !== "inputs") for (const output of block.outputs) look(output.at, 1, {what: "output", block: block.name, signal: output.signal});
  }
  if (best) return best;
  for (const {name, body} of sheet.blocks) {
    if (body && x >= body[0] && x <= body[0] + body[2] && y >= body[1] && y <= body[1] + body[3]) return {what: "block", block: name};
  }
  return undefined;
}

export function sizeOf(svg: string): At {
  const box = /viewBox="0 0 ([0-9.]+) ([0-9.]+)"/.exec(svg);
  return box ? [Number(box[1]), Number(box[2])] : [0, 0];
}
