// SPDX-License-Identifier: MIT
#include "whole_way.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>

#include "agreement.h"
#include "random_diagram.h"
#include "trial.h"

namespace oblique::fuzz {
namespace {

using End = Trial::End;

std::string_view end_name(End end) {
  constexpr std::string_view kNames[] = {"clean", "warned", "refused", "over budget", "broken"};
  return kNames[static_cast<std::size_t>(end)];
}

bool tells(const Trial& trial, std::string_view what) {
  return trial.says.find(what) != std::string::npos;
}

bool leaves_the_machine(const Trial& trial) {
  return tells(trial, "leaves the machine");
}

/// Whether one run chose among several solutions of an algebraic loop, which nothing in the diagram does, or
/// found only one that amplifiers do not hold. The order of the blocks says which element is the unknown, and
/// so from where the others are sought: what the one run sees the other may not (see known-gaps.md), and
/// either solution is right.
bool chooses_blindly(const Trial& trial) {
  return tells(trial, "has several solutions") || tells(trial, "where a machine would not settle");
}

/// Whether the run tells of something that rounding alone has done: it was pushed off an unstable
/// equilibrium, a switch turned over by errors, a state that is nothing but rounding is read. Where rounding
/// is another, it may not be done, which is as right: then there is nothing to tell.
bool is_moved_by_rounding(const Trial& trial) {
  constexpr double kRounding = 1e-13;  // [machine unit], as far as the gain of amplifiers magnifies it
  const auto is_within = [&](std::string_view words) {
    const std::size_t at = trial.message.find(words);
    return at != std::string::npos &&
           std::strtod(trial.message.c_str() + at + words.size(), nullptr) < kRounding;
  };
  const auto says = [&](std::string_view words) { return trial.message.find(words) != std::string::npos; };
  return says("to which side it goes") || says("no digit of the output") || says("it could as well stay") ||
         says("when it leaves is known only roughly") ||
         (tells(trial, "of an unstable equilibrium") && is_within("from within ")) ||
         (tells(trial, "too small for the finest tolerance") && is_within("stays within ")) ||
         tells(trial, "which is its error");
}

/// Whether all that a run tells hangs on how near to its level something lies: that it depends on a switch
/// that slides, or that a comparison lies on the other side by less than its error. What decays to its level
/// comes there by the errors of the states alone: of two runs one may tell of it and the other not, as the
/// absolute tolerance is not scaled with the values (see known-gaps.md). Their outputs are the same.
bool tells_of_levels_alone(const Trial& trial) {
  std::string_view rest = trial.says;
  for (std::size_t end = 0; (end = rest.find(';')) != std::string_view::npos; rest.remove_prefix(end + 1)) {
    const std::string_view warning = rest.substr(0, end);
    if (warning.find(" depends on , which slides along its switching surface") == std::string_view::npos &&
        warning.find(") slides along its switching surface from ") == std::string_view::npos &&
        warning.find(", though what it compares lies on the other side") == std::string_view::npos)
      return false;
  }
  return trial.end == End::warned;
}

/// Whether a run does not begin because no rest, no initial values, no positions of switches in a loop or no
/// regular solution of it were found. They are sought from one element to the next, in the order of the
/// diagram and by the sizes that its signals have: another order may find what this one does not (see
/// known-gaps.md), and to refuse is not to answer wrongly.
bool sought_in_vain(const Trial& trial) {
  constexpr std::string_view kInVain[] = {"not come to rest", "no position of its switch agrees",
                                          "follow from each other in a circle", "is singular at t = 0 s",
                                          "has no solution near"};
  return trial.end == End::refused &&
         std::any_of(std::begin(kInVain), std::end(kInVain),
                     [&](std::string_view words) { return trial.message.find(words) != std::string::npos; });
}

/// A thousand tolerances: a run is calibrated to some ten, and the worst of smooth problems has sixty.
constexpr double kTolerances = 1e3;

/// [machine unit] within which a comparison that comes to rest at its level has no certain result: ten times
/// what the engine takes for the level itself (see known-gaps.md).
constexpr double kOfLevels = 1e-12;

class Examination {
 public:
  explicit Examination(const DiagramPlan& plan)
      : plan_(plan), text_(text_of(plan)), base_(try_diagram(text_)) {}

  std::string fault(std::size_t oracle) {
    if (base_.end == End::broken) return report("the run is broken: " + base_.says, "");
    if (base_.end == End::over_budget) return "";
    // Whatever the generator writes is a diagram.
    if (base_.says == "diagram") return report("a diagram that is one is refused: " + base_.message, "");
    switch (oracle) {
      case 0:
        return renamed();
      case 1:
        return reordered();
      case 2:
        return scaled(2, 1, "scaled by 2");
      case 3:
        return scaled(1, 2, "slowed down by 2");
      case 4:
        return split();
      case 5:
        return by_method(diagram::IntegrationMethod::adams) + by_method(diagram::IntegrationMethod::bdf) +
               by_method(diagram::IntegrationMethod::rodas);
      default:
        return to_tolerance();
    }
  }

  bool compared() const { return compared_; }

 private:
  std::string report(const std::string& what, const std::string& other) const {
    std::string out = fmt::format("{}\n--- the diagram, {} {}\n{}{}", what, end_name(base_.end),
                                  base_.message, base_.message.empty() ? "" : "\n", text_);
    if (!other.empty()) out += "--- the other\n" + other;
    return out;
  }

  /// Both must end alike; then outputs must agree, exactly where no rounding differs.
  std::string alike(const Trial& other, const std::string& text, const std::string& how, double time,
                    bool exactly, bool is_scaled = false) {
    if (other.end == End::over_budget) return "";
    if (is_scaled && (leaves_the_machine(base_) || leaves_the_machine(other))) return "";
    // Of two things that are wrong, the order decides which is met first.
    if (!exactly && other.end == End::refused && base_.end == End::refused) return "";
    if (other.end != base_.end || other.says != base_.says) {
      if (!exactly && (is_moved_by_rounding(base_) || is_moved_by_rounding(other))) return "";
      if (!exactly && (sought_in_vain(base_) || sought_in_vain(other))) return "";
      if (!exactly && (chooses_blindly(base_) || chooses_blindly(other))) return "";
      if (!exactly && base_.run && other.run &&
          (tells_of_levels_alone(base_) || tells_of_levels_alone(other)))
        return same_outputs(other, text, how, 0, time);
      if (!exactly && is_on_an_edge()) return "";
      return report(fmt::format("{}: ends '{}' {}: {}", how, end_name(other.end), other.says, other.message),
                    text);
    }
    if (!base_.run) return "";
    compared_ = base_.end == End::clean;
    if (!exactly) return agreement(other, text, how, 0, time);
    const auto difference = find_difference({*base_.run, *other.run}, 0, [](auto, auto) { return 0.0; });
    return difference ? differs(*difference, how, text) : "";
  }

  std::string renamed() {
    Writing writing;
    writing.names = Writing::Names::falling;
    const std::string text = text_of(plan_, writing);
    std::string fault = alike(try_diagram(text), text, "renamed", 1, true);
    if (!fault.empty()) return fault;
    const std::string written = diagram::write_diagram(diagram::parse_diagram(text_, "fuzz.toml"));
    return alike(try_diagram(written), written, "written and read back", 1, true);
  }

  std::string reordered() {
    Writing writing;
    writing.order.resize(plan_.blocks.size());
    std::iota(writing.order.begin(), writing.order.end(), 0);
    std::reverse(writing.order.begin(), writing.order.end());
    const std::string text = text_of(plan_, writing);
    return alike(try_diagram(text), text, "in the opposite order", 1, false);
  }

  std::string scaled(double value, double time, const std::string& how) {
    if (!can_be_scaled(plan_)) return "";
    Writing writing;
    writing.value = value;
    writing.time = time;
    const std::string text = text_of(plan_, writing);
    return alike(try_diagram(text), text, how, time, false, value != 1);
  }

  std::string split() {
    if (base_.end != End::clean) return "";
    const solve::Run& whole = *base_.run;
    const std::size_t middle = whole.trajectory.rows() / 2;
    TrialOptions options;
    options.until = whole.trajectory.at(middle, 0);
    options.samples = static_cast<int>(middle + 1);
    const Trial first = try_diagram(text_, options);
    if (first.end == End::broken) return report("its first half is broken: " + first.says, "");
    if (first.end != End::clean) return "";
    options.from = solve::parse_run_state(solve::to_text(first.run->state), "state.toml");
    options.until = plan_.until;
    const Trial second = try_diagram(text_, options);
    if (second.end == End::broken) return report("its second half is broken: " + second.says, "");
    return agreement(second, solve::to_text(*options.from), "from its middle", middle, 1);
  }

  std::string by_method(diagram::IntegrationMethod method) {
    TrialOptions options;
    options.method = method;
    return unlike(options, fmt::format("by {}", diagram::method_name(method)));
  }

  std::string to_tolerance() {
    TrialOptions options;
    options.tolerance = plan_.tolerance / 100;
    return unlike(options, "to a finer tolerance");
  }

  /// Another run of the same text, which may end otherwise.
  std::string unlike(const TrialOptions& options, const std::string& how) {
    const Trial other = try_diagram(text_, options);
    if (other.end == End::broken) return report(how + ": broken: " + other.says, "");
    return agreement(other, "", how, 0, 1);
  }

  /// The outputs of two clean runs.
  std::string agreement(const Trial& other, const std::string& text, const std::string& how,
                        std::size_t first, double time) {
    if (base_.end != End::clean || other.end != End::clean) return "";
    compared_ = true;
    return same_outputs(other, text, how, first, time);
  }

  std::string same_outputs(const Trial& other, const std::string& text, const std::string& how,
                           std::size_t first, double time) {
    const Beside runs{*base_.run, *other.run, first, time};
    const double tolerance = plan_.tolerance;
    const double small = kTolerances * tolerance * std::max(1.0, size_of(*base_.run));
    const auto alike_everywhere = find_difference(runs, tolerance, [&](auto, auto) { return small; });
    if (!alike_everywhere) return "";
    if (!disturb()) return "";
    const auto difference = find_difference(runs, tolerance, [&](std::size_t row, std::size_t column) {
      return small + kRoom * disturbed_[row * columns() + column];
    });
    return difference ? differs(*difference, how, text) : "";
  }

  /// Whether the diagram ends otherwise where its numbers are disturbed, too.
  bool is_on_an_edge() const {
    for (std::uint32_t signs = 1; signs <= kDisturbances; ++signs) {
      const Trial trial = try_diagram(text_of(plan_, disturbed(signs)));
      if (trial.end != base_.end || trial.says != base_.says) return true;
    }
    return false;
  }

  Writing disturbed(std::uint32_t signs) const {
    Writing writing;
    writing.disturbance = kTolerances * plan_.tolerance;
    writing.offset = kOfLevels;
    writing.signs = signs;
    return writing;
  }

  std::size_t columns() const { return base_.run->trajectory.columns().size(); }

  /// By how much the outputs move where the numbers of the diagram are disturbed, up to each row. False where
  /// such a diagram does not run clean: then this one is at an edge, and tells nothing.
  bool disturb() {
    if (!disturbed_.empty()) return true;
    const solve::Trajectory& table = base_.run->trajectory;
    disturbed_.assign(table.values().size(), 0);
    for (std::uint32_t signs = 1; signs <= kDisturbances; ++signs) {
      const Trial trial = try_diagram(text_of(plan_, disturbed(signs)));
      if (trial.end != End::clean) return false;
      const solve::Trajectory& moved = trial.run->trajectory;
      for (std::size_t k = 0; k < disturbed_.size(); ++k)
        disturbed_[k] = std::max(disturbed_[k], std::abs(moved.values()[k] - table.values()[k]));
    }
    for (std::size_t k = columns(); k < disturbed_.size(); ++k)
      disturbed_[k] = std::max(disturbed_[k], disturbed_[k - columns()]);
    return true;
  }

  std::string differs(const Difference& difference, const std::string& how, const std::string& text) const {
    return report(fmt::format("{}: {} at t = {} is {} instead of {}, allowed {:.2g}", how,
                              base_.run->trajectory.columns()[difference.column].name, difference.time,
                              difference.b, difference.a, difference.allowed),
                  text);
  }

  /// So many that one of them, almost surely, breaks a tie of two events either way.
  static constexpr std::uint32_t kDisturbances = 8;
  static constexpr double kRoom = 10;  ///< a few disturbances are not the worst one

  const DiagramPlan& plan_;
  std::string text_;
  Trial base_;
  bool compared_ = false;
  std::vector<double> disturbed_;  ///< as the values of the trajectory
};

}  // namespace

Verdict examine_diagram(std::string_view bytes) {
  Dice dice(bytes);
  const std::size_t oracle = dice.below(7);
  const DiagramPlan plan = plan_diagram(dice);
  Examination examination(plan);
  Verdict verdict{examination.fault(oracle), false};
  verdict.compared = examination.compared();
  return verdict;
}

}  // namespace oblique::fuzz
