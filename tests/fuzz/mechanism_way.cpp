// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/patch.h>

#include "agreement.h"
#include "random_mechanism.h"
#include "trial.h"
#include "whole_way.h"

namespace oblique::fuzz {
namespace {

constexpr int kPositions = 37;
constexpr double kGain = 1e4;
constexpr double kLeastDeterminant = 0.1;

/// The exact motion of a text; or why there is none.
struct Way {
  std::optional<mechanism::Mechanism> mechanism;
  std::optional<mechanism::Motion> motion;
  std::string refusal;
  bool is_whole = false;  ///< every row stands for an assembled mechanism
};

Way go(const std::string& text) {
  Way way;
  try {
    way.mechanism = mechanism::parse_mechanism(text, "fuzz.toml");
    way.motion = mechanism::solve_motion(*way.mechanism, kPositions);
    way.is_whole =
        std::all_of(way.motion->configurations.begin(), way.motion->configurations.end(),
                    [](const mechanism::Configuration& c) { return c.status == mechanism::Status::ok; });
  } catch (const mechanism::MechanismError& error) {
    way.refusal = error.what();
  }
  return way;
}

bool turns_well(const mechanism::Mechanism& mechanism) {
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  mechanism::Follower follower(mechanism, structure);
  for (int k = 0; k <= 360; ++k) {
    follower.advance(2 * std::numbers::pi * k / 360);
    if (!follower.events().empty()) return false;
    for (std::size_t group = 1; group < structure.groups.size(); ++group) {
      if (std::abs(follower.normalised_determinant(group)) < kLeastDeterminant) return false;
    }
  }
  return true;
}

class MechanismExamination {
 public:
  explicit MechanismExamination(const MechanismPlan& plan)
      : plan_(plan), text_(text_of(plan)), base_(go(text_)) {}

  std::string fault(std::size_t oracle) {
    MechanismWriting writing;
    switch (oracle) {
      case 0:
        writing.other_names = true;
        return alike(writing, "renamed", 0);
      case 1:
        writing.other_order = true;
        // What stays of the residuals of Newton's method, magnified by a small determinant.
        return alike(writing, "in the opposite order", 1e-7);
      case 2:
        writing.scale = 2;
        return alike(writing, "twice as large", 1e-7);
      case 3:
        return written_back(patch::PatchMethod::triangles) + written_back(patch::PatchMethod::gradient);
      case 4:
        return against_exact(patch::PatchMethod::triangles);
      default:
        return against_exact(patch::PatchMethod::gradient);
    }
  }

  bool compared() const { return compared_; }

 private:
  std::string report(const std::string& what, const std::string& other = "") const {
    return what + "\n--- the mechanism\n" + text_ + (other.empty() ? "" : "--- the other\n" + other);
  }

  std::string alike(const MechanismWriting& writing, const std::string& how, double within) {
    const std::string text = text_of(plan_, writing);
    const Way other = go(text);
    if (other.motion.has_value() != base_.motion.has_value() || other.is_whole != base_.is_whole)
      return report(fmt::format("{}: '{}' instead of '{}'", how, other.refusal, base_.refusal), text);
    if (!base_.is_whole) return "";
    compared_ = true;
    for (std::size_t p = 0; p < plan_.points.size(); ++p) {
      const auto here = base_.mechanism->find_point(point_name(p));
      const auto there = other.mechanism->find_point(point_name(p, writing));
      for (std::size_t row = 0; row < base_.motion->configurations.size(); ++row) {
        const Eigen::Vector2d a = base_.motion->configurations[row].points[here.value()].position;
        const Eigen::Vector2d b =
            other.motion->configurations[row].points[there.value()].position / writing.scale;
        if ((a - b).cwiseAbs().maxCoeff() <= within) continue;
        return report(fmt::format("{}: {} in row {} is at {}, {} instead of {}, {}", how, point_name(p), row,
                                  b.x(), b.y(), a.x(), a.y()),
                      text);
      }
    }
    return "";
  }

  std::optional<diagram::Diagram> patched(patch::PatchMethod method) const {
    patch::PatchOptions options;
    options.method = method;
    options.gain = kGain;
    options.samples = kPositions;
    options.tolerance = 1e-8;
    try {
      return patch::patch(*base_.mechanism, options);
    } catch (const patch::PatchError&) {  // a triangle goes flat on the way
      return std::nullopt;
    } catch (const mechanism::MechanismError&) {
      return std::nullopt;
    }
  }

  std::string written_back(patch::PatchMethod method) {
    if (!base_.is_whole) return "";
    const auto diagram = patched(method);
    if (!diagram) return "";
    const std::string text = diagram::write_diagram(*diagram);
    if (!(diagram::parse_diagram(text, "fuzz.toml") == *diagram))
      return report("its patch is not read back as it was", text);
    const Trial here = try_diagram(*diagram), there = try_diagram(text);
    if (here.end == Trial::End::broken) return report("the run of its patch is broken: " + here.says, text);
    if (here.end != there.end || here.says != there.says)
      return report(fmt::format("its patch read back ends otherwise: {} {}", here.message, there.message),
                    text);
    if (!here.run) return "";
    compared_ = true;
    if (find_difference({*here.run, *there.run}, 0, [](auto, auto) { return 0.0; }))
      return report("its patch read back runs otherwise", text);
    return "";
  }

  std::string against_exact(patch::PatchMethod method) {
    if (!base_.is_whole || !turns_well(*base_.mechanism)) return "";
    const auto diagram = patched(method);
    if (!diagram) return "";
    const Trial trial = try_diagram(*diagram);
    if (trial.end == Trial::End::broken || trial.says == "diagram")
      return report("the run of its patch: " + trial.says + trial.message, diagram::write_diagram(*diagram));
    if (trial.end != Trial::End::clean) return "";
    compared_ = true;
    const solve::Trajectory& table = trial.run->trajectory;
    // 1/gain, magnified by the determinant, its square where residuals are squared, and by lengths.
    const double allowed = 100 / kGain / kLeastDeterminant * std::max(1.0, base_.mechanism->largest_length());
    for (std::size_t p = plan_.fixed; p < plan_.points.size(); ++p) {
      const auto point = base_.mechanism->find_point(point_name(p)).value();
      const auto x = table.find(point_name(p) + ".x");
      if (!x) continue;
      for (std::size_t row = 0; row < table.rows(); ++row) {
        const Eigen::Vector2d analog(table.at(row, *x), table.at(row, *x + 1));
        const double error = (analog - base_.motion->configurations[row].points[point].position).norm();
        if (error <= allowed) continue;
        return report(fmt::format("patched by {}: {} errs by {} in row {}", patch::method_name(method),
                                  point_name(p), error, row),
                      diagram::write_diagram(*diagram));
      }
    }
    return "";
  }

  const MechanismPlan& plan_;
  std::string text_;
  Way base_;
  bool compared_ = false;
};

}  // namespace

Verdict examine_mechanism(std::string_view bytes) {
  Dice dice(bytes);
  const std::size_t oracle = dice.below(6);
  const MechanismPlan plan = plan_mechanism(dice);
  try {
    MechanismExamination examination(plan);
    Verdict verdict{examination.fault(oracle), false};
    verdict.compared = examination.compared();
    return verdict;
  } catch (const std::exception& error) {
    return {fmt::format("an exception of no stage: {}\n{}", error.what(), text_of(plan)), false};
  }
}

}  // namespace oblique::fuzz
