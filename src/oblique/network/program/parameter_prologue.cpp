// SPDX-License-Identifier: MIT
#include <oblique/network/program/parameter_prologue.h>

#include <algorithm>
#include <limits>

#include <oblique/network/program/program_code.h>

namespace oblique::network {
namespace {

constexpr std::uint32_t kNoLeaf = std::numeric_limits<std::uint32_t>::max();

}  // namespace

ParameterPrologue::ParameterPrologue(const Program& program, std::span<const std::uint32_t> varied) {
  const ProgramCode& code = *program.code_;
  const std::vector<ProgramCode::Constant>& constants = code.constants;
  std::vector<std::uint32_t> leaf(code.n_parameters, kNoLeaf);
  for (std::uint32_t c = 0; c < constants.size(); ++c) {
    const ProgramCode::Constant& constant = constants[c];
    values_.push_back(constant.slot ? program.initial_slots_[*constant.slot] : constant.value);
    if (constant.parameter != ConstantFormula::kNoParameter) leaf[constant.parameter] = c;
  }
  std::vector<bool> follows(constants.size());
  for (const std::uint32_t parameter : varied) {
    leaves_.push_back(leaf[parameter]);
    if (leaf[parameter] != kNoLeaf) follows[leaf[parameter]] = true;
  }
  for (std::uint32_t c = 0; c < constants.size(); ++c) {
    const ProgramCode::Constant& constant = constants[c];
    if (constant.op != Op::constant && (follows[constant.a] || follows[constant.b])) {
      follows[c] = true;
      steps_.push_back({constant.op, constant.a, constant.b, c});
    }
    if (!follows[c]) continue;
    if (constant.decided != Decided::nothing) decided_.push_back({c, constant.decided});
    if (!constant.slot) continue;
    slots_.push_back(*constant.slot);
    slot_constants_.push_back(c);
  }
}

bool ParameterPrologue::run(std::span<const double> varied, std::span<double> scratch,
                            std::span<double> out) const {
  std::copy(values_.begin(), values_.end(), scratch.begin());
  for (std::size_t k = 0; k < varied.size(); ++k) {
    if (leaves_[k] != kNoLeaf) scratch[leaves_[k]] = varied[k] == 0 ? 0.0 : varied[k];
  }
  for (const Step& step : steps_) {
    const double value = evaluate(step.op, scratch[step.a], scratch[step.b]);
    scratch[step.result] = value == 0 ? 0.0 : value;  // one zero, as in the graph
  }
  for (const Held& held : decided_) {
    if (!stays(held.decided, values_[held.constant], scratch[held.constant])) return false;
  }
  for (std::size_t k = 0; k < slots_.size(); ++k) out[k] = scratch[slot_constants_[k]];
  return true;
}

}  // namespace oblique::network
