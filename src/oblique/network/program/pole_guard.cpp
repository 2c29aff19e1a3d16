// SPDX-License-Identifier: MIT
#include <oblique/network/program/pole_guard.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace oblique::network {
namespace {

using Code = Instruction::Code;

/// Which operand decides whether an instruction has a value.
std::optional<std::uint32_t> deciding_slot(const Instruction& i) {
  switch (i.code) {
    case Code::divide:
      return i.b;
    case Code::power:
    case Code::tan:
    case Code::log:
    case Code::sqrt:
      return i.a;
    default:
      return std::nullopt;
  }
}

}  // namespace

bool PoleGuard::needed(const LoopCode& loop, std::span<const Instruction> body) {
  if (needed_ != Needed::unknown) return needed_ == Needed::yes;
  needed_ = Needed::no;
  std::uint32_t last = 0;
  for (const std::uint32_t slot : loop.unknown_slots) last = std::max(last, slot);
  for (const std::uint32_t slot : loop.residual_slots) last = std::max(last, slot);
  for (const Instruction& i : body) last = std::max({last, i.a, i.b, i.c, i.result});
  std::vector<bool> by_unknowns(last + 1);
  for (const std::uint32_t slot : loop.unknown_slots) by_unknowns[slot] = true;
  for (const Instruction& i : body) {
    by_unknowns[i.result] = by_unknowns[i.a] || by_unknowns[i.b] || by_unknowns[i.c];
    const auto deciding = deciding_slot(i);
    if (deciding && by_unknowns[*deciding]) needed_ = Needed::yes;
  }
  // What a table holds lies behind its first slot, and is not among the operands that `has_values` reads.
  for (const Instruction& i : body) {
    if (i.code >= Code::table_value && i.code <= Code::table_segment) needed_ = Needed::no;
  }
  ranges_.resize(last + 1);
  return needed_ == Needed::yes;
}

bool PoleGuard::has_values(const LoopCode& loop, std::span<const Instruction> body, const double* slots,
                           const Eigen::VectorXd& start) {
  for (const Instruction& i : body) {
    for (const std::uint32_t slot : {i.a, i.b, i.c}) ranges_[slot] = {slots[slot], slots[slot]};
  }
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const double from = start[static_cast<Eigen::Index>(k)], to = slots[loop.unknown_slots[k]];
    ranges_[loop.unknown_slots[k]] = {std::min(from, to), std::max(from, to)};
  }
  run_tape(body, ranges_);
  return std::all_of(loop.residual_slots.begin(), loop.residual_slots.end(),
                     [&](std::uint32_t slot) { return std::isfinite(ranges_[slot].width()); });
}

}  // namespace oblique::network
