// SPDX-License-Identifier: MIT
#include <oblique/synthesis/mode_choice.h>

#include <algorithm>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/solver/kinematics.h>
#include <oblique/synthesis/sketch_edit.h>

namespace oblique::synthesis {
namespace {

/// Where a mechanism starts, groups that its sketch does not decide in their first mode; nothing where one of
/// these places `point`.
std::optional<mechanism::Configuration> start_of(const mechanism::Mechanism& mechanism, std::size_t point) {
  mechanism::Structure structure = mechanism::find_groups(mechanism);
  for (const std::size_t undecided : mechanism::choose_some_modes(mechanism, structure)) {
    const std::vector<std::size_t>& points = structure.groups[undecided].points;
    if (std::find(points.begin(), points.end(), point) != points.end()) return std::nullopt;
  }
  return mechanism::start_configuration(mechanism, structure);
}

bool stands_in(const mechanism::AssemblyMode& mode, const mechanism::Configuration& start, double size) {
  constexpr double kOneMode = 1e-7;  // modes are farther apart, or they are one
  for (std::size_t k = 0; k < mode.points.size(); ++k) {
    if (!((start.points[mode.points[k]].position - mode.positions[k]).norm() <= kOneMode * size))
      return false;
  }
  return true;
}

}  // namespace

ModeChoice choose_mode(const std::string& text, const mechanism::Mechanism& mechanism,
                       const mechanism::AssemblyMode& mode) {
  std::vector<mechanism::SketchPoint> points;
  points.reserve(mode.points.size());
  for (std::size_t k = 0; k < mode.points.size(); ++k) points.push_back({mode.points[k], mode.positions[k]});
  ModeChoice choice;
  choice.why = "no sketch picks it";
  for (const NewPoints new_points : {NewPoints::leave_out, NewPoints::add}) {
    try {
      std::string edited = with_sketch(text, mechanism, points, new_points);
      const auto start = start_of(mechanism::parse_mechanism(edited, mechanism.file), mode.points.front());
      if (!start || !stands_in(mode, *start, mechanism.largest_length())) continue;
      choice.start = *start;
      choice.text = std::move(edited);
      choice.why.clear();
      return choice;
    } catch (const text::Error& error) {
      choice.why = error.diagnostics().front().what;
    }
  }
  return choice;
}

}  // namespace oblique::synthesis
