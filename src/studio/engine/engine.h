// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include <oblique/diagram/block_library.h>
#include <oblique/mechanism/motion/motion_event.h>

#include "studio/engine/answer.h"

namespace oblique::studio {

/// What a page may ask for at once; beyond it is a refusal, or for the time an end before the end.
struct Limits {
  double seconds = 20;            ///< wall clock of a run or an advance
  double steps = 10e6;            ///< of the solver in a run
  double numbers = 16e6;          ///< in the rows of an answer: 128 MB
  double text = 4 * 1024 * 1024;  ///< bytes of a file
};

/// "limit", "return", "change", "infinity", "lost".
const char* event_name(mechanism::MotionEvent::Kind kind);

/// Text of a diagram or a mechanism in, objects and numbers out: what a page needs of the library. Nothing is
/// kept between two calls but the files put beside the texts and the kinds of blocks. `name` is what messages
/// call the text. No function throws: see `answer`. `options` is a JSON object; a key that is not known is
/// refused.
class Engine {
 public:
  Engine();
  explicit Engine(const Limits& limits);

  const Limits& limits() const { return limits_; }
  const std::shared_ptr<const diagram::BlockLibrary>& library() const { return library_; }

  /// Versions: {"version", "solver"}.
  static Answer about();

  /// Puts a file where texts name it (a recording): relative to the folder of their own name.
  Answer put_file(const std::string& name, const std::string& content) const;

  /// Adds a kind of block, or replaces the one of that name, for all that is opened from now on.
  Answer put_block(const std::string& name, const std::string& text);

  /// Reads it and looks whether all of it is wired: {"kind": "diagram", "title", "until", "machine",
  /// "blocks":
  /// [{"name", "type"}], "outputs": [{"name", "unit"}], "signals", "lesson" (null, or as lesson_of has it)}
  /// or {"kind": "mechanism", "title", "unit", "points", "bodies", "drives": [{"name", "slide"}], "groups":
  /// [{"name", "class"}]}.
  Answer open(const std::string& text, const std::string& name) const;

  /// Runs a diagram: {"columns": [{"name", "unit"}], "rows", "time", "complete", "method", "steps",
  /// "seconds", "events": [{"time", "what"}], "overloads": [{"signal", "first", "peak"}], "warnings"}, and
  /// the rows as numbers. Options: "until" [s], "samples", "set" {"c.gain": "1e4"}, "trust": true, which adds
  /// {"trust": {"outputs": [{"name", "size", "largest", "at_end", "lost"}], "event_shift", "events_part",
  /// "failure"}}.
  Answer run(const std::string& text, const std::string& name, const std::string& options) const;

  /// What a step of a diagram's lesson, or without one its question, expects, held against a run: {"met",
  /// "checks": [{"what", "actual", "value", "within", "met"}]}. Options: "step" (from 1), "set" as `run`.
  Answer check(const std::string& text, const std::string& name, const std::string& options) const;

  /// Patches a mechanism: {"text"} of the diagram, {"judgement"} of it in words, and {"split", "slower"}
  /// where these were asked for or found by trial. Options: "gain", "bandwidth", "slower" (quantities as
  /// texts or numbers), "method", "split" [names], "force", "period" [s].
  Answer patch(const std::string& text, const std::string& name, const std::string& options) const;

  /// The exact motion of a mechanism: {"columns": [{"name", "unit"}], "rows", "statuses": [names], "events":
  /// [{"time", "kind", "group"}]}, and the rows as numbers: NaN where there is none, the number of its status
  /// last. Options: "positions", "until" [s], "at_limit".
  Answer motion(const std::string& text, const std::string& name, const std::string& options) const;

  /// {"svg"}: the schematic of a diagram or the linkage of a mechanism. Options: "theme" (auto, light, dark),
  /// of a diagram "symbols" (classic, din), "depth" and "data" (true: elements say what they stand for), of a
  /// mechanism "time" [s] and "positions".
  Answer draw(const std::string& text, const std::string& name, const std::string& options) const;

  /// The kinds of blocks that diagrams may use; a diagram that may be wrong as a patch panel, or the inside
  /// of a composite of it; a diagram with steps of patching done: as patching.h says it.
  Answer blocks() const;
  Answer panel(const std::string& text, const std::string& name, const std::string& options) const;
  Answer inside(const std::string& text, const std::string& name, const std::string& options) const;
  Answer edit(const std::string& text, const std::string& name, const std::string& options) const;

  /// Throws ReadError for a text beyond the limit.
  void check_size(const std::string& text, const std::string& name) const;

 private:
  void check_numbers(std::size_t rows, std::size_t columns, const std::string& name) const;

  Limits limits_;
  std::shared_ptr<const diagram::BlockLibrary> library_;
};

}  // namespace oblique::studio
