// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_starts.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::ensemble {
namespace {

constexpr int kMostNewton = 15;
constexpr double kAtRest = 1e-12;     ///< a step of Newton's method, of its variable and a machine unit
constexpr double kContracts = 0.5;    ///< such a step, of the one before it
constexpr double kSurelyNear = 1e-9;  ///< from here on rounding may end the contraction

constexpr double kFirstChange = 0.01;  ///< of the states in the first step
constexpr double kFirstPart = 0.001;   ///< of the run, at most

}  // namespace

void set_constants(const LaneSpace& space, std::size_t lane, std::span<const double> draws, std::size_t width,
                   LaneArray& slots) {
  for (const LaneConstant& constant : space.constants)
    slots[constant.slot * width + lane] = draws[constant.drawn];
}

LaneArray slots_of(const LaneSpace& space, std::size_t width) {
  LaneArray slots(space.slots.size() * width);
  for (std::size_t i = 0; i < space.slots.size(); ++i)
    std::fill_n(slots.data() + i * width, width, space.slots[i]);
  return slots;
}

LaneStarts::LaneStarts(const LaneProgram& program, const LaneKernels& kernels,
                       std::span<const double> typical)
    : program_(program),
      kernels_(kernels),
      width_(static_cast<std::size_t>(kernels.width)),
      n_(program.n_variables),
      settling_(program, kernels),
      slots_(slots_of(program.integration, width_)),
      entries_(program.lu.n_entries() * width_),
      growth_(width_),
      scale_(width_) {
  for (LaneArray* const variables : {&reciprocals_, &rates_, &change_, &work_})
    *variables = LaneArray(n_ * width_);
  goes_far_ = program.needs_rest && n_ == program.n_states && typical_machine_settles(typical);
}

/// Whether it comes to the rest that CVODES brought it to.
bool LaneStarts::typical_machine_settles(std::span<const double> typical) {
  constexpr double kSame = 1e-9;
  std::vector<double> variables;
  for (const LaneNumber& start : program_.starts) variables.push_back(start.of(typical));
  Start start{typical, variables, false};
  find({&start, 1});
  for (std::size_t i = 0; start.found && i < n_; ++i)
    start.found = std::abs(variables[i] - program_.guess[i]) <= kSame * (1 + std::abs(variables[i]));
  return start.found;
}

void LaneStarts::find(std::span<Start> starts) {
  slots_ = slots_of(program_.integration, width_);
  for (std::size_t l = 0; l < width_; ++l) {
    const Start& start = starts[std::min(l, starts.size() - 1)];  // lanes without one do as the last
    set_constants(program_.integration, l, start.draws, width_, slots_);
    for (std::size_t i = 0; i < n_; ++i) slots_[(1 + i) * width_ + l] = start.variables[i];
  }
  if (program_.needs_rest) {
    std::vector<bool> far(width_);
    for (std::size_t l = 0; l < starts.size(); ++l) far[l] = !starts[l].is_near;
    const bool any_far = std::find(far.begin(), far.end(), true) != far.end();
    if (any_far) settling_.run(slots_, far);
    bring_to_rest(starts);
    if (any_far) settling_.keep_stable(slots_, far);
    for (std::size_t l = 0; l < starts.size(); ++l)
      starts[l].found = starts[l].found && (starts[l].is_near || far[l]);
  } else {
    for (Start& start : starts) start.found = true;
  }
  find_first_steps(starts);
}

/// Newton's method in all lanes; each is left alone once it stands. From the typical machine the way is
/// short: where it does not contract from its first step on, the machine is left to those who know how to
/// look for a rest.
void LaneStarts::bring_to_rest(std::span<Start> starts) {
  std::vector<double> before(starts.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> goes_on(starts.size(), true);
  for (int k = 0; k < kMostNewton && std::find(goes_on.begin(), goes_on.end(), true) != goes_on.end(); ++k) {
    kernels_.run(program_.rates.code(), slots_.data());
    kernels_.run(program_.derivatives.code(), slots_.data());
    kernels_.matrix(program_.matrix(), slots_.data(), scale_.data(), entries_.data());
    for (const auto& [entry, value] : program_.fixed_entries)
      std::fill_n(entries_.data() + entry * width_, width_, value);
    kernels_.factor(program_.lu.code(), entries_.data(), reciprocals_.data(), growth_.data());
    for (std::size_t i = 0; i < n_; ++i) {
      const double* const rate = slots_.data() + program_.rate_slots[i] * width_;
      for (std::size_t l = 0; l < width_; ++l) rates_[i * width_ + l] = program_.at_rest[i] ? rate[l] : 0;
    }
    kernels_.solve(program_.lu.code(), entries_.data(), reciprocals_.data(), rates_.data(), work_.data(),
                   change_.data());
    for (std::size_t l = 0; l < starts.size(); ++l) {
      if (goes_on[l]) goes_on[l] = take_step(l, starts[l], before[l]);
    }
  }
  for (std::size_t l = 0; l < starts.size(); ++l) {
    for (std::size_t i = 0; i < n_; ++i) starts[l].variables[i] = slots_[(1 + i) * width_ + l];
  }
}

/// Whether there is to be another one. `before`: how long the last one was.
bool LaneStarts::take_step(std::size_t lane, Start& start, double& before) {
  double largest = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    double& variable = slots_[(1 + i) * width_ + lane];
    variable += change_[i * width_ + lane];
    const double size = std::abs(change_[i * width_ + lane]) / (1 + std::abs(variable));
    largest = size <= largest ? largest : size;  // and no number
  }
  const bool contracts = largest <= kContracts * before || largest < kSurelyNear;
  if (!contracts || !(growth_[lane] < kMostGrowth)) return false;
  before = largest;
  start.found = largest < kAtRest;
  return !start.found;
}

void LaneStarts::find_first_steps(std::span<Start> starts) {
  kernels_.run(program_.rates.code(), slots_.data());
  for (std::size_t l = 0; l < starts.size(); ++l) {
    double size = kFirstChange / program_.relative, rate = 0;
    for (std::size_t i = 0; i < program_.n_states; ++i) {
      if (program_.at_rest[i]) continue;
      const double variable = std::abs(starts[l].variables[i]);
      const double unit = program_.absolute[i] + program_.relative * variable;
      size = std::max(size, variable / unit);
      rate = std::max(rate, std::abs(slots_[program_.rate_slots[i] * width_ + l]) / unit);
    }
    const double most = kFirstPart * program_.until;
    starts[l].first_step = rate * most > kFirstChange * size ? kFirstChange * size / rate : most;
  }
}

}  // namespace oblique::ensemble
