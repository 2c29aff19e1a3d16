// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/family.h>

#include <fmt/format.h>

#include <oblique/ensemble/engine/work_queue.h>
#include <oblique/ensemble/study/diagram_subject.h>
#include <oblique/ensemble/study/levels.h>
#include <oblique/ensemble/study/study.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>

namespace oblique::ensemble {
namespace {

[[noreturn]] void refuse(const Variation& variation, std::string what, std::string expected = {},
                         text::Remedy remedy = {}) {
  throw StudyError(
      text::Diagnostic{variation.place, std::move(what), std::move(expected), std::move(remedy)});
}

}  // namespace

std::string Family::label(std::size_t k) const {
  const bool told = unit != "1" && unit != "machine unit";
  return fmt::format("{} = {:.6g}{}{}", name, runs[k].value, told ? " " : "", told ? unit : "");
}

Family run_family(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                  const std::vector<diagram::ParameterOverride>& overrides, const Variation& variation,
                  const solve::RunOptions& options, int threads) {
  diagram::flatten(diagram, library, overrides);  // what is wrong with these is not the variation's fault
  Family family;
  family.name = variation.name;
  std::vector<diagram::FlatDiagram> machines;
  try {
    const text::Unit unit = unit_in(diagram, library, variation.name);
    family.unit = unit.name;
    const Levels levels(variation.values, unit);
    if (levels.grid().empty()) {
      refuse(variation, fmt::format("the range '{}' does not say how many values it has", variation.values),
             fmt::format("'{}:5', for example", variation.values));
    }
    for (const double value : levels.grid()) {
      std::vector<diagram::ParameterOverride> all = overrides;
      all.push_back({variation.name, fmt::format("{}", value)});
      machines.push_back(diagram::flatten(diagram, library, all));
      family.runs.push_back({value, {}, {}});
    }
  } catch (const text::ExpressionError& error) {
    refuse(variation, error.what, error.expected, error.remedy);
  } catch (const diagram::DiagramError& error) {
    const text::Diagnostic& first = error.diagnostics().front();
    refuse(variation, first.what, first.expected, first.remedy);
  }
  work_off(0, machines.size(), threads,
           [&](const Next& next) {
             for (std::uint64_t k = 0; next(k);) {
               try {
                 const network::Program program(network::assemble(machines[k]));
                 family.runs[k].run = solve::run(program, machines[k], options);
               } catch (const text::Error& error) {
                 const std::string& what = error.diagnostics().front().what;
                 family.runs[k].failure = what.substr(0, what.find('\n'));
               }
             }
           },
           {});
  return family;
}

}  // namespace oblique::ensemble
