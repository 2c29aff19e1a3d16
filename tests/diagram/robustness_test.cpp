// SPDX-License-Identifier: MIT
// Broken files of every sort: whatever they hold, they are read or refused with an Error, and nothing else
// happens.
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/diagram/flatten.h>

#include "small_library.h"

namespace oblique::diagram {
namespace {

using testing::small_library;

constexpr int kVariants = 1000;  // of each kind of file

const std::string kOneBlock = R"toml(format = "oblique-block/1"
title = "Box"
[inputs]
x = { sum = true, doc = "in" }
b = { default = 0.25 }
[outputs]
y = { wire = "t" }
z = { wire = "r.x" }
[parameters]
k = { default = 2, unit = "1", above = 0, at_most = "1e3" }
band = { default = "1 kHz", unit = "Hz", above = 0 }
[blocks]
s = { type = "adder", in = ["k*x", "-b", "-(k^2 - 1)*t"] }
t = { type = "servo", in = "3*s", gain = "k", bandwidth = "band" }
r = { type = "resolver", angle = "t" }
)toml";

const std::string kPrimitive = R"toml(format = "oblique-block/1"
title = "Box"
[inputs]
x = { sum = true }
b = { default = 0 }
[outputs]
y = {}
z = {}
[parameters]
k = { default = 2 }
band = { default = 1, unit = "Hz" }
[equations]
"der(y)" = "2*pi*band*(-y - k*x)"
z = "if(y > b, atan2(y, 2), table(y, 0, 0, 1, 1))"
[[cases]]
when = "k == inf or not (polarity > 0)"
implicit = { y = "x" }
equations = { z = "time" }
[start]
y = { guess = "k/2", at_rest = true }
)toml";

const std::string kDiagram = R"toml(format = "oblique-diagram/1"
title = "All there is"
[machine]
profile = "ideal"
inverting = true
[run]
until = "2*pi"
samples = 101
[blocks]
a = { type = "reference", value = "1/3" }
b = { type = "box", x = ["a", "-2*p", "b.y"], k = 5, band = "0.1 kHz" }
p = { type = "product", in = ["b.t", "b.r.y"] }
[outputs]
"P.x" = { signal = "b.z", scale = 2, unit = "m" }
p = "p"
[expect]
"P.x at pi/2" = { value = 1, within = 1 }
"p maximum" = { value = 1, within = 1 }
)toml";

/// Flips bytes, deletes, doubles or swaps stretches of the text, or cuts it off.
std::string mutate(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random()) % std::max<std::size_t>(n, 1);
  };
  const std::string likely = "\"'{}[]=.,#-+*/^()\n\\ 0ainx\x80";
  const std::size_t changes = 1 + below(3);
  for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
    const std::size_t at = below(text.size());
    const std::size_t length = std::min(1 + below(20), text.size() - at);
    switch (below(6)) {
      case 0:
        text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text[at] = likely[below(likely.size())];
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 4:
        std::swap(text[at], text[below(text.size())]);
        break;
      default:
        if (below(4) == 0) text.resize(at);
    }
  }
  return text;
}

/// Reads a block and a diagram that uses it; true where both were in order.
bool survives(const std::string& block, const std::string& diagram) {
  static const BlockLibrary others = small_library();
  try {
    BlockLibrary library = others;
    library.add(parse_block(block, "box.toml", "box"));
    const Diagram read = parse_diagram(diagram, "d.toml");
    const FlatDiagram flat = flatten(read, library);
    EXPECT_TRUE(parse_diagram(write_diagram(read), "d.toml") == read) << diagram;
    return !flat.blocks.empty();
  } catch (const text::Error& error) {
    EXPECT_FALSE(error.diagnostics().empty());
    return false;
  }
}

/// Of each kind some variants must be good and some bad, else the mutations would test nothing.
void expect_some_of_both(int good) {
  EXPECT_GT(good, kVariants / 100);
  EXPECT_LT(good, kVariants * 9 / 10);
}

TEST(Robustness, TheUnchangedFilesAreInOrder) {
  EXPECT_TRUE(survives(kOneBlock, kDiagram));
  std::string diagram = kDiagram;
  diagram.replace(diagram.find("[\"b.t\", \"b.r.y\"]"), 16, "[\"b.y\", \"b.z\"]");
  EXPECT_TRUE(survives(kPrimitive, diagram));
}

TEST(Robustness, BrokenDiagrams) {
  std::mt19937 random(1);
  int good = 0;
  for (int i = 0; i < kVariants; ++i) good += survives(kOneBlock, mutate(kDiagram, random)) ? 1 : 0;
  expect_some_of_both(good);
}

TEST(Robustness, BrokenComposites) {
  std::mt19937 random(2);
  int good = 0;
  for (int i = 0; i < kVariants; ++i) good += survives(mutate(kOneBlock, random), kDiagram) ? 1 : 0;
  expect_some_of_both(good);
}

TEST(Robustness, BrokenPrimitives) {
  std::mt19937 random(3);
  std::string diagram = kDiagram;
  diagram.replace(diagram.find("[\"b.t\", \"b.r.y\"]"), 16, "[\"b.y\", \"b.z\"]");
  int good = 0;
  for (int i = 0; i < kVariants; ++i) good += survives(mutate(kPrimitive, random), diagram) ? 1 : 0;
  expect_some_of_both(good);
}

}  // namespace
}  // namespace oblique::diagram
