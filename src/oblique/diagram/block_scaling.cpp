// SPDX-License-Identifier: MIT
#include <oblique/diagram/block_scaling.h>

#include <cmath>
#include <optional>
#include <string_view>

#include <oblique/text/nearest_decimal.h>
#include <oblique/text/quantity.h>

namespace oblique::diagram {

/// Collects the equations between the logarithms of factors.
class RuleReader {
 public:
  explicit RuleReader(BlockScalingRules& rules) : rules_(rules), block_(*rules.block_) { number_columns(); }

  void read() {
    for (const Equation& equation : block_.behaviour->equations) {
      const auto value = scale_of(equation.expression);
      if (equation.kind != Equation::Kind::implicit) equal(variable(column_of(equation.target)), value);
    }
    for (const StartRule& start : block_.definition->starts) {
      const auto value = scale_of(start.value);
      if (const Eigen::Index column = column_of(start.target); column >= 0) equal(variable(column), value);
    }
    for (const MemoryRule& memory : block_.definition->memories)
      equal(variable(column_of(memory.name)), scale_of(memory.initial));
    for (const EventRule& event : block_.definition->events) {
      scale_of(event.when);
      if (event.where) scale_of(*event.where);
      for (const auto* actions : {&event.actions, &event.piling_up}) {
        for (const EventAction& action : *actions) {
          const auto value = scale_of(action.value);
          if (const Eigen::Index column = column_of(action.target); column >= 0)
            equal(variable(column), value);
        }
      }
    }
    for (const Behaviour& behaviour : block_.definition->behaviours) {  // which of them applies must stay
      if (behaviour.when) scale_of(*behaviour.when);
    }
    reduce();
  }

 private:
  /// Logarithm of the factor of a value: a combination of the unknowns. Nothing: any factor will do (a zero
  /// or an infinity).
  using Scale = std::optional<Eigen::VectorXd>;
  using Kind = text::Expression::Kind;

  /// Outputs first, so that elimination finds them from the rest; inputs last, which stay free where they
  /// may.
  void number_columns() {
    const BlockDefinition& definition = *block_.definition;
    for (std::size_t i = 0; i < definition.outputs.size(); ++i) rules_.outputs_.push_back(rules_.columns_++);
    for (const Equation& equation : block_.behaviour->equations) {
      if (!definition.find_output(equation.target)) hidden_.emplace_back(equation.target, rules_.columns_++);
    }
    for (const MemoryRule& memory : definition.memories) hidden_.emplace_back(memory.name, rules_.columns_++);
    for (const ParameterDefinition& parameter : definition.parameters) {
      const auto unit = text::parse_unit(parameter.unit);
      const bool fixed = block_.saturation == rules_.parameters_.size();
      const bool signal = unit && unit->exponents[text::Unit::signal] != 0 && !fixed;
      rules_.parameters_.push_back(signal ? rules_.columns_++ : -1);
    }
    for (std::size_t i = 0; i < definition.inputs.size(); ++i) rules_.inputs_.push_back(rules_.columns_++);
  }

  Eigen::Index column_of(std::string_view name) const {
    const BlockDefinition& definition = *block_.definition;
    if (const auto i = definition.find_output(name)) return rules_.outputs_[*i];
    if (const auto i = definition.find_parameter(name)) return rules_.parameters_[*i];
    if (const auto i = definition.find_input(name)) return rules_.inputs_[*i];
    for (const auto& [hidden, column] : hidden_) {
      if (hidden == name) return column;
    }
    return -1;
  }

  /// Where the machine saturates does not follow the signals: a scaled diagram is to stay below it.
  bool is_saturation(std::string_view name) const {
    return block_.saturation && block_.definition->parameters[*block_.saturation].name == name;
  }

  Scale number() const { return Eigen::VectorXd::Zero(rules_.columns_); }
  Scale variable(Eigen::Index column) const {
    Scale scale = number();
    if (column >= 0) (*scale)[column] = 1;
    return scale;
  }

  Scale equal(const Scale& a, const Scale& b) {
    if (!a || !b) return a ? a : b;
    const Eigen::VectorXd difference = *a - *b;
    if (!difference.isZero(0)) rows_.push_back(difference);
    return a;
  }

  void unscaled(const Scale& a) { equal(a, number()); }

  /// The value of what the parameters alone determine; nothing for the rest.
  std::optional<double> constant(const text::Expression& e) const {
    try {
      return text::evaluate(e, [&](std::string_view name) -> std::optional<double> {
        const BlockDefinition& definition = *block_.definition;
        if (const auto p = definition.find_parameter(name)) return block_.parameters[*p];
        const auto i = definition.find_input(name);
        if (i && block_.inputs[*i].terms.empty()) return block_.inputs[*i].constant;
        return std::nullopt;
      });
    } catch (const text::ExpressionError&) {
      return std::nullopt;
    }
  }

  Scale scale_of(const text::Expression& e) {
    const std::optional<double> value = constant(e);
    if (value && (*value == 0 || std::isinf(*value))) return {};
    if (e.kind == Kind::number) return number();
    if (e.kind == Kind::name && is_saturation(e.name)) return {};
    if (e.kind == Kind::name) return variable(column_of(e.name));
    if (e.kind == Kind::call && e.function == text::Function::weights) return number();
    if (e.kind == Kind::call && e.function == text::Function::if_) {
      scale_of(e.operands[0]);
      if (const auto condition = constant(e.operands[0]))
        return scale_of(e.operands[*condition != 0 ? 1 : 2]);
    }
    std::vector<Scale> operands;
    for (const text::Expression& operand : e.operands) operands.push_back(scale_of(operand));
    if (e.kind == Kind::call) return scale_of_call(e.function, operands);
    Scale a = operands[0];
    const Scale b = operands.size() > 1 ? operands[1] : Scale();
    switch (e.kind) {
      case Kind::negate:
        return a;
      case Kind::add:
      case Kind::subtract:
        return equal(a, b);
      case Kind::multiply:
        return a && b ? Scale(*a + *b) : Scale();
      case Kind::divide:
        if (!a) return {};
        return b ? Scale(*a - *b) : a;
      case Kind::power:
        return scale_of_power(e, a, b);
      case Kind::less:
      case Kind::less_equal:
      case Kind::greater:
      case Kind::greater_equal:
      case Kind::equal:
      case Kind::not_equal:
        equal(a, b);
        break;
      case Kind::logical_and:
      case Kind::logical_or:
      case Kind::logical_not:
      case Kind::number:
      case Kind::name:
      case Kind::call:
        break;
    }
    return number();
  }

  Scale scale_of_power(const text::Expression& e, const Scale& base, const Scale& exponent) {
    unscaled(exponent);
    try {
      const double n = text::evaluate(e.operands[1], [&](std::string_view name) -> std::optional<double> {
        const auto parameter = block_.definition->find_parameter(name);
        return parameter ? std::optional(block_.parameters[*parameter]) : std::nullopt;
      });
      return base ? Scale(n * *base) : Scale();
    } catch (const text::ExpressionError&) {  // a signal in the exponent
      unscaled(base);
      return number();
    }
  }

  Scale scale_of_call(text::Function function, const std::vector<Scale>& operands) {
    switch (text::info_of(function).scaling) {
      case text::Scaling::alike:
        return all_equal(operands);
      case text::Scaling::root:
        return operands[0] ? Scale(0.5 * *operands[0]) : Scale();
      case text::Scaling::ratio:
        all_equal(operands);
        return number();
      case text::Scaling::indifferent:
        return number();
      case text::Scaling::branches:
        return equal(operands[1], operands[2]);
      case text::Scaling::pure:
        break;
    }
    for (const Scale& operand : operands) unscaled(operand);
    return number();
  }

  Scale all_equal(const std::vector<Scale>& operands) {
    Scale all;
    for (const Scale& operand : operands) all = equal(all, operand);
    return all;
  }

  /// Gauss and Jordan, with the leftmost columns as pivots.
  void reduce() {
    const auto n = static_cast<Eigen::Index>(rows_.size());
    Eigen::MatrixXd m(n, rules_.columns_);
    for (Eigen::Index r = 0; r < n; ++r) m.row(r) = rows_[static_cast<std::size_t>(r)].transpose();
    Eigen::Index rank = 0;
    for (Eigen::Index column = 0; column < m.cols() && rank < n; ++column) {
      Eigen::Index pivot = 0;
      if (m.col(column).tail(n - rank).cwiseAbs().maxCoeff(&pivot) < 1e-9) continue;
      m.row(rank).swap(m.row(rank + pivot));
      m.row(rank) /= m(rank, column);
      for (Eigen::Index r = 0; r < n; ++r) {
        if (r != rank) m.row(r) -= m(r, column) * m.row(rank).eval();
      }
      ++rank;
    }
    rules_.equations_ = m.topRows(rank);
    rules_.whole_ = Eigen::VectorXd::Ones(rules_.columns_);
    for (const auto& [name, column] : hidden_) {  // a count or a flag is a number whatever the signals are
      for (Eigen::Index r = 0; r < rank; ++r) {
        const Eigen::RowVectorXd row = rules_.equations_.row(r);
        if (row.cwiseAbs().sum() == std::abs(row[column])) rules_.whole_[column] = 0;
      }
    }
  }

  BlockScalingRules& rules_;
  const FlatBlock& block_;
  std::vector<std::pair<std::string_view, Eigen::Index>> hidden_;
  std::vector<Eigen::VectorXd> rows_;
};

BlockScalingRules::BlockScalingRules(const FlatBlock& block) : block_(&block) {
  RuleReader(*this).read();
}

bool BlockScalingRules::scales_as_a_whole() const {
  return equations_.rows() == 0 || (equations_ * whole_).isZero(1e-9);
}

BlockScaling BlockScalingRules::whole(double factor) const {
  return scaling_of(std::log(factor) * whole_);
}

BlockScaling BlockScalingRules::from_inputs(std::span<const double> inputs, double free) const {
  Eigen::VectorXd logarithms = Eigen::VectorXd::Zero(columns_);
  for (const Eigen::Index parameter : parameters_) {
    if (parameter >= 0) logarithms[parameter] = std::log(free);
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) logarithms[inputs_[i]] = std::log(inputs[i]);
  for (Eigen::Index r = 0; r < equations_.rows(); ++r) {
    Eigen::Index pivot = 0;
    while (equations_(r, pivot) == 0) ++pivot;
    logarithms[pivot] = 0;
  }
  // Free columns are set, so each row gives its pivot.
  const Eigen::VectorXd sums = equations_ * logarithms;
  for (Eigen::Index r = 0; r < equations_.rows(); ++r) {
    Eigen::Index pivot = 0;
    while (equations_(r, pivot) == 0) ++pivot;
    logarithms[pivot] = -sums[r];
  }
  return scaling_of(logarithms);
}

BlockScaling BlockScalingRules::scaling_of(const Eigen::VectorXd& logarithms) const {
  // 14 digits: a factor of 0.2 comes out as 0.2, and the equations hold far below any tolerance.
  const auto factor = [&](Eigen::Index column) {
    if (column < 0) return 1.0;
    return text::nearest_decimal(std::exp(logarithms[column]), 14);
  };
  BlockScaling scaling;
  for (const Eigen::Index column : inputs_) scaling.inputs.push_back(factor(column));
  for (const Eigen::Index column : outputs_) scaling.outputs.push_back(factor(column));
  for (const Eigen::Index column : parameters_) scaling.parameters.push_back(factor(column));
  return scaling;
}

}  // namespace oblique::diagram
