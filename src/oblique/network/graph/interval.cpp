// SPDX-License-Identifier: MIT
#include <oblique/network/graph/interval.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::network {
namespace {

using Code = Instruction::Code;
using text::hull;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Interval kLine{-kInfinity, kInfinity};

Interval truth(bool surely, bool surely_not) {
  return {surely ? 1.0 : 0.0, surely_not ? 0.0 : 1.0};
}

/// The straight line of one segment of a table, or its slope; the whole line where the segment is not known.
/// A table on slots is the number of its points, then for each segment its begin, the value there, the slope.
Interval table_range(const Instruction& i, std::span<const Interval> slots) {
  const bool slope_asked = i.code == Code::table_slope;
  const Interval segment = slots[slope_asked ? i.a : i.b];
  if (!segment.is_point() || (!slope_asked && i.code != Code::table_value)) return kLine;
  const std::size_t table = slope_asked ? i.b : i.c;
  const double last = slots[table].low - 2;
  const auto at = table + 1 + 3 * static_cast<std::size_t>(std::clamp(segment.low, 0.0, last));
  const double begin = slots[at].low, value = slots[at + 1].low, slope = slots[at + 2].low;
  if (slope_asked) return {slope, slope};
  const Interval x = slots[i.a];
  return hull({value + slope * (x.low - begin), value + slope * (x.high - begin)});
}

Interval chosen(const Interval& a, const Interval& b, const Interval& c) {
  if (a.is_point()) return hull({select(a.low, b.low, c.low), select(a.low, b.high, c.high)});
  return hull({b.low, b.high, c.low, c.high});
}

}  // namespace

void run_tape(std::span<const Instruction> instructions, std::span<Interval> slots) {
  for (const Instruction& i : instructions) {
    const Interval a = slots[i.a], b = slots[i.b];
    Interval& value = slots[i.result];
    switch (i.code) {
      case Code::multiply:
        value = i.a == i.b ? text::square(a) : text::evaluate(text::Operation::multiply, a, b);
        break;
      case Code::select:
        value = chosen(a, b, slots[i.c]);
        break;
      case Code::gate:
        value = text::evaluate(text::Operation::multiply, a, b);
        break;
      case Code::less:
        value = truth(a.high < b.low, a.low >= b.high);
        break;
      case Code::less_equal:
        value = truth(a.high <= b.low, a.low > b.high);
        break;
      case Code::equal:
        value = truth(a.is_point() && b.is_point() && a.low == b.low, a.high < b.low || b.high < a.low);
        break;
      case Code::multiply_add: {
        const Interval p = text::evaluate(text::Operation::multiply, a, b), c = slots[i.c];
        value = hull({p.low + c.low, p.high + c.high});
        break;
      }
      case Code::multiply_subtract: {
        const Interval p = text::evaluate(text::Operation::multiply, a, b), c = slots[i.c];
        value = hull({c.low - p.high, c.high - p.low});
        break;
      }
      case Code::table_value:
      case Code::table_slope:
      case Code::table_end:
      case Code::table_begin:
      case Code::table_segment:
        value = table_range(i, slots);
        break;
      default:  // smooth: they come first, in the order of the table
        value = text::evaluate(static_cast<text::Operation>(i.code), a, b);
        break;
    }
  }
}

}  // namespace oblique::network
