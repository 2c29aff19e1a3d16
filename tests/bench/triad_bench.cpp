// SPDX-License-Identifier: MIT
// All assembly modes of triads on three rods, against what someone would write first: the sextic in z =
// e^{iθ} from seven values of F, the eigenvalues of its companion matrix, those on the unit circle, q = N/D.
// No polishing, and no special case.
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include <Eigen/Eigenvalues>

#include <oblique/mechanism/triad/triad.h>

#include "figures.h"

namespace oblique::bench {
namespace {

using Complex = std::complex<double>;
using Eigen::Vector2d;
using Legs = std::array<mechanism::Leg, 3>;

/// Triads that have modes: points in a square of side 2, the lengths measured in a pose.
std::vector<Legs> random_triads(std::size_t number) {
  std::mt19937_64 engine(1);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11U) * 0x1p-53;
  };
  std::vector<Legs> all(number);
  for (Legs& legs : all) {
    const Vector2d position(between(-1, 1), between(-1, 1));
    const Eigen::Rotation2D<double> turn(between(-std::numbers::pi, std::numbers::pi));
    for (mechanism::Leg& leg : legs) {
      leg.local = Vector2d(between(-1, 1), between(-1, 1));
      leg.anchor = Vector2d(between(-1, 1), between(-1, 1));
      leg.length = (position + turn * leg.local - leg.anchor).norm();
    }
  }
  return all;
}

/// N, D and F in the direction z, with the first rod for reference.
struct Elimination {
  Complex n;
  double d = 0;
  double f = 0;
};

Elimination eliminate(const Legs& legs, Complex z) {
  const auto complex = [](const Vector2d& v) { return Complex(v.x(), v.y()); };
  std::array<Complex, 2> u;
  std::array<double, 2> w{};
  const double l = legs[0].length;
  for (std::size_t i = 0; i < 2; ++i) {
    const mechanism::Leg& leg = legs[i + 1];
    u[i] = complex(leg.local - legs[0].local) * z - complex(leg.anchor - legs[0].anchor);
    w[i] = (leg.length * leg.length - l * l - std::norm(u[i])) / 2;
  }
  Elimination result;
  result.n = Complex(0, -1) * (w[0] * u[1] - w[1] * u[0]);
  result.d = (std::conj(u[0]) * u[1]).imag();
  result.f = std::norm(result.n) - l * l * result.d * result.d;
  return result;
}

int modes_by_hand(const Legs& legs, std::array<mechanism::PlatformPose, 6>& poses) {
  constexpr int kValues = 7;
  std::array<Complex, kValues> roots_of_one;
  std::array<double, kValues> values{};
  for (int i = 0; i < kValues; ++i) {
    const auto at = static_cast<std::size_t>(i);
    roots_of_one[at] = std::polar(1.0, 2 * std::numbers::pi * i / kValues);
    values[at] = eliminate(legs, roots_of_one[at]).f;
  }
  std::array<Complex, kValues> c;  // of z⁻³ … z³
  for (int k = -3; k <= 3; ++k) {
    Complex sum = 0;
    for (int i = 0; i < kValues; ++i)
      sum += values[static_cast<std::size_t>(i)] *
             std::conj(roots_of_one[static_cast<std::size_t>(((k * i) % kValues + kValues) % kValues)]);
    c[static_cast<std::size_t>(k + 3)] = sum / static_cast<double>(kValues);
  }
  Eigen::Matrix<Complex, 6, 6> companion = Eigen::Matrix<Complex, 6, 6>::Zero();
  for (int i = 0; i < 6; ++i) {
    companion(i, 5) = -c[static_cast<std::size_t>(i)] / c[6];
    if (i > 0) companion(i, i - 1) = 1;
  }
  const Eigen::ComplexEigenSolver<Eigen::Matrix<Complex, 6, 6>> solver(companion, false);
  int count = 0;
  for (const Complex z : solver.eigenvalues()) {
    if (std::abs(std::abs(z) - 1) > 1e-7) continue;
    const Elimination at = eliminate(legs, z);
    const Vector2d q(at.n.real() / at.d, at.n.imag() / at.d);
    const Vector2d& local = legs[0].local;
    const Vector2d turned(z.real() * local.x() - z.imag() * local.y(),
                          z.imag() * local.x() + z.real() * local.y());
    poses[static_cast<std::size_t>(count++)] = {legs[0].anchor + q - turned, z.real(), z.imag()};
  }
  return count;
}

void triad_modes(benchmark::State& state) {
  const std::vector<Legs> triads = random_triads(4096);
  const auto number = static_cast<double>(triads.size());
  std::vector<double> ratios, ours, by_hand;
  long our_modes = 0;
  long hand_modes = 0;
  std::array<mechanism::PlatformPose, 6> poses;
  for (auto _ : state) {
    our_modes = hand_modes = 0;
    const double start = cpu_seconds();
    for (const Legs& legs : triads) our_modes += mechanism::platform_modes(legs).count;
    const double between = cpu_seconds();
    for (const Legs& legs : triads) hand_modes += modes_by_hand(legs, poses);
    const double end = cpu_seconds();
    benchmark::DoNotOptimize(poses);
    state.SetIterationTime(end - start);
    ours.push_back(between - start);
    by_hand.push_back(end - between);
    ratios.push_back(ours.back() / by_hand.back());
  }
  // Eigenvalues near a double zero lie off the circle by the root of rounding: one triad in a thousand or so.
  if (std::abs(static_cast<double>(our_modes - hand_modes)) > 0.002 * static_cast<double>(our_modes)) {
    state.SkipWithError("the two do not find the same modes");
    return;
  }
  state.counters["triads_per_s"] = number / median(ours);
  state.counters["hand_per_s"] = number / median(by_hand);
  state.counters["ratio"] = median(ratios);
  state.counters["modes_ours"] = static_cast<double>(our_modes);
  state.counters["modes_hand"] = static_cast<double>(hand_modes);
  record({"triad: all modes, ours over companion eigenvalues", median(ratios), 0.5, ""});
  record({"triad: all modes of one on three rods", 1e6 * median(ours) / number, 5, "us"});
}

BENCHMARK(triad_modes)->Name("triad_modes")->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(1);

}  // namespace
}  // namespace oblique::bench
