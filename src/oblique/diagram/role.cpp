// SPDX-License-Identifier: MIT
#include <oblique/diagram/role.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/block_definition.h>
#include <oblique/text/expression_parser.h>

namespace oblique::diagram {
namespace {

/// What a block of a role has and says.
struct RoleRule {
  Role role;
  std::string_view name;
  std::optional<std::size_t> inputs;  ///< exactly; nothing: any number
  bool sum = false;                   ///< the first input adds
  std::vector<std::string> parameters;
  /// The output (of an integrator its rate, of an open amplifier where it rests), of the first input `in` or
  /// of `x` and `y`; none: a block of the role is counted, and nothing is made of its equations.
  std::string_view formula;
};

const std::vector<RoleRule>& rules() {
  static const std::vector<RoleRule> all{
      {Role::reference, "reference", 0, false, {"value"}, "value"},
      {Role::potentiometer, "potentiometer", 1, false, {"setting"}, "setting*in"},
      {Role::gain, "gain", 1, false, {"factor"}, "factor*in"},
      {Role::inverter, "inverter", 1, false, {}, "-in"},
      {Role::summer, "summer", 1, true, {}, "polarity*in"},
      {Role::integrator, "integrator", {}, true, {"rate", "initial"}, "polarity*rate*in"},
      {Role::open_amplifier, "open-amplifier", 1, true, {"gain", "bandwidth"}, "-gain*in"},
      {Role::multiplier, "multiplier", 2, false, {}, "x*y"},
      {Role::squarer, "squarer", 1, false, {}, "in*in"},
      {Role::comparator, "comparator", {}, false, {}, ""},
      {Role::function_generator, "function-generator", {}, false, {}, ""},
  };
  return all;
}

const RoleRule* rule_of(Role role) {
  const auto found =
      std::find_if(rules().begin(), rules().end(), [&](const RoleRule& rule) { return rule.role == role; });
  return found == rules().end() ? nullptr : &*found;
}

/// A block in numbers: those of its inputs, and of its parameters the defaults, but for the role's own, which
/// are tried where their place in the equations shows.
class Sample {
 public:
  Sample(const BlockDefinition& block, const RoleRule& rule, std::vector<double> inputs, double polarity)
      : block_(block), inputs_(std::move(inputs)), polarity_(polarity) {
    for (const ParameterDefinition& parameter : block.parameters)
      parameters_.push_back(parameter.default_value);
    // Not 1, which a product does not show; of an amplifier finite, which its defaults need not be.
    const double tried = rule.role == Role::open_amplifier ? 1000 : 0.75;
    for (const std::string& name : rule.parameters) {
      const std::size_t k = block.find_parameter(name).value();
      if (block.parameters[k].allows(tried)) parameters_[k] = tried;
    }
    behaviour_ = block.choose_behaviour(parameters_, polarity);
  }

  /// The equation of the one output: every case has one.
  const Equation& equation() const {
    return *std::find_if(behaviour_->equations.begin(), behaviour_->equations.end(),
                         [&](const Equation& e) { return e.target == block_.outputs.front().name; });
  }

  /// What the formula of the role says.
  double promised(std::string_view formula) const {
    return text::evaluate(text::parse_expression(formula),
                          [&](std::string_view name) -> std::optional<double> {
                            if (name == "in" || name == "x") return inputs_[0];
                            if (name == "y") return inputs_[1];
                            if (name == "polarity") return polarity_;
                            return parameters_[block_.find_parameter(name).value()];
                          });
  }

  /// What an expression of the block is where its output is `out`. Throws ExpressionError where it has no
  /// value by itself.
  double value(const text::Expression& expression, double out, int depth = 0) const {
    constexpr int kDeepest = 20;  // equations that name each other in a circle
    return text::evaluate(expression, [&](std::string_view name) -> std::optional<double> {
      if (name == "polarity") return polarity_;
      if (name == "in_operate") return 1;
      if (name == "in_initial" || name == "in_hold" || name == "time") return 0;
      if (name == block_.outputs.front().name) return out;
      if (const auto k = block_.find_parameter(name)) return parameters_[*k];
      if (const auto k = block_.find_input(name)) return *k < inputs_.size() ? inputs_[*k] : 0;
      if (const auto k = block_.find_memory(name)) return value(block_.memories[*k].initial, out, depth);
      const auto inner =
          std::find_if(behaviour_->equations.begin(), behaviour_->equations.end(), [&](const Equation& e) {
            return e.target == name && e.kind == Equation::Kind::assignment && depth < kDeepest;
          });
      if (inner == behaviour_->equations.end()) return std::nullopt;
      return value(inner->expression, out, depth + 1);
    });
  }

 private:
  const BlockDefinition& block_;
  std::vector<double> inputs_, parameters_;
  double polarity_;
  const Behaviour* behaviour_ = nullptr;
};

/// Whether a sample agrees with the role, to rounding.
bool agrees(const RoleRule& rule, const Sample& sample) {
  constexpr double kRounding = 1e-12;
  const Equation& equation = sample.equation();
  const double promised = sample.promised(rule.formula);
  if (rule.role == Role::open_amplifier) {
    // A state or an unknown that stands still where the role says, and not elsewhere.
    if (equation.kind == Equation::Kind::assignment) return false;
    const double elsewhere = std::abs(sample.value(equation.expression, 2 * promised));
    return std::abs(sample.value(equation.expression, promised)) < kRounding * elsewhere;
  }
  const bool integrates = rule.role == Role::integrator;
  if (equation.kind != (integrates ? Equation::Kind::derivative : Equation::Kind::assignment)) return false;
  return std::abs(sample.value(equation.expression, 0) - promised) <= kRounding * std::abs(promised);
}

bool agrees_everywhere(const RoleRule& rule, const BlockDefinition& block) {
  try {
    for (const double polarity : {1.0, -1.0}) {
      for (const double first : {0.3, -0.7}) {
        std::vector<double> inputs{first};
        if (rule.inputs == 2) inputs.push_back(0.4);
        if (!agrees(rule, Sample(block, rule, std::move(inputs), polarity))) return false;
      }
    }
    return true;
  } catch (const text::ExpressionError&) {
    return false;
  }
}

std::string counted(std::size_t n, std::string_view one) {
  return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s");
}

/// What of the block is not as its role wants it, and how it is wanted; nothing where all is.
std::optional<std::pair<std::string, std::string>> mismatch(const RoleRule& rule,
                                                            const BlockDefinition& block) {
  if (block.is_composite())
    return {{"the block is made of [blocks]", "a role of each of those: a machine sees them alone"}};
  if (rule.inputs && *rule.inputs != block.inputs.size())
    return {{"the block has " + counted(block.inputs.size(), "input"), counted(*rule.inputs, "input")}};
  if (rule.sum && (block.inputs.empty() || !block.inputs.front().sum))
    return {{"the first input does not add", "an input with sum = true"}};
  for (const std::string& name : rule.parameters) {
    const auto k = block.find_parameter(name);
    if (k && !block.parameters[*k].points && !block.parameters[*k].formula) continue;
    return {{fmt::format("the block has no number '{}' in [parameters]", name),
             fmt::format("{}", fmt::join(rule.parameters, " and "))}};
  }
  if (rule.formula.empty()) return std::nullopt;
  if (block.outputs.size() != 1)
    return {{"the block has " + counted(block.outputs.size(), "output"), counted(1, "output")}};
  if (agrees_everywhere(rule, block)) return std::nullopt;
  const std::string_view left = rule.role == Role::integrator       ? "der(out)"
                                : rule.role == Role::open_amplifier ? "at rest out"
                                                                    : "out";
  return {{"with the defaults of the other parameters the equations say something else",
           fmt::format("{} = {}", left, rule.formula)}};
}

}  // namespace

std::string_view role_name(Role role) {
  const RoleRule* const rule = rule_of(role);
  return rule == nullptr ? std::string_view() : rule->name;
}

Role read_role(std::string_view name, const text::Place& place, text::Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const RoleRule& rule : rules()) {
    if (rule.name == name) return rule.role;
    names.emplace_back(rule.name);
  }
  diagnostics.add({place, fmt::format("there is no role '{}'", name), {}, text::suggest(name, names)});
  return Role::other;
}

void check_role(const BlockDefinition& block, const text::Place& place, text::Diagnostics& diagnostics) {
  const RoleRule* const rule = rule_of(block.role);
  if (rule == nullptr) return;
  auto found = mismatch(*rule, block);
  if (!found) return;
  diagnostics.add({place, fmt::format("role '{}': {}", rule->name, found->first), std::move(found->second),
                   "without a role the block is an element of its own, which a machine may not have"});
}

}  // namespace oblique::diagram
