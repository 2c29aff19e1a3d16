// SPDX-License-Identifier: MIT
// The engine as a page and its tests take it. Every function gives an object: {ok: true, …}, or {ok: false, error,
// diagnostics: [{file, line, column, what, expected, remedy, message}]}; none throws. What the objects hold stands
// in engine.h and live_console.h; `numbers` is a Float64Array, row by row.

function refusal(what, remedy) {
  const message = `${what}\n  remedy: ${remedy}`;
  return {
    ok: false,
    error: "InternalError",
    diagnostics: [{file: "", line: 0, column: 0, what, expected: "", remedy, message}],
    numbers: new Float64Array(0),
  };
}

const text = (given) => String(given ?? "");
const texts = (given) => Array.from(given ?? [], text);

// Of a module that is compiled already; createEngine itself would wait for ever for one that cannot be instantiated.
function instantiated(createEngine, module) {
  return new Promise((done, failed) => {
    const instantiateWasm = (imports, take) => {
      WebAssembly.instantiate(module, imports).then((instance) => take(instance, module)).catch(failed);
      return {};
    };
    createEngine({instantiateWasm}).then(done, failed);
  });
}

// `createEngine` is what engine.js defines, `wasmBinary` the bytes of engine.wasm, or in place of them `wasmModule` what
// they were compiled to; `limits` may hold seconds, steps and numbers, as `Limits` has them. Throws where this browser
// cannot run it.
export async function loadEngine({createEngine, wasmBinary, wasmModule, limits = {}}) {
  const wasm = await (wasmModule ? instantiated(createEngine, wasmModule) : createEngine({wasmBinary}));
  let ended = false;

  // What WebAssembly itself ends with (a stack that is used up) leaves an engine that nobody may trust.
  const call = (work) => {
    if (ended) return refusal("the engine has ended", "load it anew");
    try {
      return work();
    } catch (error) {
      ended = true;
      return refusal(`the engine ended: ${error}`, "load it anew, and ask for less");
    }
  };
  const limit = (name) => Number(limits[name] ?? 0);
  const engine = new wasm.Engine(limit("seconds"), limit("steps"), limit("numbers"));
  const ask = (verb) => (source, options, name) =>
    call(() => engine[verb](text(source), text(name), JSON.stringify(options ?? {})));

  // An object of the engine until it is closed, which frees its memory.
  function keep(Kind, what) {
    const held = new Kind(engine);
    let closed = false;
    const use = (work) => (closed ? refusal(`this ${what} is closed`, "take another") : call(work));
    const close = () => {
      if (!closed) held.delete();
      closed = true;
    };
    return {held, use, close};
  }

  const consoles = new WeakMap();
  function openConsole() {
    const {held, use: machine, close} = keep(wasm.Console, "console");
    const taken = {
      open: (source, name) => machine(() => held.open(text(source), text(name))),
      exchange: (source, renamed, name) =>
        machine(() => held.exchange(text(source), text(name), JSON.stringify(renamed ?? []))),
      setMode: (mode) => machine(() => held.setMode(text(mode))),
      repeat: (initial, operate) => machine(() => held.repeat(Number(initial), Number(operate))),
      advance: (duration, names, rows = 1) =>
        machine(() => held.advance(Number(duration), texts(names), Number(rows))),
      turn: (pot, value) => machine(() => held.turn(text(pot), text(value))),
      read: (...names) => machine(() => held.read(texts(names))),
      signals: () => machine(() => held.signals()),
      overloads: () => machine(() => held.overloads()),
      events: () => machine(() => held.events()),
      setProbe: (names, options) => machine(() => held.setProbe(texts(names), JSON.stringify(options ?? {}))),
      takeTraces: (probe) => machine(() => held.takeTraces(Number(probe))),
      removeProbe: (probe) => machine(() => held.removeProbe(Number(probe))),
      save: () => machine(() => held.save()),
      restore: (state) => machine(() => held.restore(text(state))),
      close,
    };
    consoles.set(taken, {held, machine});
    return taken;
  }

  function openMechanism() {
    const {held, use, close} = keep(wasm.Mechanism, "mechanism");
    return {
      open: (source, name) => use(() => held.open(text(source), text(name))),
      at: (time) => use(() => held.at(Number(time))),
      follow(console, magnification = 1) {
        const followed = consoles.get(console);
        if (!followed) return refusal("there is no such console", "take one of this engine");
        return use(() => followed.machine(() => held.follow(followed.held, Number(magnification))));
      },
      nearest: (point, x, y, time) => use(() => held.nearest(text(point), Number(x), Number(y), Number(time))),
      drag: (point, x, y, time) => use(() => held.drag(text(point), Number(x), Number(y), Number(time))),
      timeOf: (drive) => use(() => held.timeOf(Number(drive))),
      events: () => use(() => held.events()),
      close,
    };
  }

  function openComparison() {
    const {held, use, close} = keep(wasm.Comparison, "comparison");
    return {
      open: (source, options, name) => use(() => held.open(text(source), text(name), JSON.stringify(options ?? {}))),
      add: (gain) => use(() => held.add(Number(gain))),
      close,
    };
  }

  return {
    get ended() {
      return ended;
    },
    about: () => call(() => wasm.Engine.about()),
    putFile: (name, content) => call(() => engine.putFile(text(name), text(content))),
    putBlock: (name, source) => call(() => engine.putBlock(text(name), text(source))),
    open: (source, name) => call(() => engine.open(text(source), text(name))),
    run: ask("run"),
    check: ask("check"),
    patch: ask("patch"),
    motion: ask("motion"),
    draw: ask("draw"),
    blocks: () => call(() => engine.blocks()),
    panel: ask("panel"),
    inside: ask("inside"),
    edit: ask("edit"),
    modes: (source, name) => call(() => engine.modes(text(source), text(name))),
    splits: (source, name) => call(() => engine.splits(text(source), text(name))),
    loops: ask("loops"),
    console: openConsole,
    mechanism: openMechanism,
    comparison: openComparison,
  };
}
