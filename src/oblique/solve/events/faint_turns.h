// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/interpolant.h>

namespace oblique::solve {

/// A switch that turned over, with an effect, where the errors of the states do not tell its surface from
/// zero: whether it turns over at all, rounding has decided.
struct FaintTurn {
  std::uint32_t number = 0;         ///< in Program::switches
  double time = 0;                  ///< [s]
  double error = 0;                 ///< of its surface
  std::vector<std::size_t> states;  ///< that decide about it, and would be known better by a finer run
};

/// Tells turns that are faint. The surface of a switch that reads a decay comes from afar, ever nearer to
/// zero, and never passes it; its states are known to the absolute tolerance, and one of their errors lets it
/// pass. It is then within its error during the whole step in which it passes, and so slow that in all the
/// time that it took to come it would not have moved by more than some errors. So is each half-wave of an
/// oscillation that has decayed.
class FaintTurns {
 public:
  /// `span` is the length of the run [s]. All must outlive this.
  FaintTurns(const network::Program& program, network::Workspace& workspace, double span);

  /// Looks how the surfaces of the switches that turn over at `at` come there in a step that began at `from`.
  void approach(double from, double at, const std::vector<std::pair<std::uint32_t, double>>& turned,
                const Interpolant& solution);
  /// What was looked at lies behind.
  void leave() { approaches_.clear(); }

  /// What is known of a surface besides.
  struct Past {
    double error = 0;      ///< by those of the states
    double excursion = 0;  ///< how far it has been from zero since it turned over last
    double since = 0;      ///< [s] how long that is ago
  };
  /// Those of the switches that are faint.
  std::vector<std::uint32_t> faint(const std::function<Past(std::uint32_t)>& past);
  bool any() const { return !approaches_.empty(); }

  /// Whether so much more than errors of this size lies between two values of the signals.
  static bool jumps(const std::vector<double>& before, const std::vector<double>& after, double error);

 private:
  struct Approach {
    std::uint32_t number = 0;
    double before = 0;  ///< magnitude of the surface where the step began
    double speed = 0;   ///< magnitude of its rate at the turn [1/s]
  };

  const network::Program& program_;
  network::Workspace& workspace_;
  double span_;
  std::vector<Approach> approaches_;
  std::vector<double> farthest_;  ///< of each surface: how far from zero it has been
  std::vector<double> states_, rates_, surfaces_;
};

}  // namespace oblique::solve
