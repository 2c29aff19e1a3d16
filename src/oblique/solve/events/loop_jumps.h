// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/readings/switch_placing.h>
#include <oblique/solve/readings/thresholds.h>

namespace oblique::solve {

/// Whether nothing but elements whose outputs follow their inputs is on a loop, and it may have several
/// solutions: of linear equations on which no switch acts there is one. Switches of loops of more than 32
/// unknowns do not count.
bool may_have_several(const network::Program& program, std::size_t loop);

/// Where the unknowns of a loop begin when other solutions of it are sought: point k = 1 … kLoopPoints of
/// those that fill ±kLoopReach [machine unit] evenly.
constexpr int kLoopPoints = 24;
constexpr double kLoopReach = 3;
std::vector<double> loop_point(const network::Program& program, std::size_t loop, int k);

/// Looks after the algebraic loops of elements without memory where an event has come. Between events such a
/// loop keeps to its solution. An event may take that away, or leave the loop at one from which its elements
/// would run away; and where there are several, Newton's method goes to any. The loop then goes where its
/// elements take it from where it was, if they follow their inputs with one short lag, while the switches and
/// tables in it turn over on the way. So do amplifiers on whose loop a switch or a table acts; of others see
/// BranchWatch, and only where a loop has no solution any more do they go so too. A loop on which something
/// acts that slides stays as it is. Not installed.
class LoopJumps {
 public:
  /// All must outlive this.
  LoopJumps(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
            const Thresholds& thresholds);

  /// Of each loop of the program: whether it is such a one whose elements would leave the solution at (t, x).
  std::vector<bool> run_away(double t, std::span<const double> x);
  /// Whether there is any such loop.
  bool any() const { return any_goes_; }
  /// Notes the guesses from which the loops begin.
  void begin();
  /// Notes the solutions at (t, x), before what happens next.
  void note(double t, std::span<const double> x);
  /// A switch that is due then is to go on from where it will be: at its level it would stay where it was.
  void expect(std::size_t discrete_state, double position);
  /// Puts the switches and tables of a loop where these unknowns ask for them, whether they solve it or not.
  void place(std::size_t loop, const std::vector<double>& unknowns, double t, std::span<const double> x);
  /// The same, but for the limits of elements, at the guesses of every loop that amplifiers or equations
  /// hold, or on which a table acts: with the switches as they stand elsewhere it would be solved where it
  /// does not begin. (That a guess is beyond a limit says nothing: what is behind it has not settled yet.)
  void place_at_guesses(double t, std::span<const double> x);
  /// The same a moment beside the guesses: at a corner none of the switches that bend there need hold, and
  /// the loop would answer to nothing. Whether that puts any elsewhere.
  bool place_beside_guesses(double t, std::span<const double> x);
  /// Looks at all loops at (t, x), where everything has settled. True where one was put elsewhere: everything
  /// is then to be settled again. What `leaves` a solution that its elements do not hold, though they lead
  /// nowhere, goes to another (where a run starts OtherSolutions look for that).
  bool settle(double t, std::span<const double> x, bool leaves = true);
  /// Where something has no solution at (t, x): lets the first loop go from where it was noted, or from its
  /// guess, that comes to rest elsewhere, one of amplifiers too. False where there is none.
  bool go(double t, std::span<const double> x);
  /// Where the branch of the loop `lost` has ended between the switches as they stand: lets the first loop go
  /// from there that comes to rest elsewhere, that one or one of amplifiers on which a switch acts, as a
  /// limit. False where there is none.
  bool go_past_branch_end(std::size_t lost, double t, std::span<const double> x);

 private:
  /// A loop of equations of one's own, which say nothing of where it goes.
  struct Equations {
    std::size_t loop = 0;
    SwitchPlacing within;  ///< see Watched
  };
  struct Watched {
    std::size_t loop = 0;
    SwitchPlacing placing;       ///< of what turns over with the unknowns of the loop, and acts on it
    SwitchPlacing within;        ///< of the same, but for limits
    Eigen::VectorXd directions;  ///< of each unknown: an amplifier moves as −residual, another as +residual
    bool blind = true;           ///< of elements without memory alone
    bool goes = true;            ///< at events, and where a run starts
    bool stable = true;          ///< when it was noted
    int searches = 0;            ///< for another solution that were in vain
  };

  /// The residuals of a loop, and how they move its unknowns.
  struct Pull {
    Eigen::VectorXd residuals;
    Eigen::MatrixXd rates;  ///< −d residual/dz
  };

  void place(std::size_t loop, SwitchPlacing& placing, const std::vector<double>& unknowns, double t,
             std::span<const double> x);
  void place_near_guesses(double off, double t, std::span<const double> x);
  std::optional<Pull> pull(const Watched& watched, double t, std::span<const double> x,
                           network::Workspace& workspace);
  std::optional<Pull> pull_at(Watched& watched, const Eigen::VectorXd& z, double t, std::span<const double> x,
                              network::Workspace& workspace);
  bool rests(const Watched& watched, const Eigen::MatrixXd& rates) const;
  bool follow(Watched& watched, Eigen::VectorXd& z, double t, std::span<const double> x,
              network::Workspace& workspace);
  bool go_from_before(Watched& watched, double t, std::span<const double> x);
  bool leave(Watched& watched, double t, std::span<const double> x);
  Eigen::VectorXd unknowns_of(const Watched& watched, const std::vector<double>& all) const;

  const network::Program& program_;
  network::Workspace& workspace_;
  const SlidingMode& slide_;
  const Thresholds& thresholds_;
  std::vector<Watched> watched_;
  std::vector<Equations> equations_;
  bool any_goes_ = false;
  std::vector<double> unknowns_, discrete_states_;  ///< as they were noted
  std::vector<double> signals_;
};

}  // namespace oblique::solve
