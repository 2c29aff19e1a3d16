// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_runner.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <oblique/solve/integrator/rosenbrock.h>

namespace oblique::ensemble {
namespace {

using solve::Rodas5p;

constexpr double kSafety = 0.9, kLeastFactor = 0.2, kMostFactor = 6;  ///< of the next step
constexpr double kShortest = 1e-14;                                   ///< step, of the run
constexpr double kMostGrowth = 1e6;  ///< of a multiplier: beyond, the fixed order of pivots does not suit
/// How far the argument of a sine or cosine of the time may go in a step [rad].
constexpr double kMostTurn = std::numbers::pi / 2;
constexpr int kMostNewton = 15;
constexpr double kAtRest = 1e-12;     ///< a step of Newton's method, of its variable and a machine unit
constexpr double kContracts = 0.5;    ///< such a step, of the one before it
constexpr double kSurelyNear = 1e-9;  ///< from here on rounding may end the contraction

/// 0.9 error^(−1/5) within bounds, as a polynomial in the exponent: the library's power costs as much as what
/// it is for. To 2e-5, which is more than is known of the next step.
double step_factor(double error) {
  if (!std::isfinite(error)) return kLeastFactor;
  if (error < 1e-5) return kMostFactor;
  if (error > 1e4) return kLeastFactor;
  int exponent = 0;
  const double x = 2 * std::frexp(error, &exponent) - 1.5;  // error = (x + 1.5) 2^(exponent − 1)
  const double root = 0.92211035 + x * (-0.12278577 + x * (0.04900795 + x * (-0.02653251 + x * 0.01457163)));
  static const double powers[] = {1, 0.8705505632961241, 0.757858283255199, 0.6597539553864471,
                                  0.5743491774985175};
  const int k = exponent - 1 + 100;
  return std::clamp(kSafety * root * powers[k % 5] * std::ldexp(1.0, 20 - k / 5), kLeastFactor, kMostFactor);
}

}  // namespace

LaneRunner::LaneRunner(const LaneProgram& program, std::span<const double> base, const LaneKernels& kernels)
    : program_(program),
      base_(base),
      kernels_(kernels),
      width_(static_cast<std::size_t>(kernels.width)),
      n_(program.n_variables),
      lanes_(width_),
      scratch_(program.prologue->scratch_size()),
      slots_(slots_of(program.integration)),
      output_slots_(slots_of(program.output)) {
  const auto variables = [&] { return LaneArray(n_ * width_); };
  const auto numbers = [&] { return LaneArray(width_); };
  u_ = variables();
  after_ = variables();
  stages_ = LaneArray(Rodas5p::kStages * n_ * width_);
  right_side_ = variables();
  work_ = variables();
  by_time_ = variables();
  entries_ = LaneArray(program.lu.n_entries() * width_);
  reciprocals_ = variables();
  c1_ = variables();
  c2_ = variables();
  c3_ = variables();
  between_ = variables();
  slope_ = variables();
  change_ = variables();
  growth_ = numbers();
  error_ = numbers();
  scale_ = numbers();
  inverse_ = numbers();
  time_scale_ = numbers();
  theta_ = numbers();
  where_ = numbers();
  for (std::size_t i = 0; i < Rodas5p::kStages; ++i) stage_.push_back(stages_.data() + i * n_ * width_);
  for (const std::uint32_t slot : program.rate_slots) rate_.push_back(slots_.data() + slot * width_);
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
  set_constants(program_.integration, lane, machine, slots_);
  for (std::size_t i = 0; i < n_; ++i) u_[i * width_ + lane] = machine.start[i];
  machine.rows.resize(static_cast<std::size_t>(program_.rows) * n_);
  std::copy(machine.start.begin(), machine.start.end(), machine.rows.begin());
  lanes_[lane] = {m, true, 0, machine.first_step, false, 1};
}

/// All lanes try their next step.
void LaneRunner::step() {
  double* const variables = slots_.data() + width_;
  const auto n = static_cast<std::uint32_t>(n_), n_states = static_cast<std::uint32_t>(program_.n_states);
  const StraightLuCode lu = program_.lu.code();
  const auto set_times = [&](double part) {
    for (std::size_t l = 0; l < width_; ++l) slots_[l] = lanes_[l].t + part * lanes_[l].h;
  };
  for (std::size_t l = 0; l < width_; ++l) {
    inverse_[l] = 1 / lanes_[l].h;
    scale_[l] = 1 / (lanes_[l].h * Rodas5p::kGamma);
  }
  for (std::uint32_t i = 0; i < Rodas5p::kStages; ++i) {
    set_times(Rodas5p::c[i]);
    kernels_.combine(n, i, Rodas5p::a[i], stage_.data(), u_.data(), variables);
    kernels_.run(program_.rates.code(), slots_.data());
    if (i == 0) {
      kernels_.run(program_.derivatives.code(), slots_.data());
      kernels_.matrix(program_.matrix(), slots_.data(), scale_.data(), entries_.data());
      kernels_.factor(lu, entries_.data(), reciprocals_.data(), growth_.data());
      for (const LaneConstant& entry : program_.by_time)
        std::copy_n(slots_.data() + entry.slot * width_, width_, by_time_.data() + entry.drawn * width_);
    }
    const bool by_time = !program_.by_time.empty() && Rodas5p::d[i] != 0;
    if (by_time) {
      for (std::size_t l = 0; l < width_; ++l) time_scale_[l] = lanes_[l].h * Rodas5p::d[i];
    }
    kernels_.right_side(n, n_states, i, Rodas5p::C[i], stage_.data(), inverse_.data(),
                        by_time ? by_time_.data() : nullptr, time_scale_.data(), rate_.data(),
                        right_side_.data());
    kernels_.solve(lu, entries_.data(), reciprocals_.data(), right_side_.data(), work_.data(),
                   stages_.data() + i * n_ * width_);
  }
  constexpr double one = 1;
  kernels_.combine(n, 1, &one, stage_.data() + Rodas5p::kStages - 1, variables, after_.data());
  kernels_.norm(n, stage_.back(), u_.data(), after_.data(), program_.absolute.data(), program_.relative,
                error_.data());
}

/// The polynomial is of order 4 where nothing is stiff. What follows others fast it misses by a hundred times
/// more: there F at the polynomial tells by how much, and W, which is still that of the step, takes it away.
void LaneRunner::correct_between() {
  double* const variables = slots_.data() + width_;
  std::copy_n(between_.data(), n_ * width_, variables);
  for (std::size_t l = 0; l < width_; ++l) slots_[l] = lanes_[l].t + theta_[l] * lanes_[l].h;
  kernels_.run(program_.rates.code(), slots_.data());
  constexpr double minus = -1;
  const double* const slope = slope_.data();
  kernels_.right_side(static_cast<std::uint32_t>(n_), static_cast<std::uint32_t>(program_.n_states), 1,
                      &minus, &slope, inverse_.data(), nullptr, nullptr, rate_.data(), right_side_.data());
  kernels_.solve(program_.lu.code(), entries_.data(), reciprocals_.data(), right_side_.data(), work_.data(),
                 change_.data());
  constexpr double one = 1;
  const double* const change = change_.data();
  kernels_.combine(static_cast<std::uint32_t>(n_), 1, &one, &change, between_.data(), between_.data());
}

/// Takes the rows that lie in the steps just taken, which stand in `where_`.
void LaneRunner::keep_rows() {
  const auto n = static_cast<std::uint32_t>(n_);
  bool first = true;
  while (true) {
    bool any = false;
    for (std::size_t l = 0; l < width_; ++l) {
      theta_[l] = -1;
      const Lane& lane = lanes_[l];
      if (where_[l] == 0 || lane.row >= program_.rows) continue;
      const double t = row_time(lane.row);
      const bool last = lane.t + lane.h >= program_.until;
      if (t > lane.t + lane.h && !last) continue;
      theta_[l] = std::min((t - lane.t) / lane.h, 1.0);
      any = true;
    }
    if (!any) return;
    if (first) {
      for (int k = 0; k < 3; ++k) {
        LaneArray& out = k == 0 ? c1_ : k == 1 ? c2_ : c3_;
        kernels_.combine(n, Rodas5p::kStages, Rodas5p::between[k], stage_.data(), nullptr, out.data());
      }
      first = false;
    }
    kernels_.between(n, theta_.data(), u_.data(), after_.data(), c1_.data(), c2_.data(), c3_.data(),
                     between_.data(), slope_.data());
    correct_between();
    for (std::size_t l = 0; l < width_; ++l) {
      if (theta_[l] < 0) continue;
      double* const row =
          machines_[lanes_[l].machine].rows.data() + static_cast<std::size_t>(lanes_[l].row) * n_;
      for (std::size_t i = 0; i < n_; ++i) row[i] = between_[i * width_ + l];
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

/// What becomes of each lane after a step: it goes on, tries again shorter, ends, or gives its machine up.
void LaneRunner::judge(const Take& take, const Refuse& refuse) {
  for (std::size_t l = 0; l < width_; ++l) {
    Lane& lane = lanes_[l];
    where_[l] = 0;
    if (!lane.busy) continue;
    Machine& machine = machines_[lane.machine];
    if (!(growth_[l] < kMostGrowth)) {
      refuse_lane(l, "the order of pivots does not suit", refuse);
    } else if (++machine.steps > program_.most_steps) {
      refuse_lane(l, "too many steps", refuse);
    } else if (error_[l] <= 1) {
      where_[l] = 1;
    }
  }
  keep_rows();
  kernels_.take(static_cast<std::uint32_t>(n_), where_.data(), after_.data(), u_.data());
  for (std::size_t l = 0; l < width_; ++l) {
    Lane& lane = lanes_[l];
    if (!lane.busy) continue;
    const Machine& machine = machines_[lane.machine];
    const bool taken = where_[l] != 0;
    double factor = step_factor(error_[l]);
    if (taken) {
      if (lane.t + lane.h >= program_.until) {
        end(l, take);
        continue;
      }
      lane.t += lane.h;
      if (lane.rejected) factor = std::min(factor, 1.0);
    }
    lane.rejected = !taken;
    lane.h = std::min(lane.h * factor, machine.longest_step);
    const double left = program_.until - lane.t;
    if (lane.h >= left) {
      lane.h = left;
    } else if (2 * lane.h > left) {
      lane.h = left / 2;
    }
    if (!(lane.h > kShortest * program_.until)) refuse_lane(l, "no step is short enough", refuse);
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
    for (std::size_t l = 0; l < width_; ++l) {  // idle lanes do what a busy one does
      if (lanes_[l].busy) continue;
      const auto busy =
          std::find_if(lanes_.begin(), lanes_.end(), [](const Lane& lane) { return lane.busy; });
      lanes_[l].t = busy->t;
      lanes_[l].h = busy->h;
    }
    step();
    judge(take, refuse);
  }
  if (!done_.empty()) evaluate(done_, take);
  free_.insert(free_.end(), done_.begin(), done_.end());
  done_.clear();
}

}  // namespace oblique::ensemble
