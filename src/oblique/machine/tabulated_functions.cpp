// SPDX-License-Identifier: MIT
#include <oblique/machine/tabulated_functions.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <oblique/machine/function_reader.h>
#include <oblique/machine/line_segments.h>
#include <oblique/machine/logic_ports.h>
#include <oblique/machine/mode_control.h>
#include <oblique/machine/realise.h>
#include <oblique/machine/role.h>
#include <oblique/machine/time_circuit.h>

namespace oblique::machine {
namespace {

/// Of the span of a function: by less than this a straight line is what it says.
constexpr double kStraight = 1e-12;
constexpr double kMostError = 0.05;  ///< of the span: lines that miss by more do not stand for the function
/// As many times larger signals than what becomes of them leave nothing of it on a machine.
constexpr double kMostExcess = 1e4;

class Tabulator {
 public:
  Tabulator(diagram::FlatDiagram& flat, const diagram::BlockLibrary& library,
            const diagram::MachineProfile& machine, const std::vector<SignalRange>& ranges, double until,
            int segments)
      : flat_(flat),
        library_(library),
        machine_(machine),
        has_generators_(machine.find(diagram::ElementKind::function_generator) != nullptr),
        switches_corners_(!has_generators_ && machine.find(diagram::ElementKind::comparator) != nullptr &&
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
      if (!may_be_tabulated(flat_.blocks[b].definition->role, machine_)) continue;
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
    diagram::FlatInput argument;
    if (function.input()) argument = block.inputs[*function.input()];
    if (function.is_of_time()) argument = time();
    const SignalRange range = function.is_of_time() ? SignalRange{0, until_} : range_of(argument);
    const auto& outputs = block.definition->outputs;
    std::vector<diagram::FlatBlock> made;
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      const std::string path = outputs.size() == 1 ? block.path : block.path + "." + outputs[k].name;
      const std::size_t signal = first_[b] + k;
      Function wanted;
      if (needed_[signal]) {
        wanted.value = [&function, k](double x) { return function.value(k, x); };
        wanted.seen = ranges_[signal];
        if (function.is_of_time()) wanted.of_time = function.formula(k);
      }
      made.push_back(element_for(wanted, block, path, argument, range));
    }
    flat_.blocks[b] = std::move(made.front());
    for (std::size_t k = 1; k < made.size(); ++k) {
      redirect({b, k}, {flat_.blocks.size(), 0});
      flat_.blocks.push_back(std::move(made[k]));
    }
  }

  /// What is to be made of elements.
  struct Function {
    std::function<double(double)> value = [](double) { return 0; };
    std::optional<text::Expression> of_time;  ///< where the time is the argument
    std::optional<SignalRange> seen;  ///< what it was over the run, where it is a signal of the diagram
  };

  diagram::FlatBlock element_for(const Function& function, const diagram::FlatBlock& block,
                                 const std::string& path, const diagram::FlatInput& argument,
                                 const SignalRange& range) {
    const auto value = [&](double x) {
      try {
        return function.value(x);
      } catch (const text::ExpressionError&) {
        return std::nan("");
      }
    };
    const double middle = (range.low + range.high) / 2;
    const LineSegments one = range.high > range.low ? lines_for(function, value, range, 1)
                                                    : LineSegments{{{middle}, {value(middle)}}, 0};
    double size = 0;
    for (const double y : one.points.y) size = std::max(size, std::abs(y));
    if (one.error <= kStraight * size) return summer(one.points, block, path, argument);
    const LineSegments lines = lines_for(function, value, range, segments_);
    const bool is_exact = lines.error <= kStraight * (lines.high - lines.low);
    constexpr std::size_t kMostCorners = 4;
    const bool becomes_corners = switches_corners_ && is_exact && lines.points.x.size() <= kMostCorners + 2;
    // It is then refused as the function generator that it is.
    if (block.definition->role == Role::function_generator && !becomes_corners) return block;
    if (function.of_time && !is_exact) {
      const auto circuit = time_circuit(*function.of_time, until_);
      if (circuit && is_better(*circuit, lines)) return drawn(*circuit, block, path);
      if (circuit && circuit->excess > kMostExcess && !are_good(lines)) {
        diagnostics_.add(
            {block.place,
             fmt::format("'{}' ({}) would be made of signals up to {:.2g} times as large as itself", path,
                         block.definition->name, circuit->excess),
             "a formula whose parts a machine can carry beside it",
             "leave out what hardly counts, or let it run for a shorter time"});
        return block;
      }
    }
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
    if (!are_good(lines)) {
      diagnostics_.add(
          {block.place,
           fmt::format("{} straight line{} '{}' ({}) by {:.2g}, which itself goes from {:.4g} to {:.4g}",
                       lines.points.x.size() - 1, lines.points.x.size() > 2 ? "s miss" : " misses", path,
                       block.definition->name, lines.error, low, high),
           "a function that a function generator can be set for",
           text::Remedy{"more lines (", text::Setting{"segments"}, "), if the machine has them"}});
      return block;
    }
    if (becomes_corners) return corners(lines.points, block, path, argument);
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

  /// The lines, which miss by as much as the signal was beyond them in the run: what is narrower than the
  /// points that they are found by.
  static LineSegments lines_for(const Function& function, const std::function<double(double)>& value,
                                const SignalRange& range, int segments) {
    LineSegments lines = line_segments(value, range.low, range.high, segments);
    if (!function.seen || !std::isfinite(lines.error)) return lines;
    const auto [least, most] = std::minmax_element(lines.points.y.begin(), lines.points.y.end());
    const double beyond = std::max(*least - function.seen->low, function.seen->high - *most);
    lines.low = std::min(lines.low, function.seen->low);
    lines.high = std::max(lines.high, function.seen->high);
    constexpr double kRounding = 1e-6;  // between the points, and the solver's
    if (beyond > kRounding * (lines.high - lines.low)) lines.error = std::max(lines.error, beyond);
    return lines;
  }

  static bool are_good(const LineSegments& lines) {
    return std::isfinite(lines.error) && lines.error <= kMostError * (lines.high - lines.low);
  }

  /// Whether a circuit draws a formula better than straight lines behind a clock. What oscillates or jumps it
  /// does where it can be carried; of what only grows or decays both err, elements by a part of their largest
  /// signals.
  bool is_better(const TimeCircuit& circuit, const LineSegments& lines) const {
    constexpr double kExcess = 100;  // of what oscillates
    // By which elements err, of their unit.
    constexpr double kOfMultipliers = 5e-3, kOfOthers = 2e-4;
    const bool multiplies =
        std::any_of(circuit.signals.begin(), circuit.signals.end(),
                    [](const TimeSignal& signal) { return signal.kind == TimeSignal::Kind::product; });
    const bool has_lines =
        std::all_of(circuit.signals.begin(), circuit.signals.end(), [&](const TimeSignal& signal) {
          return signal.kind != TimeSignal::Kind::function ||
                 are_good(line_segments(value_of(signal), signal.range.low, signal.range.high, segments_));
        });
    if (!has_lines || circuit.excess > kMostExcess) return false;
    if (!has_generators_ || !are_good(lines) || circuit.excess <= 1 + kStraight) return true;
    if (circuit.turns) return circuit.excess <= kExcess;
    return circuit.excess * (multiplies ? kOfMultipliers : kOfOthers) <
           lines.error / (lines.high - lines.low);
  }

  static std::function<double(double)> value_of(const TimeSignal& function) {
    return [&function](double x) {
      return text::evaluate(function.function, [x](std::string_view) { return x; });
    };
  }

  /// The sum of a circuit's signals, which are appended.
  diagram::FlatBlock drawn(const TimeCircuit& circuit, const diagram::FlatBlock& block,
                           const std::string& path) {
    const std::vector<TimeSum::Term>& terms = circuit.out.terms;
    const bool is_one = terms.size() == 1 && circuit.out.constant == 0;
    std::vector<diagram::FlatInput> signals;
    signals.reserve(circuit.signals.size());
    for (const TimeSignal& signal : circuit.signals) {
      // What is the whole formula but for a factor has its size at once.
      const bool is_all = is_one && terms.front().signal == signals.size();
      signals.push_back(drawn(signal, is_all ? terms.front().weight : 1, signals, block, path));
    }
    const diagram::FlatInput sum = sum_of(circuit.out, signals);
    if (sum.terms.size() != 1 || sum.constant != 0) {
      diagram::FlatBlock made = element_for(block, Role::summer, path);
      made.inputs = {sum};
      return made;
    }
    diagram::FlatBlock made = element_for(block, Role::gain, path);  // no element, but a weight
    made.parameters[made.definition->find_parameter("factor").value()] = sum.terms.front().weight;
    made.inputs = {{{{1, sum.terms.front().signal}}, 0}};
    return made;
  }

  static diagram::FlatInput sum_of(const TimeSum& sum, const std::vector<diagram::FlatInput>& signals) {
    diagram::FlatInput input{{}, sum.constant};
    for (const TimeSum::Term& term : sum.terms) {
      const diagram::FlatInput& signal = signals[term.signal];
      input.constant += term.weight * signal.constant;
      for (const diagram::FlatTerm& part : signal.terms)
        input.terms.push_back({term.weight * part.weight, part.signal});
    }
    return input;
  }

  /// A signal of a circuit as a sum of appended elements, of which oscillations and exponentials are `size`
  /// times as large.
  diagram::FlatInput drawn(const TimeSignal& signal, double size,
                           const std::vector<diagram::FlatInput>& signals, const diagram::FlatBlock& block,
                           const std::string& path) {
    const std::string name = fmt::format("{}.part_{}", path, signals.size());
    switch (signal.kind) {
      case TimeSignal::Kind::clock:
        return time();
      case TimeSignal::Kind::sine:
        return sine(signal, size, block, path);
      case TimeSignal::Kind::exponential:
        return exponential(signal, size, block, path);
      case TimeSignal::Kind::product: {
        diagram::FlatBlock product = element_for(block, Role::multiplier, name);
        product.inputs = {sum_of(signal.a, signals), sum_of(signal.b, signals)};
        return {{{1, append(std::move(product))}}, 0};
      }
      case TimeSignal::Kind::comparison: {
        diagram::FlatBlock comparator = element_for(block, Role::comparator, name);
        feed(comparator, sum_of(signal.a, signals));
        return {{{1, append(std::move(comparator))}}, 0};
      }
      case TimeSignal::Kind::function: {
        const Function function{value_of(signal), {}, {}};
        diagram::FlatBlock made = element_for(function, block, name, sum_of(signal.a, signals), signal.range);
        return {{{1, append(std::move(made))}}, 0};
      }
    }
    return {};
  }

  /// exp(growth·t) of an integrator, one for all of a growth.
  diagram::FlatInput exponential(const TimeSignal& wanted, double size, const diagram::FlatBlock& block,
                                 const std::string& path) {
    const auto [found, is_new] = exponentials_.try_emplace(wanted.growth);
    if (is_new) {
      found->second = {size, 0, {flat_.blocks.size(), 0}, {}};
      diagram::FlatBlock integrator = element_for(block, Role::integrator, path + ".exponential");
      set_initial(integrator, size);
      feed(integrator, {{{wanted.growth, found->second.sine}}, 0});
      append(std::move(integrator));
    }
    return {{{1 / found->second.size, found->second.sine}}, 0};
  }

  /// exp(growth·t) sin(rate·t + phase) of a ring of two integrators, one for all of a rate and growth.
  diagram::FlatInput sine(const TimeSignal& wanted, double size, const diagram::FlatBlock& block,
                          const std::string& path) {
    const auto [found, is_new] = rings_.try_emplace({wanted.rate, wanted.growth});
    Source& ring = found->second;
    if (is_new) {
      ring = {size, wanted.phase, {flat_.blocks.size(), 0}, {flat_.blocks.size() + 1, 0}};
      diagram::FlatBlock sine = element_for(block, Role::integrator, path + ".source_sine");
      diagram::FlatBlock cosine = element_for(block, Role::integrator, path + ".source_cosine");
      const double a = std::sin(wanted.phase), b = std::cos(wanted.phase);
      set_initial(sine, std::abs(a) > kStraight ? size * a : 0);
      set_initial(cosine, std::abs(b) > kStraight ? size * b : 0);
      diagram::FlatInput sine_in{{{wanted.rate, ring.cosine}}, 0}, cosine_in{{{-wanted.rate, ring.sine}}, 0};
      if (wanted.growth != 0) {
        sine_in.terms.push_back({wanted.growth, ring.sine});
        cosine_in.terms.push_back({wanted.growth, ring.cosine});
      }
      feed(sine, sine_in);
      feed(cosine, cosine_in);
      append(std::move(sine));
      append(std::move(cosine));
    }
    const double ahead = wanted.phase - ring.phase;
    diagram::FlatInput sum;
    for (const auto& [weight, signal] :
         {std::pair(std::cos(ahead), ring.sine), {std::sin(ahead), ring.cosine}}) {
      if (std::abs(weight) > kStraight) sum.terms.push_back({weight / ring.size, signal});
    }
    return sum;
  }

  static void set_initial(diagram::FlatBlock& integrator, double value) {
    integrator.parameters[integrator.definition->find_parameter("initial").value()] = value;
  }

  /// Connects the summing input.
  static void feed(diagram::FlatBlock& block, const diagram::FlatInput& input) {
    for (std::size_t i = 0; i < block.inputs.size(); ++i) {
      if (block.definition->inputs[i].sum) block.inputs[i] = input;
    }
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
      feed(above, compared);
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
      feed(clock, {{}, 1});
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

  /// What draws size·exp(growth·t) sin(rate·t + phase) and the same of the cosine; of an exponential the
  /// first alone, without the sine.
  struct Source {
    double size = 1, phase = 0;
    diagram::SignalRef sine, cosine;
  };

  diagram::FlatDiagram& flat_;
  const diagram::BlockLibrary& library_;
  const diagram::MachineProfile& machine_;
  bool has_generators_;
  bool switches_corners_;
  const std::vector<SignalRange>& ranges_;
  double until_;
  int segments_;
  std::vector<std::size_t> first_;  ///< signal of each block
  std::size_t signals_ = 0;
  std::vector<bool> needed_;  ///< each signal, by an output or for the modes
  std::optional<std::size_t> clock_;
  std::map<std::pair<double, double>, Source> rings_;  ///< of each rate and growth
  std::map<double, Source> exponentials_;              ///< of each growth
  std::vector<TabulatedFunction> functions_;
  text::Diagnostics diagnostics_;
};

}  // namespace

bool may_be_tabulated(Role role, const diagram::MachineProfile& machine) {
  return role == Role::other || (role == Role::function_generator &&
                                 machine.find(diagram::ElementKind::function_generator) == nullptr);
}

std::vector<TabulatedFunction> tabulate_functions(diagram::FlatDiagram& flat,
                                                  const diagram::BlockLibrary& library,
                                                  const diagram::MachineProfile& machine,
                                                  const std::vector<SignalRange>& ranges, double until,
                                                  int segments) {
  return Tabulator(flat, library, machine, ranges, until, segments).tabulate();
}

}  // namespace oblique::machine
