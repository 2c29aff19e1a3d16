// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_runner.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace oblique::ensemble {
namespace {

constexpr double kShortest = 1e-14;  ///< step, of the run
/// How far the argument of a sine or cosine of the time may go in a step [rad].
constexpr double kMostTurn = std::numbers::pi / 2;
/// How far a value of a machine may be from the typical one, of that or of 1, so that its servo loops come to
/// the rest that is near the typical one's: what would decide between two rests is far. Farther away they are
/// let run to their rest.
constexpr double kNear = 0.05;

}  // namespace

LaneRunner::LaneRunner(const LaneProgram& program, std::span<const double> base, const LaneKernels& kernels)
    : program_(program),
      base_(base),
      kernels_(kernels),
      width_(static_cast<std::size_t>(kernels.width)),
      n_(program.n_variables),
      lanes_(width_),
      scratch_(program.prologue->scratch_size()),
      starts_(program, kernels, typical_draws()),
      troughs_(program, kernels),
      signals_(program, width_),
      output_slots_(slots_of(program.output, width_)),
      taken_(width_) {
  at_.slots = slots_of(program.integration, width_);
  for (LaneArray* const variables : {&at_.u, &at_.after, &at_.between}) *variables = LaneArray(n_ * width_);
  for (LaneArray* const numbers : {&at_.t, &at_.h, &at_.error, &at_.growth, &at_.theta})
    *numbers = LaneArray(width_);
  method_ = make_lane_method(program, kernels, at_);
}

std::vector<double> LaneRunner::typical_draws() {
  std::vector<double> draws(program_.prologue->slots().size());
  program_.prologue->run(base_, scratch_, draws);
  return draws;
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
  machine.is_near = !program_.needs_rest || is_near(machine.values);
  if (!machine.is_near && !starts_.goes_far()) {
    machine.refused = "its loops may come to another rest than those of the typical machine";
    return false;
  }
  machine.start = program_.guess;
  for (std::size_t i = 0; i < program_.n_states; ++i) {
    if (!machine.is_near || !program_.at_rest[i]) machine.start[i] = program_.starts[i].of(machine.draws);
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
  std::vector<LaneStarts::Start> starts;
  starts.reserve(batch.size());
  for (const std::size_t m : batch)
    starts.push_back({machines_[m].draws, machines_[m].start, machines_[m].is_near});
  starts_.find(starts);
  for (std::size_t k = 0; k < batch.size(); ++k) {
    Machine& machine = machines_[batch[k]];
    machine.first_step = std::min(starts[k].first_step, machine.longest_step);
    if (starts[k].found) {
      ready_.push_back(batch[k]);
    } else {
      refuse(machine.number, machine.values,
             machine.is_near ? "no rest near that of the typical machine"
                             : "its loops do not settle as those of the typical machine do");
      free_.push_back(batch[k]);
    }
  }
  return true;
}

void LaneRunner::put(std::size_t lane, std::size_t m) {
  Machine& machine = machines_[m];
  set_constants(program_.integration, lane, machine.draws, width_, at_.slots);
  for (std::size_t i = 0; i < n_; ++i) at_.u[i * width_ + lane] = machine.start[i];
  machine.rows.resize(static_cast<std::size_t>(program_.rows) * n_);
  std::copy(machine.start.begin(), machine.start.end(), machine.rows.begin());
  troughs_.begin(lane, machine.start);
  lanes_[lane] = {m, true, false, 1};
  at_.t[lane] = 0;
  at_.h[lane] = machine.first_step;
}

/// Takes the rows that lie in the steps just taken.
void LaneRunner::keep_rows() {
  while (true) {
    bool any = false;
    for (std::size_t l = 0; l < width_; ++l) {
      at_.theta[l] = -1;
      const Lane& lane = lanes_[l];
      if (taken_[l] == 0 || lane.row >= program_.rows) continue;
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

/// What becomes of each lane after a step: it goes on, tries again shorter, ends, or gives its machine up.
void LaneRunner::judge(const Take& take, const Refuse& refuse) {
  for (std::size_t l = 0; l < width_; ++l) {
    Lane& lane = lanes_[l];
    taken_[l] = 0;
    if (!lane.busy) continue;
    Machine& machine = machines_[lane.machine];
    if (!(at_.growth[l] < kMostGrowth)) {
      refuse_lane(l, "the order of pivots does not suit", refuse);
    } else if (++machine.steps > program_.most_steps) {
      refuse_lane(l, "too many steps", refuse);
    } else if (at_.error[l] <= 1) {
      taken_[l] = 1;
    }
  }
  troughs_.look(at_, taken_);
  for (std::size_t l = 0; l < width_; ++l) {
    if (!troughs_.has_risen(l)) continue;
    taken_[l] = 0;
    refuse_lane(l, "a state grows from where the tolerance hides it", refuse);
  }
  keep_rows();
  kernels_.take(static_cast<std::uint32_t>(n_), taken_.data(), at_.after.data(), at_.u.data());
  for (std::size_t l = 0; l < width_; ++l) {
    Lane& lane = lanes_[l];
    if (!lane.busy) continue;
    const Machine& machine = machines_[lane.machine];
    const bool taken = taken_[l] != 0;
    double factor = method_->step_factor(at_.error[l]);
    if (taken) {
      if (at_.t[l] + at_.h[l] >= program_.until) {
        end(l, take, refuse);
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

void LaneRunner::end(std::size_t l, const Take& take, const Refuse& refuse) {
  done_.push_back(lanes_[l].machine);
  lanes_[l].busy = false;
  if (done_.size() < width_) return;
  evaluate(done_, take, refuse);
  free_.insert(free_.end(), done_.begin(), done_.end());
  done_.clear();
}

/// The outputs of machines that are done, row by row; those in which there is something to warn of are left
/// to CVODES.
void LaneRunner::evaluate(std::span<const std::size_t> batch, const Take& take, const Refuse& refuse) {
  const std::size_t columns = 1 + program_.output_slots.size();
  const auto rows = static_cast<std::size_t>(program_.rows);
  table_.resize(batch.size() * rows * columns);
  for (std::size_t l = 0; l < width_; ++l)
    set_constants(program_.output, l, machines_[batch[std::min(l, batch.size() - 1)]].draws, width_,
                  output_slots_);
  signals_.begin();
  for (std::size_t r = 0; r < rows; ++r) {
    const double t = row_time(static_cast<int>(r));
    for (std::size_t l = 0; l < width_; ++l) {
      const double* const row = machines_[batch[std::min(l, batch.size() - 1)]].rows.data() + r * n_;
      output_slots_[l] = t;
      for (std::size_t i = 0; i < n_; ++i) output_slots_[(1 + i) * width_ + l] = row[i];
    }
    kernels_.run(program_.outputs.code(), output_slots_.data());
    signals_.look_at(t / program_.until, output_slots_);
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
    if (const std::string found = signals_.finding(l); !found.empty()) {
      refuse(machine.number, machine.values, found);
      continue;
    }
    take(machine.number, std::span(table_).subspan(l * rows * columns, rows * columns), machine.steps);
  }
}

/// Lanes without a machine do what one with a machine does: other numbers might be slow ones, sines of huge
/// arguments or what is denormal.
void LaneRunner::occupy_idle_lanes() {
  const auto is_busy = [](const Lane& lane) { return lane.busy; };
  const auto busy =
      static_cast<std::size_t>(std::find_if(lanes_.begin(), lanes_.end(), is_busy) - lanes_.begin());
  for (std::size_t l = 0; l < width_; ++l) {
    if (lanes_[l].busy) continue;
    at_.t[l] = at_.t[busy];
    at_.h[l] = at_.h[busy];
    for (std::size_t i = 0; i < n_; ++i) at_.u[i * width_ + l] = at_.u[i * width_ + busy];
    set_constants(program_.integration, l, machines_[lanes_[busy].machine].draws, width_, at_.slots);
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
    occupy_idle_lanes();
    method_->step(at_);
    judge(take, refuse);
  }
  if (!done_.empty()) evaluate(done_, take, refuse);
  free_.insert(free_.end(), done_.begin(), done_.end());
  done_.clear();
}

}  // namespace oblique::ensemble
