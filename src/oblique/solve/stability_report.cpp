// SPDX-License-Identifier: MIT
#include <oblique/solve/stability_report.h>

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace oblique {
namespace {

constexpr std::size_t kMostStates = 200;
constexpr std::size_t kMostStatesForMargins = 60;
constexpr double kRounding = 1e-9;  ///< of a damping ratio

class Judge {
 public:
  Judge(const Program& program, const SignalFlow& flow)
      : program_(program), flow_(flow), workspace_(program), signals_(program.n_signals()) {
    for (std::vector<std::size_t>& group : coupled_groups(program)) {
      const std::string whom =
          fmt::format("a group of {} states about '{}'", group.size(), program.states()[group.front()].name);
      if (group.size() > kMostStates) {
        report_.left_out.push_back(fmt::format(
            "the modes and phase margins of {}: eigenvalues are sought up to {}", whom, kMostStates));
        continue;
      }
      const bool servos = std::any_of(group.begin(), group.end(), [&](std::size_t i) { return is_servo(i); });
      if (servos && group.size() > kMostStatesForMargins) {
        report_.left_out.push_back(
            fmt::format("the phase margins of {}: they are sought up to {}", whom, kMostStatesForMargins));
      }
      groups_.push_back(std::move(group));
    }
    for (const std::vector<std::size_t>& group : groups_) {
      if (group.size() > kMostStatesForMargins) continue;
      for (const std::size_t i : group) {
        if (is_servo(i)) report_.margins.push_back({i, {}, 0});
      }
    }
    std::sort(report_.margins.begin(), report_.margins.end(),
              [](const ServoMargin& a, const ServoMargin& b) { return a.state < b.state; });
    margin_of_.resize(program.n_states());
    for (std::size_t k = 0; k < report_.margins.size(); ++k) margin_of_[report_.margins[k].state] = k;
  }

  void look_at(const Instant& instant) {
    const auto linear = Linearisation::at(program_, workspace_, instant);
    if (!linear || !program_.signals(instant.t, instant.states.data(), signals_.data(), workspace_)) {
      ++without_value_;
      return;
    }
    ++report_.instants;
    for (const std::vector<std::size_t>& group : groups_) {
      const Eigen::MatrixXd block = linear->block(group);
      for (const Mode& mode : modes_of(block, group)) take(mode, instant.t);
      if (group.size() <= kMostStatesForMargins) find_margins(block, group, instant.t);
    }
  }

  StabilityReport finish() {
    if (without_value_ > 0) {
      report_.left_out.push_back(
          fmt::format("{} of {} instants, at which the equations have no linearisation", without_value_,
                      report_.instants + without_value_));
    }
    return std::move(report_);
  }

 private:
  bool is_servo(std::size_t state) const { return program_.states()[state].at_rest; }

  void take(const Mode& mode, double t) {
    double servo_share = 0;
    for (const Participation& p : mode.participants) servo_share += is_servo(p.state) ? p.share : 0;
    const bool servo = servo_share >= 0.5;
    std::optional<WorstMode>& worst = servo ? report_.servo_mode : report_.problem_mode;
    if (!worst || is_worse(mode, worst->mode)) worst = {mode, t};
    if (servo && (!report_.slowest_servo || mode.pole.real() > report_.slowest_servo->mode.pole.real()))
      report_.slowest_servo = {mode, t};
    if (servo && verdict_on(mode) == ModeVerdict::grows && !report_.grows_from) report_.grows_from = t;
  }

  /// By the damping ratio; among those alike (real poles have ±1) the one further to the right.
  static bool is_worse(const Mode& mode, const Mode& than) {
    const double difference = mode.damping_ratio() - than.damping_ratio();
    if (std::abs(difference) > kRounding) return difference < 0;
    return mode.pole.real() > than.pole.real();
  }

  void find_margins(const Eigen::MatrixXd& block, const std::vector<std::size_t>& group, double t) {
    if (std::none_of(group.begin(), group.end(), [&](std::size_t i) { return is_servo(i); })) return;
    const OpenLoops loops(block);
    for (std::size_t place = 0; place < group.size(); ++place) {
      if (!is_servo(group[place])) continue;
      const auto own = flow_.own_slope(program_.states()[group[place]].name, t, signals_);
      if (!own) continue;
      const auto margin = loops.phase_margin(static_cast<Eigen::Index>(place), *own);
      ServoMargin& worst = report_.margins[margin_of_[group[place]]];
      if (margin && (!worst.margin || margin->degrees < worst.margin->degrees)) {
        worst.margin = margin;
        worst.time = t;
      }
    }
  }

  StabilityReport report_;
  const Program& program_;
  const SignalFlow& flow_;
  Workspace workspace_;
  std::vector<double> signals_;
  std::vector<std::vector<std::size_t>> groups_;
  std::vector<std::size_t> margin_of_;  ///< place in the report of a servo state
  std::size_t without_value_ = 0;
};

}  // namespace

ModeVerdict verdict_on(const Mode& mode) {
  const double damping = mode.damping_ratio();
  if (damping < -kRounding) return ModeVerdict::grows;
  if (damping <= kRounding) return ModeVerdict::undamped;
  return damping < kBadDamping ? ModeVerdict::badly_damped : ModeVerdict::well_damped;
}

StabilityReport judge_stability(const Program& program, const SignalFlow& flow,
                                const std::vector<Instant>& instants) {
  Judge judge(program, flow);
  for (const Instant& instant : instants) judge.look_at(instant);
  return judge.finish();
}

}  // namespace oblique
