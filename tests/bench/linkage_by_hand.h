// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace oblique::bench {

/// Points of a linkage by hand, numbered: the end of the crank, points of the frame, revolute joints of
/// dyads, carried points. Lengths in machine units.
struct HandLinkage {
  double crank = 0;                   ///< radius; the crank's end is point 0, turning about the origin
  std::optional<std::size_t> mirror;  ///< a point opposite to the crank's end
  struct Fixed {
    std::size_t point;
    double x, y;
  };
  std::vector<Fixed> fixed;
  /// A revolute joint over P → Q, left of it for side 1; where `length` stands, r2 in units of reach is a
  /// state that closes the loop below.
  struct Dyad {
    std::size_t c, p, q;
    double r1, r2, side, reach;
    bool variable = false;
  };
  /// point = P + (a + i b)(Q − P)
  struct Carried {
    std::size_t point, p, q;
    double a, b;
  };
  /// In this order: a dyad or a carried point, each from points before it.
  struct Step {
    std::optional<Dyad> dyad;
    std::optional<Carried> carried;
  };
  std::vector<Step> steps;
  /// The servo that finds the variable length: (point − fixed end)² = length², slower than the others.
  struct Loop {
    std::size_t point;
    double x, y, length, slower;
  };
  std::optional<Loop> loop;
  std::vector<std::size_t> shown;  ///< whose x and y are the columns
};

struct HandSettings {
  double gain = 1e6, input_gain = 10;
  double bandwidth = 20;   ///< [Hz]
  double crank_speed = 1;  ///< [rad/s]
  double scale = 1;        ///< of a machine unit, for the columns
  double until = 0;        ///< [s]
  double tolerance = 0, absolute_tolerance = 0;
  int samples = 0;
};

struct HandRun {
  std::vector<double> values;  ///< rows of t [s] and the columns
  std::size_t columns = 0;
  long steps = 0;
  double seconds = 0;  ///< CPU time, from the first call of CVODES to the last row
};

/// What someone would write who has such linkages to run and knows CVODES: the equations of their
/// servo-tracked triangles in C++, with their Jacobian, in one solver that is started anew for each. `start`
/// has all states at rest: cos and sin of the crank, then of each dyad L, cos ψ, sin ψ, cos γ, sin γ, then
/// the variable length.
class HandSolver {
 public:
  enum class Algebra { sparse, dense };
  /// All linkages that it runs are of the form of this one.
  HandSolver(const HandLinkage& linkage, const HandSettings& settings, Algebra algebra = Algebra::sparse);
  ~HandSolver();
  HandSolver(const HandSolver&) = delete;
  HandSolver& operator=(const HandSolver&) = delete;

  /// Takes another linkage of the form, before its time is taken.
  void use(const HandLinkage& linkage);
  HandRun run(std::span<const double> start);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// One run of one.
HandRun run_by_hand(const HandLinkage& linkage, const HandSettings& settings, std::span<const double> start);

}  // namespace oblique::bench
