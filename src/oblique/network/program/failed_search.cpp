// SPDX-License-Identifier: MIT
#include <oblique/network/program/failed_search.h>

#include <algorithm>

namespace oblique::network {

void FailedSearch::list_read(const LoopCode& loop, std::span<const Instruction> body) {
  listed_ = true;
  std::vector<std::uint32_t> known = loop.unknown_slots;
  for (const Instruction& i : body) {
    has_tables_ = has_tables_ ||
                  (i.code >= Instruction::Code::table_value && i.code <= Instruction::Code::table_segment);
    const std::uint32_t operands[] = {i.a, i.b, i.c};
    read_.insert(read_.end(), operands, operands + operand_count(i.code));
    known.push_back(i.result);
  }
  std::sort(known.begin(), known.end());
  std::sort(read_.begin(), read_.end());
  read_.erase(std::unique(read_.begin(), read_.end()), read_.end());
  std::erase_if(read_,
                [&](std::uint32_t slot) { return std::binary_search(known.begin(), known.end(), slot); });
}

void FailedSearch::note(const LoopCode& loop, std::span<const Instruction> body, const double* slots,
                        const Eigen::VectorXd& origin, int how) {
  if (!listed_) list_read(loop, body);
  known_ = !has_tables_;
  how_ = how;
  read_values_.clear();
  for (const std::uint32_t slot : read_) read_values_.push_back(slots[slot]);
  begin_.assign(origin.begin(), origin.end());
  end_.clear();
  for (const std::uint32_t slot : loop.unknown_slots) end_.push_back(slots[slot]);
}

bool FailedSearch::repeats(const LoopCode& loop, double* slots, int how) const {
  if (!known_ || how != how_) return false;
  for (std::size_t i = 0; i < begin_.size(); ++i) {
    if (slots[loop.unknown_slots[i]] != begin_[i]) return false;
  }
  for (std::size_t k = 0; k < read_.size(); ++k) {
    if (slots[read_[k]] != read_values_[k]) return false;
  }
  for (std::size_t i = 0; i < end_.size(); ++i) slots[loop.unknown_slots[i]] = end_[i];
  return true;
}

}  // namespace oblique::network
