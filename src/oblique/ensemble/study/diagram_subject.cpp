// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/diagram_subject.h>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/text/diagnostic.h>

namespace oblique::ensemble {
namespace {

/// The type of the block that a path names, "C.c" among them.
const diagram::BlockDefinition* definition_at(const std::vector<diagram::BlockInstance>& top,
                                              const diagram::BlockLibrary& library, std::string_view path) {
  const std::vector<diagram::BlockInstance>* blocks = &top;
  const diagram::BlockDefinition* found = nullptr;
  for (std::size_t at = 0; at <= path.size();) {
    const std::size_t end = std::min(path.find('.', at), path.size());
    const std::string_view name = path.substr(at, end - at);
    const auto block = std::find_if(blocks->begin(), blocks->end(),
                                    [&](const diagram::BlockInstance& b) { return b.name == name; });
    if (block == blocks->end()) return nullptr;
    found = library.find(block->type);
    if (found == nullptr) return nullptr;
    blocks = &found->blocks;
    at = end + 1;
  }
  return found;
}

class DiagramSubject : public Subject {
 public:
  DiagramSubject(const Plan& plan, const std::string& text, const diagram::BlockLibrary& library)
      : library_(library), diagram_(diagram::parse_diagram(text, plan.subject)) {
    const diagram::FlatDiagram flat = diagram::flatten(diagram_, library_);
    for (const diagram::FlatOutput& output : flat.outputs) all_outputs_.push_back(output.name);
    asked_ = diagram_;
    asked_.outputs.clear();
    asked_.expectations.clear();
    asked_.published.reset();
    asked_.lesson.reset();
  }

  solve::RunOptions run_options() const override { return solve::options_of(diagram_.run); }
  const diagram::Diagram& diagram() const override { return diagram_; }

  std::vector<std::string> output_names() const override { return all_outputs_; }
  std::vector<Measure> usual_measures() const override {
    std::vector<Measure> measures;
    for (const std::string& name : all_outputs_) {
      std::string measure = fmt::format("end({})", name);
      measures.push_back({measure, measure, {}});
    }
    return measures;
  }

  text::Unit unit_of(const std::string& name) override { return unit_in(diagram_, library_, name); }

  double vary(const std::string& name, double lowest, double highest) override {
    overrides_.push_back({name, {}});
    for (const double value : {lowest, highest})
      diagram::flatten(diagram_, library_, {{name, fmt::format("{}", value)}});
    return lowest;
  }

  std::size_t add_output(const std::string& name) override {
    for (std::size_t k = 0; k < asked_.outputs.size(); ++k) {
      if (asked_.outputs[k].name == name) return k;
    }
    asked_.outputs.push_back(output_called(diagram_, library_, name, all_outputs_));
    return asked_.outputs.size() - 1;
  }

  void check_exact(const std::string& /*column*/) const override {}  // measures of diagrams have none

  Machine machine(std::span<const double> values) const override {
    std::vector<diagram::ParameterOverride> overrides = overrides_;
    for (std::size_t k = 0; k < overrides.size(); ++k) overrides[k].value = fmt::format("{}", values[k]);
    Machine machine;
    machine.flat = diagram::flatten(asked_, library_, overrides);
    machine.until = diagram_.run.until;
    return machine;
  }

 private:
  const diagram::BlockLibrary& library_;
  diagram::Diagram diagram_;
  diagram::Diagram asked_;  ///< with the outputs that were asked for
  std::vector<std::string> all_outputs_;
  std::vector<diagram::ParameterOverride> overrides_;
};

}  // namespace

text::Unit unit_in(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                   const std::string& name) {
  const std::size_t bracket = name.find('[');
  const std::size_t dot = name.substr(0, bracket).rfind('.');
  if (dot != std::string::npos && bracket == std::string::npos) {
    if (const auto* const definition = definition_at(diagram.blocks, library, name.substr(0, dot))) {
      if (const auto index = definition->find_parameter(name.substr(dot + 1)))
        return diagram::unit_on(diagram.machine.profile, definition->parameters[*index].unit);
    }
  }
  // A weight, or a name that is none: whoever sets it says so.
  diagram::flatten(diagram, library, {{name, "1"}});
  return {};
}

diagram::OutputSpec output_called(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                                  const std::string& name, const std::vector<std::string>& outputs) {
  const auto own = std::find_if(diagram.outputs.begin(), diagram.outputs.end(),
                                [&](const diagram::OutputSpec& output) { return output.name == name; });
  if (own != diagram.outputs.end()) return *own;
  diagram::OutputSpec output;
  output.name = name;
  output.signal = name;
  diagram::Diagram trial = diagram;
  trial.outputs = {output};
  trial.expectations.clear();
  trial.published.reset();
  trial.lesson.reset();
  try {
    diagram::flatten(trial, library);
  } catch (const diagram::DiagramError&) {
    std::vector<std::string> names = outputs;
    for (const diagram::BlockInstance& block : diagram.blocks) {
      if (std::find(names.begin(), names.end(), block.name) == names.end()) names.push_back(block.name);
    }
    throw text::ExpressionError{
        0, fmt::format("there is no output or signal '{}'", name), {}, text::suggest(name, names)};
  }
  return output;
}

std::unique_ptr<Subject> diagram_subject(const Plan& plan, const std::string& text,
                                         const diagram::BlockLibrary& library) {
  return std::make_unique<DiagramSubject>(plan, text, library);
}

}  // namespace oblique::ensemble
