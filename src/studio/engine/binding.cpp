// SPDX-License-Identifier: MIT
// The engine as JavaScript has it: the object of an answer and in it `numbers`, a Float64Array of the page's
// own.
#include <emscripten/bind.h>
#include <emscripten/val.h>

#include "studio/engine/engine.h"
#include "studio/engine/live_comparison.h"
#include "studio/engine/live_console.h"
#include "studio/engine/live_mechanism.h"
#include "studio/engine/mechanism_study.h"

namespace oblique::studio {
namespace {

using emscripten::val;
using Text = std::string;

val to_js(const Answer& given) {
  val object = val::global("JSON").call<val>("parse", to_text(given.object));
  const val view(emscripten::typed_memory_view(given.numbers.size(), given.numbers.data()));
  object.set("numbers", view.call<val>("slice"));
  return object;
}

template <auto kFunction, class... Arguments>
val ask(Engine& engine, Arguments... arguments) {
  return to_js((engine.*kFunction)(arguments...));
}

template <auto kFunction, class... Arguments>
val study(Engine& engine, Arguments... arguments) {
  return to_js(kFunction(engine, arguments...));
}

template <class Held, auto kFunction, class... Arguments>
val hold(Held& held, Arguments... arguments) {
  return to_js((held.*kFunction)(arguments...));
}

template <auto kFunction, class... Arguments>
val operate(LiveConsole& console, Arguments... arguments) {
  return hold<LiveConsole, kFunction>(console, arguments...);
}

val follow(LiveMechanism& mechanism, LiveConsole& console, double magnification) {
  return to_js(mechanism.follow(console, magnification));
}

val about() {
  return to_js(Engine::about());
}

val blocks(const Engine& engine) {
  return to_js(engine.blocks());
}

val advance(LiveConsole& console, double duration, val names, int rows) {
  return to_js(console.advance(duration, emscripten::vecFromJSArray<Text>(names), rows));
}

val read(LiveConsole& console, val names) {
  return to_js(console.read(emscripten::vecFromJSArray<Text>(names)));
}

val set_probe(LiveConsole& console, val names, const Text& options) {
  return to_js(console.set_probe(emscripten::vecFromJSArray<Text>(names), options));
}

/// 0 for the usual limit.
Engine* make_engine(double seconds, double steps, double numbers) {
  Limits limits;
  if (seconds > 0) limits.seconds = seconds;
  if (steps > 0) limits.steps = steps;
  if (numbers > 0) limits.numbers = numbers;
  return new Engine(limits);
}

EMSCRIPTEN_BINDINGS(oblique_studio) {
  emscripten::class_<Engine>("Engine")
      .constructor(&make_engine, emscripten::allow_raw_pointers())
      .class_function("about", &about)
      .function("putFile", &ask<&Engine::put_file, Text, Text>)
      .function("putBlock", &ask<&Engine::put_block, Text, Text>)
      .function("open", &ask<&Engine::open, Text, Text>)
      .function("run", &ask<&Engine::run, Text, Text, Text>)
      .function("check", &ask<&Engine::check, Text, Text, Text>)
      .function("patch", &ask<&Engine::patch, Text, Text, Text>)
      .function("motion", &ask<&Engine::motion, Text, Text, Text>)
      .function("draw", &ask<&Engine::draw, Text, Text, Text>)
      .function("blocks", &blocks)
      .function("panel", &ask<&Engine::panel, Text, Text, Text>)
      .function("inside", &ask<&Engine::inside, Text, Text, Text>)
      .function("edit", &ask<&Engine::edit, Text, Text, Text>)
      .function("modes", &study<&modes, Text, Text>)
      .function("splits", &study<&splits, Text, Text>)
      .function("loops", &study<&loops, Text, Text, Text>);
  emscripten::class_<LiveConsole>("Console")
      .constructor<const Engine&>()
      .function("open", &operate<&LiveConsole::open, Text, Text>)
      .function("exchange", &operate<&LiveConsole::exchange, Text, Text, Text>)
      .function("setMode", &operate<&LiveConsole::set_mode, Text>)
      .function("repeat", &operate<&LiveConsole::repeat, double, double>)
      .function("advance", &advance)
      .function("turn", &operate<&LiveConsole::turn, Text, Text>)
      .function("read", &read)
      .function("signals", &operate<&LiveConsole::signals>)
      .function("overloads", &operate<&LiveConsole::overloads>)
      .function("events", &operate<&LiveConsole::events>)
      .function("setProbe", &set_probe)
      .function("takeTraces", &operate<&LiveConsole::take_traces, double>)
      .function("removeProbe", &operate<&LiveConsole::remove_probe, double>)
      .function("save", &operate<&LiveConsole::save>)
      .function("restore", &operate<&LiveConsole::restore, Text>);
  using M = LiveMechanism;
  emscripten::class_<M>("Mechanism")
      .constructor<const Engine&>()
      .function("open", &hold<M, &M::open, Text, Text>)
      .function("at", &hold<M, &M::at, double>)
      .function("follow", &follow)
      .function("nearest", &hold<M, &M::nearest, Text, double, double, double>)
      .function("drag", &hold<M, &M::drag, Text, double, double, double>)
      .function("timeOf", &hold<M, &M::time_of, double>)
      .function("events", &hold<M, &M::events>);
  using C = LiveComparison;
  emscripten::class_<C>("Comparison")
      .constructor<const Engine&>()
      .function("open", &hold<C, &C::open, Text, Text, Text>)
      .function("add", &hold<C, &C::add, double>);
}

}  // namespace
}  // namespace oblique::studio
