// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/readings/thresholds.h>

#include <limits>

namespace oblique::solve {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kSmallestDifference = 1e-13;  ///< of what a switch compares, or of a machine unit

}  // namespace

Thresholds::Thresholds(const network::Program& program)
    : program_(program),
      now_(program.switches().size(), 0.0),
      roundings_(program.switches().size(), 0.0),
      resolutions_(program.switches().size(), 0.0),
      slack_(program.switches().size(), 0.0),
      excursions_(program.switches().size(), 0.0),
      let_since_(program.switches().size()),
      of_time_(program.switches().size(), false) {
  for (const network::Source& source : program.sources()) {
    if (source.switch_index && !source.by_states) of_time_[*source.switch_index] = true;
  }
}

void Thresholds::update(double t, const network::Evaluation& here) {
  for (std::size_t s = 0; s < now_.size(); ++s) {
    const double size = here.compared_size(s);
    roundings_[s] = rounding_of(s, size);
    resolutions_[s] = std::isfinite(size) ? 8 * kEpsilon * size : std::numeric_limits<double>::infinity();
    if (program_.switches()[s].rate) {  // known to rounding of the time
      double known = std::isfinite(size) ? size : std::abs(t);
      // A steep argument of a table is not: it would be moved there and back.
      if (program_.switches()[s].moves_along)
        known = std::max(known, std::abs(here.known_rate(s).value_or(0) * t));
      now_[s] = 8 * kEpsilon * known;
    } else {
      now_[s] = std::max(roundings_[s], slack_[s]);
    }
  }
}

double Thresholds::rounding_of(std::size_t s, double compared_size) const {
  const bool finite = std::isfinite(compared_size);
  if (of_time_[s] && finite) return 8 * kEpsilon * compared_size;
  return kSmallestDifference * (finite ? std::max(1.0, compared_size) : 1);
}

void Thresholds::note_side(std::size_t s, double against, double rounding, double t) {
  const bool let = slack_[s] > 0 && against > rounding;
  if (let == let_since_[s].has_value()) return;
  lets_ += let ? 1 : -1;
  let_since_[s] = let ? std::optional(t) : std::nullopt;
}

std::optional<double> Thresholds::leave_behind(std::size_t s, double event_function, double rounding) {
  note_excursion(s, event_function);
  if (slack_[s] == 0 || excursions_[s] <= 2 * slack_[s]) return std::nullopt;
  const double less = along_solution(s, rounding) - rounding;
  now_[s] = rounding;
  slack_[s] = 0;
  return less;
}

}  // namespace oblique::solve
