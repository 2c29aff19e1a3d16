// SPDX-License-Identifier: MIT
// How a formula of the time becomes a circuit
//
// A function generator behind a clock draws few straight lines over the whole run: of a sine, of a step and
// of many periods of anything it is no picture. What a machine room made of such a formula are circuits: two
// integrators in a ring for a sine, one with feedback for an exponential, a comparator of the clock for a
// step, multipliers between them. So the formula is read from its numbers upwards, and each part of it is one
// of
//
//   constant    a number
//   linear      weight·t + constant
//   polynomial  sums and products of these
//   smooth      another function of the time: one function generator behind the clock
//   circuit     a sum of signals that are circuits already
//
// What is linear becomes a circuit in a sine, an exponential or a condition; what is smooth becomes one
// signal where it meets a circuit. At the end the signals are drawn over the run: where one has to be far
// larger than what becomes of it, as exp(400 − t) times 0, a machine could not carry both.
#include <oblique/machine/time_circuit.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>

namespace oblique::machine {
namespace {

using text::Expression;
using text::Function;
using Kind = text::Expression::Kind;

constexpr std::string_view kArgument = "x";  ///< of TimeSignal::function

Expression number(double value) {
  Expression made;
  made.number = value;
  return made;
}

Expression named(std::string_view name) {
  Expression made;
  made.kind = Kind::name;
  made.name = name;
  return made;
}

Expression joined(Kind kind, Expression a, Expression b) {
  Expression made;
  made.kind = kind;
  made.operands = {std::move(a), std::move(b)};
  return made;
}

/// The expression with another in the place of a name.
Expression with(Expression expression, std::string_view name, const Expression& value) {
  if (expression.kind == Kind::name && expression.name == name) return value;
  for (Expression& operand : expression.operands) operand = with(std::move(operand), name, value);
  return expression;
}

double value_at(const Expression& expression, std::string_view name, double x) {
  return text::evaluate(
      expression, [&](std::string_view asked) { return asked == name ? std::optional(x) : std::nullopt; });
}

TimeSum scaled(TimeSum sum, double factor) {
  sum.constant *= factor;
  for (TimeSum::Term& term : sum.terms) term.weight *= factor;
  return sum;
}

TimeSum sum_of(TimeSum a, const TimeSum& b) {
  a.constant += b.constant;
  for (const TimeSum::Term& term : b.terms) {
    const auto same =
        std::find_if(a.terms.begin(), a.terms.end(), [&](const auto& t) { return t.signal == term.signal; });
    if (same == a.terms.end()) {
      a.terms.push_back(term);
    } else {
      same->weight += term.weight;
    }
  }
  return a;
}

/// What a part of the formula is.
struct Part {
  enum class Is { constant, linear, polynomial, smooth, circuit };
  Is is = Is::constant;
  Expression formula;     ///< of `time`; not looked at of a circuit
  TimeSum sum;            ///< not looked at of what is smooth
  bool is_truth = false;  ///< a circuit of nothing but 0 and 1
};

/// There is no circuit for it.
struct NoCircuit {};

class Reader {
 public:
  explicit Reader(double until) : until_(until) {}

  std::optional<TimeCircuit> read(const Expression& formula) {
    try {
      const Part whole = part_of(formula);
      if (whole.is == Is::smooth) return std::nullopt;
      TimeCircuit circuit = used(whole.sum);
      if (!draw(circuit)) return std::nullopt;
      return circuit;
    } catch (const NoCircuit&) {
      return std::nullopt;
    } catch (const text::ExpressionError&) {
      return std::nullopt;
    }
  }

 private:
  using Is = Part::Is;

  Part part_of(const Expression& e) {
    if (e.kind == Kind::name && e.name == "time")
      return {Is::linear, e, {0, {{1, signal({TimeSignal::Kind::clock, 0, 0, {}, {}, {}, {}})}}}, false};
    std::vector<Part> operands;
    operands.reserve(e.operands.size());
    for (const Expression& operand : e.operands) operands.push_back(part_of(operand));
    const auto most = std::max_element(operands.begin(), operands.end(),
                                       [](const Part& a, const Part& b) { return a.is < b.is; });
    if (operands.empty() || most->is == Is::constant)
      return {Is::constant, e, {text::evaluate(e), {}}, false};
    switch (e.kind) {
      case Kind::negate:
        return weighted(e, operands[0], -1);
      case Kind::add:
        return added(e, operands[0], operands[1], 1);
      case Kind::subtract:
        return added(e, operands[0], operands[1], -1);
      case Kind::multiply:
        return multiplied(e, operands[0], operands[1]);
      case Kind::divide:
        return divided(e, operands[0], operands[1]);
      case Kind::power:
        return power(e, operands[0], operands[1]);
      case Kind::less:
      case Kind::less_equal:
        return compared(added(e, operands[1], operands[0], -1));
      case Kind::greater:
      case Kind::greater_equal:
        return compared(added(e, operands[0], operands[1], -1));
      case Kind::logical_and:
        return logical(operands[0], operands[1], -1.5);
      case Kind::logical_or:
        return logical(operands[0], operands[1], -0.5);
      case Kind::logical_not:
        if (!operands[0].is_truth) throw NoCircuit{};
        return {Is::circuit, {}, sum_of({1, {}}, scaled(operands[0].sum, -1)), true};
      case Kind::call:
        return called(e, operands);
      case Kind::equal:
      case Kind::not_equal:
      case Kind::number:
      case Kind::name:
        break;
    }
    throw NoCircuit{};
  }

  static bool is_constant(const Part& part) { return part.is == Is::constant; }

  Part weighted(const Expression& e, const Part& part, double factor) {
    if (part.is == Is::smooth) return {Is::smooth, e, {}, false};
    return {part.is, e, scaled(part.sum, factor), false};
  }

  Part added(const Expression& e, const Part& a, const Part& b, double sign) {
    const Is is = std::max(a.is, b.is);
    if (is == Is::smooth) return {is, e, {}, false};
    return {is, e, sum_of(sum_in(a), scaled(sum_in(b), sign)), false};
  }

  Part multiplied(const Expression& e, const Part& a, const Part& b) {
    if (is_constant(a)) return weighted(e, b, a.sum.constant);
    if (is_constant(b)) return weighted(e, a, b.sum.constant);
    const Is is = std::max(a.is, b.is);
    if (is == Is::smooth) return {is, e, {}, false};
    return {std::max(is, Is::polynomial), e, product(sum_in(a), sum_in(b)).sum, false};
  }

  Part divided(const Expression& e, const Part& a, const Part& b) {
    if (is_constant(b)) return weighted(e, a, 1 / b.sum.constant);
    if (std::max(a.is, b.is) < Is::circuit) return {Is::smooth, e, {}, false};
    if (is_constant(a) || b.is < Is::circuit) {
      // A smooth divisor is one signal with its reciprocal.
      const Expression one = number(is_constant(a) ? a.sum.constant : 1);
      const Part reciprocal = b.is < Is::circuit
                                  ? Part{Is::smooth, joined(Kind::divide, one, b.formula), {}, false}
                                  : function_of(joined(Kind::divide, one, named(kArgument)), b);
      return is_constant(a) ? reciprocal : product(sum_in(a), sum_in(reciprocal));
    }
    return product(sum_in(a), function_of(joined(Kind::divide, number(1), named(kArgument)), b).sum);
  }

  Part power(const Expression& e, const Part& base, const Part& exponent) {
    const Is is = std::max(base.is, exponent.is);
    if (is == Is::smooth) return {is, e, {}, false};
    if (!is_constant(exponent)) {
      if (is < Is::circuit) return {Is::smooth, e, {}, false};
      throw NoCircuit{};
    }
    const double n = exponent.sum.constant;
    if (n == 1) return base;
    constexpr int kMostFactors = 4;
    if (n == 2 || n == 3 || n == kMostFactors) {
      TimeSum factors = product(base.sum, base.sum).sum;
      if (n > 2) factors = product(factors, n == 3 ? base.sum : factors).sum;
      return {std::max(is, Is::polynomial), e, std::move(factors), false};
    }
    if (base.is < Is::circuit) return {Is::smooth, e, {}, false};
    return function_of(joined(Kind::power, named(kArgument), number(n)), base);
  }

  /// 1 where a part is above 0, else 0.
  Part compared(const Part& part) {
    return {
        Is::circuit, {}, one(signal({TimeSignal::Kind::comparison, 0, 0, sum_in(part), {}, {}, {}})), true};
  }

  Part logical(const Part& a, const Part& b, double threshold) {
    if (!a.is_truth || !b.is_truth) throw NoCircuit{};
    return compared({Is::circuit, {}, sum_of(sum_of(a.sum, b.sum), {threshold, {}}), false});
  }

  Part called(const Expression& e, const std::vector<Part>& operands) {
    const auto varies = [](const Part& part) { return !is_constant(part); };
    const Part& first = operands.front();
    switch (e.function) {
      case Function::sin:
      case Function::cos:
        if (first.is == Is::linear) return sine(first.sum, e.function == Function::cos);
        break;
      case Function::exp:
        if (first.is == Is::linear) return exponential(first.sum);
        break;
      case Function::step:
        return compared(first);
      case Function::sign: {
        const Part above = compared(first);
        return {Is::circuit, {}, sum_of({-1, {}}, scaled(above.sum, 2)), false};
      }
      case Function::if_:
        return chosen(operands);
      case Function::min:
      case Function::max:
        if (std::count_if(operands.begin(), operands.end(), varies) > 1) return extreme(e, operands);
        break;
      default:
        break;
    }
    const bool has_circuit = std::any_of(operands.begin(), operands.end(),
                                         [](const Part& part) { return part.is == Is::circuit; });
    if (!has_circuit) return {Is::smooth, e, {}, false};
    if (std::count_if(operands.begin(), operands.end(), varies) > 1) throw NoCircuit{};
    const auto k = std::find_if(operands.begin(), operands.end(), varies) - operands.begin();
    Expression of_one = e;
    of_one.operands[static_cast<std::size_t>(k)] = named(kArgument);
    return function_of(std::move(of_one), operands[static_cast<std::size_t>(k)]);
  }

  Part chosen(const std::vector<Part>& operands) {
    if (!operands[0].is_truth) throw NoCircuit{};
    const Part &a = operands[1], &b = operands[2];
    if (is_constant(a) && is_constant(b))
      return {
          Is::circuit, {}, sum_of(scaled(operands[0].sum, a.sum.constant - b.sum.constant), b.sum), false};
    const TimeSum otherwise = sum_in(b);
    const TimeSum change = sum_of(sum_in(a), scaled(otherwise, -1));
    return {Is::circuit, {}, sum_of(product(operands[0].sum, change).sum, otherwise), false};
  }

  /// max(a, b) = a + max(b − a, 0), min(a, b) = a + min(b − a, 0).
  Part extreme(const Expression& e, const std::vector<Part>& operands) {
    if (std::all_of(operands.begin(), operands.end(), [](const Part& p) { return p.is < Is::circuit; }))
      return {Is::smooth, e, {}, false};
    Expression beyond = e;
    beyond.operands = {named(kArgument), number(0)};
    TimeSum found = sum_in(operands.front());
    for (std::size_t k = 1; k < operands.size(); ++k) {
      const Part difference{Is::circuit, {}, sum_of(sum_in(operands[k]), scaled(found, -1)), false};
      found = sum_of(found, function_of(beyond, difference).sum);
    }
    return {Is::circuit, {}, found, false};
  }

  /// sin(rate·t + constant), or the cosine.
  Part sine(const TimeSum& angle, bool is_cosine) {
    double rate = angle.terms.front().weight;
    double phase = angle.constant + (is_cosine ? std::numbers::pi / 2 : 0);
    if (rate < 0) {
      rate = -rate;
      phase = std::numbers::pi - phase;
    }
    phase = std::remainder(phase, 2 * std::numbers::pi);
    return {Is::circuit, {}, one(signal({TimeSignal::Kind::sine, rate, phase, {}, {}, {}, {}})), false};
  }

  Part exponential(const TimeSum& exponent) {
    const double rate = exponent.terms.front().weight;
    return {Is::circuit,
            {},
            one(signal({TimeSignal::Kind::exponential, rate, exponent.constant, {}, {}, {}, {}})),
            false};
  }

  Part product(TimeSum a, TimeSum b) {
    return {Is::circuit,
            {},
            one(signal({TimeSignal::Kind::product, 0, 0, std::move(a), std::move(b), {}, {}})),
            false};
  }

  /// A function of the argument at a part; of a function of one signal, a function of that signal.
  Part function_of(Expression function, const Part& part) {
    TimeSum argument = part.sum;
    if (argument.terms.size() == 1) {
      const auto [weight, inner] = argument.terms.front();
      if (signals_[inner].kind == TimeSignal::Kind::function) {
        const Expression of_inner =
            joined(Kind::add, joined(Kind::multiply, number(weight), signals_[inner].function),
                   number(argument.constant));
        function = with(std::move(function), kArgument, of_inner);
        argument = signals_[inner].a;
      }
    }
    return {Is::circuit,
            {},
            one(signal({TimeSignal::Kind::function, 0, 0, std::move(argument), {}, std::move(function), {}})),
            false};
  }

  /// A part as a sum of signals: what is smooth is a function of the clock.
  TimeSum sum_in(const Part& part) {
    if (part.is != Is::smooth) return part.sum;
    const TimeSum clock = part_of(named("time")).sum;
    return one(signal(
        {TimeSignal::Kind::function, 0, 0, clock, {}, with(part.formula, "time", named(kArgument)), {}}));
  }

  /// The circuit of the signals that a sum is made of.
  TimeCircuit used(TimeSum out) const {
    std::vector<bool> needed(signals_.size(), false);
    const auto need = [&](const TimeSum& sum) {
      for (const TimeSum::Term& term : sum.terms) needed[term.signal] = true;
    };
    need(out);
    for (std::size_t i = signals_.size(); i-- > 0;) {
      if (!needed[i]) continue;
      need(signals_[i].a);
      need(signals_[i].b);
    }
    TimeCircuit circuit;
    std::vector<std::size_t> place(signals_.size());
    const auto move = [&](TimeSum& sum) {
      for (TimeSum::Term& term : sum.terms) term.signal = place[term.signal];
    };
    for (std::size_t i = 0; i < signals_.size(); ++i) {
      if (!needed[i]) continue;
      place[i] = circuit.signals.size();
      circuit.signals.push_back(signals_[i]);
      move(circuit.signals.back().a);
      move(circuit.signals.back().b);
    }
    move(out);
    circuit.out = std::move(out);
    return circuit;
  }

  static TimeSum one(std::size_t signal) { return {0, {{1, signal}}}; }

  std::size_t signal(TimeSignal made) {
    if (made.kind == TimeSignal::Kind::clock) {
      const auto clock = std::find_if(signals_.begin(), signals_.end(),
                                      [](const TimeSignal& s) { return s.kind == TimeSignal::Kind::clock; });
      if (clock != signals_.end()) return static_cast<std::size_t>(clock - signals_.begin());
    }
    signals_.push_back(std::move(made));
    return signals_.size() - 1;
  }

  /// What the signals are over the run. False where one is not finite, or too large for what becomes of it.
  bool draw(TimeCircuit& circuit) const {
    /// Of what becomes of it: a larger one leaves little of a machine's unit to that.
    constexpr double kMostOf = 100;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const std::optional<int> count = moments(circuit);
    if (!count) return false;
    struct Peaks {
      double a = 0, b = 0, terms = 0, own = 0;
    };
    const std::size_t n = circuit.signals.size();
    std::vector<double> s(n);
    std::vector<Peaks> peaks(n);
    Peaks whole;
    for (TimeSignal& signal : circuit.signals) signal.range = {kInfinity, -kInfinity};
    const auto grow = [](double& peak, double value) { peak = std::max(peak, std::abs(value)); };
    const auto value = [&](const TimeSum& sum, double& most) {
      grow(most, sum.constant);
      double total = sum.constant;
      for (const TimeSum::Term& term : sum.terms) {
        grow(most, term.weight * s[term.signal]);
        total += term.weight * s[term.signal];
      }
      return total;
    };
    for (int k = 0; k <= *count; ++k) {
      const double t = until_ * k / *count;
      for (std::size_t i = 0; i < n; ++i) {
        TimeSignal& signal = circuit.signals[i];
        const double a = value(signal.a, peaks[i].terms), b = value(signal.b, peaks[i].terms);
        s[i] = value_of(signal, t, a, b);
        if (!std::isfinite(s[i])) return false;
        grow(peaks[i].a, a);
        grow(peaks[i].b, b);
        grow(peaks[i].own, s[i]);
        signal.range = {std::min(signal.range.low, a), std::max(signal.range.high, a)};
      }
      grow(whole.own, value(circuit.out, whole.terms));
    }
    for (std::size_t i = 0; i < n; ++i) {
      const TimeSignal::Kind kind = circuit.signals[i].kind;
      const Peaks& seen = peaks[i];
      if (kind == TimeSignal::Kind::product && seen.a * seen.b > kMostOf * seen.own) return false;
      const double span = circuit.signals[i].range.high - circuit.signals[i].range.low;
      if (kind == TimeSignal::Kind::function && seen.terms > kMostOf * span) return false;
    }
    return whole.terms <= kMostOf * whole.own;
  }

  /// At how many the signals are looked at: the extremes of an argument of a function are met to 1e-4.
  /// Nothing where these would be too many.
  std::optional<int> moments(const TimeCircuit& circuit) const {
    constexpr double kLeast = 4096, kMost = 1e6, kOfRadian = 40;
    double radians = 0;
    bool has_function = false;
    for (const TimeSignal& signal : circuit.signals) {
      if (signal.kind == TimeSignal::Kind::sine) radians = std::max(radians, signal.rate * until_);
      has_function = has_function || signal.kind == TimeSignal::Kind::function;
    }
    const double wanted = std::max(kLeast, kOfRadian * radians);
    if (wanted <= kMost) return static_cast<int>(wanted);
    return has_function ? std::nullopt : std::optional(static_cast<int>(kLeast));
  }

  static double value_of(const TimeSignal& signal, double t, double a, double b) {
    switch (signal.kind) {
      case TimeSignal::Kind::clock:
        return t;
      case TimeSignal::Kind::sine:
        return std::sin(signal.rate * t + signal.phase);
      case TimeSignal::Kind::exponential:
        return std::exp(signal.rate * t + signal.phase);
      case TimeSignal::Kind::product:
        return a * b;
      case TimeSignal::Kind::comparison:
        return a > 0 ? 1 : 0;
      case TimeSignal::Kind::function:
        return value_at(signal.function, kArgument, a);
    }
    return 0;
  }

  double until_;
  std::vector<TimeSignal> signals_;
};

}  // namespace

std::optional<TimeCircuit> time_circuit(const Expression& formula, double until) {
  return Reader(until).read(formula);
}

}  // namespace oblique::machine
