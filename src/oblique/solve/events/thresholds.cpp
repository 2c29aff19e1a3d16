// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/events/thresholds.h>

#include <limits>

namespace oblique::solve {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kRounding = 1e-13;  ///< of what a switch compares, or of a machine unit

}  // namespace

Thresholds::Thresholds(const network::Program& program, const network::Workspace& workspace)
    : program_(program),
      workspace_(workspace),
      now_(program.switches().size(), 0.0),
      slack_(program.switches().size(), 0.0),
      excursions_(program.switches().size(), 0.0),
      of_time_(program.switches().size(), false) {
  for (const network::Source& source : program.sources()) {
    if (source.switch_index) of_time_[*source.switch_index] = true;
  }
}

void Thresholds::update(double t) {
  for (std::size_t s = 0; s < now_.size(); ++s) {
    if (program_.switches()[s].rate) {  // known to rounding of the time
      const double size = program_.compared_size(s, workspace_);
      now_[s] = 8 * kEpsilon * (std::isfinite(size) ? size : std::abs(t));
    } else {
      now_[s] = std::max(rounding(s), slack_[s]);
    }
  }
}

double Thresholds::rounding(std::size_t s) const {
  const double size = program_.compared_size(s, workspace_);
  if (of_time_[s] && std::isfinite(size)) return 8 * kEpsilon * size;
  return kRounding * (std::isfinite(size) ? std::max(1.0, size) : 1);
}

std::optional<double> Thresholds::leave_behind(std::size_t s, double surface) {
  excursions_[s] = std::max(excursions_[s], std::abs(surface));
  if (slack_[s] == 0 || excursions_[s] <= 2 * slack_[s]) return std::nullopt;
  const double before = now_[s];
  now_[s] = rounding(s);
  slack_[s] = 0;
  return before - now_[s];
}

}  // namespace oblique::solve
