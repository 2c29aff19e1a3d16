// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/stability_report.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/ideal_machine.h>
#include <oblique/solve/stability/rightmost_modes.h>
#include <oblique/solve/stability/servo_loops.h>

namespace oblique::solve {
namespace {

constexpr std::size_t kMostReported = kMostStatesForModes;
constexpr std::size_t kMostStatesForMargins = 60;
constexpr double kRoundingOfDamping = 1e-9;  ///< of a damping ratio
constexpr double kRoundingOfGrowth =
    1e-9;  ///< over the whole run, in powers of e: far below what a run shows
/// Instants times n³ that are given to the QR algorithm, some seconds.
constexpr double kMostReportWork = 2e8;
constexpr std::size_t kInstantsOfLargeGroups = 3;

using Complex = std::complex<double>;

class Judge {
 public:
  Judge(const network::Program& program, const SignalFlow& flow, const std::vector<Instant>& instants,
        bool margins)
      : program_(program),
        flow_(flow),
        instants_(instants),
        workspace_(program),
        signals_(program.n_signals()),
        ideal_(std::make_unique<IdealMachine>(flow.diagram(), program)) {
    for (std::vector<std::size_t>& states : coupled_groups(program)) {
      Group& group = groups_.emplace_back();
      group.states = std::move(states);
      const std::size_t n = group.states.size();
      std::size_t most = kInstantsOfLargeGroups;
      if (n <= kMostReported)
        most =
            std::max(most, static_cast<std::size_t>(kMostReportWork / std::pow(static_cast<double>(n), 3)));
      group.stride = std::max<std::size_t>(1, (instants.size() + most - 2) / (most - 1));
    }
    if (margins) find_margins_to_seek();
  }

  StabilityReport judge(const std::optional<DisturbanceGrowth>& growth) {
    for (std::size_t k = 0; k < instants_.size(); ++k) look_at(k);
    report_.growth = growth;
    say_what_is_left_out();
    report_.switches = !program_.switches().empty();
    report_.verdict = verdict();
    return std::move(report_);
  }

 private:
  struct Group {
    std::vector<std::size_t> states;
    std::vector<std::size_t> servos;  ///< whose phase margins are sought
    std::size_t stride = 1;           ///< of the instants at which it is looked at
    Eigen::SparseMatrix<double>
        last;  ///< where it was last looked at: what has not changed is not judged anew
    bool seen = false, has_modes = false;
    bool machine = false;  ///< has states that an ideal machine has not
    bool varies = false, proven = false;
    bool neutral = true;      ///< a pole was zero whenever it was looked at
    bool grows_now = false;   ///< a mode of the problem, when it was last looked at
    std::size_t growing = 0;  ///< eigenvalues right of the axis then
  };

  void find_margins_to_seek() {
    std::vector<bool> wanted(program_.n_states(), false);
    for (const ServoLoop& loop : servo_loops(program_, flow_, instants_)) {
      for (const std::size_t i : loop.servos) wanted[i] = true;
    }
    for (Group& group : groups_) {
      if (group.states.size() > kMostStatesForMargins) continue;
      for (const std::size_t i : group.states) {
        if (wanted[i]) group.servos.push_back(i);
      }
      for (const std::size_t i : group.servos) report_.margins.push_back({i, {}, 0});
    }
    std::sort(report_.margins.begin(), report_.margins.end(),
              [](const ServoMargin& a, const ServoMargin& b) { return a.state < b.state; });
    margin_of_.resize(program_.n_states());
    for (std::size_t k = 0; k < report_.margins.size(); ++k) margin_of_[report_.margins[k].state] = k;
    for (const Group& group : groups_) {
      const bool too_large = group.states.size() > kMostStatesForMargins;
      if (too_large &&
          std::any_of(group.states.begin(), group.states.end(), [&](std::size_t i) { return wanted[i]; }))
        without_margins_.push_back(&group);
    }
  }

  void look_at(std::size_t k) {
    const Instant& instant = instants_[k];
    const auto linear = Linearisation::at(program_, workspace_, instant);
    if (!linear || !program_.signals(instant.t, instant.states.data(), signals_.data(), workspace_)) {
      ++without_value_;
      return;
    }
    ++report_.instants;
    bool grows = false;
    std::size_t growing = 0;
    bool ideal_seen = false;
    for (Group& group : groups_) {
      if (k % group.stride != 0 && k + 1 != instants_.size() && group.seen) {
        grows = grows || group.grows_now;
        continue;
      }
      Eigen::SparseMatrix<double> block = linear->sparse_block(group.states);
      const bool same = group.seen && block.nonZeros() == group.last.nonZeros() &&
                        Eigen::SparseMatrix<double>(block - group.last).norm() == 0;
      if (!same) {
        group.varies = group.varies || group.seen;
        group.last = block;
        if (!ideal_seen && ideal_->differs_in(group.states)) {
          ideal_seen = true;
          ideal_->look_at(instant, workspace_);
        }
        judge_group(group, instant.t);
      }
      group.seen = true;
      grows = grows || group.grows_now;
    }
    for (const Group& group : groups_) growing += group.growing;
    report_.growing = std::max(report_.growing, growing);
    if (grows) ++instants_of_growth_;
  }

  void judge_group(Group& group, double t) {
    group.machine = ideal_->differs_in(group.states);
    const bool large = group.states.size() > kMostReported;
    std::vector<Mode> modes = large ? rightmost_modes(group.last, group.states)
                                    : modes_of(Eigen::MatrixXd(group.last), group.states);
    const double run = instants_.back().t - instants_.front().t;
    for (Mode& mode : modes) {
      if (run > 0) mode.rounding = std::max(mode.rounding, kRoundingOfGrowth / run);
    }
    if (large) group.proven = (group.proven || !group.seen) && is_proven_stable(group.last);
    std::vector<std::optional<Complex>> ideal(modes.size());
    if (group.machine) ideal = ideal_->problem_modes(group.states, modes);
    bool servo_grows = false;
    std::size_t growing = 0, poles = 0;
    group.grows_now = false;
    for (std::size_t m = 0; m < modes.size(); ++m) {
      poles += modes[m].pole.imag() > 0 ? 2U : 1U;
      const bool servo = group.machine && !ideal[m];
      const WorstMode worst{modes[m], t, group.machine ? ideal[m] : std::nullopt};
      const bool grows = verdict_on(worst) == ModeVerdict::grows;
      if (grows) growing += modes[m].pole.imag() > 0 ? 2U : 1U;
      servo_grows = servo_grows || (servo && grows);
      group.grows_now = group.grows_now || (!servo && grows);
      take(worst, servo);
    }
    group.has_modes = group.has_modes || !modes.empty();
    group.growing = growing;
    group.neutral = group.neutral && !large && poles < group.states.size();
    if (!group.servos.empty()) find_margins(group, t, servo_grows);
  }

  void take(const WorstMode& found, bool servo) {
    const Mode& mode = found.mode;
    std::optional<WorstMode>& worst = servo ? report_.servo_mode : report_.problem_mode;
    if (!worst || is_worse(mode, worst->mode)) worst = found;
    if (servo && (!report_.slowest_servo || mode.pole.real() > report_.slowest_servo->mode.pole.real()))
      report_.slowest_servo = found;
    if (servo && verdict_on(found) == ModeVerdict::grows && !report_.grows_from)
      report_.grows_from = found.time;
    if (!report_.rightmost || mode.pole.real() > report_.rightmost->mode.pole.real()) {
      report_.rightmost = found;
      report_.rightmost_is_servo = servo;
    }
  }

  /// By the damping ratio; among those alike (real poles have ±1) the one further to the right.
  static bool is_worse(const Mode& mode, const Mode& than) {
    const double difference = mode.damping_ratio() - than.damping_ratio();
    if (std::abs(difference) > kRoundingOfDamping) return difference < 0;
    return mode.pole.real() > than.pole.real();
  }

  void find_margins(const Group& group, double t, bool unstable) {
    const OpenLoops loops{Eigen::MatrixXd(group.last)};
    for (const std::size_t i : group.servos) {
      const auto own = flow_.own_derivative(program_.states()[i].name, t, signals_);
      if (!own) continue;
      const auto place = std::lower_bound(group.states.begin(), group.states.end(), i);
      const auto margin = loops.phase_margin(place - group.states.begin(), *own, unstable);
      ServoMargin& worst = report_.margins[margin_of_[i]];
      if (margin && (!worst.margin || margin->degrees < worst.margin->degrees)) {
        worst.margin = margin;
        worst.time = t;
      }
    }
  }

  void say_what_is_left_out() {
    const auto name = [&](const Group& group) {
      return fmt::format("a group of {} states about '{}'", group.states.size(),
                         program_.states()[group.states.front()].name);
    };
    for (const Group& group : groups_) {
      report_.varies = report_.varies || group.varies;
      if (!group.seen) continue;
      if (group.states.size() > kMostReported) {
        report_.proven = report_.proven && group.proven;
        if (group.proven) continue;
        report_.left_out.push_back(fmt::format(
            "all but the rightmost modes of {}: beyond {} states they are sought, and one that is "
            "hidden among many alike may be missed",
            name(group), kMostReported));
      }
    }
    for (const Group& group : groups_) {
      if (group.stride <= 1 || !group.varies) continue;
      report_.left_out.push_back(
          fmt::format("instants: {} is looked at every {} of them only", name(group), group.stride));
    }
    for (const Group* const group : without_margins_) {
      report_.left_out.push_back(fmt::format("the phase margins of {}: they are sought up to {}",
                                             name(*group), kMostStatesForMargins));
    }
    if (without_value_ > 0) {
      report_.left_out.push_back(
          fmt::format("{} of {} instants, at which the equations have no linearisation", without_value_,
                      report_.instants + without_value_));
    }
  }

  /// Whether states of the group act on each other or on themselves beside where the run was at its end. One
  /// of its poles, at zero, is then not that of an integrator which nothing reaches: it belongs to a quantity
  /// that is conserved, or to a state that acts on itself though its slopes all vanish where it rests.
  bool has_feedback(const Group& group) {
    constexpr double kBeside = 0.01;  // [machine unit]
    Instant beside = instants_.back();
    for (const std::size_t i : group.states) beside.states[i] += kBeside;
    const auto linear = Linearisation::at(program_, workspace_, beside);
    return linear && linear->sparse_block(group.states).norm() > 0;
  }

  StabilityVerdict verdict() {
    using Verdict = StabilityVerdict;
    if (report_.instants == 0 && program_.n_states() > 0) return Verdict::not_told;
    if (report_.grows_from) return Verdict::servos_unstable;
    const auto& growth = report_.growth;
    if (growth && growth->grows()) return Verdict::grows;
    if (instants_of_growth_ > 0) {
      const bool always = instants_of_growth_ == report_.instants;
      return always && !(growth && growth->does_not_grow()) ? Verdict::grows : Verdict::grows_at_times;
    }
    if (growth && !growth->does_not_grow()) return Verdict::not_told;
    if (std::any_of(groups_.begin(), groups_.end(),
                    [&](const Group& group) { return group.seen && group.neutral && has_feedback(group); }))
      return Verdict::undamped;
    if (!report_.rightmost) {
      const bool large = std::any_of(groups_.begin(), groups_.end(), [](const Group& group) {
        return group.states.size() > kMostReported && !group.has_modes;
      });
      return large ? Verdict::not_told : Verdict::no_feedback;
    }
    for (const auto* const mode : {&report_.servo_mode, &report_.problem_mode}) {
      if (*mode && verdict_on(**mode) == ModeVerdict::undamped) return Verdict::undamped;
    }
    return report_.varies && !growth ? Verdict::stable_when_frozen : Verdict::stable;
  }

  StabilityReport report_;
  const network::Program& program_;
  const SignalFlow& flow_;
  const std::vector<Instant>& instants_;
  network::Workspace workspace_;
  std::vector<double> signals_;
  std::vector<Group> groups_;
  std::vector<const Group*> without_margins_;
  std::vector<std::size_t> margin_of_;  ///< place in the report of a servo state
  std::unique_ptr<IdealMachine> ideal_;
  std::size_t without_value_ = 0;
  std::size_t instants_of_growth_ = 0;  ///< of a mode of the problem
};

}  // namespace

ModeVerdict verdict_on(const Mode& mode) {
  const double rounding = std::max(kRoundingOfDamping * std::abs(mode.pole), mode.rounding);
  if (mode.pole.real() > rounding) return ModeVerdict::grows;
  if (mode.pole.real() >= -rounding) return ModeVerdict::undamped;
  return mode.damping_ratio() < kBadDamping ? ModeVerdict::badly_damped : ModeVerdict::well_damped;
}

ModeVerdict verdict_on(const WorstMode& worst) {
  const auto& ideal = worst.ideal_pole;
  constexpr double kMillionth = 1e-6;
  const bool undamped_by_design = ideal && std::abs(ideal->real()) <= kRoundingOfDamping * std::abs(*ideal) &&
                                  std::abs(worst.mode.damping_ratio()) <= kMillionth;
  return undamped_by_design ? ModeVerdict::undamped : verdict_on(worst.mode);
}

StabilityReport judge_stability(const network::Program& program, const SignalFlow& flow,
                                const std::vector<Instant>& instants,
                                const std::optional<DisturbanceGrowth>& growth, bool margins) {
  return Judge(program, flow, instants, margins).judge(growth);
}

}  // namespace oblique::solve
