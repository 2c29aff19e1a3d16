// SPDX-License-Identifier: MIT
#include <oblique/compare/worst_reason.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/solve/readings/driving_states.h>
#include <oblique/solve/stability/loop_report.h>
#include <oblique/solve/stability/stability_report.h>

namespace oblique::compare {
namespace {

/// Part of the turn within which two positions count as the same.
constexpr double kNear = 0.05;
/// What falls by less than a quarter along the turn explains nothing.
constexpr double kDip = 0.75;
/// Every so many rows the gains of the loops are looked at.
constexpr std::size_t kRowsPerInstant = 5;

/// sin γ at P of a dyad's triangle.
double sine_at_pivot(const mechanism::Dyad& dyad, const mechanism::Configuration& here) {
  const Eigen::Vector2d d = here.points[dyad.q].position - here.points[dyad.p].position;
  const Eigen::Vector2d e = here.points[dyad.c].position - here.points[dyad.p].position;
  return std::abs(d.x() * e.y() - d.y() * e.x()) / (d.norm() * e.norm());
}

/// Whether states act on an output: directly, or through other states.
std::vector<bool> states_behind(const PatchedMechanism& patched, const solve::Instant& instant,
                                const PointOutputs& point) {
  const auto here = place_in(patched, point, instant);
  solve::Instant moved = instant;
  std::vector<bool> behind(instant.states.size(), false);
  for (std::size_t i = 0; i < behind.size(); ++i) {
    moved.states[i] += 0.0371;  // an odd part of a machine unit
    behind[i] = place_in(patched, point, moved) != here;
    moved.states[i] = instant.states[i];
  }
  return solve::with_driving_states(patched.program.jacobian_pattern(), std::move(behind));
}

}  // namespace

WorstReasons::WorstReasons(const mechanism::Mechanism& mechanism, const mechanism::Motion& exact)
    : mechanism_(mechanism),
      exact_(exact),
      structure_(mechanism::decompose(mechanism)),
      determinants_(structure_.groups.size()) {
  mechanism::Follower follower(mechanism, structure_);
  for (const double t : exact.times) {
    follower.advance(t);
    for (std::size_t g = 0; g < determinants_.size(); ++g)
      determinants_[g].push_back(std::abs(follower.normalised_determinant(g)));
  }
}

bool WorstReasons::is_near(double a, double b) const {
  const double turn = exact_.times.back() - exact_.times.front();
  const double apart = std::abs(a - b);
  return std::min(apart, turn - apart) <= kNear * turn;
}

std::vector<double> WorstReasons::flatness(std::size_t group, patch::PatchMethod method) const {
  const auto& dyad = structure_.groups[group].form.dyad;
  if (!dyad || method == patch::PatchMethod::gradient) return determinants_[group];
  std::vector<double> sines;
  for (const mechanism::Configuration& here : exact_.configurations)
    sines.push_back(sine_at_pivot(*dyad, here));
  return sines;
}

/// The group that places a point, then those that it hangs on, the nearest first; without drives.
std::vector<std::size_t> WorstReasons::groups_behind(std::size_t point) const {
  std::vector<std::size_t> behind, points{point};
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (std::size_t g = 0; g < structure_.groups.size(); ++g) {
      const mechanism::Group& group = structure_.groups[g];
      const bool places =
          std::find(group.points.begin(), group.points.end(), points[k]) != group.points.end();
      if (!places || group.assur_class == 1 || std::find(behind.begin(), behind.end(), g) != behind.end())
        continue;
      behind.push_back(g);
      for (const std::size_t body : group.bodies) {
        for (const mechanism::BodyPoint& p : mechanism_.bodies[body].points) points.push_back(p.point);
      }
      for (const std::size_t s : group.slides) {
        const mechanism::Slide& slide = mechanism_.slides[s];
        points.insert(points.end(), {slide.point, slide.first, slide.second});
      }
    }
  }
  return behind;
}

std::string WorstReasons::flat_group(std::size_t point, std::size_t row, patch::PatchMethod method) const {
  for (const std::size_t g : groups_behind(point)) {
    const std::vector<double> values = flatness(g, method);
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    const auto where = static_cast<std::size_t>(least - values.begin());
    if (!is_near(exact_.times[row], exact_.times[where]) || *least > kDip * *greatest) continue;
    const mechanism::Group& group = structure_.groups[g];
    const auto& dyad = group.form.dyad;
    if (!dyad || method == patch::PatchMethod::gradient) {
      return fmt::format("the group {} is nearest to a dead centre there (normalised determinant {:.2g})",
                         group.name, *least);
    }
    const auto name = [&](std::size_t p) { return mechanism_.points[p].name; };
    return fmt::format("the triangle {}–{}–{} is nearest to collinear there (sin γ = {:.2g} at {})",
                       name(dyad->p), name(dyad->c), name(dyad->q), *least, name(dyad->p));
  }
  return {};
}

std::string WorstReasons::weak_loop(const PatchedMechanism& patched, double gain, const RecordedRun& recorded,
                                    const Distances& error) const {
  std::vector<solve::Instant> instants;
  for (std::size_t row = 0; row < recorded.instants.size(); row += kRowsPerInstant)
    instants.push_back(recorded.instants[row]);
  const std::vector<bool> behind = states_behind(patched, recorded.instants[error.row], error.worst);
  const solve::SignalFlow flow(patched.flat, patched.program);
  const solve::LoopUnknown* weakest = nullptr;
  const std::vector<solve::LoopReport> loops = solve::explain_loops(patched.program, flow, instants);
  for (const solve::LoopReport& loop : loops) {
    for (const solve::LoopUnknown& unknown : loop.unknowns) {
      const auto& states = patched.program.states();
      const auto state = std::find_if(states.begin(), states.end(),
                                      [&](const network::State& s) { return s.name == unknown.signal; });
      if (state == states.end() || !behind[static_cast<std::size_t>(state - states.begin())]) continue;
      if (weakest == nullptr || std::abs(unknown.least_gain) < std::abs(weakest->least_gain))
        weakest = &unknown;
    }
  }
  if (weakest == nullptr || !is_near(weakest->least_time, exact_.times[error.row]) ||
      std::abs(weakest->least_gain) > kDip * std::abs(weakest->greatest_gain)) {
    return {};
  }
  return fmt::format("the loop of '{}' has the least gain of all there ({:.2g} times the amplifier's)",
                     weakest->signal, weakest->least_gain / gain);
}

std::string WorstReasons::reason(const PatchedMechanism& patched, const patch::PatchOptions& options,
                                 const RecordedRun& recorded, const Distances& error) const {
  std::string found = flat_group(error.worst.point, error.row, options.method);
  return found.empty() ? weak_loop(patched, options.gain, recorded, error) : found;
}

}  // namespace oblique::compare
