// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/loop_report.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/network/program/program.h>
#include <oblique/solve/stability/loop_gain.h>
#include <oblique/solve/stability/servo_loops.h>

namespace oblique::solve {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
/// Derivatives that differ by less are the same: far above rounding, far below what a term of second order
/// does.
constexpr double kSameDerivative = 1e-9;
/// A derivative that a move leaves the same by accident is not so at three instants.
constexpr int kMostTrials = 3;

/// The loop gain of one unknown along a run.
struct GainHistory {
  std::string signal;
  bool amplified = true;
  std::vector<double> times, gains;
};

LoopUnknown summary_of(const GainHistory& history) {
  LoopUnknown unknown;
  unknown.signal = history.signal;
  constexpr double kSame = 1e-6;  // of two instants of the same gain the first is named
  double least = kUnbounded, greatest = -1;
  const auto sign_of = [](double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; };
  for (std::size_t k = 0; k < history.gains.size(); ++k) {
    const double gain = history.gains[k];
    if (k == 0) unknown.sign = sign_of(gain);
    if (std::abs(gain) < (1 - kSame) * least || k == 0) {
      least = std::abs(gain);
      unknown.least_gain = gain;
      unknown.least_time = history.times[k];
    }
    if (std::abs(gain) > greatest) {
      greatest = std::abs(gain);
      unknown.greatest_gain = gain;
    }
    if (k == 0) continue;
    const double before = history.gains[k - 1];
    if (sign_of(before) * sign_of(gain) >= 0) continue;
    const double part = std::isfinite(before) && std::isfinite(gain) ? before / (before - gain) : 0.5;
    unknown.sign_changes.push_back(history.times[k - 1] + part * (history.times[k] - history.times[k - 1]));
  }
  if (history.amplified && !history.gains.empty()) unknown.static_error = 1 / least;
  return unknown;
}

/// Whether a gain keeps its value along the run.
bool is_steady(const GainHistory& history) {
  return std::all_of(history.gains.begin(), history.gains.end(), [&](double gain) {
    const double first = history.gains.front();
    return gain == first || std::abs(gain - first) <= kSameDerivative * std::abs(first);
  });
}

bool same_derivatives(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kSameDerivative * a.cwiseAbs().maxCoeff();
}

class ServoLoopHistory {
 public:
  ServoLoopHistory(const network::Program& program, const SignalFlow& flow, ServoLoop loop)
      : program_(program), flow_(flow), loop_(std::move(loop)) {
    for (const std::size_t i : loop_.servos) histories_.push_back({program.states()[i].name, true, {}, {}});
  }

  void look_at(const Linearisation& linear, const Instant& instant, std::span<const double> signals,
               const network::Workspace& workspace) {
    const Eigen::MatrixXd block = linear.block(loop_.states);
    const OpenLoops loops(block);
    for (std::size_t k = 0; k < histories_.size(); ++k) {
      const auto own = flow_.own_derivative(histories_[k].signal, instant.t, signals);
      if (!own) continue;
      const auto place = std::lower_bound(loop_.states.begin(), loop_.states.end(), loop_.servos[k]);
      const double gain = loops.gain(place - loop_.states.begin(), *own, 0).real();
      constexpr double kBehindAnIntegrator = 1e14;  // a pole of L at 0, to rounding
      histories_[k].times.push_back(instant.t);
      histories_[k].gains.push_back(std::abs(gain) > kBehindAnIntegrator ? std::copysign(kUnbounded, gain)
                                                                         : gain);
    }
    for (const Mode& mode : modes_of(block, loop_.states)) {
      slowest_ = std::max(slowest_, mode.pole.real());
    }
    if (linear_ && trials_ < kMostTrials) {
      ++trials_;
      linear_ = !depends_on_itself(block, instant, workspace);
    }
  }

  LoopReport report() const {
    LoopReport loop;
    loop.members = flow_.members_of_loop(loop_.states);
    const bool steady = std::all_of(histories_.begin(), histories_.end(), is_steady);
    loop.kind = !linear_ ? LoopKind::non_linear : steady ? LoopKind::linear : LoopKind::varying;
    for (const GainHistory& history : histories_) loop.unknowns.push_back(summary_of(history));
    if (slowest_ < 0 && std::isfinite(slowest_)) loop.time_constant = -1 / slowest_;
    return loop;
  }

 private:
  /// Whether the derivatives change with the loop's own signals, which are moved by odd parts of a machine
  /// unit.
  bool depends_on_itself(const Eigen::MatrixXd& block, const Instant& instant,
                         const network::Workspace& workspace) const {
    network::Workspace scratch = workspace;  // with the solutions of the algebraic loops here
    Instant moved = instant;
    double by = 0.0371;
    for (const std::size_t i : loop_.states) {
      moved.states[i] += by * (1 + std::abs(moved.states[i]));
      by = by > 0 ? -by * 0.83 : -by * 1.13;
    }
    const auto linear = Linearisation::at(program_, scratch, moved);
    return !linear || !same_derivatives(block, linear->block(loop_.states));
  }

  const network::Program& program_;
  const SignalFlow& flow_;
  ServoLoop loop_;
  std::vector<GainHistory> histories_;
  double slowest_ = -kUnbounded;
  bool linear_ = true;
  int trials_ = 0;  ///< of its linearity
};

class AlgebraicLoop {
 public:
  AlgebraicLoop(const network::Program& program, const SignalFlow& flow, std::size_t loop)
      : program_(program), flow_(flow), loop_(loop) {
    for (const std::size_t u : program.loops()[loop].unknowns) {
      const network::Unknown& unknown = program.unknowns()[u];
      histories_.push_back({unknown.name, !unknown.torn, {}, {}});
    }
  }

  /// `here` is the evaluation of the signals at the instant.
  void look_at(const Instant& instant, std::span<const double> signals,
               const network::SignalEvaluation& here) {
    const Eigen::MatrixXd jacobian = here.loop_jacobian(loop_);
    if (!jacobian.allFinite()) return;
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(jacobian);
    const Eigen::MatrixXd inverse = lu.inverse();
    for (std::size_t k = 0; k < histories_.size(); ++k) {
      const auto own = flow_.own_derivative(histories_[k].signal, instant.t, signals);
      if (!own) continue;
      // With the other unknowns solved for, dg_k/dz_k is 1/(G⁻¹)_kk = own (1 + L).
      const auto place = static_cast<Eigen::Index>(k);
      const double total = histories_.size() == 1 ? jacobian(0, 0) : 1 / inverse(place, place);
      const double gain = *own == 0 ? std::copysign(kUnbounded, total) : (total - *own) / *own;
      if (std::isnan(gain)) continue;
      histories_[k].times.push_back(instant.t);
      histories_[k].gains.push_back(gain);
    }
    if (first_.size() == 0) first_ = jacobian;
    steady_ = steady_ && same_derivatives(first_, jacobian);
  }

  LoopReport report() const {
    LoopReport loop;
    loop.algebraic = true;
    loop.members = program_.loops()[loop_].members;
    loop.kind = !program_.loop_is_linear(loop_) ? LoopKind::non_linear
                : steady_                       ? LoopKind::linear
                                                : LoopKind::varying;
    for (const GainHistory& history : histories_) loop.unknowns.push_back(summary_of(history));
    return loop;
  }

 private:
  const network::Program& program_;
  const SignalFlow& flow_;
  std::size_t loop_;
  std::vector<GainHistory> histories_;
  Eigen::MatrixXd first_;
  bool steady_ = true;
};

}  // namespace

std::vector<LoopReport> explain_loops(const network::Program& program, const SignalFlow& flow,
                                      const std::vector<Instant>& instants) {
  std::vector<ServoLoopHistory> servos;
  for (ServoLoop& loop : servo_loops(program, flow, instants)) {
    // Beyond, a loop has no margins either; the stability report says so.
    if (loop.states == loop.servos || loop.states.size() <= kMostStatesForModes)
      servos.emplace_back(program, flow, std::move(loop));
  }
  std::vector<AlgebraicLoop> algebraic;
  for (std::size_t l = 0; l < program.loops().size(); ++l) algebraic.emplace_back(program, flow, l);
  network::Workspace workspace(program);
  std::vector<double> signals(program.n_signals());
  for (const Instant& instant : instants) {
    workspace.load_discrete_states(instant.discrete_states);
    const auto here = program.signals(instant.t, instant.states.data(), signals.data(), workspace);
    if (!here) continue;
    for (AlgebraicLoop& loop : algebraic) loop.look_at(instant, signals, *here);
    const auto linear = Linearisation::at(program, workspace, instant);
    if (!linear) continue;
    for (ServoLoopHistory& loop : servos) loop.look_at(*linear, instant, signals, workspace);
  }
  std::vector<LoopReport> reports;
  reports.reserve(servos.size() + algebraic.size());
  for (const ServoLoopHistory& loop : servos) reports.push_back(loop.report());
  for (const AlgebraicLoop& loop : algebraic) reports.push_back(loop.report());
  return reports;
}

}  // namespace oblique::solve
