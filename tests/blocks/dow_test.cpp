// SPDX-License-Identifier: MIT
// Finite gain and bandwidth of the amplifiers move the roots of a computed equation: Dow, "An analysis of
// certain errors in electronic differential analyzers" (1957).
//
// The harmonic oscillator x″ = −x of two integrators and an inverter has the roots ±i. With amplifiers of
// gain A and gain-bandwidth product ω_t, thus 1/A(s) = 1/A + s/ω_t, a unity integrator and a unity inverter
// are
//
//     −1/(s + (1 + s)/A(s))         −1/(1 + 2/A(s))
//
// and the characteristic equation is (s + (1 + s)/A(s))² (1 + 2/A(s)) + 1 = 0. To the first order in 1/A(s) a
// root at s₀ = i moves by δ with 2 s₀ (δ + (1 + s₀)/A(s₀)) + 2 s₀²/A(s₀) = 0, so that
//
//     δ = −(1 + 2 s₀)/A(s₀)        finite gain:       δ = −1/A − 2i/A     decays, slower
//                                  finite bandwidth:  δ = (2 − i)/ω_t     grows, slower
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>

#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

/// σ + iω of a signal e^{σt} cos(ωt + φ), from its rows: such a signal obeys x₊ = p x − q x₋ with p = 2
/// e^{σh} cos ωh and q = e^{2σh} (Prony 1795), which least squares find.
std::complex<double> root_of(const solve::Run& result, std::string_view column) {
  const auto t = row_values(result, "t"), x = row_values(result, column);
  double aa = 0, ab = 0, bb = 0, ac = 0, bc = 0;
  for (std::size_t r = 2; r + 1 < x.size(); ++r) {  // the first two rows: while the amplifiers settle
    const double a = x[r], b = -x[r - 1], c = x[r + 1];
    aa += a * a;
    ab += a * b;
    bb += b * b;
    ac += a * c;
    bc += b * c;
  }
  const double determinant = aa * bb - ab * ab;
  const double p = (ac * bb - bc * ab) / determinant, q = (aa * bc - ab * ac) / determinant;
  const double h = t[1] - t[0];
  return {std::log(q) / (2 * h), std::acos(p / (2 * std::sqrt(q))) / h};
}

std::complex<double> displacement_of(const std::string& imperfection) {
  const Compiled made(fmt::format(R"(x = {{ {0} type = "integrator", in = ["n"], initial = 1 }}
y = {{ {0} type = "integrator", in = ["x"] }}
n = {{ {0} type = "inverter", in = "y" }})",
                                  imperfection),
                      "\n[machine]\ninverting = true\n");
  const auto result = run_of(made, {.until = 60, .tolerance = 1e-11, .samples = 121});
  return root_of(result, "x") - std::complex<double>(0, 1);
}

TEST(Dow, WithoutImperfectionTheRootsStayInPlace) {
  EXPECT_LT(std::abs(displacement_of("")), 1e-8);  // a thousandth of what is measured below
}

TEST(Dow, FiniteGainMovesTheRoots) {
  for (const double gain : {1e3, 1e4}) {
    const auto found = displacement_of(fmt::format("gain = {},", gain));
    // 1 % is asked for; the next order is 1/A of it.
    EXPECT_NEAR(found.real(), -1 / gain, 0.01 / gain);
    EXPECT_NEAR(found.imag(), -2 / gain, 0.01 / gain);
  }
}

TEST(Dow, FiniteBandwidthMovesTheRoots) {
  for (const double turning : {2e3, 2e4}) {
    const auto found = displacement_of(fmt::format("bandwidth = \"{}/(2*pi)\",", turning));
    EXPECT_NEAR(found.real(), 2 / turning, 0.01 / turning);
    EXPECT_NEAR(found.imag(), -1 / turning, 0.01 / turning);
  }
}

}  // namespace
}  // namespace oblique::test
