// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/run.h>

namespace oblique::solve {

/// States that go on from a moment as they moved there.
class StraightLine final : public Interpolant {
 public:
  StraightLine(double t, std::vector<double> states, std::vector<double> rates)
      : t_(t), states_(std::move(states)), rates_(std::move(rates)) {}
  void states_at(double t, std::span<double> x) const override {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = states_[i] + (t - t_) * rates_[i];
  }
  void rates_at(double, std::span<double> dxdt) const override {
    std::copy(rates_.begin(), rates_.end(), dxdt.begin());
  }

 private:
  double t_;
  std::vector<double> states_, rates_;
};

/// A warning for each loop whose amplifiers, at equal speeds, do not rest at the solution that they have been
/// given at (t, states), be it one of several or the only one. Throws SolveError.
std::vector<text::Diagnostic> unstable_branches(const network::Program& program,
                                                network::Workspace& workspace, double t,
                                                const std::vector<double>& states, const std::string& file);

/// Watches during a run for ends of the branches of solutions on which algebraic loops are.
class BranchWatch {
 public:
  /// All must outlive this.
  BranchWatch(const network::Program& program, network::Workspace& workspace, double begin,
              const RunOptions& options, const std::string& file);

  /// The first time behind `from`, up to the last of these, without a solution on its branch, to 1e-10 of the
  /// run, of loops that no derivative needs (of others the solver finds no step across it); nothing where
  /// there is none. Each of the `times`, which ascend, is looked at: they are to show what the time alone
  /// does.
  std::optional<double> find(double from, std::span<const double> times, const Interpolant& solution);

  /// The last time that is sure to lie before an end that was found.
  double before(double end) const { return end - resolution_; }

  enum class Ahead {
    nothing,
    end,     ///< in sight
    not_yet  ///< lost farther on: the solver may come nearer, starting anew from here
  };
  /// What lies ahead where the solver has found no step from (t, states), which go on beyond an end in sight
  /// along a straight line.
  Ahead look_ahead(double& t, double segment_end, std::vector<double>& states, const Interpolant& solution);

  /// Lets the amplifiers of all loops go, infinitely fast, to where they rest at (t, states), after the
  /// branch of a loop has ended there, which was the last that was not solved; first `go` of that one: to
  /// limits and the like, or where elements without memory lead it. A loop that has no rest in reach but a
  /// solution that goes on smoothly keeps to that. Throws SolveError for any other. The workspace must not
  /// follow branches.
  void pass(double t, const std::vector<double>& states, const std::function<bool(std::size_t)>& go);

  /// Tells, once of each, of loops that an event at t has left where their amplifiers do not rest; those that
  /// are `told` of already are noted alone; but of none that a slide `mixes`.
  void look(double t, const std::vector<double>& states, bool told,
            const std::function<bool(std::size_t)>& mixes);

  /// To another branch, where the amplifiers rest.
  const std::vector<EventRecord>& jumps() const { return jumps_; }
  /// All events by time.
  std::vector<EventRecord> merged_with(std::vector<EventRecord> events) const;
  /// Of loops that go on where their amplifiers run away.
  const std::vector<text::Diagnostic>& warnings() const { return warnings_; }

 private:
  std::optional<double> search(double from, std::span<const double> times, double longest,
                               const Interpolant& solution);
  void stand_at(double t);
  bool leaps();

  const network::Program& program_;
  network::Workspace& workspace_;
  const std::string& file_;
  double span_, apart_, resolution_;     ///< [s]
  bool any_ = false;                     ///< any loop has branches
  bool unseen_ = false;                  ///< one that no derivative needs
  std::vector<double> stood_;            ///< the unknowns where `search` stands
  std::optional<double> reached_;        ///< [s] and when
  std::vector<bool> told_;               ///< of each loop: there is nothing to tell, or it has been told
  std::vector<Eigen::MatrixXd> judged_;  ///< of each loop: where `look` found its amplifiers at rest
  std::optional<double> tried_;          ///< [s] where the solver was let to start anew
  std::vector<EventRecord> jumps_;
  std::vector<text::Diagnostic> warnings_;
};

}  // namespace oblique::solve
