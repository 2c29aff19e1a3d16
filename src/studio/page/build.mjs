// SPDX-License-Identifier: MIT
// One page of it all: node build.mjs FOLDER, with the engine in FOLDER and what the lock file names in FOLDER/npm; checks the
// types and writes FOLDER/studio.html.
import {spawnSync} from "node:child_process";
import {createHash} from "node:crypto";
import {cpSync, existsSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync} from "node:fs";
import {createRequire} from "node:module";
import {basename, dirname, join, relative, resolve} from "node:path";
import {fileURLToPath, pathToFileURL} from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2];
const built = resolve(folder), stage = join(built, "npm");
const diagrams = join(here, "../../../diagrams");

// Beside the packages, where they are found.
rmSync(join(stage, "src"), {recursive: true, force: true});
cpSync(join(here, "src"), join(stage, "src"), {recursive: true});
cpSync(join(here, "tsconfig.json"), join(stage, "tsconfig.json"));

function run(program, given, options = {}) {
  const done = spawnSync(program, given, {encoding: "utf8", cwd: stage, maxBuffer: 1 << 27, ...options});
  if (done.status !== 0) throw new Error(`${program}: ${done.stdout ?? ""}${done.stderr ?? ""}${done.error ?? ""}`);
  return done.stdout;
}

run(process.execPath, [join(stage, "node_modules/typescript/bin/tsc"), "-p", "."]);

function bundle(entry, ...options) {
  return run("esbuild", [join("src", entry), "--bundle", "--minify", "--target=es2022", "--charset=utf8", "--log-level=warning",
    "--legal-comments=none", ...options]);
}

const files = (at) => readdirSync(at, {withFileTypes: true}).flatMap((entry) =>
  entry.isDirectory() ? files(join(at, entry.name)) : entry.name.endsWith(".toml") ? [join(at, entry.name)] : []);
const blocksBeside = (path) => {
  const folder = join(dirname(path), "blocks");
  return existsSync(folder) ? {blocks: files(folder).sort().map((block) => ({name: basename(block, ".toml"), text: readFileSync(block, "utf8")}))} : {};
};
const examples = files(diagrams).sort().map((path) => ({name: relative(diagrams, path), text: readFileSync(path, "utf8"), ...blocksBeside(path)}))
  .filter(({text}) => /^format *= *"oblique-(diagram|mechanism)\/1"/m.test(text));
const opening = examples.find(({name}) => name === "mechanisms/class-iii.toml");

// No text of a file or of a program ends the element that it stands in.
const inside = (text) => text.replaceAll("</", "<\\/").replaceAll("<!--", "<\\!--");
const json = (value) => JSON.stringify(value).replaceAll("<", "\\u003c");

function packed(content) {
  const file = join(stage, "to-pack");
  writeFileSync(file, content);
  return run("zopfli", ["-c", "--i5", file], {encoding: "buffer"}).toString("base64");
}

const worker = bundle("worker.ts", "--format=iife", `--alias:engine=${join(built, "engine.mjs")}`, `--alias:engine-glue=${join(built, "engine.js")}`,
  "--external:fs", "--external:path", "--external:crypto");
const script = inside(bundle("main.tsx", "--format=iife", "--jsx=automatic", "--jsx-import-source=preact"));
const early = inside(bundle("early.ts", "--format=iife"));
const style = bundle("page.css");
const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const policy = `default-src 'none'; script-src ${hash(early)} ${hash(script)} 'wasm-unsafe-eval' blob:; worker-src blob:; style-src 'unsafe-inline'; img-src data: blob:; ` +
  "connect-src 'none'; form-action 'none'; base-uri 'none'";

// What the page would ask the engine first of all (src/patch.ts).
const {drawing, usualGain} = await import(`data:text/javascript,${encodeURIComponent(bundle("patch.ts", "--format=esm"))}`);
const {loadEngine} = await import(pathToFileURL(join(built, "engine.mjs")));
const engine = await loadEngine({createEngine: createRequire(import.meta.url)(join(built, "engine.js")), wasmBinary: readFileSync(join(built, "engine.wasm"))});
const patched = engine.patch(opening.text, {gain: usualGain, split: [], force: false}, opening.name);
const drawn = engine.draw(patched.text, drawing, opening.name);
if (!patched.ok || !drawn.ok) throw new Error(`${opening.name}: ${JSON.stringify([patched, drawn])}`);

const parts = {
  POLICY: policy,
  STYLE: style,
  OPENING: json(opening),
  PATCH: packed(JSON.stringify({...opening, diagram: patched.text, judgement: patched.judgement, schematic: drawn.svg})),
  EXAMPLES: packed(JSON.stringify(examples)),
  ENGINE: packed(readFileSync(join(built, "engine.wasm"))),
  WORKER: inside(worker),
  EARLY: early,
  SCRIPT: script,
};
const page = readFileSync(join(here, "index.html"), "utf8").replace(/@([A-Z]+)@/g, (_, part) => parts[part]);
writeFileSync(join(built, "studio.html.new"), page);
renameSync(join(built, "studio.html.new"), join(built, "studio.html"));
console.log(`${join(folder, "studio.html")}: ${(page.length / 1e6).toFixed(2)} MB`);
