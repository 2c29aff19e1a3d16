// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/plan_reader.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/flatten.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/ensemble/study/diagram_subject.h>
#include <oblique/ensemble/study/mechanism_subject.h>
#include <oblique/ensemble/study/study.h>

namespace oblique::ensemble {
namespace {

constexpr double kMostTolerance = 0.5;  // a factor of two is no tolerance any more
constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 32;

class PlanReader {
 public:
  PlanReader(const Plan& plan, const std::string& text, const diagram::BlockLibrary& library)
      : plan_(plan), library_(library) {
    result_.subject =
        plan.mechanism ? mechanism_subject(plan, text, library) : diagram_subject(plan, text, library);
    result_.seed = plan.seed;
    result_.mechanism = plan.mechanism;
  }

  Understood read() {
    for (const Variation& variation : plan_.vary) add(variation);
    add_scatters();
    choose_combinations();
    std::vector<Measure> measures = plan_.measures;
    if (measures.empty()) measures = result_.subject->usual_measures();
    for (const Measure& measure : measures) add(measure);
    check_run();
    findings_.throw_if_any<StudyError>();
    return std::move(result_);
  }

 private:
  void report(const text::Place& place, std::string what, std::string expected = {},
              text::Remedy remedy = {}) {
    findings_.add({place, std::move(what), std::move(expected), std::move(remedy)});
  }

  /// What an error says, at a place of the plan.
  void report(const text::Place& place, const std::string& subject, const text::Error& error) {
    for (const text::Diagnostic& found : error.diagnostics())
      report(place, subject + found.what, found.expected, found.remedy);
  }

  void add(const Variation& variation) {
    const bool twice =
        std::find(result_.names.begin(), result_.names.end(), variation.name) != result_.names.end();
    if (twice) {
      report(variation.place, fmt::format("'{}' is varied twice", variation.name), "each name once");
      return;
    }
    try {
      const text::Unit unit = result_.subject->unit_of(variation.name);
      Levels levels(variation.values, unit);
      if (plan_.sampling == Sampling::grid && levels.grid().empty()) {
        report(variation.place,
               fmt::format("the range '{}' of '{}' does not say how many values it has", variation.values,
                           variation.name),
               fmt::format("'{}:5', for example", variation.values));
        return;
      }
      const double usual = result_.subject->vary(variation.name, levels.lowest(), levels.highest());
      result_.names.push_back(variation.name);
      result_.units.push_back(unit.name);
      result_.lowest.push_back(levels.lowest());
      result_.usual.push_back(usual);
      result_.highest.push_back(levels.highest());
      result_.logarithmic.push_back(levels.logarithmic());
      levels_.push_back(std::move(levels));
    } catch (const text::ExpressionError& error) {
      report(variation.place, fmt::format("values of '{}': {}", variation.name, error.what), error.expected,
             error.remedy);
    } catch (const text::Error& error) {
      report(variation.place, "", error);
    }
  }

  void add_scatters() {
    const diagram::Diagram& diagram = result_.subject->diagram();
    const diagram::FlatDiagram flat = diagram::flatten(diagram, library_);
    for (const Scattered& scatter : plan_.scatter) {
      const diagram::BlockDefinition* const definition = library_.find(scatter.block);
      if (definition == nullptr) {
        report(scatter.place, fmt::format("there is no type of block '{}'", scatter.block), {},
               text::suggest(scatter.block, types_of(flat)));
        continue;
      }
      const auto parameter = definition->find_parameter(scatter.parameter);
      if (!parameter) {
        std::vector<std::string> names;
        for (const auto& known : definition->parameters) names.push_back(known.name);
        report(scatter.place,
               fmt::format("'{}' of block type '{}' is not a parameter", scatter.parameter, scatter.block),
               {}, text::suggest(scatter.parameter, names));
        continue;
      }
      if (!(scatter.half_width > 0 && std::isfinite(scatter.half_width))) {
        report(scatter.place,
               fmt::format("'{}.{}' scatters by ±{}", scatter.block, scatter.parameter, scatter.half_width),
               "a finite number above 0");
        continue;
      }
      const std::string& unit = definition->parameters[*parameter].unit;
      if (scatter.in_percent && !is_part_of_one(scatter, unit, flat)) continue;
      add_scatter({scatter.block, scatter.parameter, scatter.half_width, "scatter", definition->role}, flat,
                  scatter.place);
    }
    if (plan_.tolerance_of_elements != 0) {
      if (!(plan_.tolerance_of_elements > 0 && plan_.tolerance_of_elements <= kMostTolerance)) {
        report({plan_.file, {}}, fmt::format("the elements' tolerance is {}", plan_.tolerance_of_elements),
               "a number above 0 and up to 50%");
      } else {
        add_all(scatters_of_tolerance(library_, plan_.tolerance_of_elements));
      }
    }
    if (!plan_.machine.empty()) {
      const diagram::MachineProfile* const machine = diagram::find_machine(plan_.machine);
      if (machine == nullptr) {
        findings_.add(diagram::unknown_machine(plan_.machine, {plan_.file, {}}));
      } else if (machine->scatters.empty()) {
        report({plan_.file, {}},
               fmt::format("nothing is published of how the elements of {} scatter", machine->title),
               "a tolerance of the elements, such as 0.1%");
      } else {
        add_all(machine->scatters);
      }
    }
    n_drawn_ = drawn_elements(flat, result_.scatters).size();
    if (n_drawn_ == 0 && !result_.scatters.empty() && findings_.empty())
      report({plan_.file, {}}, "no block of the diagram has a parameter that scatters");
  }

  /// Whether what scatters by a percentage is a number without a unit, and nowhere beyond 1: it is one of 1,
  /// not of the value.
  bool is_part_of_one(const Scattered& scatter, const std::string& unit, const diagram::FlatDiagram& flat) {
    const auto wanted = text::parse_unit(unit);
    if (wanted && !text::factor_between(text::parse_unit("%").value(), *wanted)) {
      report(scatter.place,
             fmt::format("'{}.{}' is in {}, and {:.6g} % is not", scatter.block, scatter.parameter, unit,
                         100 * scatter.half_width),
             fmt::format("half the width in {}, without %", unit));
      return false;
    }
    const diagram::BlockFigure figure{scatter.block, scatter.parameter, scatter.half_width, "scatter"};
    const auto value_of = [&](const DrawnElement& element) {
      return flat.blocks[element.block].parameters[element.parameter];
    };
    const std::vector<DrawnElement> drawn = drawn_elements(flat, {figure});
    const auto beyond = std::find_if(drawn.begin(), drawn.end(), [&](const DrawnElement& element) {
      return std::isfinite(value_of(element)) && std::abs(value_of(element)) > 1;
    });
    if (beyond == drawn.end()) return true;
    const double value = value_of(*beyond), size = std::abs(value);
    report(scatter.place,
           fmt::format("'{}.{}' is {:.6g}, and {:.6g} % is ±{:.6g}, not a part of it",
                       flat.blocks[beyond->block].path, scatter.parameter, value, 100 * scatter.half_width,
                       scatter.half_width),
           "half the width itself, without %",
           fmt::format("write {:.6g} for that, or {:.6g} for {:.6g} % of {:.6g}", scatter.half_width,
                       scatter.half_width * size, 100 * scatter.half_width, size));
    return false;
  }

  static std::vector<std::string> types_of(const diagram::FlatDiagram& flat) {
    std::vector<std::string> types;
    for (const diagram::FlatBlock& block : flat.blocks) {
      if (std::find(types.begin(), types.end(), block.definition->name) == types.end())
        types.push_back(block.definition->name);
    }
    return types;
  }

  void add_scatter(diagram::BlockFigure scatter, const diagram::FlatDiagram& flat, const text::Place& place) {
    if (drawn_elements(flat, {scatter}).empty()) {
      report(place, fmt::format("no block of the diagram is a '{}', so that none scatters", scatter.block),
             {}, text::suggest(scatter.block, types_of(flat)));
      return;
    }
    const bool twice =
        std::any_of(result_.scatters.begin(), result_.scatters.end(), [&](const diagram::BlockFigure& other) {
          return other.block == scatter.block && other.parameter == scatter.parameter;
        });
    if (twice) {
      report(place, fmt::format("'{}.{}' scatters twice", scatter.block, scatter.parameter), "each once");
      return;
    }
    if (stays_allowed(scatter, flat, place)) result_.scatters.push_back(std::move(scatter));
  }

  /// Whether nothing that a scatter names may draw what it may not be, wherever it is varied to.
  bool stays_allowed(const diagram::BlockFigure& scatter, const diagram::FlatDiagram& flat,
                     const text::Place& place) {
    if (!keeps_range(scatter, flat, place)) return false;
    for (std::size_t k = 0; k < result_.names.size(); ++k) {
      for (const double bound : {result_.lowest[k], result_.highest[k]}) {
        std::vector<double> values = result_.usual;
        values[k] = bound;
        try {
          if (!keeps_range(scatter, result_.subject->machine(values).flat, place)) return false;
        } catch (const text::Error&) {
          // a machine that there is not: its row says so
        }
      }
    }
    return true;
  }

  bool keeps_range(const diagram::BlockFigure& scatter, const diagram::FlatDiagram& flat,
                   const text::Place& place) {
    const std::vector<DrawnElement> elements = drawn_elements(flat, {scatter});
    return std::all_of(elements.begin(), elements.end(), [&](const DrawnElement& element) {
      const diagram::FlatBlock& block = flat.blocks[element.block];
      const diagram::ParameterDefinition& parameter = block.definition->parameters[element.parameter];
      const double value = block.parameters[element.parameter];
      if (parameter.allows(value - scatter.value) && parameter.allows(value + scatter.value)) return true;
      report(
          place,
          fmt::format("'{}.{}' is {}, and scatters by ±{}", block.path, parameter.name, value, scatter.value),
          fmt::format("a half width that keeps it {}", parameter.range()));
      return false;
    });
  }

  /// Those that were not given by themselves.
  void add_all(const std::vector<diagram::BlockFigure>& scatters) {
    for (const diagram::BlockFigure& scatter : scatters) {
      const bool known = std::any_of(
          result_.scatters.begin(), result_.scatters.end(), [&](const diagram::BlockFigure& other) {
            return other.block == scatter.block && other.parameter == scatter.parameter;
          });
      if (!known) result_.scatters.push_back(scatter);
    }
  }

  void choose_combinations() {
    const text::Place place{plan_.file, {}};
    const bool scatters = !result_.scatters.empty();
    if (!findings_.empty()) return;
    if (levels_.empty() && !scatters) {
      report(place, "nothing is varied and nothing scatters, so that all machines are one",
             "names with values, such as c.gain=1e2..1e6:5:log");
      return;
    }
    const bool is_grid = plan_.sampling == Sampling::grid;
    if (plan_.runs && *plan_.runs == 0) report(place, "a study of no runs", "1 or more");
    if (is_grid && !plan_.runs && levels_.empty()) {
      report(place, "it is not said how many machines draw", "a number of runs");
    } else if (is_grid && plan_.runs && !scatters) {
      report(place, fmt::format("{} runs of each combination would be the same one", *plan_.runs),
             "no number of runs with a grid, or elements that scatter");
    } else if (!is_grid && levels_.empty()) {
      report(place, "there are no names whose values a Latin hypercube or a Sobol sequence chooses",
             "names with ranges, such as c.gain=1e2..1e6:log");
    } else if (!is_grid && !plan_.runs) {
      report(place, "it is not said how many points are to be chosen", "a number of runs");
    } else if (!is_grid && *plan_.runs >= kMostPoints) {
      report(place, fmt::format("{} points are too many", *plan_.runs), fmt::format("below {}", kMostPoints));
    } else if (plan_.sampling == Sampling::sobol && levels_.size() > kMostSobolDimensions) {
      report(place, fmt::format("{} names are varied along a Sobol sequence", levels_.size()),
             fmt::format("at most {}", kMostSobolDimensions), "a Latin hypercube takes any number");
    } else if (is_grid) {
      constexpr std::uint64_t kMost = std::uint64_t{1} << 53;
      const auto size = grid_size(levels_);
      if (!size || *size > kMost / plan_.runs.value_or(1))
        report(place, "the combinations are more than can be numbered", fmt::format("at most {}", kMost));
    }
    if (findings_.empty())
      result_.combinations = Combinations(levels_, plan_.sampling, plan_.runs, plan_.seed);
  }

  void add(const Measure& measure) {
    const std::string& name = measure.name.empty() ? measure.expression : measure.name;
    const auto taken = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    if (taken(result_.measure_names) || taken(result_.names)) {
      report(measure.place, fmt::format("two columns are called '{}'", name), "names of their own");
      return;
    }
    try {
      MeasureProgram program(measure.expression, plan_.mechanism, result_.subject->output_names(),
                             [&](const std::string& column) { return column_of(column); });
      if (program.asks_for_errors() && !result_.asks_for_errors) {
        result_.asks_for_errors = true;
        result_.subject->add_error_outputs();
      }
      result_.measures.push_back(std::move(program));
      result_.measure_names.push_back(name);
    } catch (const text::ExpressionError& error) {
      text::Place place = measure.place;
      if (place.position.column > 0) place.position.column += error.column;
      const bool told = !place.setting.name.empty();  // by the place itself
      report(place, (told ? "" : fmt::format("measure '{}': ", measure.expression)) + error.what,
             error.expected, error.remedy);
    }
  }

  std::size_t column_of(const std::string& name) {
    for (std::size_t k = 0; k < result_.measured.size(); ++k) {
      if (result_.measured[k].name == name) return 1 + k;
    }
    MeasuredColumn column;
    column.name = name;
    if (name.starts_with("exact(")) {
      column.exact = name.substr(6, name.size() - 7);
      result_.subject->check_exact(column.exact);
    } else {
      column.output = result_.subject->add_output(name);
    }
    result_.measured.push_back(std::move(column));
    return result_.measured.size();
  }

  void check_run() {
    constexpr int kMostSamples = 10'000'000;
    if (plan_.tolerance && !(*plan_.tolerance > 0 && *plan_.tolerance < 1))
      report({plan_.file, {}}, fmt::format("the tolerance of the runs is {}", *plan_.tolerance),
             "a number above 0 and below 1");
    if (plan_.samples && !(*plan_.samples >= 2 && *plan_.samples <= kMostSamples))
      report({plan_.file, {}}, fmt::format("each run has {} rows", *plan_.samples),
             fmt::format("from 2 to {}", kMostSamples));
  }

  const Plan& plan_;
  const diagram::BlockLibrary& library_;
  Understood result_;
  std::vector<Levels> levels_;
  std::size_t n_drawn_ = 0;
  text::Diagnostics findings_;
};

}  // namespace

Understood understand(const Plan& plan, const std::string& text, const diagram::BlockLibrary& library) {
  return PlanReader(plan, text, library).read();
}

}  // namespace oblique::ensemble
