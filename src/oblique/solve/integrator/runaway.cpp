// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/runaway.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace oblique::solve {

bool grows_without_end(const SizeAlong& largest) {
  const auto rate = [&](std::size_t eighth) {  // ln of the factor from the one before
    return std::log(largest[eighth] / largest[eighth - 1]);
  };
  if (!(largest[4] > 0)) return false;
  const double least = std::log(2.0) / 2;
  if (!(rate(5) >= least) || !(rate(6) >= least) || !(rate(7) >= least)) return false;
  // tᵈ has ln(8/7)/ln(6/5) = 0.73 there, an exponential 1. An oscillation that grows moves this a little.
  constexpr double kKeepsUp = 0.85;
  return rate(7) >= kKeepsUp * rate(6) && rate(7) >= kKeepsUp * rate(5);
}

std::size_t eighth_of(double part) {
  return static_cast<std::size_t>(std::clamp(8 * part, 0.0, 7.0));
}

RunawayWatch::RunawayWatch(const network::Program& program, double begin, double end, bool any_size)
    : program_(program), begin_(begin), end_(end), any_size_(any_size), records_(program.n_signals()) {}

void RunawayWatch::look_at(double t, std::span<const double> signals) {
  const std::size_t eighth = eighth_of((t - begin_) / (end_ - begin_));
  for (std::size_t s = 0; s < records_.size(); ++s) {
    Record& record = records_[s];
    const double size = std::abs(signals[s]);
    record.largest[eighth] = std::max(record.largest[eighth], size);
    if (size > std::abs(record.peak)) {
      record.peak = signals[s];
      record.peak_time = t;
    }
    if (size >= kFarOutside && record.left < 0) record.left = t;
  }
}

std::vector<text::Diagnostic> RunawayWatch::warnings(const std::string& file) const {
  std::size_t count = 0, furthest = 0;
  for (std::size_t s = 0; s < records_.size(); ++s) {
    const Record& record = records_[s];
    if (record.left < 0 || !(any_size_ || grows_without_end(record.largest))) continue;
    if (count++ == 0 || std::abs(record.peak) > std::abs(records_[furthest].peak)) furthest = s;
  }
  if (count == 0) return {};
  const Record& record = records_[furthest];
  const std::string others = count == 1 ? "" : fmt::format("; {} signals do so in all", count);
  return {{{file, {}},
           fmt::format("the signal '{}' leaves the machine: it passes {:g} machine units at t = {:.6g} s and "
                       "comes to {:.3g} at t = {:.6g} s{}{}",
                       program_.signal_names()[furthest], kFarOutside, record.left, record.peak,
                       record.peak_time, grows_without_end(record.largest) ? ", still growing" : "", others),
           {},
           {text::Action{"check"},
            " tells which loop or mode grows, and proposes a scaling where it is only large"}}};
}

}  // namespace oblique::solve
