// SPDX-License-Identifier: MIT
#include <oblique/synthesis/path_problem.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/mechanism/motion/obstacle.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/synthesis/synthesis_error.h>

namespace oblique::synthesis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Rows over the turn: a degree apart, which makes the error of PathCurve rounding.
constexpr int kRows = 361;
/// Largest change of a dimension, relative to the mechanism's size, over which the mode is carried at once.
constexpr double kModeStep = 0.05;
/// Step of central differences, relative to the width of the bounds: truncation and rounding are both about
/// 1e-10 of the derivative.
constexpr double kDifference = 1e-5;

bool is_assembled(const mechanism::Configuration& configuration) {
  return configuration.status != mechanism::Status::open;
}

StartConfiguration start_configuration_in(const mechanism::Mechanism& mechanism,
                                          const mechanism::Configuration& configuration) {
  StartConfiguration start_configuration;
  for (std::size_t i = 0; i < mechanism.points.size(); ++i) {
    if (!mechanism.points[i].fixed) start_configuration.push_back({i, configuration.points[i].position});
  }
  return start_configuration;
}

VectorXd two_columns(const std::vector<PathCurve::Foot>& feet, const VectorXd& accelerations) {
  VectorXd residuals(2 * std::ssize(feet) + accelerations.size());
  for (std::size_t k = 0; k < feet.size(); ++k) {
    residuals.segment<2>(2 * static_cast<Index>(k)) = feet[k].difference;
  }
  residuals.tail(accelerations.size()) = accelerations;
  return residuals;
}

}  // namespace

std::optional<StartConfiguration> start_configuration_of(const mechanism::Mechanism& mechanism) {
  const mechanism::Configuration start =
      mechanism::solve_motion(mechanism, std::vector<double>{0}).configurations.front();
  if (!is_assembled(start)) return std::nullopt;
  return start_configuration_in(mechanism, start);
}

PathProblem::PathProblem(const DesignSpace& space, const TargetPath& target)
    : space_(space), target_(target) {
  const mechanism::Mechanism& mechanism = space.original();
  size_ = mechanism.largest_length();
  must_turn_ = !mechanism::find_obstacle(mechanism, mechanism::decompose(mechanism));
  original_ = {space.values(), start_configuration_in(mechanism, turn_of(mechanism).configurations.front())};
  restart();
  if (residuals(original_.values)) return;
  throw SynthesisError(
      SynthesisError::Kind::request,
      text::Diagnostic{
          {target.file, {}},
          fmt::format("point '{}' cannot be followed: the mechanism cannot be assembled where column '{}' "
                      "wants it",
                      mechanism.points[target.point].name, target.timing),
          "targets within the motion of the mechanism",
          {text::Action{"solve", mechanism.file}, " tells where it is open"}});
}

void PathProblem::restart() {
  here_ = original_;
}

mechanism::Motion PathProblem::turn_of(const mechanism::Mechanism& mechanism) const {
  return mechanism::solve_motion(mechanism, kRows);
}

VectorXd PathProblem::accelerations_in(const mechanism::Motion& turn) const {
  const mechanism::Mechanism& mechanism = space_.original();
  const double speed = mechanism.drives.front().speed;
  VectorXd accelerations(std::ssize(mechanism.bodies) * std::ssize(turn.configurations));
  Index at = 0;
  for (const mechanism::Configuration& configuration : turn.configurations) {
    for (const mechanism::BodyState& body : configuration.bodies) {
      accelerations[at++] = body.alpha / (speed * speed);
    }
  }
  return accelerations;
}

double PathProblem::weight_of_an_acceleration() const {
  return std::sqrt(barrier_ / static_cast<double>(space_.original().bodies.size() * kRows));
}

/// The start configuration from which the member with these values takes its mode.
std::optional<StartConfiguration> PathProblem::walk_to(const VectorXd& values) const {
  const VectorXd way = values - here_.values;
  const auto steps = static_cast<long>(std::ceil(way.cwiseAbs().maxCoeff() / (kModeStep * size_)));
  StartConfiguration start_configuration = here_.start_configuration;
  for (long k = 1; k < steps; ++k) {
    mechanism::Mechanism between =
        space_.mechanism(here_.values + static_cast<double>(k) / static_cast<double>(steps) * way);
    between.sketch = start_configuration;
    const auto next = start_configuration_of(between);
    if (!next) return std::nullopt;
    start_configuration = *next;
  }
  return start_configuration;
}

std::optional<std::vector<PathCurve::Foot>> PathProblem::timed_feet(
    const mechanism::Mechanism& mechanism) const {
  std::vector<double> times{0};  // the motion begins at the start, where the mode is known
  times.insert(times.end(), target_.times.begin(), target_.times.end());
  const mechanism::Motion motion = mechanism::solve_motion(mechanism, times);
  std::vector<PathCurve::Foot> feet;
  for (std::size_t k = 0; k < target_.times.size(); ++k) {
    if (!is_assembled(motion.configurations[k + 1])) return std::nullopt;
    feet.push_back({target_.times[k],
                    motion.configurations[k + 1].points[target_.point].position - target_.positions[k],
                    Eigen::Matrix2d::Identity()});
  }
  return feet;
}

std::optional<PathProblem::Solved> PathProblem::solve(const VectorXd& values,
                                                      const StartConfiguration& near) {
  ++members_tried_;
  mechanism::Mechanism mechanism = space_.mechanism(values);
  mechanism.sketch = near;
  const mechanism::Motion turn = turn_of(mechanism);
  if (!is_assembled(turn.configurations.front())) return std::nullopt;
  if (must_turn_) {
    const bool turns =
        std::all_of(turn.configurations.begin(), turn.configurations.end(),
                    [](const mechanism::Configuration& c) { return c.status == mechanism::Status::ok; }) &&
        !mechanism::find_obstacle(mechanism, mechanism::decompose(mechanism));
    if (!turns) return std::nullopt;
  }
  Solved solved{start_configuration_in(mechanism, turn.configurations.front()), {}, {}};
  if (barrier_ > 0) solved.accelerations = weight_of_an_acceleration() * accelerations_in(turn);
  if (!target_.times.empty()) {
    auto feet = timed_feet(mechanism);
    if (!feet) return std::nullopt;
    solved.feet = std::move(*feet);
    return solved;
  }
  const PathCurve curve(turn, target_.point);
  for (const Vector2d& wanted : target_.positions) {
    const auto foot = curve.nearest(wanted);
    if (!foot) return std::nullopt;
    solved.feet.push_back(*foot);
  }
  return solved;
}

std::optional<VectorXd> PathProblem::residuals(const VectorXd& values) {
  try {
    const auto near = walk_to(values);
    if (!near) return std::nullopt;
    auto solved = solve(values, *near);
    if (!solved) return std::nullopt;
    here_ = {values, std::move(solved->start_configuration)};
    return two_columns(solved->feet, solved->accelerations);
  } catch (const mechanism::MechanismError&) {  // no such mechanism, or it cannot be assembled at the start
    return std::nullopt;
  }
}

std::optional<PathProblem::Perturbed> PathProblem::perturb(const VectorXd& values,
                                                           const std::vector<PathCurve::Foot>& feet) {
  try {
    ++members_tried_;
    mechanism::Mechanism mechanism = space_.mechanism(values);
    mechanism.sketch = here_.start_configuration;
    Perturbed perturbed;
    if (!target_.times.empty()) {
      const auto moved = timed_feet(mechanism);
      if (!moved) return std::nullopt;
      for (std::size_t k = 0; k < moved->size(); ++k) {
        perturbed.places.emplace_back((*moved)[k].difference + target_.positions[k]);
      }
      if (barrier_ == 0) return perturbed;
    }
    const mechanism::Motion turn = turn_of(mechanism);
    if (barrier_ > 0) perturbed.accelerations = weight_of_an_acceleration() * accelerations_in(turn);
    if (!perturbed.accelerations.allFinite()) return std::nullopt;
    if (!target_.times.empty()) return perturbed;
    const PathCurve curve(turn, target_.point);
    for (const PathCurve::Foot& foot : feet) {
      const auto place = curve.at(foot.time);
      if (!place) return std::nullopt;
      perturbed.places.push_back(*place);
    }
    return perturbed;
  } catch (const mechanism::MechanismError&) {
    return std::nullopt;
  }
}

MatrixXd PathProblem::jacobian(const VectorXd& values) {
  const auto near = walk_to(values);
  const auto base = near ? solve(values, *near) : std::nullopt;
  if (!base) return MatrixXd::Zero(2 * std::ssize(target_.positions), values.size());
  here_ = {values, base->start_configuration};
  Perturbed middle;
  for (std::size_t k = 0; k < base->feet.size(); ++k) {
    middle.places.emplace_back(base->feet[k].difference + target_.positions[k]);
  }
  middle.accelerations = base->accelerations;
  const auto n_places = 2 * std::ssize(base->feet);
  MatrixXd jacobian = MatrixXd::Zero(n_places + base->accelerations.size(), values.size());
  const VectorXd steps = kDifference * (space_.upper() - space_.lower());
  for (Index i = 0; i < values.size(); ++i) {
    VectorXd moved = values;
    moved[i] = values[i] + steps[i];
    const double above = moved[i];
    const auto plus = perturb(moved, base->feet);
    moved[i] = values[i] - steps[i];
    const double below = moved[i];
    const auto minus = perturb(moved, base->feet);
    const double step = (plus ? above : values[i]) - (minus ? below : values[i]);
    if (step == 0) continue;
    const Perturbed& high = plus ? *plus : middle;
    const Perturbed& low = minus ? *minus : middle;
    for (std::size_t k = 0; k < base->feet.size(); ++k) {
      jacobian.block<2, 1>(2 * static_cast<Index>(k), i) =
          base->feet[k].projector * (high.places[k] - low.places[k]) / step;
    }
    jacobian.col(i).tail(base->accelerations.size()) = (high.accelerations - low.accelerations) / step;
  }
  return jacobian;
}

VectorXd PathProblem::accelerations(const VectorXd& values,
                                    const StartConfiguration& start_configuration) const {
  mechanism::Mechanism mechanism = space_.mechanism(values);
  mechanism.sketch = start_configuration;
  return accelerations_in(turn_of(mechanism));
}

std::optional<double> PathProblem::effect_of(Index dimension) {
  constexpr double kStep = 1e-3;  // of the width of the bounds
  restart();
  const auto path = [&](double change) -> std::optional<mechanism::Motion> {
    VectorXd values = original_.values;
    values[dimension] += change * (space_.upper()[dimension] - space_.lower()[dimension]);
    try {
      mechanism::Mechanism mechanism = space_.mechanism(values);
      mechanism.sketch = original_.start_configuration;
      return turn_of(mechanism);
    } catch (const mechanism::MechanismError&) {
      return std::nullopt;
    }
  };
  auto moved = path(kStep);
  if (!moved) moved = path(-kStep);
  if (!moved) return std::nullopt;
  const mechanism::Motion still = turn_of(space_.original());
  double largest = 0;
  for (std::size_t row = 0; row < still.configurations.size(); ++row) {
    const mechanism::Configuration& a = still.configurations[row];
    const mechanism::Configuration& b = moved->configurations[row];
    // a row that opens or closes is an effect too
    if (is_assembled(a) != is_assembled(b)) return size_;
    if (!is_assembled(a)) continue;
    const std::size_t point = target_.point;
    largest = std::max(largest, (a.points[point].position - b.points[point].position).norm());
  }
  return largest;
}

}  // namespace oblique::synthesis
