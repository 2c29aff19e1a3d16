// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/loop_gain.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace oblique::solve {
namespace {

constexpr double kPointsPerDecade = 20;
constexpr double kRounding = 1e-6;  ///< [°] of a loop on the verge

}  // namespace

OpenLoops::OpenLoops(const Eigen::MatrixXd& a) {
  const Eigen::ComplexSchur<Eigen::MatrixXcd> schur(a.cast<std::complex<double>>());
  vectors_ = schur.matrixU();
  triangle_ = schur.matrixT();
}

std::complex<double> OpenLoops::gain(Eigen::Index place, double own_pole, std::complex<double> s) const {
  const Eigen::Index n = triangle_.rows();
  // (s − T) y = u*, from the last row up.
  Eigen::VectorXcd y(n);
  for (Eigen::Index row = n - 1; row >= 0; --row) {
    std::complex<double> sum = std::conj(vectors_(place, row));
    for (Eigen::Index k = row + 1; k < n; ++k) sum += triangle_(row, k) * y[k];
    const std::complex<double> divisor = s - triangle_(row, row);
    if (divisor == 0.0) return -1;  // an eigenvalue: 1 + L = 0
    y[row] = sum / divisor;
  }
  const std::complex<double> resolvent = (vectors_.row(place) * y)(0);
  const std::complex<double> divisor = (s - own_pole) * resolvent;
  if (divisor == 0.0) return std::numeric_limits<double>::infinity();
  return 1.0 / divisor - 1.0;
}

std::optional<OpenLoops::Margin> OpenLoops::phase_margin(Eigen::Index place, double own_pole) const {
  return phase_margin(place, own_pole, triangle_.diagonal().real().maxCoeff() > 0);
}

std::optional<OpenLoops::Margin> OpenLoops::phase_margin(Eigen::Index place, double own_pole,
                                                         bool unstable) const {
  double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
  const auto take = [&](double rate) {
    if (rate == 0 || !std::isfinite(rate)) return;
    slowest = std::min(slowest, rate);
    fastest = std::max(fastest, rate);
  };
  for (Eigen::Index i = 0; i < triangle_.rows(); ++i) take(std::abs(triangle_(i, i)));
  take(std::abs(own_pole));
  if (fastest == 0) return std::nullopt;

  const auto magnitude = [&](double exponent) {  // log |L| at ω = e^exponent
    return std::log(std::abs(gain(place, own_pole, {0, std::exp(exponent)})));
  };
  const double begin = std::log(slowest / 100), end = std::log(fastest * 100);
  const auto points = static_cast<int>(std::ceil((end - begin) / std::log(10.0) * kPointsPerDecade));
  std::optional<Margin> worst;
  double last = begin, at_last = magnitude(begin);
  for (int k = 1; k <= points; ++k) {
    const double next = begin + (end - begin) * k / points;
    const double at_next = magnitude(next);
    if ((at_last > 0) != (at_next > 0)) {
      double low = last, high = next;
      while (high - low > 1e-13 * std::max(1.0, std::abs(high))) {
        const double middle = low + (high - low) / 2;
        ((magnitude(middle) > 0) == (at_last > 0) ? low : high) = middle;
      }
      const double frequency = std::exp(high);
      // arg(−L) is 180° + arg L brought into (−180°, 180°].
      double degrees = std::arg(-gain(place, own_pole, {0, frequency})) * 180 / std::numbers::pi;
      if (!unstable && degrees < -kRounding) degrees += 360;
      if (!worst || degrees < worst->degrees) worst = {degrees, frequency};
    }
    last = next;
    at_last = at_next;
  }
  return worst;
}

}  // namespace oblique::solve
