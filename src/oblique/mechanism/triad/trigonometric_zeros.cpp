// SPDX-License-Identifier: MIT
#include <oblique/mechanism/triad/trigonometric_zeros.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <oblique/mechanism/solver/complex_plane.h>

namespace oblique::mechanism::triad {
namespace {

constexpr int kHighest = 6;  // derivative that is asked whether it has a zero

/// jᵏ for j = 1, 2, 3.
constexpr auto kPowers = [] {
  std::array<std::array<double, 3>, kHighest + 4> powers{};
  powers[0] = {1, 1, 1};
  for (std::size_t k = 1; k < powers.size(); ++k) {
    for (std::size_t j = 0; j < 3; ++j) powers[k][j] = powers[k - 1][j] * static_cast<double>(j + 1);
  }
  return powers;
}();

/// f about the middle of an arc. A place on the arc is τ = tan((θ − middle)/2): small, for an arc is short.
class Arc {
 public:
  Arc(const TrigonometricCubic& f, Complex middle)
      : constant_(f.constant),
        middle_(middle),
        first_(f.harmonics[0] * middle),
        second_(f.harmonics[1] * (middle * middle)),
        third_(f.harmonics[2] * (middle * middle * middle)) {}

  /// e^{iθ} at τ.
  Complex direction(double tau) const { return middle_ * turn(tau); }

  /// f⁽ᵏ⁾ in the middle.
  double derivative(int k) const { return part(k, first_, second_, third_); }

  /// f⁽ᵏ⁾ and f⁽ᵏ⁺¹⁾ at τ.
  std::pair<double, double> derivatives(int k, double tau) const {
    const Complex once = turn(tau);
    const Complex twice = once * once;
    const Complex first = first_ * once;
    const Complex second = second_ * twice;
    const Complex third = third_ * (twice * once);
    return {part(k, first, second, third), part(k + 1, first, second, third)};
  }

  double value(double tau) const { return derivatives(0, tau).first; }

 private:
  static Complex turn(double tau) {
    const double scale = 1 / (1 + tau * tau);
    return {(1 - tau * tau) * scale, 2 * tau * scale};
  }

  /// dᵏ/dθᵏ of c₀ + Re(first + second + third): Re((ij)ᵏ·) of the j-th harmonic.
  double part(int k, Complex first, Complex second, Complex third) const {
    const auto& power = kPowers[static_cast<std::size_t>(k)];
    const double sum = k % 2 == 0
                           ? power[0] * first.real() + power[1] * second.real() + power[2] * third.real()
                           : power[0] * first.imag() + power[1] * second.imag() + power[2] * third.imag();
    const bool negative = k % 4 == 1 || k % 4 == 2;
    return (negative ? -sum : sum) + (k == 0 ? constant_ : 0);
  }

  double constant_;
  Complex middle_, first_, second_, third_;
};

class Search {
 public:
  Search(const TrigonometricCubic& f, double negligible) : f_(f), negligible_(negligible) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double size = modulus(f.harmonics[j]);
      for (std::size_t k = 0; k < bounds_.size(); ++k) bounds_[k] += kPowers[k][j] * size;
    }
  }

  Directions all() {
    constexpr double kHalf = std::numbers::sqrt3 / 2;
    constexpr std::array<double, 12> kCosines = {1,  kHalf,  0.5,  0, -0.5, -kHalf,
                                                 -1, -kHalf, -0.5, 0, 0.5,  kHalf};
    constexpr double kHalfWidth = std::numbers::pi / 12;
    constexpr double kTangent = 0.13165249758739585;  // of half the half-width: tan(π/24)
    for (std::size_t i = 0; i < kCosines.size(); ++i) {
      search(Complex(kCosines[i], kCosines[(i + 9) % 12]), kHalfWidth, kTangent, 0);
    }
    return found_;
  }

 private:
  void report(const Arc& arc, double tau) {
    const Complex z = arc.direction(tau);
    for (int i = found_.count; i-- > 0;) {
      if (std::norm(z - found_.z[static_cast<std::size_t>(i)]) < 1e-20) return;
    }
    if (found_.count < static_cast<int>(found_.z.size()))
      found_.z[static_cast<std::size_t>(found_.count++)] = z;
  }

  /// Whether f⁽ᵏ⁾ stays farther from zero than `distance` on the arc.
  bool stays_away(const Arc& arc, int k, double r, double distance) const {
    return std::abs(arc.derivative(k)) >
           distance +
               r * (std::abs(arc.derivative(k + 1)) +
                    r / 2 *
                        (std::abs(arc.derivative(k + 2)) + r / 3 * bounds_[static_cast<std::size_t>(k) + 3]));
  }

  /// The zeros in the arc of half-width r about `middle`; tangent = tan(r/2).
  void search(Complex middle, double r, double tangent, int depth) {
    const Arc arc(f_, middle);
    if (stays_away(arc, 0, r, negligible_)) return;
    const int highest = depth < 3 ? 2 : kHighest;  // two shorter arcs are less work than a long ladder
    for (int k = 1; k <= highest; ++k) {
      if (!stays_away(arc, k, r, 0)) continue;
      isolate(arc, tangent, k);
      return;
    }
    if (depth == 16) {  // an arc of 4e-6; only an f of rounding alone comes here
      report(arc, 0);
      return;
    }
    const double half = tangent / (1 + std::sqrt(1 + tangent * tangent));  // tan(r/4)
    search(arc.direction(-half), r / 2, half, depth + 1);
    search(arc.direction(half), r / 2, half, depth + 1);
  }

  /// The zeros on −tangent ≤ τ ≤ tangent, where f⁽ᵏ⁾ has none: of f⁽ᵏ⁻¹⁾ first, then down to f.
  void isolate(const Arc& arc, double tangent, int k) {
    std::array<double, 2 + kHighest*(kHighest + 1) / 2> places{-tangent, tangent};
    std::size_t count = 2;
    for (int order = k - 1; order > 0; --order) {
      const std::size_t known = count;
      double from = arc.derivatives(order, places[0]).first;
      for (std::size_t i = 1; i < known; ++i) {
        const double to = arc.derivatives(order, places[i]).first;
        if ((from < 0) != (to < 0)) places[count++] = zero(arc, order, places[i - 1], places[i], from, to);
        from = to;
      }
      std::sort(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(count));
    }
    double from = arc.value(places[0]);
    if (std::abs(from) <= negligible_) report(arc, places[0]);
    for (std::size_t i = 1; i < count; ++i) {
      const double to = arc.value(places[i]);
      if ((from < 0) != (to < 0)) report(arc, zero(arc, 0, places[i - 1], places[i], from, to));
      if (std::abs(to) <= negligible_) report(arc, places[i]);
      from = to;
    }
  }

  /// The zero of f⁽ᵏ⁾ between `low` and `high`, where it is monotone: Newton, with bisection where that
  /// leaves the bracket.
  static double zero(const Arc& arc, int k, double low, double high, double value_at_low,
                     double value_at_high) {
    double tau = low + (high - low) * (value_at_low / (value_at_low - value_at_high));
    for (int step = 0; step < 60; ++step) {
      const auto [value, derivative] = arc.derivatives(k, tau);
      ((value < 0) == (value_at_low < 0) ? low : high) = tau;
      const double next = tau - value * (1 + tau * tau) / (2 * derivative);  // dθ = 2 dτ / (1 + τ²)
      const bool inside = low <= next && next <= high;
      const double last = std::exchange(tau, inside ? next : (low + high) / 2);
      if (inside ? std::abs(tau - last) < 1e-9 : high - low < 1e-15) break;  // Newton squares it
    }
    return tau;
  }

  const TrigonometricCubic& f_;
  double negligible_;
  std::array<double, kHighest + 4> bounds_{};  ///< of |f⁽ᵏ⁾| without c₀
  Directions found_;
};

}  // namespace

double TrigonometricCubic::size() const {
  return std::abs(constant) + modulus(harmonics[0]) + modulus(harmonics[1]) + modulus(harmonics[2]);
}

Directions zeros(const TrigonometricCubic& f, double negligible) {
  return Search(f, negligible).all();
}

}  // namespace oblique::mechanism::triad
