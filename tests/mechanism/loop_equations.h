// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <string>
#include <vector>

#include <Eigen/LU>

namespace oblique::mechanism {

/// The oracle of the exact kinematics, which shares nothing with it: a mechanism as closed loops of links in
/// the unknown link ANGLES, Σ r·e^{i(θ+δ)} = 0, solved by Newton's method in long double; rates from linear
/// solves of the differentiated loops.
///
///     Σ i r e^{i(θ+δ)} θ̇ = 0,      Σ r e^{i(θ+δ)} (i θ̈ − θ̇²) = 0
class LoopEquations {
 public:
  using Real = long double;
  using Complex = std::complex<Real>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  /// The vector r·e^{i(θ+δ)} of a link; link 0 is the crank, links 1 … n are unknown, −1 is the frame (θ =
  /// 0).
  struct Term {
    int link;
    Real length;
    Real offset = 0;
  };
  using Chain = std::vector<Term>;

  struct Point {
    std::string name;
    Complex origin;
    Chain chain;
  };

  struct State {
    Vector theta, omega, alpha;  ///< of all links, the crank first
  };

  struct Moving {
    Complex position, velocity, acceleration;
  };

  std::vector<Chain> loops;
  std::vector<Point> points;

  /// Link angles at crank angle `phi` and constant speed; `guess` for all links, the crank's ignored.
  State solve(Real phi, Real speed, Vector guess) const {
    guess(0) = phi;
    const Eigen::Index n = guess.size() - 1;
    for (int iteration = 0; iteration < 50; ++iteration) {
      const Vector step = jacobian(guess).rightCols(n).fullPivLu().solve(residual(guess));
      guess.tail(n) -= step;
      if (step.lpNorm<Eigen::Infinity>() < 1e-18L) break;
    }
    const auto jacobian_here = jacobian(guess);
    const Eigen::FullPivLU<Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>> lu(
        jacobian_here.rightCols(n));
    State state{guess, Vector::Zero(n + 1), Vector::Zero(n + 1)};
    state.omega(0) = speed;
    state.omega.tail(n) = lu.solve(-jacobian_here.col(0) * speed);
    Vector centripetal(n);
    for (Eigen::Index loop = 0; loop < n / 2; ++loop) {
      Complex sum = 0;
      for (const Term& term : loops[static_cast<std::size_t>(loop)])
        sum -= vector(term, guess) * std::pow(rate(term, state.omega), 2.0L);
      centripetal(2 * loop) = sum.real();
      centripetal(2 * loop + 1) = sum.imag();
    }
    state.alpha.tail(n) = lu.solve(-centripetal);
    return state;
  }

  Moving point(const Point& point, const State& state) const {
    const Complex i(0, 1);
    Moving moving{point.origin, 0, 0};
    for (const Term& term : point.chain) {
      const Complex r = vector(term, state.theta);
      const Real omega = rate(term, state.omega);
      moving.position += r;
      moving.velocity += i * omega * r;
      moving.acceleration += (i * rate(term, state.alpha) - omega * omega) * r;
    }
    return moving;
  }

 private:
  static Complex vector(const Term& term, const Vector& theta) {
    return std::polar(1.0L, rate(term, theta) + term.offset) * term.length;
  }
  static Real rate(const Term& term, const Vector& rates) { return term.link < 0 ? 0 : rates(term.link); }

  Vector residual(const Vector& theta) const {
    Vector result(2 * static_cast<Eigen::Index>(loops.size()));
    for (std::size_t loop = 0; loop < loops.size(); ++loop) {
      Complex sum = 0;
      for (const Term& term : loops[loop]) sum += vector(term, theta);
      result(2 * static_cast<Eigen::Index>(loop)) = sum.real();
      result(2 * static_cast<Eigen::Index>(loop) + 1) = sum.imag();
    }
    return result;
  }

  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> jacobian(const Vector& theta) const {
    Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> result =
        Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>::Zero(2 * static_cast<Eigen::Index>(loops.size()),
                                                                  theta.size());
    for (std::size_t loop = 0; loop < loops.size(); ++loop) {
      for (const Term& term : loops[loop]) {
        if (term.link < 0) continue;
        const Complex slope = Complex(0, 1) * vector(term, theta);
        result(2 * static_cast<Eigen::Index>(loop), term.link) += slope.real();
        result(2 * static_cast<Eigen::Index>(loop) + 1, term.link) += slope.imag();
      }
    }
    return result;
  }
};

}  // namespace oblique::mechanism
