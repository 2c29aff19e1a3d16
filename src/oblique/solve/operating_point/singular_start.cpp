// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/singular_start.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace oblique::solve {
namespace {

/// The unknowns z of the loops that are singular at the start, all one after the other, and the equation
/// z = Z(t + h, x + h f(z)) of a moment later.
class Start {
 public:
  Start(const network::Program& program, network::Workspace& workspace, double t,
        const std::vector<double>& states)
      : program_(program),
        workspace_(workspace),
        t_(t),
        states_(states),
        moved_(states.size()),
        derivatives_(states.size()),
        signals_(program.n_signals()) {}

  /// Finds the singular loops; false where there are none, or something else is wrong.
  bool find_loops() {
    while (!program_.signals(t_, states_.data(), signals_.data(), workspace_)) {
      const std::size_t loop = workspace_.trouble().loop;
      if (workspace_.trouble().failure != network::LoopFailure::singular || is_found(loop)) return false;
      loops_.push_back(loop);
      hold(guess(), true);
    }
    return !loops_.empty();
  }

  Eigen::VectorXd guess() const {
    std::vector<double> z;
    for (const std::size_t loop : loops_) {
      for (const std::size_t u : program_.loops()[loop].unknowns) z.push_back(program_.unknowns()[u].guess);
    }
    return Eigen::Map<const Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size()));
  }

  /// Newton's method by differences, from z, for a moment that is h later; false where it finds nothing.
  bool solve(double h, Eigen::VectorXd& z) {
    constexpr int kMostIterations = 12;
    constexpr double kSmall = 1e-9;  // of 1 + |z|
    constexpr double kProbe = 1e-4;  // the equation is nearly linear in z where h is small
    Eigen::VectorXd residual(z.size()), shifted(z.size());
    Eigen::MatrixXd jacobian(z.size(), z.size());
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
      if (!residual_at(h, z, residual)) return false;
      for (Eigen::Index k = 0; k < z.size(); ++k) {
        Eigen::VectorXd probe = z;
        probe[k] += kProbe * (1 + std::abs(z[k]));
        if (!residual_at(h, probe, shifted)) return false;
        jacobian.col(k) = (shifted - residual) / (probe[k] - z[k]);
      }
      const Eigen::VectorXd step = jacobian.fullPivLu().solve(-residual);
      if (!step.allFinite()) return false;
      z += step;
      if ((step.array().abs() < kSmall * (1 + z.array().abs())).all()) return true;
    }
    return false;
  }

  bool has_branches() const {
    return !loops_.empty() && std::all_of(loops_.begin(), loops_.end(),
                                          [&](std::size_t loop) { return program_.loop_has_branches(loop); });
  }

  void let_go() {
    const std::vector<double> nothing;
    for (const std::size_t loop : loops_)
      workspace_.hold_loop(loop, std::numeric_limits<double>::quiet_NaN(), nothing, false);
    workspace_.reset();
  }

  /// Holds z, from now on only as far as it solves the loops; true where it does.
  bool keep(const Eigen::VectorXd& z) {
    workspace_.reset();
    hold(z, false);
    return program_.signals(t_, states_.data(), signals_.data(), workspace_).has_value();
  }

 private:
  bool is_found(std::size_t loop) const {
    return std::find(loops_.begin(), loops_.end(), loop) != loops_.end();
  }

  void hold(const Eigen::VectorXd& z, bool whatever) {
    Eigen::Index first = 0;
    for (const std::size_t loop : loops_) {
      const auto size = static_cast<Eigen::Index>(program_.loops()[loop].unknowns.size());
      const Eigen::VectorXd part = z.segment(first, size);
      workspace_.hold_loop(loop, t_, {part.begin(), part.end()}, whatever);
      first += size;
    }
  }

  bool residual_at(double h, const Eigen::VectorXd& z, Eigen::VectorXd& residual) {
    hold(z, true);
    if (!program_.derivatives(t_, states_.data(), derivatives_.data(), workspace_)) return false;
    for (std::size_t i = 0; i < moved_.size(); ++i) moved_[i] = states_[i] + h * derivatives_[i];
    if (!program_.signals(t_ + h, moved_.data(), signals_.data(), workspace_)) return false;
    Eigen::Index k = 0;
    for (const std::size_t loop : loops_) {
      for (const std::size_t u : program_.loops()[loop].unknowns) {
        residual[k] = workspace_.unknown(u) - z[k];
        ++k;
      }
    }
    return residual.allFinite();
  }

  const network::Program& program_;
  network::Workspace& workspace_;
  double t_;
  const std::vector<double>& states_;
  std::vector<double> moved_, derivatives_, signals_;
  std::vector<std::size_t> loops_;
};

}  // namespace

bool hold_singular_start(const network::Program& program, network::Workspace& workspace, double t,
                         const std::vector<double>& states, double span) {
  constexpr double kLongest = 1e-4, kShortest = 1e-9;  // of the run
  constexpr double kAgrees = 1e-6;                     // of 1 + |z|, between two moments
  constexpr double kRounding = 1e-13;                  // by so little a limit is not made better
  workspace.reset();
  Start start(program, workspace, t, states);
  bool found = false;
  if (start.find_loops()) {
    for (double h = kLongest * span; h > kShortest * span && !found; h /= 10) {
      Eigen::VectorXd later = start.guess(), sooner = later;
      if (!start.solve(h, later) || !start.solve(h / 2, sooner)) continue;
      Eigen::VectorXd limit = 2 * sooner - later;  // the moment's error is of first order
      if (!((limit - sooner).array().abs() < kAgrees * (1 + limit.array().abs())).all()) continue;
      Eigen::VectorXd soonest = sooner;
      if (start.solve(h / 4, soonest)) {  // and of second, unless that one is another solution
        const Eigen::VectorXd nearer = (8 * soonest - 6 * sooner + later) / 3;
        const Eigen::ArrayXd change = (nearer - limit).array().abs(), before = (sooner - later).array().abs();
        if ((change <= before).all() && change.maxCoeff() > kRounding) limit = nearer;
      }
      found = start.keep(limit);
    }
  }
  // A root of even order that the loop starts from (y² = x at x = 0) is left with an infinite derivative.
  found = found || (start.has_branches() && start.keep(start.guess()));
  if (!found) start.let_go();
  return found;
}

}  // namespace oblique::solve
