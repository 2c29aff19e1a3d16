// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/amplifier_motion.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include <Eigen/LU>

#include <oblique/solve/stability/eigenvalues.h>

namespace oblique::solve {

AmplifierMotion amplifier_motion(const network::Program& program, std::size_t loop,
                                 const Eigen::MatrixXd& jacobian) {
  const std::vector<std::size_t>& unknowns = program.loops()[loop].unknowns;
  std::vector<Eigen::Index> amplifiers, others;
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    (program.unknowns()[unknowns[i]].held_by_amplifier ? amplifiers : others)
        .push_back(static_cast<Eigen::Index>(i));
  Eigen::MatrixXd own = jacobian(amplifiers, amplifiers);
  if (!others.empty()) {
    const Eigen::MatrixXd inner = jacobian(others, others);
    own -= jacobian(amplifiers, others) *
           inner.partialPivLu().solve(Eigen::MatrixXd(jacobian(others, amplifiers)));
  }
  if (!own.allFinite()) return AmplifierMotion::rest;
  constexpr double kRounding = 1e-9;  // a root of even order has no derivative but that of its rounding
  constexpr double kTurn = 1e-6;
  const Eigen::VectorXcd values = eigenvalues_of(own);
  const double largest = std::max(values.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  if (values.real().minCoeff() <= -kRounding * largest) return AmplifierMotion::run_away;
  const bool swings = std::any_of(values.begin(), values.end(), [&](const std::complex<double>& value) {
    return value.real() <= kRounding * largest && std::abs(value.imag()) > kTurn * largest;
  });
  return swings ? AmplifierMotion::swing : AmplifierMotion::rest;
}

}  // namespace oblique::solve
