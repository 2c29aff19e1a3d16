// SPDX-License-Identifier: MIT
#include <oblique/compare/machine_comparison.h>

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include <oblique/compare/patched_run.h>
#include <oblique/machine/component_list.h>
#include <oblique/machine/realise.h>
#include <oblique/solve/solve_error.h>

namespace oblique::compare {
namespace {

bool has_setting(const diagram::BlockInstance& block, const std::string& key) {
  return std::any_of(block.settings.begin(), block.settings.end(),
                     [&](const text::Entry& entry) { return entry.key == key; });
}

void set(diagram::BlockInstance& block, const std::string& key, double value) {
  std::erase_if(block.settings, [&](const text::Entry& entry) { return entry.key == key; });
  block.settings.push_back(diagram::number_setting(key, value));
}

/// The same elements without errors; amplifiers that take their gain from the machine get that of the patch.
diagram::Diagram on_ideal_elements(diagram::Diagram diagram, const diagram::BlockLibrary& library,
                                   double gain) {
  diagram.machine.profile = "ideal";
  for (diagram::BlockInstance& block : diagram.blocks) {
    const bool is_open = library.find(block.type)->role == diagram::Role::open_amplifier;
    if (is_open && !has_setting(block, "gain")) set(block, "gain", gain);
  }
  return diagram;
}

/// A figure and a kind of block on which it acts.
struct Acting {
  std::string figure, block;
  bool operator==(const Acting&) const = default;
};

/// Whether an error acts on a block of a realised diagram, whose types the library has.
bool acts_on(const diagram::BlockFigure& error, const diagram::BlockInstance& block,
             const diagram::BlockLibrary& library) {
  return error.acts_on(*library.find(block.type)).has_value();
}

/// Ideal elements but for one figure on one kind of block, where the diagram itself does not say otherwise.
diagram::Diagram with_figure(const diagram::Diagram& realised, diagram::Diagram ideal,
                             const diagram::BlockLibrary& library, const diagram::MachineProfile& machine,
                             const Acting& acting) {
  for (const diagram::BlockFigure& error : machine.errors) {
    if (Acting{error.figure, error.block} != acting) continue;
    for (std::size_t b = 0; b < ideal.blocks.size(); ++b) {
      const bool acts =
          acts_on(error, ideal.blocks[b], library) && !has_setting(realised.blocks[b], error.parameter);
      if (acts) set(ideal.blocks[b], error.parameter, error.value);
    }
  }
  return ideal;
}

/// What acts on blocks of the diagram, each once.
std::vector<Acting> acting_figures(const diagram::MachineProfile& machine,
                                   const diagram::BlockLibrary& library, const diagram::Diagram& diagram) {
  std::vector<Acting> found;
  for (const diagram::BlockFigure& error : machine.errors) {
    const Acting acting{error.figure, error.block};
    const bool used =
        std::any_of(diagram.blocks.begin(), diagram.blocks.end(),
                    [&](const diagram::BlockInstance& block) { return acts_on(error, block, library); });
    if (used && std::find(found.begin(), found.end(), acting) == found.end()) found.push_back(acting);
  }
  return found;
}

std::vector<std::string> scatter_figures(const diagram::MachineProfile& machine) {
  std::vector<std::string> names;
  for (const diagram::BlockFigure& scatter : machine.scatters) {
    if (std::find(names.begin(), names.end(), scatter.figure) == names.end()) names.push_back(scatter.figure);
  }
  return names;
}

/// Where `points` of two runs are farthest from each other [length unit].
double largest_distance(const mechanism::Mechanism& mechanism, const PatchedMechanism& patched,
                        const solve::Trajectory& a, const solve::Trajectory& b) {
  double largest = 0;
  for (const PointOutputs& point : point_outputs(mechanism, patched.flat)) {
    for (std::size_t row = 0; row < a.rows(); ++row)
      largest = std::max(largest, (place_of(point, a, row) - place_of(point, b, row)).norm());
  }
  return largest;
}

/// A cosine of 1 passes the machine unit by the errors of real elements; no machine overloads for so little.
constexpr double kMargin = 0.02;

}  // namespace

double MachineComparison::explained() const {
  double sum = ideal_share;
  for (const FigureError& figure : figures) sum += figure.share;
  return sum / max_error;
}

MachineComparison compare_on_machine(const mechanism::Mechanism& whole, const diagram::BlockLibrary& library,
                                     const diagram::MachineProfile& machine,
                                     const patch::PatchOptions& options,
                                     const std::function<void(double)>& progress) {
  const mechanism::Mechanism mechanism = patch::within_range(whole);
  diagram::Diagram realised = machine::realise(patch_named(mechanism, options), library, machine).diagram;
  const mechanism::Motion exact = mechanism::solve_motion(mechanism, options.samples);
  const std::vector<Acting> figures = acting_figures(machine, library, realised);
  double done = 0;
  const auto run_of = [&](const PatchedMechanism& diagram, const std::string& name) {
    const auto total = static_cast<double>(figures.size() + 2);
    RecordedRun recorded = run_recorded(diagram, name, options.tolerance, [&](double fraction) {
      if (progress) progress((done + fraction) / total);
    });
    ++done;
    return recorded;
  };

  const PatchedMechanism none(on_ideal_elements(realised, library, options.gain), library);
  const solve::Run ideal_run = run_of(none, "ideal elements").run;
  const solve::Trajectory& on_ideal = ideal_run.trajectory;
  realised.run.max_steps = kStepsOfAFailure * ideal_run.statistics.steps;
  const diagram::Diagram ideal = on_ideal_elements(realised, library, options.gain);
  const PatchedMechanism all(realised, library);
  const RecordedRun on_machine = run_of(all, "all figures of " + machine.title);
  const solve::Trajectory& analog = on_machine.run.trajectory;
  const Distances error = distances(mechanism, all.flat, analog, exact);
  const Eigen::Vector2d& there = exact.configurations[error.row].points[error.worst.point].position;
  const Eigen::Vector2d along = (place_of(error.worst, analog, error.row) - there).normalized();
  const Eigen::Vector2d by_ideal = place_of(error.worst, on_ideal, error.row);

  MachineComparison result;
  result.machine = machine.title;
  result.absent = machine::component_list_of(all.flat, machine).absent();
  result.scatter = scatter_figures(machine);
  result.max_error = error.largest;
  result.rms_error = error.rms;
  result.from_ideal = largest_distance(mechanism, all, analog, on_ideal);
  result.ideal_error = distances(mechanism, none.flat, on_ideal, exact).largest;
  result.worst = {mechanism.points[error.worst.point].name,
                  exact.times[error.row],
                  exact.drives[error.row].front().value,
                  {}};
  result.ideal_share = along.dot(by_ideal - there);
  for (const Acting& acting : figures) {
    const PatchedMechanism one(with_figure(realised, ideal, library, machine, acting), library);
    const solve::Trajectory alone =
        run_of(one, fmt::format("nothing but '{}' of each {}", acting.figure, acting.block)).run.trajectory;
    result.figures.push_back({acting.figure, acting.block, largest_distance(mechanism, one, alone, on_ideal),
                              along.dot(place_of(error.worst, alone, error.row) - by_ideal) + 0.0});  // no −0
  }
  result.overloads = overloads_of(all.program, on_machine.run, kMargin);
  result.stable = slowest_pole_of(all.program, on_machine.instants) < 0;
  return result;
}

MachineComparison compare_on_machine(const solve::Trajectory& reference, diagram::Diagram realised,
                                     const diagram::BlockLibrary& library,
                                     const diagram::MachineProfile& machine,
                                     const std::function<void(double)>& progress) {
  constexpr double kUsualGain = 1e6;
  const std::vector<Acting> figures = acting_figures(machine, library, realised);
  realised.run.samples = static_cast<int>(reference.rows());
  const diagram::Diagram ideal = on_ideal_elements(realised, library, kUsualGain);
  double done = 0;
  const auto run_of = [&](const PatchedMechanism& diagram, const std::string& name) {
    const auto total = static_cast<double>(figures.size() + 2);
    RecordedRun recorded = run_recorded(diagram, name, realised.run.tolerance, [&](double fraction) {
      if (progress) progress((done + fraction) / total);
    });
    ++done;
    return recorded;
  };
  const PatchedMechanism none(ideal, library);
  const RecordedRun on_ideal = run_of(none, "ideal elements");
  realised.run.max_steps = kStepsOfAFailure * std::max(on_ideal.run.statistics.steps, std::int64_t{1});
  const PatchedMechanism all(realised, library);
  const RecordedRun on_machine = run_of(all, "all figures of " + machine.title);
  const solve::Trajectory& analog = on_machine.run.trajectory;
  const Distances error = relative_distances(analog.values(), reference);
  const std::size_t column = 1 + error.worst.point;
  const double size = largest_of(reference, column);
  const double by_ideal = on_ideal.run.trajectory.at(error.row, column);
  const double sign = analog.at(error.row, column) < reference.at(error.row, column) ? -1 : 1;

  MachineComparison result;
  result.machine = machine.title;
  result.absent = machine::component_list_of(all.flat, machine).absent();
  result.scatter = scatter_figures(machine);
  result.max_error = error.largest;
  result.rms_error = error.rms;
  result.from_ideal = relative_distances(analog.values(), on_ideal.run.trajectory).largest;
  result.ideal_error = relative_distances(on_ideal.run.trajectory.values(), reference).largest;
  result.worst = {reference.columns()[column].name, analog.at(error.row, 0), 0, {}};
  result.ideal_share = sign * (by_ideal - reference.at(error.row, column)) / size;
  for (const Acting& acting : figures) {
    const PatchedMechanism one(with_figure(realised, ideal, library, machine, acting), library);
    const solve::Trajectory alone =
        run_of(one, fmt::format("nothing but '{}' of each {}", acting.figure, acting.block)).run.trajectory;
    result.figures.push_back({acting.figure, acting.block,
                              relative_distances(alone.values(), on_ideal.run.trajectory).largest,
                              sign * (alone.at(error.row, column) - by_ideal) / size + 0.0});  // no −0
  }
  result.overloads = overloads_of(all.program, on_machine.run, kMargin);
  result.stable = slowest_pole_of(all.program, on_machine.instants) < 0;
  return result;
}

}  // namespace oblique::compare
