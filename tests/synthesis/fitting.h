// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/synthesis/fit.h>

#include "four_bar.h"

// Fits of four-bars to paths that plain trigonometry gives.
namespace oblique::test {

enum class Timing { given, free };

inline std::string csv_of(const FourBar& four_bar, const std::vector<double>& angles, Timing timing,
                          double noise = 0, const Eigen::Vector2d& shift = Eigen::Vector2d::Zero()) {
  test::Noise random;
  std::string csv = timing == Timing::given ? "crank,F.x,F.y\n" : "F.x,F.y\n";
  for (const double angle : angles) {
    const Eigen::Vector2d p =
        four_bar.point(angle) + shift + noise * Eigen::Vector2d(random.next(), random.next());
    csv += timing == Timing::given ? fmt::format("{},", angle) : "";
    csv += fmt::format("{},{}\n", p.x(), p.y());
  }
  return csv;
}

inline synthesis::Fit fit(const std::string& text, const std::vector<std::string>& free,
                          const std::string& csv, int starts = 8) {
  const synthesis::TargetPath target =
      synthesis::read_target_path(csv, "target.csv", mechanism::parse_mechanism(text, "four-bar.toml"));
  synthesis::FitOptions options;
  options.starts = starts;
  return synthesis::fit_path(text, "four-bar.toml", free, target, options);
}

inline std::vector<double> values_of(const synthesis::Fit& fit) {
  std::vector<double> values;
  for (const synthesis::FittedDimension& d : fit.dimensions) values.push_back(d.after);
  return values;
}

}  // namespace oblique::test
