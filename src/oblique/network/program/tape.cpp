// SPDX-License-Identifier: MIT
#include <oblique/network/program/tape.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <oblique/text/noise.h>
#include <oblique/text/operations.h>

namespace oblique::network {
namespace {

constexpr std::uint32_t kNoSlot = std::numeric_limits<std::uint32_t>::max();

/// Nothing of constants, variables and discrete states, which are never written.
std::optional<Instruction::Code> code_of(Op op) {
  using Code = Instruction::Code;
  switch (op) {
#define OBLIQUE_OPERATION(name, ...) \
  case Op::name:                     \
    return Code::name;
#include <oblique/text/operations.def>
    case Op::select:
      return Code::select;
    case Op::gate:
      return Code::gate;
    case Op::less:
      return Code::less;
    case Op::less_equal:
      return Code::less_equal;
    case Op::equal:
      return Code::equal;
    case Op::table_value:
      return Code::table_value;
    case Op::table_slope:
      return Code::table_slope;
    case Op::table_end:
      return Code::table_end;
    case Op::table_begin:
      return Code::table_begin;
    case Op::table_segment:
      return Code::table_segment;
    case Op::constant:
    case Op::variable:
    case Op::discrete_state:
      break;
  }
  return std::nullopt;
}

/// A PointTable on slots: the number of points, then for each segment its begin, the value there, the slope.
class TableOnSlots {
 public:
  explicit TableOnSlots(const double* first) : first_(first) {}

  std::size_t segments() const { return static_cast<std::size_t>(first_[0]) - 1; }
  std::size_t segment_of(double index) const {
    return index < 0 ? 0 : std::min(static_cast<std::size_t>(index), segments() - 1);
  }
  double begin(std::size_t segment) const { return first_[1 + 3 * segment]; }
  double slope(std::size_t segment) const { return first_[3 + 3 * segment]; }
  double value(double x, std::size_t segment) const {
    return first_[2 + 3 * segment] + slope(segment) * (x - begin(segment));
  }
  /// The last segment that begins at or before x.
  std::size_t find(double x) const {
    std::size_t low = 0, high = segments();
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (begin(middle) <= x ? low : high) = middle;
    }
    return low;
  }

 private:
  const double* first_;
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

int operand_count(Instruction::Code code) {
  switch (code) {
#define OBLIQUE_OPERATION(name, operands, ...) \
  case Instruction::Code::name:                \
    return operands;
#include <oblique/text/operations.def>
    case Instruction::Code::select:
    case Instruction::Code::table_value:
    case Instruction::Code::multiply_add:
    case Instruction::Code::multiply_subtract:
      return 3;
    case Instruction::Code::gate:
    case Instruction::Code::less:
    case Instruction::Code::less_equal:
    case Instruction::Code::equal:
    case Instruction::Code::table_slope:
    case Instruction::Code::table_end:
    case Instruction::Code::table_begin:
    case Instruction::Code::table_segment:
      break;
  }
  return 2;
}

void run_tape(std::span<const Instruction> instructions, double* slots) {
  using Code = Instruction::Code;
  for (const Instruction& i : instructions) {
    const double a = slots[i.a];
    const double b = slots[i.b];
    double value = 0;
    switch (i.code) {
#define OBLIQUE_OPERATION(name, operands, traits, value_of_ab, by_a, by_b) \
  case Code::name:                                                         \
    value = value_of_ab;                                                   \
    break;
#include <oblique/text/operations.def>
      case Code::select:
        value = select(a, b, slots[i.c]);
        break;
      case Code::gate:
        value = a == 0 ? 0 : a * b;
        break;
      case Code::less:
        value = a < b ? 1 : 0;
        break;
      case Code::less_equal:
        value = a <= b ? 1 : 0;
        break;
      case Code::equal:
        value = a == b ? 1 : 0;
        break;
      case Code::table_value: {
        const TableOnSlots table(slots + i.c);
        value = table.value(a, table.segment_of(b));
        break;
      }
      case Code::table_slope: {
        const TableOnSlots table(slots + i.b);
        value = table.slope(table.segment_of(a));
        break;
      }
      case Code::table_end: {
        const TableOnSlots table(slots + i.b);
        const std::size_t segment = table.segment_of(a);
        value = segment + 1 == table.segments() ? kInfinity : table.begin(segment + 1);
        break;
      }
      case Code::table_begin: {
        const TableOnSlots table(slots + i.b);
        const std::size_t segment = table.segment_of(a);
        value = segment == 0 ? -kInfinity : table.begin(segment);
        break;
      }
      case Code::table_segment:
        value = static_cast<double>(TableOnSlots(slots + i.b).find(a));
        break;
      case Code::multiply_add:
        value = a * b + slots[i.c];
        break;
      case Code::multiply_subtract:
        value = slots[i.c] - a * b;
        break;
    }
    slots[i.result] = value;
  }
}

TapeWriter::TapeWriter(const ExpressionGraph& graph, std::size_t n_variables, std::size_t n_discrete_states,
                       const std::vector<text::PointTable>& tables, std::vector<std::uint32_t> uses)
    : graph_(&graph),
      n_variables_(n_variables),
      uses_(std::move(uses)),
      slots_(graph.size(), kNoSlot),
      segment_(graph.size(), 0),
      fused_(graph.size(), 0),
      initial_slots_(n_variables + n_discrete_states, 0.0) {
  for (const text::PointTable& table : tables) {
    table_slots_.push_back(static_cast<std::uint32_t>(initial_slots_.size()));
    const std::size_t count = initial_slots_.size();
    initial_slots_.push_back(1);
    for (std::size_t k = 0; k + 1 < table.x.size(); ++k) {
      if (table.x[k] == table.x[k + 1]) continue;  // a jump: it lies between two segments
      ++initial_slots_[count];
      initial_slots_.push_back(table.x[k]);
      initial_slots_.push_back(table.y[k]);
      initial_slots_.push_back((table.y[k + 1] - table.y[k]) / (table.x[k + 1] - table.x[k]));
    }
  }
}

std::uint32_t TapeWriter::operand_slot(const Node& node, int operand) {
  const bool table = node.op >= Op::table_value && operand + 1 == operand_count(node.op);
  if (!table) return slot(node.operand(operand));
  return table_slots_[static_cast<std::size_t>((*graph_)[node.operand(operand)].value)];
}

std::uint32_t TapeWriter::slot(NodeId id) {
  if (slots_[id] == kNoSlot) {
    const Node& node = (*graph_)[id];
    if (node.op == Op::variable) {
      slots_[id] = node.variable;
    } else if (node.op == Op::discrete_state) {
      slots_[id] = static_cast<std::uint32_t>(n_variables_ + node.variable);
    } else {
      slots_[id] = static_cast<std::uint32_t>(initial_slots_.size());
      initial_slots_.push_back(node.op == Op::constant ? node.value : 0.0);
    }
  }
  return slots_[id];
}

std::optional<std::uint32_t> TapeWriter::known_slot(NodeId id) const {
  return slots_[id] == kNoSlot ? std::nullopt : std::optional(slots_[id]);
}

bool TapeWriter::can_fuse(NodeId id) const {
  return (*graph_)[id].op == Op::multiply && uses_[id] == 1 && segment_[id] == current_segment_;
}

TapeRange TapeWriter::write(std::span<const NodeId> nodes) {
  ++current_segment_;
  for (const NodeId id : nodes) segment_[id] = current_segment_;

  // A product is taken into the sum that reads it: mark those first, so that they are not written on their
  // own.
  const auto fused_operand = [&](const Node& node) {
    if (node.op == Op::add && can_fuse(node.a)) return 1;
    if ((node.op == Op::add || node.op == Op::subtract) && can_fuse(node.b)) return 2;
    return 0;
  };
  for (const NodeId id : nodes) {
    const Node& node = (*graph_)[id];
    const int operand = fused_operand(node);
    if (operand != 0) fused_[operand == 1 ? node.a : node.b] = current_segment_;
  }

  TapeRange range{static_cast<std::uint32_t>(instructions_.size()), 0};
  for (const NodeId id : nodes) {
    const Node& node = (*graph_)[id];
    const auto code = code_of(node.op);
    if (!code || fused_[id] == current_segment_) continue;
    Instruction instruction{};
    const int operand = fused_operand(node);
    if (operand != 0) {
      const Node& product = (*graph_)[operand == 1 ? node.a : node.b];
      instruction.code =
          node.op == Op::add ? Instruction::Code::multiply_add : Instruction::Code::multiply_subtract;
      instruction.a = slot(product.a);
      instruction.b = slot(product.b);
      instruction.c = slot(operand == 1 ? node.b : node.a);
    } else {
      instruction.code = *code;
      const int operands = operand_count(node.op);
      instruction.a = operand_slot(node, 0);
      instruction.b = operands >= 2 ? operand_slot(node, 1) : instruction.a;
      instruction.c = operands >= 3 ? operand_slot(node, 2) : 0;
    }
    instruction.result = slot(id);
    instructions_.push_back(instruction);
  }
  range.end = static_cast<std::uint32_t>(instructions_.size());
  return range;
}

}  // namespace oblique::network
