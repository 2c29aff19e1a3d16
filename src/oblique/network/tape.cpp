// SPDX-License-Identifier: MIT
#include <oblique/network/tape.h>

#include <cmath>
#include <limits>

namespace oblique {
namespace {

constexpr std::uint32_t kNoSlot = std::numeric_limits<std::uint32_t>::max();

Instruction::Code code_of(Op op) {
  using Code = Instruction::Code;
  switch (op) {
    case Op::add:
      return Code::add;
    case Op::subtract:
      return Code::subtract;
    case Op::multiply:
      return Code::multiply;
    case Op::divide:
      return Code::divide;
    case Op::power:
      return Code::power;
    case Op::negate:
      return Code::negate;
    case Op::sin:
      return Code::sin;
    case Op::cos:
      return Code::cos;
    case Op::tan:
      return Code::tan;
    case Op::asin:
      return Code::asin;
    case Op::acos:
      return Code::acos;
    case Op::atan:
      return Code::atan;
    case Op::atan2:
      return Code::atan2;
    case Op::exp:
      return Code::exp;
    case Op::log:
      return Code::log;
    case Op::sqrt:
      return Code::sqrt;
    case Op::hypot:
      return Code::hypot;
    case Op::constant:
    case Op::variable:
      break;
  }
  return Code::add;  // constants and variables are never written
}

}  // namespace

void run_tape(std::span<const Instruction> instructions, double* slots) {
  using Code = Instruction::Code;
  for (const Instruction& i : instructions) {
    const double a = slots[i.a];
    const double b = slots[i.b];
    double value = 0;
    switch (i.code) {
      case Code::add:
        value = a + b;
        break;
      case Code::subtract:
        value = a - b;
        break;
      case Code::multiply:
        value = a * b;
        break;
      case Code::divide:
        value = a / b;
        break;
      case Code::power:
        value = std::pow(a, b);
        break;
      case Code::negate:
        value = -a;
        break;
      case Code::sin:
        value = std::sin(a);
        break;
      case Code::cos:
        value = std::cos(a);
        break;
      case Code::tan:
        value = std::tan(a);
        break;
      case Code::asin:
        value = std::asin(a);
        break;
      case Code::acos:
        value = std::acos(a);
        break;
      case Code::atan:
        value = std::atan(a);
        break;
      case Code::atan2:
        value = std::atan2(a, b);
        break;
      case Code::exp:
        value = std::exp(a);
        break;
      case Code::log:
        value = std::log(a);
        break;
      case Code::sqrt:
        value = std::sqrt(a);
        break;
      case Code::hypot:
        value = std::hypot(a, b);
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

TapeWriter::TapeWriter(const ExpressionGraph& graph, std::size_t n_variables, std::vector<std::uint32_t> uses)
    : graph_(&graph),
      uses_(std::move(uses)),
      slots_(graph.size(), kNoSlot),
      stretch_(graph.size(), 0),
      fused_(graph.size(), 0),
      initial_slots_(n_variables, 0.0) {}

std::uint32_t TapeWriter::slot(NodeId id) {
  if (slots_[id] == kNoSlot) {
    const Node& node = (*graph_)[id];
    if (node.op == Op::variable) {
      slots_[id] = node.variable;
    } else {
      slots_[id] = static_cast<std::uint32_t>(initial_slots_.size());
      initial_slots_.push_back(node.op == Op::constant ? node.value : 0.0);
    }
  }
  return slots_[id];
}

bool TapeWriter::can_fuse(NodeId id) const {
  return (*graph_)[id].op == Op::multiply && uses_[id] == 1 && stretch_[id] == current_stretch_;
}

TapeRange TapeWriter::write(std::span<const NodeId> nodes) {
  ++current_stretch_;
  for (const NodeId id : nodes) stretch_[id] = current_stretch_;

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
    if (operand != 0) fused_[operand == 1 ? node.a : node.b] = current_stretch_;
  }

  TapeRange range{static_cast<std::uint32_t>(instructions_.size()), 0};
  for (const NodeId id : nodes) {
    const Node& node = (*graph_)[id];
    if (operand_count(node.op) == 0 || fused_[id] == current_stretch_) continue;
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
      instruction.code = code_of(node.op);
      instruction.a = slot(node.a);
      instruction.b = operand_count(node.op) == 2 ? slot(node.b) : instruction.a;
    }
    instruction.result = slot(id);
    instructions_.push_back(instruction);
  }
  range.end = static_cast<std::uint32_t>(instructions_.size());
  return range;
}

}  // namespace oblique
