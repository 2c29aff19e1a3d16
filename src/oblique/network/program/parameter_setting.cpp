// SPDX-License-Identifier: MIT
#include <oblique/network/program/parameter_setting.h>

#include <algorithm>
#include <bit>
#include <limits>

#include <oblique/network/program/program_code.h>

namespace oblique::network {
namespace {

constexpr std::uint32_t kNotRead = std::numeric_limits<std::uint32_t>::max();

}  // namespace

ParameterSetting::ParameterSetting(const Program& program)
    : code_(program.code_), leaf_(code_->n_parameters, kNotRead) {
  const std::vector<ProgramCode::Constant>& constants = code_->constants;
  users_.resize(constants.size());
  for (std::uint32_t c = 0; c < constants.size(); ++c) {
    const ProgramCode::Constant& constant = constants[c];
    values_.push_back(constant.slot ? program.initial_slots_[*constant.slot] : constant.value);
    if (constant.parameter != ConstantFormula::kNoParameter) leaf_[constant.parameter] = c;
    if (constant.op == Op::constant) continue;
    users_[constant.a].push_back(c);
    if (constant.b != constant.a) users_[constant.b].push_back(c);
  }
}

bool ParameterSetting::set(std::span<const Parameter> parameters) {
  return set(parameters, true);
}

bool ParameterSetting::set_beside(std::span<const Parameter> parameters) {
  return set(parameters, false);
}

bool ParameterSetting::set(std::span<const Parameter> parameters, bool kinds_count) {
  was_.clear();
  const auto put = [&](std::uint32_t c, double value) {
    was_.emplace_back(c, values_[c]);
    values_[c] = value == 0 ? 0.0 : value;  // one zero, as in the graph
  };
  for (const Parameter& parameter : parameters) {
    if (leaf_[parameter.number] != kNotRead) put(leaf_[parameter.number], parameter.value);
  }
  for (const Parameter& parameter : parameters) {
    if (leaf_[parameter.number] == kNotRead) continue;
    for (const std::uint32_t c : followers(leaf_[parameter.number])) {
      const ProgramCode::Constant& constant = code_->constants[c];
      put(c, evaluate(constant.op, values_[constant.a], values_[constant.b]));
    }
  }
  const bool same = std::all_of(was_.begin(), was_.end(),
                                [&](const auto& entry) { return holds(entry.first, kinds_count); });
  if (!same) {
    std::for_each(was_.rbegin(), was_.rend(), [&](const auto& was) { values_[was.first] = was.second; });
  }
  return same;
}

bool ParameterSetting::holds(std::uint32_t c, bool kinds_count) const {
  const ProgramCode::Constant& constant = code_->constants[c];
  return stays(constant.decided, constant.value, values_[c]) ||
         (constant.decided == Decided::kind && !kinds_count);
}

const std::vector<std::uint32_t>& ParameterSetting::followers(std::uint32_t leaf) {
  const auto [known, inserted] = followers_.try_emplace(leaf);
  if (!inserted) return known->second;
  std::vector<std::uint32_t>& all = known->second;
  std::vector<std::uint32_t> pending{leaf};
  std::vector<bool> found(users_.size());
  while (!pending.empty()) {
    const std::uint32_t c = pending.back();
    pending.pop_back();
    for (const std::uint32_t user : users_[c]) {
      if (found[user]) continue;
      found[user] = true;
      all.push_back(user);
      pending.push_back(user);
    }
  }
  std::sort(all.begin(), all.end());  // each after its operands
  return all;
}

void ParameterSetting::write(std::vector<double>& slots) const {
  for (std::size_t c = 0; c < values_.size(); ++c) {
    if (const auto& slot = code_->constants[c].slot) slots[*slot] = values_[c];
  }
}

}  // namespace oblique::network
