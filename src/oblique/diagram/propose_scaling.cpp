// SPDX-License-Identifier: MIT
#include <oblique/diagram/propose_scaling.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace oblique::diagram {
namespace {

/// A signal that needs more is the balance of others, such as the residual of a loop: noise, to be left
/// alone.
constexpr double kMostAmplification = 1000;

double usable_scale(double peak) {
  const double scale = scale_for_peak(peak);
  return scale <= kMostAmplification ? scale : 1;
}

class Proposal {
 public:
  Proposal(const FlatDiagram& flat, std::span<const double> peaks)
      : flat_(flat), peaks_(peaks), marks_(flat.blocks.size(), Mark::open), scaling_(flat.blocks.size()) {
    for (const FlatBlock& block : flat.blocks) {
      first_.push_back(first_.empty() ? 0 : first_.back() + previous_outputs_);
      previous_outputs_ = block.definition->outputs.size();
      rules_.emplace_back(block);
    }
  }

  AmplitudeScaling make() {
    for (std::size_t b = 0; b < flat_.blocks.size(); ++b) {
      if (rules_[b].scales_as_a_whole()) scale_as_a_whole(b);
    }
    for (std::size_t b = 0; b < flat_.blocks.size(); ++b) scale_from_inputs(b);
    return std::move(scaling_);
  }

 private:
  enum class Mark { open, under_way, done };

  double peak_of(SignalRef signal) const { return std::abs(peaks_[first_[signal.block] + signal.output]); }

  void scale_as_a_whole(std::size_t b) {
    double factor = kMostAmplification;
    for (std::size_t o = 0; o < flat_.blocks[b].definition->outputs.size(); ++o) {
      factor = std::min(factor, usable_scale(peak_of({b, o})));
    }
    if (flat_.blocks[b].inputs.empty()) factor = std::min(factor, 1.0);
    finish(b, rules_[b].whole(factor));
  }

  /// Sources first; the blocks of a ring that no linear block breaks take the peaks in place of the factors.
  void scale_from_inputs(std::size_t b) {
    if (marks_[b] != Mark::open) return;
    marks_[b] = Mark::under_way;
    std::vector<double> inputs;
    for (const FlatInput& input : flat_.blocks[b].inputs) inputs.push_back(input_factor(input));
    finish(b, largest_in_range(b, inputs));
  }

  /// As the inputs ask, or by a 1-2-5 step less where an output would leave the machine unit and that helps.
  BlockScaling largest_in_range(std::size_t b, const std::vector<double>& inputs) const {
    BlockScaling asked = rules_[b].from_inputs(inputs);
    if (is_in_range(b, asked)) return asked;
    for (const double less : {0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001}) {
      std::vector<double> smaller = inputs;
      for (double& factor : smaller) factor *= less;
      BlockScaling scaling = rules_[b].from_inputs(smaller);
      if (is_in_range(b, scaling)) return scaling;
    }
    return asked;
  }

  bool is_in_range(std::size_t b, const BlockScaling& scaling) const {
    for (std::size_t o = 0; o < scaling.outputs.size(); ++o) {
      if (scaling.outputs[o] * peak_of({b, o}) > 1 + kOverloadTolerance) return false;
    }
    return true;
  }

  double input_factor(const FlatInput& input) {
    if (input.terms.size() == 1 && input.constant == 0 && input.terms[0].weight != 0) {
      const SignalRef source = input.terms[0].signal;
      scale_from_inputs(source.block);
      if (marks_[source.block] == Mark::done) {
        const double factor = scaling_[source.block].outputs[source.output];
        const bool in_range = factor * peak_of(source) <= 1 + kOverloadTolerance;
        if (in_range) return factor / std::abs(input.terms[0].weight);
      }
    }
    double peak = std::abs(input.constant);
    for (const FlatTerm& term : input.terms) peak += std::abs(term.weight) * peak_of(term.signal);
    return usable_scale(peak);
  }

  void finish(std::size_t b, BlockScaling scaling) {
    const FlatBlock& block = flat_.blocks[b];
    for (std::size_t k = 0; k < block.parameters.size(); ++k) {
      if (block.definition->parameters[k].allows(block.parameters[k] * scaling.parameters[k])) continue;
      scaling = rules_[b].whole(1);  // a parameter would leave its range
      break;
    }
    scaling_[b] = std::move(scaling);
    marks_[b] = Mark::done;
  }

  const FlatDiagram& flat_;
  std::span<const double> peaks_;
  std::vector<std::size_t> first_;
  std::size_t previous_outputs_ = 0;
  std::vector<BlockScalingRules> rules_;
  std::vector<Mark> marks_;
  AmplitudeScaling scaling_;
};

}  // namespace

double scale_for_peak(double peak) {
  const double size = std::abs(peak) / (1 + kOverloadTolerance);
  if (size == 0 || !std::isfinite(size)) return 1;
  const int decade = static_cast<int>(std::floor(-std::log10(size)));
  // The powers are whole numbers, so that factors are the nearest numbers to 0.2, 0.05, …
  const auto step = [](int mantissa, int power) {
    const double whole = std::pow(10.0, std::abs(power));
    return power < 0 ? mantissa / whole : mantissa * whole;
  };
  double best = step(5, decade - 1);
  for (const int mantissa : {1, 2, 5, 10}) {
    if (step(mantissa, decade) * size <= 1) best = step(mantissa, decade);
  }
  return best;
}

AmplitudeScaling propose_scaling(const FlatDiagram& flat, std::span<const double> peaks) {
  return Proposal(flat, peaks).make();
}

}  // namespace oblique::diagram
