// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

namespace oblique::fuzz {

/// How a quantity changes where the values of a diagram are multiplied by v and its times by t:
/// by v^value · t^time.
struct Dimension {
  int value = 0, time = 0;
};

inline constexpr Dimension kPlain{0, 0}, kValue{1, 0}, kTime{0, 1}, kRate{0, -1}, kSlope{1, -1};

/// An input as it is wired at random. Angles and logic signals are plain: they keep their values where the
/// others are scaled.
struct PortKind {
  std::string_view name;
  Dimension dimension;
  bool is_sum = false;
  bool required = true;
};

struct OutputKind {
  std::string_view name;
  Dimension dimension;
};

/// How the number of a parameter is written.
enum class Form {
  number,
  whole,          ///< rounded
  curve,          ///< a table whose ends it says
  jumping_curve,  ///< one that jumps by it at 0
  sine,           ///< the frequency in a formula
};

/// Left at its default in one of two blocks, unless it is required: as all are whose default would have to be
/// scaled too.
struct ParameterKind {
  std::string_view name;
  double low, high;
  Dimension dimension;
  bool required = false;
  Form form = Form::number;
};

/// What the generator knows of a kind of block. It is written down here, not read from the block's own file:
/// that is among the things under test.
struct BlockKind {
  std::string_view type;
  int weight;  ///< how often it is drawn
  std::span<const PortKind> inputs;
  std::span<const OutputKind> outputs;
  std::span<const ParameterKind> parameters;
  bool has_state = false;  ///< its output does not follow its inputs at once
  bool weighs = false;     ///< the weights of its inputs tell, not only their sum
};

std::span<const BlockKind> block_kinds();

}  // namespace oblique::fuzz
