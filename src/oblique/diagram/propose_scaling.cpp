// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>

#include <oblique/diagram/rescale.h>

namespace oblique {
namespace {

constexpr double kMostAmplification = 100;  ///< a signal far below the machine unit is noise

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
      factor = std::min(factor, scale_for_peak(peak_of({b, o})));
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
    finish(b, rules_[b].from_inputs(inputs));
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
    return std::min(scale_for_peak(peak), kMostAmplification);
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

}  // namespace oblique
