// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_settling.h>

#include <algorithm>
#include <cmath>

#include <oblique/solve/stability/eigenvalues.h>

namespace oblique::ensemble {
namespace {

constexpr double kMostMoved = 0.2, kSmallMove = 0.02;  ///< of 1 + |x|, in a step
constexpr double kShortestStep = 1e-9;                 ///< of the first one
constexpr double kLongStep = 1e10;                     ///< time constants of the fastest loop
constexpr double kNearRest = 1e-8;                     ///< moved in a long step
constexpr double kFarAway = 1e6;                       ///< [machine unit]
constexpr double kShortPart = 1e-3;                    ///< of a first step, in which no loop is unstable
constexpr std::uint32_t kMostLoops = 40;  ///< that act on each other: eigenvalues of so many take long
constexpr int kMostSettling = 400;        ///< steps: a run by CVODES has patience

}  // namespace

LaneSettling::LaneSettling(const LaneProgram& program, const LaneKernels& kernels)
    : program_(program),
      kernels_(kernels),
      width_(static_cast<std::size_t>(kernels.width)),
      n_(program.n_variables),
      ways_(width_),
      negative_(n_ * width_),
      entries_(program.lu.n_entries() * width_),
      growth_(width_),
      h_(width_),
      scale_(width_) {
  for (LaneArray* const variables : {&before_, &reciprocals_, &rates_, &change_, &work_})
    *variables = LaneArray(n_ * width_);
}

/// F of the loops at the slots, and 1/h − ∂F/∂u.
void LaneSettling::linearise(LaneArray& slots) {
  kernels_.run(program_.rates.code(), slots.data());
  kernels_.run(program_.derivatives.code(), slots.data());
  for (std::size_t i = 0; i < n_; ++i) {
    const double* const rate = slots.data() + program_.rate_slots[i] * width_;
    for (std::size_t l = 0; l < width_; ++l) rates_[i * width_ + l] = program_.at_rest[i] ? rate[l] : 0;
  }
  kernels_.matrix(program_.matrix(), slots.data(), scale_.data(), entries_.data());
  for (const auto& [entry, value] : program_.fixed_entries)
    std::fill_n(entries_.data() + entry * width_, width_, value);
}

double LaneSettling::step_of_change(const LaneArray& slots, std::size_t lane) const {
  double fastest = 0;
  for (std::size_t i = 0; i < n_; ++i)
    fastest = std::max(fastest,
                       std::abs(rates_[i * width_ + lane]) / (1 + std::abs(slots[(1 + i) * width_ + lane])));
  return kMostMoved / fastest;
}

void LaneSettling::factor() {
  kernels_.factor(program_.lu.code(), entries_.data(), reciprocals_.data(), growth_.data());
}

/// First steps, and the signs of the pivots before any loop has moved.
void LaneSettling::begin(LaneArray& slots, const std::vector<bool>& lanes) {
  std::fill_n(scale_.data(), width_, 0.0);
  linearise(slots);
  for (std::size_t l = 0; l < width_; ++l) {
    double rate = 0;
    for (const RestGroup& group : program_.rest_groups) {
      for (const RestGroup::Entry& entry : group.entries)
        rate = std::max(rate, std::abs(entries_[entry.place * width_ + l]));
    }
    Way& way = ways_[l];
    way = {lanes[l], false, rate > 0 ? 1 / rate : 1, 0};
    h_[l] = std::min(way.unit, step_of_change(slots, l));
    way.shortest = kShortestStep * h_[l];
    scale_[l] = 1 / (kShortPart * h_[l]);
  }
  linearise(slots);
  factor();
  for (std::size_t k = 0; k < n_ * width_; ++k) negative_[k] = std::signbit(reciprocals_[k]);
}

void LaneSettling::run(LaneArray& slots, std::vector<bool>& lanes) {
  begin(slots, lanes);
  const auto goes_on = [](const Way& way) { return way.goes_on; };
  for (int step = 0; step < kMostSettling && std::any_of(ways_.begin(), ways_.end(), goes_on); ++step) {
    for (std::size_t l = 0; l < width_; ++l) scale_[l] = 1 / h_[l];
    linearise(slots);
    factor();
    kernels_.solve(program_.lu.code(), entries_.data(), reciprocals_.data(), rates_.data(), work_.data(),
                   change_.data());
    std::copy_n(slots.data() + width_, n_ * width_, before_.data());
    for (std::size_t k = 0; k < n_ * width_; ++k) slots[width_ + k] += change_[k];
    kernels_.run(program_.rates.code(), slots.data());
    for (std::size_t l = 0; l < width_; ++l) judge(slots, l);
  }
  for (std::size_t l = 0; l < width_; ++l) lanes[l] = ways_[l].rests;
}

/// What becomes of a lane after a step: it is taken, tried again shorter, or was the last.
void LaneSettling::judge(LaneArray& slots, std::size_t l) {
  Way& way = ways_[l];
  const auto take_back = [&] {
    for (std::size_t i = 0; i < n_; ++i) slots[(1 + i) * width_ + l] = before_[i * width_ + l];
  };
  if (!way.goes_on) {
    take_back();
    return;
  }
  bool good = growth_[l] < kMostGrowth;
  double moved = 0, farthest = 0;
  for (std::size_t i = 0; good && i < n_; ++i) {
    const std::size_t k = i * width_ + l;
    moved = std::max(moved, std::abs(change_[k]) / (1 + std::abs(before_[k])));
    farthest = std::max(farthest, std::abs(slots[width_ + k]));
    good = std::isfinite(change_[k]) && std::isfinite(slots[program_.rate_slots[i] * width_ + l]) &&
           std::signbit(reciprocals_[k]) == negative_[k];
  }
  if (!good || moved >= kMostMoved) {
    take_back();
    h_[l] /= 4;
    way.goes_on = h_[l] > way.shortest;
    return;
  }
  way.rests = h_[l] >= kLongStep * way.unit && moved < kNearRest;
  way.goes_on = !way.rests && farthest <= kFarAway;
  way.shortest = kShortestStep * std::min(way.unit, step_of_change(slots, l));
  if (moved < kSmallMove) {
    h_[l] *= 10;
  } else if (moved < kMostMoved / 2) {
    h_[l] *= 2;
  }
}

void LaneSettling::keep_stable(LaneArray& slots, std::vector<bool>& lanes) {
  std::fill_n(scale_.data(), width_, 0.0);
  linearise(slots);
  for (std::size_t l = 0; l < width_; ++l) lanes[l] = lanes[l] && is_stable(l);
}

bool LaneSettling::is_stable(std::size_t lane) const {
  for (const RestGroup& group : program_.rest_groups) {
    if (group.size > kMostLoops) return false;
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(group.size, group.size);
    for (const RestGroup::Entry& entry : group.entries)
      jacobian(entry.row, entry.column) = -entries_[entry.place * width_ + lane];
    const double slowest =
        group.size == 1 ? jacobian(0, 0) : solve::eigenvalues_of(jacobian).real().maxCoeff();
    if (!(slowest < 0)) return false;
  }
  return true;
}

}  // namespace oblique::ensemble
