// SPDX-License-Identifier: MIT
#include <oblique/machine/tabulated_functions.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/names.h>
#include <oblique/machine/line_segments.h>
#include <oblique/machine/logic_ports.h>
#include <oblique/machine/mode_control.h>
#include <oblique/machine/realise.h>
#include <oblique/machine/role.h>

namespace oblique::machine {
namespace {

/// Of the span of a function: by less than this a straight line is what it says.
constexpr double kStraight = 1e-12;
constexpr double kMostError = 0.05;  ///< of the span: lines that miss by more do not stand for the function

/// Finds what a block computes from its one argument, be it by a formula or by points.
class FunctionReader {
 public:
  explicit FunctionReader(diagram::FlatBlock block)
      : block_(std::move(block)), definition_(*block_.definition), equations_(block_.behaviour->equations) {
    for (diagram::Equation& equation : equations_) write_out_tables(equation.expression);
  }

  /// Whether its outputs depend on one input or on time alone, and on nothing that was before.
  bool is_function() {
    const auto assigns = [](const diagram::Equation& equation) {
      return equation.kind == diagram::Equation::Kind::assignment;
    };
    if (!definition_.memories.empty() || !std::all_of(equations_.begin(), equations_.end(), assigns))
      return false;
    bool time = false;
    for (const diagram::Equation& equation : equations_) {
      for (const text::Expression* const name : diagram::names_in(equation.expression)) {
        if (name->name == "time") time = true;
      }
    }
    for (std::size_t i = 0; i < block_.inputs.size(); ++i) {
      if (block_.inputs[i].terms.empty()) continue;
      if (time || input_) return false;
      input_ = i;
    }
    if (!time && !input_) return false;
    try {  // a mode of operation: no function that is known here
      for (std::size_t k = 0; k < definition_.outputs.size(); ++k) value(k, 0.5);
    } catch (const text::ExpressionError&) {
      return false;
    }
    return true;
  }

  /// The input that is the argument; nothing: it is time.
  std::optional<std::size_t> input() const { return input_; }

  double value(std::size_t output, double argument) const {
    return value_of(definition_.outputs[output].name, argument);
  }

 private:
  /// Puts the points in the place of a parameter that is a function: table(x, data) is table(x, x1, y1, …).
  void write_out_tables(text::Expression& expression) const {
    for (text::Expression& operand : expression.operands) write_out_tables(operand);
    const bool is_named = expression.kind == text::Expression::Kind::call &&
                          expression.function == text::Function::table && expression.operands.size() == 2;
    if (!is_named) return;
    const auto parameter = definition_.find_parameter(expression.operands[1].name);
    if (!parameter) return;
    const text::PointTable& points = block_.points[*parameter];
    expression.operands.pop_back();
    for (std::size_t k = 0; k < points.x.size(); ++k) {
      for (const double coordinate : {points.x[k], points.y[k]}) {
        text::Expression number;
        number.number = coordinate;
        expression.operands.push_back(std::move(number));
      }
    }
  }

  double value_of(std::string_view target, double argument) const {
    const auto equation = std::find_if(equations_.begin(), equations_.end(),
                                       [&](const diagram::Equation& e) { return e.target == target; });
    return text::evaluate(equation->expression, [&](std::string_view name) -> std::optional<double> {
      if (name == "time") return argument;
      if (name == "polarity") return block_.polarity;
      if (const auto p = definition_.find_parameter(name)) return block_.parameters[*p];
      if (const auto i = definition_.find_input(name))
        return i == input_ ? argument : block_.inputs[*i].constant;
      const bool known = std::any_of(equations_.begin(), equations_.end(),
                                     [&](const diagram::Equation& e) { return e.target == name; });
      return known ? std::optional(value_of(name, argument)) : std::nullopt;
    });
  }

  diagram::FlatBlock block_;
  const diagram::BlockDefinition& definition_;
  std::vector<diagram::Equation> equations_;
  std::optional<std::size_t> input_;
};

class Tabulator {
 public:
  Tabulator(diagram::FlatDiagram& flat, const diagram::BlockLibrary& library,
            const diagram::MachineProfile& machine, const std::vector<SignalRange>& ranges, double until,
            int segments)
      : flat_(flat),
        library_(library),
        switches_corners_(machine.find(diagram::ElementKind::function_generator) == nullptr &&
                          machine.find(diagram::ElementKind::comparator) != nullptr &&
                          machine.find(diagram::ElementKind::multiplier) != nullptr),
        ranges_(ranges),
        until_(until),
        segments_(segments) {
    for (const diagram::FlatBlock& block : flat.blocks) {
      first_.push_back(signals_);
      signals_ += block.definition->outputs.size();
    }
    needed_.resize(signals_);
    for (const diagram::FlatOutput& output : flat.outputs) need(output.signal);
    for (const diagram::SignalRef signal : mode_signals(flat.timeline)) need(signal);
  }

  std::vector<TabulatedFunction> tabulate() {
    const std::size_t n = flat_.blocks.size();
    for (std::size_t b = 0; b < n; ++b) {
      if (flat_.blocks[b].definition->role != Role::other) continue;
      if (!is_needed(b)) continue;
      FunctionReader function(flat_.blocks[b]);
      if (!function.is_function()) continue;
      // A noise generator is a function of the time, and an element.
      if (!function.input() && logic_ports(flat_.blocks[b])) continue;
      replace(b, function);
    }
    diagnostics_.throw_if_any<RealiseError>();
    return std::move(functions_);
  }

 private:
  /// Notes a signal, and what the block that gives it is fed with.
  void need(diagram::SignalRef signal) {
    std::vector<diagram::SignalRef> found{signal};
    while (!found.empty()) {
      const diagram::SignalRef next = found.back();
      found.pop_back();
      const bool seen = is_needed(next.block);
      needed_[first_[next.block] + next.output] = true;
      if (seen) continue;
      for (const diagram::FlatInput& input : flat_.blocks[next.block].inputs) {
        for (const diagram::FlatTerm& term : input.terms) {
          if (term.weight != 0) found.push_back(term.signal);
        }
      }
    }
  }

  bool is_needed(std::size_t block) const {
    const auto first = needed_.begin() + static_cast<std::ptrdiff_t>(first_[block]);
    const auto outputs = static_cast<std::ptrdiff_t>(flat_.blocks[block].definition->outputs.size());
    return std::find(first, first + outputs, true) != first + outputs;
  }

  void replace(std::size_t b, const FunctionReader& function) {
    const diagram::FlatBlock block = flat_.blocks[b];  // whose place others take
    const diagram::FlatInput argument = function.input() ? block.inputs[*function.input()] : time();
    SignalRange range{0, until_};
    if (function.input()) range = range_of(argument);
    const auto& outputs = block.definition->outputs;
    std::vector<diagram::FlatBlock> made;
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      const std::string path = outputs.size() == 1 ? block.path : block.path + "." + outputs[k].name;
      const auto value = [&](double x) { return needed_[first_[b] + k] ? function_at(function, k, x) : 0; };
      made.push_back(element_for(value, block, path, argument, range));
    }
    flat_.blocks[b] = std::move(made.front());
    for (std::size_t k = 1; k < made.size(); ++k) {
      redirect({b, k}, {flat_.blocks.size(), 0});
      flat_.blocks.push_back(std::move(made[k]));
    }
  }

  static double function_at(const FunctionReader& function, std::size_t output, double x) {
    try {
      return function.value(output, x);
    } catch (const text::ExpressionError&) {
      return std::nan("");
    }
  }

  diagram::FlatBlock element_for(const std::function<double(double)>& value, const diagram::FlatBlock& block,
                                 const std::string& path, const diagram::FlatInput& argument,
                                 const SignalRange& range) {
    const double middle = (range.low + range.high) / 2;
    const LineSegments one = range.high > range.low ? line_segments(value, range.low, range.high, 1)
                                                    : LineSegments{{{middle}, {value(middle)}}, 0};
    double size = 0;
    for (const double y : one.points.y) size = std::max(size, std::abs(y));
    if (one.error <= kStraight * size) return summer(one.points, block, path, argument);
    const LineSegments lines = line_segments(value, range.low, range.high, segments_);
    if (!std::isfinite(lines.error)) {
      diagnostics_.add(
          {block.place,
           fmt::format("'{}' ({}) jumps, or is not finite, where its argument runs from {:.4g} to "
                       "{:.4g}",
                       path, block.definition->name, range.low, range.high),
           "a continuous function, which a function generator can be set for",
           "a comparator makes a jump; limit the argument where there is no value"});
      return block;
    }
    const double low = lines.low, high = lines.high;
    if (lines.error > kMostError * (high - low)) {
      diagnostics_.add(
          {block.place,
           fmt::format("{} straight lines miss '{}' ({}) by {:.2g}, which itself goes from {:.4g} to "
                       "{:.4g}",
                       lines.points.x.size() - 1, path, block.definition->name, lines.error, low, high),
           "a function that a function generator can be set for",
           text::Remedy{"more lines (", text::Setting{"segments"}, "), if the machine has them"}});
      return block;
    }
    constexpr std::size_t kMostCorners = 4;
    const bool has_few_corners =
        lines.error <= kStraight * (high - low) && lines.points.x.size() <= kMostCorners + 2;
    if (switches_corners_ && has_few_corners) return corners(lines.points, block, path, argument);
    functions_.push_back({path, block.definition->name, static_cast<int>(lines.points.x.size()) - 1,
                          range.low, range.high, lines.error});
    diagram::FlatBlock generator = element_for(block, Role::function_generator, path);
    const auto& parameters = generator.definition->parameters;
    generator.points.resize(parameters.size());
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (parameters[k].points) generator.points[k] = lines.points;
    }
    generator.inputs = {argument};
    return generator;
  }

  /// y = slope · argument + what is left.
  diagram::FlatBlock summer(const text::PointTable& line, const diagram::FlatBlock& block,
                            const std::string& path, const diagram::FlatInput& argument) const {
    diagram::FlatBlock sum = element_for(block, Role::summer, path);
    double slope = line.x.size() < 2 ? 0 : (line.y[1] - line.y[0]) / (line.x[1] - line.x[0]);
    const bool is_level =
        std::abs(slope * (line.x.back() - line.x.front())) <= kStraight * std::abs(line.y.front());
    if (is_level) slope = 0;  // but for rounding
    sum.inputs = {argument};
    for (diagram::FlatTerm& term : sum.inputs.front().terms) term.weight *= slope;
    sum.inputs.front().constant = line.y[0] - slope * (line.x[0] - argument.constant);
    return sum;
  }

  /// Straight lines without a function generator: the one with the least slope, and at each corner x_k away
  /// from it a comparator that lets the change of slope through, d_k (x − x_k) [x > x_k], or [x < x_k]. So
  /// what is small is no difference of what is large.
  diagram::FlatBlock corners(text::PointTable lines, const diagram::FlatBlock& block, const std::string& path,
                             const diagram::FlatInput& argument) {
    const std::size_t n = lines.x.size() - 1;
    for (std::vector<double>* const values : {&lines.x, &lines.y}) {
      const auto [least, most] = std::minmax_element(values->begin(), values->end());
      const double rounding = kStraight * (*most - *least);
      for (double& value : *values) value = std::abs(value) <= rounding ? 0 : value;
    }
    std::vector<double> slopes;
    for (std::size_t k = 0; k < n; ++k)
      slopes.push_back((lines.y[k + 1] - lines.y[k]) / (lines.x[k + 1] - lines.x[k]));
    const auto flattest = std::min_element(slopes.begin(), slopes.end(),
                                           [](double a, double b) { return std::abs(a) < std::abs(b); });
    const auto base = static_cast<std::size_t>(flattest - slopes.begin());
    diagram::FlatBlock sum = summer({{lines.x[base], lines.x[base + 1]}, {lines.y[base], lines.y[base + 1]}},
                                    block, path, argument);
    for (std::size_t k = 1; k < n; ++k) {
      const double side = k > base ? 1 : -1;
      diagram::FlatInput beyond = argument;
      beyond.constant -= lines.x[k];
      diagram::FlatInput compared = beyond;
      for (diagram::FlatTerm& term : compared.terms) term.weight *= side;
      compared.constant *= side;
      diagram::FlatBlock above = element_for(block, Role::comparator, fmt::format("{}.above_{}", path, k));
      for (std::size_t i = 0; i < above.inputs.size(); ++i) {
        if (above.definition->inputs[i].sum) above.inputs[i] = compared;
      }
      diagram::FlatBlock passed = element_for(block, Role::multiplier, fmt::format("{}.beyond_{}", path, k));
      passed.inputs = {beyond, {{{1, append(std::move(above))}}, 0}};
      sum.inputs.front().terms.push_back({side * (slopes[k] - slopes[k - 1]), append(std::move(passed))});
    }
    return sum;
  }

  diagram::SignalRef append(diagram::FlatBlock block) {
    flat_.blocks.push_back(std::move(block));
    return {flat_.blocks.size() - 1, 0};
  }

  /// An element in the group of a block, in its place.
  diagram::FlatBlock element_for(const diagram::FlatBlock& of, Role role, std::string path) const {
    diagram::FlatBlock made = element(library_, role, std::move(path), of.place);
    made.group = of.group;
    return made;
  }

  /// The signal that rises by 1 machine unit a second from 0.
  diagram::FlatInput time() {
    if (!clock_) {
      const auto taken = [&](const std::string& name) {
        return std::any_of(flat_.blocks.begin(), flat_.blocks.end(),
                           [&](const diagram::FlatBlock& block) { return block.path == name; });
      };
      std::string name = "clock";
      while (taken(name)) name += "_";
      diagram::FlatBlock clock = element_for(flat_.blocks.front(), Role::integrator, name);
      for (std::size_t i = 0; i < clock.inputs.size(); ++i) {
        if (clock.definition->inputs[i].sum) clock.inputs[i].constant = 1;
      }
      clock_ = flat_.blocks.size();
      flat_.blocks.push_back(std::move(clock));
    }
    return {{{1, {*clock_, 0}}}, 0};
  }

  SignalRange range_of(const diagram::FlatInput& input) const {
    SignalRange sum{input.constant, input.constant};
    for (const diagram::FlatTerm& term : input.terms) {
      const SignalRange& signal = ranges_[first_[term.signal.block] + term.signal.output];
      const double a = term.weight * signal.low, b = term.weight * signal.high;
      sum.low += std::min(a, b);
      sum.high += std::max(a, b);
    }
    return sum;
  }

  void redirect(diagram::SignalRef from, diagram::SignalRef to) {
    const auto follow = [&](diagram::SignalRef& signal) {
      if (signal == from) signal = to;
    };
    for (diagram::FlatBlock& block : flat_.blocks) {
      for (diagram::FlatInput& input : block.inputs) {
        for (diagram::FlatTerm& term : input.terms) follow(term.signal);
      }
    }
    for (diagram::FlatOutput& output : flat_.outputs) follow(output.signal);
    for (diagram::FlatGroup& group : flat_.timeline.groups) {
      if (group.initial) follow(*group.initial);
      if (group.hold) follow(*group.hold);
    }
    for (diagram::FlatPhase& phase : flat_.timeline.phases) {
      if (phase.until) follow(phase.until->signal);
    }
  }

  diagram::FlatDiagram& flat_;
  const diagram::BlockLibrary& library_;
  bool switches_corners_;
  const std::vector<SignalRange>& ranges_;
  double until_;
  int segments_;
  std::vector<std::size_t> first_;  ///< signal of each block
  std::size_t signals_ = 0;
  std::vector<bool> needed_;  ///< each signal, by an output or for the modes
  std::optional<std::size_t> clock_;
  std::vector<TabulatedFunction> functions_;
  text::Diagnostics diagnostics_;
};

}  // namespace

std::vector<TabulatedFunction> tabulate_functions(diagram::FlatDiagram& flat,
                                                  const diagram::BlockLibrary& library,
                                                  const diagram::MachineProfile& machine,
                                                  const std::vector<SignalRange>& ranges, double until,
                                                  int segments) {
  return Tabulator(flat, library, machine, ranges, until, segments).tabulate();
}

}  // namespace oblique::machine
