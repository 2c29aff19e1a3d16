// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/trough_watch.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::ensemble {
namespace {

/// A trough below so many absolute tolerances, where no more than 4 digits are known, and what rises to so
/// many times of it.
constexpr double kLow = 1e4, kRisen = 100;
constexpr double kGrown = 1;  ///< logarithm of what a state has grown by of itself, at the least
constexpr double kNoTrough = std::numeric_limits<double>::infinity();

}  // namespace

TroughWatch::TroughWatch(const LaneProgram& program, const LaneKernels& kernels)
    : program_(program),
      kernels_(kernels),
      width_(static_cast<std::size_t>(kernels.width)),
      risen_(width_, 0) {
  for (std::size_t i = 0; i < program.n_states; ++i) {
    if (program.at_rest[i] || !program.grows[i]) continue;
    Watched& watched = watched_.emplace_back(Watched{i, {}});
    for (std::size_t k = 0; k < program.matrix_steps.size(); k += 2) {
      if (program.matrix_steps[k] == program.diagonal[i])
        watched.own_growth.push_back(program.matrix_steps[k + 1]);
    }
  }
  troughs_.resize((watched_.size() + 1) * width_);
}

void TroughWatch::begin(std::size_t lane, std::span<const double> start) {
  const auto set = [&](std::size_t place, double size) {
    trough(place, lane) = {size > 0 ? size : kNoTrough, 0};
  };
  double largest = 0;
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    const double size = std::abs(start[watched_[k].state]);
    largest = std::max(largest, size);
    set(k, size);
  }
  set(watched_.size(), largest);
}

/// Whether a state's own growth has brought it up since then: the derivative of its rate by itself, for that
/// time. Else what drives it has, and its error stays what it was.
bool TroughWatch::grows_by_itself(const Watched& watched, double since, std::size_t lane, LaneStates& lanes) {
  double* const slots = lanes.slots.data();
  if (!evaluated_) {
    std::copy_n(lanes.after.data(), program_.n_variables * width_, slots + width_);
    for (std::size_t l = 0; l < width_; ++l) slots[l] = lanes.t[l] + lanes.h[l];
    kernels_.run(program_.rates.code(), slots);
    kernels_.run(program_.derivatives.code(), slots);
    evaluated_ = true;
  }
  double rate = 0;
  for (const std::uint32_t slot : watched.own_growth) rate += slots[slot * width_ + lane];
  return rate * (lanes.t[lane] + lanes.h[lane] - since) > kGrown;
}

void TroughWatch::look_at(std::size_t place, std::size_t lane, double before, double after, double tolerance,
                          LaneStates& lanes) {
  Trough& least = trough(place, lane);
  if (after < before && after < least.size && after > 0) least = {after, lanes.t[lane] + lanes.h[lane]};
  if (!(least.size < kLow * tolerance && after > kRisen * least.size)) return;
  if (place < watched_.size() && !grows_by_itself(watched_[place], least.time, lane, lanes)) return;
  risen_[lane] = 1;
}

void TroughWatch::look(LaneStates& lanes, const LaneArray& taken) {
  evaluated_ = false;
  for (std::size_t l = 0; l < width_; ++l) {
    risen_[l] = 0;
    if (taken[l] == 0) continue;
    double largest_before = 0, largest_after = 0, largest_tolerance = 0;
    for (std::size_t k = 0; k < watched_.size(); ++k) {
      const std::size_t i = watched_[k].state;
      const double before = std::abs(lanes.u[i * width_ + l]), after = std::abs(lanes.after[i * width_ + l]);
      const double tolerance = program_.absolute[i];
      look_at(k, l, before, after, tolerance, lanes);
      largest_before = std::max(largest_before, before);
      largest_after = std::max(largest_after, after);
      largest_tolerance = std::max(largest_tolerance, tolerance);
    }
    if (watched_.size() > 1)
      look_at(watched_.size(), l, largest_before, largest_after, largest_tolerance, lanes);
  }
}

}  // namespace oblique::ensemble
