// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_tape.h>

#include <algorithm>
#include <limits>
#include <map>
#include <unordered_map>

namespace oblique::ensemble {
namespace {

using network::Instruction;
using Code = Instruction::Code;

LaneOp op_of(Code code) {
  switch (code) {
    case Code::add:
      return LaneOp::add;
    case Code::subtract:
      return LaneOp::subtract;
    case Code::multiply:
      return LaneOp::multiply;
    case Code::divide:
      return LaneOp::divide;
    case Code::negate:
      return LaneOp::negate;
    case Code::sqrt:
      return LaneOp::sqrt;
    case Code::sin:
      return LaneOp::sin;
    case Code::cos:
      return LaneOp::cos;
    case Code::multiply_add:
      return LaneOp::multiply_add;
    case Code::multiply_subtract:
      return LaneOp::multiply_subtract;
    default:
      return LaneOp::other;
  }
}

}  // namespace

bool lanes_can_run(std::span<const Instruction> instructions) {
  return std::none_of(instructions.begin(), instructions.end(), [](const Instruction& i) {
    return i.code == Code::table_value || i.code == Code::table_slope || i.code == Code::table_end ||
           i.code == Code::table_begin || i.code == Code::table_segment;
  });
}

LaneTape::LaneTape(std::span<const Instruction> instructions,
                   const std::function<std::uint32_t(std::uint32_t)>& slot_of) {
  const std::size_t n = instructions.size();
  std::unordered_map<std::uint32_t, std::uint32_t> writer;
  for (std::uint32_t i = 0; i < n; ++i) writer.emplace(instructions[i].result, i);
  std::vector<std::uint32_t> waits_for(n, 0);
  std::vector<std::vector<std::uint32_t>> readers(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const Instruction& instruction = instructions[i];
    const std::uint32_t operands[] = {instruction.a, instruction.b, instruction.c};
    for (int k = 0; k < network::operand_count(instruction.code); ++k) {
      const auto found = writer.find(operands[k]);
      if (found == writer.end()) continue;
      readers[found->second].push_back(i);
      ++waits_for[i];
    }
  }
  std::map<Code, std::vector<std::uint32_t>> ready;  // by kind; the most of one kind go first
  for (std::uint32_t i = 0; i < n; ++i) {
    if (waits_for[i] == 0) ready[instructions[i].code].push_back(i);
  }
  while (true) {
    const auto most = std::max_element(ready.begin(), ready.end(), [](const auto& a, const auto& b) {
      return a.second.size() < b.second.size();
    });
    if (most == ready.end() || most->second.empty()) break;
    std::vector<std::uint32_t>& mine = most->second;
    const auto begin = static_cast<std::uint32_t>(steps_.size());
    std::size_t next = 0;
    while (next < mine.size()) {  // it may grow
      const std::uint32_t now = mine[next++];
      const Instruction& instruction = instructions[now];
      const int operands = network::operand_count(instruction.code);
      const std::uint32_t a = slot_of(instruction.a);
      steps_.push_back({a, operands >= 2 ? slot_of(instruction.b) : a,
                        operands >= 3 ? slot_of(instruction.c) : a, slot_of(instruction.result)});
      for (const std::uint32_t reader : readers[now]) {
        if (--waits_for[reader] == 0) ready[instructions[reader].code].push_back(reader);
      }
    }
    ranges_.push_back({op_of(most->first), static_cast<std::uint32_t>(most->first), begin,
                       static_cast<std::uint32_t>(steps_.size())});
    mine.clear();
  }
}

std::vector<std::uint32_t> LaneTape::share_slots(std::span<LaneTape* const> tapes,
                                                 std::span<const std::uint32_t> kept, std::size_t n_slots) {
  constexpr std::size_t kNever = 0, kForEver = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> last_read(n_slots, kNever);
  std::vector<bool> is_result(n_slots);
  std::size_t now = 0;
  for (const LaneTape* const tape : tapes) {
    for (const LaneRange& range : tape->ranges_) {
      // Sines are perhaps computed twice, so that what they read lives until their range ends.
      const bool twice = range.op == LaneOp::sin || range.op == LaneOp::cos;
      for (std::uint32_t k = range.begin; k < range.end; ++k) {
        const LaneStep& step = tape->steps_[k];
        ++now;
        const std::size_t until = twice ? now + (range.end - k) : now;
        for (const std::uint32_t slot : {step.a, step.b, step.c})
          last_read[slot] = std::max(last_read[slot], until);
        is_result[step.result] = true;
      }
    }
  }
  for (const std::uint32_t slot : kept) last_read[slot] = kForEver;
  std::vector<std::uint32_t> slot_of(n_slots, 0);
  std::uint32_t next = 0;
  for (std::size_t slot = 0; slot < n_slots; ++slot) {
    if (!is_result[slot]) slot_of[slot] = next++;
  }
  std::vector<std::uint32_t> free;
  std::map<std::size_t, std::vector<std::uint32_t>> ends;  ///< new slots by the step that reads them last
  now = 0;
  for (LaneTape* const tape : tapes) {
    for (LaneStep& step : tape->steps_) {
      ++now;
      step.a = slot_of[step.a];
      step.b = slot_of[step.b];
      step.c = slot_of[step.c];
      while (!ends.empty() && ends.begin()->first <= now) {
        free.insert(free.end(), ends.begin()->second.begin(), ends.begin()->second.end());
        ends.erase(ends.begin());
      }
      std::uint32_t mine = next;
      if (free.empty()) {
        ++next;
      } else {
        mine = free.back();
        free.pop_back();
      }
      const std::size_t end = last_read[step.result];
      slot_of[step.result] = mine;
      step.result = mine;
      if (end != kForEver) ends[std::max(end, now + 1)].push_back(mine);
    }
  }
  return slot_of;
}

}  // namespace oblique::ensemble
