// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/flatten.h>

namespace oblique::testing {

/// Blocks of our own, so that these tests do not hang on the shipped ones.
inline diagram::BlockLibrary small_library() {
  diagram::BlockLibrary library;
  const auto add = [&](std::string name, std::string text) {
    library.add(diagram::parse_block("format = \"oblique-block/1\"\ntitle = \"" + name + "\"\n" + text,
                                     name + ".toml", name));
  };
  add("reference", R"toml(
[outputs]
out = {}
[parameters]
value = { default = 1, unit = "machine unit", above = "-inf", below = "inf" }
[equations]
out = "value"
)toml");
  add("adder", R"toml(
[inputs]
in = { sum = true }
[outputs]
out = {}
[equations]
out = "polarity*in"
)toml");
  add("product", R"toml(
[inputs]
x = {}
y = {}
[outputs]
out = {}
[equations]
out = "x*y"
)toml");
  add("cosine-of", R"toml(
[inputs]
angle = {}
[outputs]
out = {}
[equations]
out = "cos(angle)"
)toml");
  add("resolver", R"toml(
[inputs]
angle = { default = 0.5 }
radius = { default = 1 }
[outputs]
x = {}
y = {}
[equations]
x = "radius*cos(angle)"
y = "radius*sin(angle)"
)toml");
  add("servo", R"toml(
[inputs]
in = { sum = true }
[outputs]
out = {}
[parameters]
gain = { default = 1e6, above = 0 }
bandwidth = { default = "10 Hz", unit = "Hz", above = 0 }
damping = { default = 0.5, at_least = 0, at_most = 1 }
initial = { default = 0, unit = "machine unit" }
[equations]
"der(out)" = "2*pi*bandwidth*(-out - gain*in)"
[[cases]]
when = "gain == inf"
implicit = { out = "in" }
[[cases]]
when = "bandwidth == inf"
implicit = { out = "in + out/gain" }
[start]
out = { guess = "initial", at_rest = true }
)toml");
  return library;
}

/// The text of a diagram with these blocks.
inline std::string diagram_text(std::string_view blocks, std::string_view rest = "") {
  return "format = \"oblique-diagram/1\"\n[blocks]\n" + std::string(blocks) + std::string(rest);
}

/// What is thrown by `action`, as the user sees it; "" where nothing is.
template <class Thrown = diagram::DiagramError, class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Thrown& error) {
    return error.what();
  }
  return {};
}

/// What `flatten` says about a diagram with these blocks, which stand from line 3 on.
inline std::string wiring_message(std::string_view blocks,
                                  const diagram::BlockLibrary& library = small_library(),
                                  std::string_view rest = "") {
  return message_of(
      [&] { diagram::flatten(diagram::parse_diagram(diagram_text(blocks, rest), "d.toml"), library); });
}

}  // namespace oblique::testing
