// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/signal_watch.h>

#include <algorithm>
#include <cmath>

#include <oblique/solve/integrator/runaway.h>

namespace oblique::ensemble {
namespace {

constexpr std::size_t kEighths = std::tuple_size_v<solve::SizeAlong>;

}  // namespace

SignalWatch::SignalWatch(const LaneProgram& program, std::size_t width)
    : program_(program),
      width_(width),
      n_(program.signal_slots.size()),
      largest_(kEighths * n_ * width),
      doubt_(width) {}

void SignalWatch::begin() {
  std::fill_n(largest_.data(), kEighths * n_ * width_, 0.0);
  std::fill_n(doubt_.data(), width_, 0.0);
}

void SignalWatch::look_at(double part, const LaneArray& slots) {
  double* largest = largest_.data() + solve::eighth_of(part) * n_ * width_;
  for (const std::uint32_t slot : program_.signal_slots) {
    const double* const signal = slots.data() + slot * width_;
    for (std::size_t l = 0; l < width_; ++l) {
      const double size = std::abs(signal[l]);
      largest[l] = size > largest[l] ? size : largest[l];
      doubt_[l] += size - size;
    }
    largest += width_;
  }
}

std::string SignalWatch::finding(std::size_t lane) const {
  if (std::isnan(doubt_[lane])) return "a signal that is no number";
  for (std::size_t s = 0; s < n_; ++s) {
    solve::SizeAlong along{};
    for (std::size_t e = 0; e < kEighths; ++e) along[e] = largest_[(e * n_ + s) * width_ + lane];
    if (*std::max_element(along.begin(), along.end()) < solve::kFarOutside) continue;
    if (program_.bound_to_unit || solve::grows_without_end(along)) return "a signal leaves the machine";
  }
  return {};
}

}  // namespace oblique::ensemble
