// SPDX-License-Identifier: MIT
// What the tests of the engine share. They stand in the source folder, so that both name a file alike.
import {spawnSync} from "node:child_process";
import {mkdtempSync, readdirSync, readFileSync, rmSync} from "node:fs";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {pathToFileURL} from "node:url";

const built = process.env.OBLIQUE_ENGINE;
const program = process.env.OBLIQUE_PROGRAM;

export const enginePath = (name) => join(built, name);

export async function newEngine(limits) {
  const {loadEngine} = await import(pathToFileURL(enginePath("engine.mjs")));
  const createEngine = createRequire(import.meta.url)(enginePath("engine.js"));
  return loadEngine({createEngine, wasmBinary: readFileSync(enginePath("engine.wasm")), limits});
}

// Runs the program: {status, out, err}.
export function runProgram(args, input = "", env = process.env) {
  const done = spawnSync(program, args, {input, env, encoding: "utf8", maxBuffer: 1 << 28});
  if (done.error) throw done.error;
  return {status: done.status, out: done.stdout, err: done.stderr};
}

// Gives `work` a folder that is gone afterwards.
export function inScratch(work) {
  const folder = mkdtempSync(join(tmpdir(), "oblique-"));
  try {
    return work(folder);
  } finally {
    rmSync(folder, {recursive: true});
  }
}

// All files below diagrams of a format, sorted: {name, text}.
export function shipped(format) {
  const files = (folder) =>
    readdirSync(folder, {withFileTypes: true}).flatMap((entry) =>
      entry.isDirectory() ? files(join(folder, entry.name)) : [join(folder, entry.name)]);
  return files("diagrams")
    .filter((name) => name.endsWith(".toml"))
    .sort()
    .map((name) => ({name, text: readFileSync(name, "utf8")}))
    .filter(({text}) => new RegExp(`^format *= *"${format}"`, "m").test(text));
}

// A table of the program: {columns, rows}; no value is NaN, a word the number of it in `words`.
export function readTable(csv, words = []) {
  const [head, ...lines] = csv.trimEnd().split("\n");
  const number = (cell) => (cell === "" ? NaN : words.includes(cell) ? words.indexOf(cell) : Number(cell.replace(/inf$/, "Infinity")));
  return {columns: head.split(","), rows: lines.map((line) => line.split(",").map(number))};
}
