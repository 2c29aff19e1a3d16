// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_runner.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace oblique::ensemble {
namespace {

constexpr double kShortest = 1e-14;  ///< step, of the run
constexpr double kMostGrowth = 1e6;  ///< of a multiplier: beyond, the fixed order of pivots does not suit
/// How far the argument of a sine or cosine of the time may go in a step [rad].
constexpr double kMostTurn = std::numbers::pi / 2;
constexpr int kMostNewton = 15;
/// How far a value of a machine may be from the typical one, of that or of 1, so that its servo loops come to
/// the rest that is near the typical one's: what would decide between two rests is far.
constexpr double kNear = 0.05;
/// A state in a trough below kLow absolute tolerances, of which no more than 4 digits are known, that rises
/// to kRisen times of it.
constexpr double kLow = 1e4, kRisen = 100;
constexpr double kGrown = 1;  ///< times e: what a state has grown by of itself is no less
constexpr double kNoTrough = std::numeric_limits<double>::infinity();
constexpr double kAtRest = 1e-12;     ///< a step of Newton's method, of its variable and a machine unit
constexpr double kContracts = 0.5;    ///< such a step, of the one before it
constexpr double kSurelyNear = 1e-9;  ///< from here on rounding may end the contraction

}  // namespace

LaneRunner::LaneRunner(const LaneProgram& program, std::span<const double> base, const LaneKernels& kernels)
    : program_(program),
      base_(base),
      kernels_(kernels),
      width_(static_cast<std::size_t>(kernels.width)),
      n_(program.n_variables),
      lanes_(width_),
      scratch_(program.prologue->scratch_size()),
      output_slots_(slots_of(program.output)),
      where_(width_) {
  at_.slots = slots_of(program.integration);
  for (LaneArray* const variables : {&at_.u, &at_.after, &at_.between}) *variables = LaneArray(n_ * width_);
  for (LaneArray* const numbers : {&at_.t, &at_.h, &at_.error, &at_.growth, &at_.theta})
    *numbers = LaneArray(width_);
  method_ = make_lane_method(program, kernels, at_);
  for (std::size_t i = 0; i < program.n_states; ++i) {
    if (program.at_rest[i] || !program.grows[i]) continue;
    std::vector<std::uint32_t> own;
    for (std::size_t k = 0; k < program.matrix_steps.size(); k += 2) {
      if (program.matrix_steps[k] == program.diagonal[i]) own.push_back(program.matrix_steps[k + 1]);
    }
    watched_.emplace_back(i, std::move(own));
  }
  trough_ = LaneArray((watched_.size() + 1) * width_);
  trough_time_ = LaneArray((watched_.size() + 1) * width_);
  risen_ = LaneArray(width_);
}

LaneArray LaneRunner::slots_of(const LaneSpace& space) const {
  LaneArray slots(space.slots.size() * width_);
  for (std::size_t i = 0; i < space.slots.size(); ++i)
    std::fill_n(slots.data() + i * width_, width_, space.slots[i]);
  return slots;
}

void LaneRunner::set_constants(const LaneSpace& space, std::size_t lane, const Machine& machine,
                               LaneArray& slots) const {
  for (const LaneConstant& constant : space.constants)
    slots[constant.slot * width_ + lane] = machine.draws[constant.drawn];
}

double LaneRunner::row_time(int row) const {
  return row + 1 == program_.rows ? program_.until : program_.until * row / (program_.rows - 1);
}

double LaneRunner::longest_step(const Machine& machine) const {
  double fastest = 0;
  for (const LaneNumber& rate : program_.turning)
    fastest = std::max(fastest, std::abs(rate.of(machine.draws)));
  return std::min({program_.max_step, program_.until, kMostTurn / fastest});
}

/// What a machine draws becomes constants and starts; says why not where a lane cannot have it.
bool LaneRunner::draw(Machine& machine) {
  machine.draws.resize(program_.prologue->slots().size());
  if (!program_.prologue->run(machine.values, scratch_, machine.draws)) {
    machine.refused = "another case of the equations";
    return false;
  }
  if (program_.needs_rest && !is_near(machine.values)) {
    machine.refused = "its loops may come to another rest than those of the typical machine";
    return false;
  }
  machine.start = program_.guess;
  for (std::size_t i = 0; i < program_.n_states; ++i) {
    if (!program_.at_rest[i]) machine.start[i] = program_.starts[i].of(machine.draws);
  }
  const auto is_finite = [](double x) { return std::isfinite(x); };
  if (!std::all_of(machine.start.begin(), machine.start.end(), is_finite)) {
    machine.refused = "a start that is no number";
    return false;
  }
  machine.longest_step = longest_step(machine);
  return true;
}

bool LaneRunner::is_near(std::span<const double> values) const {
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!(std::abs(values[k] - base_[k]) <= kNear * std::max(1.0, std::abs(base_[k])))) return false;
  }
  return true;
}

/// Takes a batch of machines from the queue; false where none is left.
bool LaneRunner::prepare(const Next& next, const Values& values, const Refuse& refuse) {
  std::vector<std::size_t> batch;
  std::uint64_t number = 0;
  bool any = false;
  while (batch.size() < width_ && next(number)) {
    any = true;
    if (free_.empty()) {
      free_.push_back(machines_.size());
      machines_.emplace_back();
    }
    Machine& machine = machines_[free_.back()];
    machine.number = number;
    machine.values.assign(base_.begin(), base_.end());
    machine.steps = 0;
    machine.refused.clear();
    values(number, machine.values);
    if (draw(machine)) {
      batch.push_back(free_.back());
      free_.pop_back();
    } else {
      refuse(number, machine.values, machine.refused);
    }
  }
  if (batch.empty()) return any;
  bring_to_rest(batch);
  for (const std::size_t m : batch) {
    Machine& machine = machines_[m];
    if (machine.refused.empty()) {
      ready_.push_back(m);
    } else {
      refuse(machine.number, machine.values, machine.refused);
      free_.push_back(m);
    }
  }
  return true;
}

/// Newton's method for what is brought to rest, in all machines of a batch; each is left alone once it
/// stands. From the typical machine the way is short: where it does not contract from its first step on, the
/// machine is left to those who know how to look for a rest.
void LaneRunner::bring_to_rest(std::span<const std::size_t> batch) {
  LaneArray slots = slots_of(program_.integration);
  LaneArray entries(program_.lu.n_entries() * width_), reciprocals(n_ * width_), rates(n_ * width_),
      change(n_ * width_), work(n_ * width_), growth(width_), scale(width_);
  std::vector<double> before(width_, std::numeric_limits<double>::infinity());
  std::vector<bool> stands(width_, false);
  for (std::size_t l = 0; l < width_; ++l) {
    const Machine& machine = machines_[batch[std::min(l, batch.size() - 1)]];
    set_constants(program_.integration, l, machine, slots);
    for (std::size_t i = 0; i < n_; ++i) slots[(1 + i) * width_ + l] = machine.start[i];
    if (l >= batch.size()) stands[l] = true;
  }
  for (int k = 0; program_.needs_rest && k < kMostNewton; ++k) {
    if (std::find(stands.begin(), stands.end(), false) == stands.end()) break;
    kernels_.run(program_.rates.code(), slots.data());
    kernels_.run(program_.derivatives.code(), slots.data());
    kernels_.matrix(program_.matrix(), slots.data(), scale.data(), entries.data());
    for (const auto& [entry, value] : program_.fixed_entries)
      std::fill_n(entries.data() + entry * width_, width_, value);
    kernels_.factor(program_.lu.code(), entries.data(), reciprocals.data(), growth.data());
    for (std::size_t i = 0; i < n_; ++i) {
      const double* const rate = slots.data() + program_.rate_slots[i] * width_;
      for (std::size_t l = 0; l < width_; ++l) rates[i * width_ + l] = program_.at_rest[i] ? rate[l] : 0;
    }
    kernels_.solve(program_.lu.code(), entries.data(), reciprocals.data(), rates.data(), work.data(),
                   change.data());
    for (std::size_t l = 0; l < batch.size(); ++l) {
      if (stands[l]) continue;
      double largest = 0;
      for (std::size_t i = 0; i < n_; ++i) {
        double& variable = slots[(1 + i) * width_ + l];
        variable += change[i * width_ + l];
        const double size = std::abs(change[i * width_ + l]) / (1 + std::abs(variable));
        largest = size <= largest ? largest : size;  // and no number
      }
      if (!(largest <= kContracts * before[l] || largest < kSurelyNear) || !(growth[l] < kMostGrowth)) {
        machines_[batch[l]].refused = "no rest near that of the typical machine";
        stands[l] = true;
      }
      before[l] = largest;
      if (largest < kAtRest) stands[l] = true;
    }
  }
  for (std::size_t l = 0; l < batch.size(); ++l) {
    Machine& machine = machines_[batch[l]];
    if (!stands[l] && program_.needs_rest) machine.refused = "no rest near that of the typical machine";
    for (std::size_t i = 0; i < n_; ++i) machine.start[i] = slots[(1 + i) * width_ + l];
  }
  kernels_.run(program_.rates.code(), slots.data());
  for (std::size_t l = 0; l < batch.size(); ++l) {
    Machine& machine = machines_[batch[l]];
    double size = 0, rate = 0;
    for (std::size_t i = 0; i < program_.n_states; ++i) {
      if (program_.at_rest[i]) continue;
      const double unit = program_.absolute[i] + program_.relative * std::abs(machine.start[i]);
      size = std::max(size, std::abs(machine.start[i]) / unit);
      rate = std::max(rate, std::abs(slots[program_.rate_slots[i] * width_ + l]) / unit);
    }
    const double scale_of_time = rate > 0 ? 0.01 * std::max(size, 0.01 / program_.relative) / rate
                                          : std::numeric_limits<double>::infinity();
    machine.first_step = std::min({scale_of_time, 0.001 * program_.until, machine.longest_step});
  }
}

void LaneRunner::put(std::size_t lane, std::size_t m) {
  Machine& machine = machines_[m];
  set_constants(program_.integration, lane, machine, at_.slots);
  for (std::size_t i = 0; i < n_; ++i) at_.u[i * width_ + lane] = machine.start[i];
  machine.rows.resize(static_cast<std::size_t>(program_.rows) * n_);
  std::copy(machine.start.begin(), machine.start.end(), machine.rows.begin());
  double largest = 0;
  for (std::size_t k = 0; k <= watched_.size(); ++k) {
    const double start = k < watched_.size() ? std::abs(machine.start[watched_[k].first]) : largest;
    largest = std::max(largest, start);
    trough_[k * width_ + lane] = start > 0 ? start : kNoTrough;
    trough_time_[k * width_ + lane] = 0;
  }
  lanes_[lane] = {m, true, false, 1};
  at_.t[lane] = 0;
  at_.h[lane] = machine.first_step;
}

/// Takes the rows that lie in the steps just taken, which stand in `where_`.
void LaneRunner::keep_rows() {
  while (true) {
    bool any = false;
    for (std::size_t l = 0; l < width_; ++l) {
      at_.theta[l] = -1;
      const Lane& lane = lanes_[l];
      if (where_[l] == 0 || lane.row >= program_.rows) continue;
      const double t = row_time(lane.row), end = at_.t[l] + at_.h[l];
      if (t > end && end < program_.until) continue;
      at_.theta[l] = std::min((t - at_.t[l]) / at_.h[l], 1.0);
      any = true;
    }
    if (!any) return;
    method_->find_between(at_);
    for (std::size_t l = 0; l < width_; ++l) {
      if (at_.theta[l] < 0) continue;
      double* const row =
          machines_[lanes_[l].machine].rows.data() + static_cast<std::size_t>(lanes_[l].row) * n_;
      for (std::size_t i = 0; i < n_; ++i) row[i] = at_.between[i * width_ + l];
      ++lanes_[l].row;
    }
  }
}

void LaneRunner::refuse_lane(std::size_t l, const std::string& why, const Refuse& refuse) {
  const Machine& machine = machines_[lanes_[l].machine];
  refuse(machine.number, machine.values, why);
  free_.push_back(lanes_[l].machine);
  lanes_[l].busy = false;
}

/// Whether a state's own growth has brought it up from its trough: ∂F/∂x of its own, for the time since then.
/// Else what drives it has, and its error stays what it was.
bool LaneRunner::grows_by_itself(std::size_t watched, std::size_t lane, bool& evaluated) {
  if (!evaluated) {
    std::copy_n(at_.after.data(), n_ * width_, at_.slots.data() + width_);
    for (std::size_t l = 0; l < width_; ++l) at_.slots[l] = at_.t[l] + at_.h[l];
    kernels_.run(program_.rates.code(), at_.slots.data());
    kernels_.run(program_.derivatives.code(), at_.slots.data());
    evaluated = true;
  }
  double rate = 0;
  for (const std::uint32_t slot : watched_[watched].second) rate += at_.slots[slot * width_ + lane];
  return rate * (at_.t[lane] + at_.h[lane] - trough_time_[watched * width_ + lane]) > kGrown;
}

/// A state that comes near its absolute tolerance and grows again is known to few digits: down there the
/// solver looks at the tolerance alone. (A single run begins anew, finer.) So are all of them where they come
/// near it together. What others drive through 0 is no such state, nor what rises from an exact 0. Sees the
/// steps just taken, which stand in `where_`.
void LaneRunner::watch_troughs() {
  bool evaluated = false;
  for (std::size_t l = 0; l < width_; ++l) {
    risen_[l] = 0;
    if (where_[l] == 0) continue;
    const double end = at_.t[l] + at_.h[l];
    double largest_before = 0, largest_after = 0, tolerance = 0;
    for (std::size_t k = 0; k <= watched_.size(); ++k) {
      const bool all = k == watched_.size();
      if (all && watched_.size() < 2) break;
      double before = largest_before, after = largest_after;
      if (!all) {
        const std::size_t i = watched_[k].first;
        before = at_.u[i * width_ + l];
        after = at_.after[i * width_ + l];
        largest_before = std::max(largest_before, std::abs(before));
        largest_after = std::max(largest_after, std::abs(after));
        tolerance = std::max(tolerance, program_.absolute[i]);
      }
      double& least = trough_[k * width_ + l];
      const double size = std::abs(after);
      if (size < std::abs(before) && size < least && size > 0) {
        least = size;
        trough_time_[k * width_ + l] = end;
      }
      const double low = kLow * (all ? tolerance : program_.absolute[watched_[k].first]);
      if (least < low && size > kRisen * least && (all || grows_by_itself(k, l, evaluated))) risen_[l] = 1;
    }
  }
}

/// What becomes of each lane after a step: it goes on, tries again shorter, ends, or gives its machine up.
void LaneRunner::judge(const Take& take, const Refuse& refuse) {
  for (std::size_t l = 0; l < width_; ++l) {
    Lane& lane = lanes_[l];
    where_[l] = 0;
    if (!lane.busy) continue;
    Machine& machine = machines_[lane.machine];
    if (!(at_.growth[l] < kMostGrowth)) {
      refuse_lane(l, "the order of pivots does not suit", refuse);
    } else if (++machine.steps > program_.most_steps) {
      refuse_lane(l, "too many steps", refuse);
    } else if (at_.error[l] <= 1) {
      where_[l] = 1;
    }
  }
  watch_troughs();
  for (std::size_t l = 0; l < width_; ++l) {
    if (!lanes_[l].busy || risen_[l] == 0) continue;
    where_[l] = 0;
    refuse_lane(l, "a state grows from where the tolerance hides it", refuse);
  }
  keep_rows();
  kernels_.take(static_cast<std::uint32_t>(n_), where_.data(), at_.after.data(), at_.u.data());
  for (std::size_t l = 0; l < width_; ++l) {
    Lane& lane = lanes_[l];
    if (!lane.busy) continue;
    const Machine& machine = machines_[lane.machine];
    const bool taken = where_[l] != 0;
    double factor = method_->step_factor(at_.error[l]);
    if (taken) {
      if (at_.t[l] + at_.h[l] >= program_.until) {
        end(l, take);
        continue;
      }
      at_.t[l] += at_.h[l];
      if (lane.rejected) factor = std::min(factor, 1.0);
    }
    lane.rejected = !taken;
    double& h = at_.h[l];
    h = std::min(h * factor, machine.longest_step);
    const double left = program_.until - at_.t[l];
    if (h >= left) {
      h = left;
    } else if (2 * h > left) {
      h = left / 2;
    }
    if (!(h > kShortest * program_.until)) refuse_lane(l, "no step is short enough", refuse);
  }
}

void LaneRunner::end(std::size_t l, const Take& take) {
  done_.push_back(lanes_[l].machine);
  lanes_[l].busy = false;
  if (done_.size() < width_) return;
  evaluate(done_, take);
  free_.insert(free_.end(), done_.begin(), done_.end());
  done_.clear();
}

/// The outputs of machines that are done, row by row.
void LaneRunner::evaluate(std::span<const std::size_t> batch, const Take& take) {
  const std::size_t columns = 1 + program_.output_slots.size();
  const auto rows = static_cast<std::size_t>(program_.rows);
  table_.resize(batch.size() * rows * columns);
  for (std::size_t l = 0; l < width_; ++l)
    set_constants(program_.output, l, machines_[batch[std::min(l, batch.size() - 1)]], output_slots_);
  for (std::size_t r = 0; r < rows; ++r) {
    const double t = row_time(static_cast<int>(r));
    for (std::size_t l = 0; l < width_; ++l) {
      const double* const row = machines_[batch[std::min(l, batch.size() - 1)]].rows.data() + r * n_;
      output_slots_[l] = t;
      for (std::size_t i = 0; i < n_; ++i) output_slots_[(1 + i) * width_ + l] = row[i];
    }
    kernels_.run(program_.outputs.code(), output_slots_.data());
    for (std::size_t l = 0; l < batch.size(); ++l) {
      double* const row = table_.data() + (l * rows + r) * columns;
      row[0] = t;
      for (std::size_t k = 0; k + 1 < columns; ++k) {
        const auto& [scale, offset] = program_.scale_and_offset[k];
        row[1 + k] = scale * output_slots_[program_.output_slots[k] * width_ + l] + offset;
      }
    }
  }
  for (std::size_t l = 0; l < batch.size(); ++l) {
    const Machine& machine = machines_[batch[l]];
    take(machine.number, std::span(table_).subspan(l * rows * columns, rows * columns), machine.steps);
  }
}

void LaneRunner::work(const Next& next, const Values& values, const Take& take, const Refuse& refuse) {
  bool more = true;
  while (true) {
    bool any = false;
    for (std::size_t l = 0; l < width_; ++l) {
      while (!lanes_[l].busy && ready_.empty() && more) more = prepare(next, values, refuse);
      if (!lanes_[l].busy && !ready_.empty()) {
        put(l, ready_.back());
        ready_.pop_back();
      }
      any = any || lanes_[l].busy;
    }
    if (!any) break;
    for (std::size_t l = 0; l < width_;
         ++l) {  // idle lanes do what a busy one does: numbers that are no harm
      if (lanes_[l].busy) continue;
      const auto busy =
          std::find_if(lanes_.begin(), lanes_.end(), [](const Lane& lane) { return lane.busy; }) -
          lanes_.begin();
      at_.t[l] = at_.t[static_cast<std::size_t>(busy)];
      at_.h[l] = at_.h[static_cast<std::size_t>(busy)];
      for (std::size_t i = 0; i < n_; ++i)
        at_.u[i * width_ + l] = at_.u[i * width_ + static_cast<std::size_t>(busy)];
      for (const LaneConstant& constant : program_.integration.constants)
        at_.slots[constant.slot * width_ + l] =
            at_.slots[constant.slot * width_ + static_cast<std::size_t>(busy)];
    }
    method_->step(at_);
    judge(take, refuse);
  }
  if (!done_.empty()) evaluate(done_, take);
  free_.insert(free_.end(), done_.begin(), done_.end());
  done_.clear();
}

}  // namespace oblique::ensemble
