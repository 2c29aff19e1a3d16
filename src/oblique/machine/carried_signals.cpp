// SPDX-License-Identifier: MIT
#include <oblique/machine/carried_signals.h>

#include <algorithm>

#include <fmt/format.h>

#include <oblique/diagram/diagram.h>

namespace oblique::machine {
namespace {

std::size_t variables_of(Role role) {
  if (stays_as_it_is(role)) return 0;
  return role == Role::multiplier ? 2 : 1;
}

}  // namespace

bool has_signed_weights(const diagram::MachineProfile& machine) {
  return machine.signed_coefficients || !machine.inverting;
}

CarriedSignals::CarriedSignals(const Circuit& circuit, const diagram::MachineProfile& machine)
    : circuit_(circuit), polarity_(machine.inverting ? -1 : 1) {
  const SignProblem signs = problem();
  signs_ = has_signed_weights(machine) ? signs_of(signs, std::vector<bool>(signs.variables, false))
                                       : choose_signs(signs);
  if (has_signed_weights(machine)) {
    signs_.inverted.assign(signs.signals.size(), false);
    signs_.inverters = 0;
  }
  choose_names();
}

CarriedSignals::Orientation CarriedSignals::orientation(std::size_t index, std::size_t port) const {
  const CircuitElement& element = circuit_.elements[index];
  const std::size_t variable = first_variable_[index];
  switch (element.role) {
    case Role::summer:
      return {element.polarity * polarity_, variable};
    case Role::integrator: {
      const diagram::InputPort& input = element.definition->inputs[port];
      if (input.sum) return {element.polarity * polarity_ * parameter_of(*element.block, "rate"), variable};
      if (input.name == "start") return {1, variable};
      return {};
    }
    case Role::inverter:
    case Role::open_amplifier:
      return {1, variable};
    case Role::multiplier:
      return {1, variable + port};
    default:
      return {};
  }
}

SignProblem CarriedSignals::problem() {
  SignProblem problem;
  for (const CircuitElement& element : circuit_.elements) {
    first_variable_.push_back(problem.variables);
    first_signal_.push_back(problem.signals.size());
    SignProblem::Signal signal;
    for (std::size_t k = 0; k < variables_of(element.role); ++k) signal.variables[k] = problem.variables++;
    problem.signals.resize(problem.signals.size() + element.definition->outputs.size(), signal);
  }
  for (std::size_t e = 0; e < circuit_.elements.size(); ++e) {
    const auto& inputs = circuit_.elements[e].inputs;
    for (std::size_t port = 0; port < inputs.size(); ++port) {
      const auto [factor, variable] = orientation(e, port);
      for (const CircuitTerm& term : inputs[port].terms) {
        if (term.signal) problem.uses.push_back({index_of(*term.signal), factor * term.weight < 0, variable});
      }
    }
  }
  return problem;
}

double CarriedSignals::input_factor(std::size_t index, std::size_t port) const {
  const auto [factor, variable] = orientation(index, port);
  return variable && signs_.variables[*variable] ? -factor : factor;
}

void CarriedSignals::choose_names() {
  for (std::size_t e = 0; e < circuit_.elements.size(); ++e) {
    const CircuitElement& element = circuit_.elements[e];
    const std::string& plus = element.path;
    const std::string minus = "minus_" + plus;
    names_.push_back(free_name(is_negative(e) ? minus : plus));
    const auto& outputs = element.definition->outputs;
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      if (!signs_.inverted[index_of({e, k})]) continue;
      const std::string port = outputs.size() > 1 ? "." + outputs[k].name : "";
      inverse_[index_of({e, k})] = free_name((is_negative(e) ? plus : minus) + port);
    }
  }
}

std::string CarriedSignals::output_name(diagram::SignalRef signal) const {
  const auto& outputs = circuit_.elements[signal.block].definition->outputs;
  const std::string& name = names_[signal.block];
  return outputs.size() == 1 ? name : name + "." + outputs[signal.output].name;
}

std::vector<std::pair<std::string, std::string>> CarriedSignals::inverters(std::size_t element) {
  std::vector<std::pair<std::string, std::string>> found;
  for (std::size_t k = 0; k < circuit_.elements[element].definition->outputs.size(); ++k) {
    const auto inverse = inverse_.find(index_of({element, k}));
    if (inverse != inverse_.end()) found.emplace_back(inverse->second, output_name({element, k}));
  }
  return found;
}

std::string CarriedSignals::source(const std::optional<diagram::SignalRef>& signal, bool negative) {
  if (signal) return negative == is_negative(*signal) ? output_name(*signal) : inverse_.at(index_of(*signal));
  std::string& name = references_[negative ? 1 : 0];
  if (name.empty()) name = free_name(negative ? "minus_reference" : "reference");
  return name;
}

std::string CarriedSignals::free_name(std::string path) {
  std::replace(path.begin(), path.end(), '.', '_');
  std::string name = path;
  for (int k = 2; diagram::is_reserved(name) || !taken_.insert(name).second; ++k)
    name = fmt::format("{}_{}", path, k);
  return name;
}

}  // namespace oblique::machine
