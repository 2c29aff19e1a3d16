// SPDX-License-Identifier: MIT
#include "own_blocks.h"

#include <string>

namespace oblique::fuzz {
namespace {

/// It bounces, ever faster, and then lies still. (How often it bounced before that is said by no equation.)
constexpr const char* kBallText = R"toml(
[outputs]
height = { doc = "[machine unit]" }
speed = { doc = "[machine unit/s]" }
[parameters]
drop = { default = 1 }
g = { default = 10 }
restitution = { default = 0.9 }
[memories]
rests = 0
[equations]
"der(height)" = "speed"
"der(speed)" = "if(rests == 1, 0, -g)"
[start]
height = "drop"
speed = 0
[[events]]
when = "height < 0 and speed < 0"
set = { height = 0, speed = "-restitution*speed" }
piling_up = { height = 0, speed = 0, rests = 1 }
)toml";

/// A lag that discharges whenever it has reached its threshold.
constexpr const char* kSpikerText = R"toml(
[inputs]
in = { doc = "[machine unit]" }
[outputs]
out = { doc = "[machine unit]" }
[parameters]
rate = { default = 1 }
threshold = { default = 1 }
[equations]
"der(out)" = "rate*(in - 0.5*out)"
[start]
out = 0
[[events]]
when = "out > threshold"
set = { out = 0 }
)toml";

/// Two memories that change places at every rise of the input.
constexpr const char* kSwap = R"toml(
[inputs]
in = { doc = "a plain number" }
[outputs]
out = { doc = "a plain number" }
[memories]
a = 1
b = -0.5
[equations]
out = "a*sin(in) + b*exp(-in^2)"
[[events]]
when = "in > 0.25"
set = { a = "b", b = "a" }
)toml";

}  // namespace

const diagram::BlockLibrary& library() {
  static const diagram::BlockLibrary blocks = [] {
    diagram::BlockLibrary made = diagram::BlockLibrary::shipped();
    const auto add = [&](const std::string& name, const char* text) {
      made.add(diagram::parse_block("format = \"oblique-block/1\"\ntitle = \"" + name + "\"\n" + text,
                                    name + ".toml", name));
    };
    add("ball", kBallText);
    add("spiker", kSpikerText);
    add("swap", kSwap);
    return made;
  }();
  return blocks;
}

}  // namespace oblique::fuzz
