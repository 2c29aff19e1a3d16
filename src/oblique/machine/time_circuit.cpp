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
// signal where it meets a circuit. A function of what only grows and decays is smooth too: behind an
// exponential that goes through decades no function generator could be set. At the end the signals are drawn
// over the run, to tell how much larger they are than what becomes of them.
#include <oblique/machine/time_circuit.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include <oblique/machine/time_circuit_run.h>

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
  Expression formula;     ///< of `time`
  TimeSum sum;            ///< not looked at of what is smooth
  bool turns = false;     ///< whether there is a sine in it, or a comparison
  bool is_truth = false;  ///< of nothing but 0 and 1
};

/// There is no circuit for it.
struct NoCircuit {};

class Reader {
 public:
  explicit Reader(double until) : until_(until) {}

  std::optional<TimeCircuit> read(const Expression& formula) {
    try {
      const Part whole = part_of(formula);
      if (whole.is == Is::smooth || is_constant(whole)) return std::nullopt;
      TimeCircuit circuit = used(whole.sum);
      circuit.turns = whole.turns;
      if (!look_over_run(circuit, until_)) return std::nullopt;
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
      return {Is::linear, e, one(signal({TimeSignal::Kind::clock, 0, 0, 0, {}, {}, {}}))};
    std::vector<Part> operands;
    operands.reserve(e.operands.size());
    for (const Expression& operand : e.operands) operands.push_back(part_of(operand));
    if (std::all_of(operands.begin(), operands.end(), is_constant)) {
      const double value = text::evaluate(with_values(e, operands));
      return {Is::constant, number(value), {value, {}}, false, value == 0 || value == 1};
    }
    Part part = part_of(e, operands);
    std::erase_if(part.sum.terms, [](const TimeSum::Term& term) { return term.weight == 0; });
    if (part.is != Is::smooth && part.sum.terms.empty())
      return {Is::constant, number(part.sum.constant), part.sum, false, part.is_truth};
    part.formula = e;
    for (const Part& operand : operands) part.turns = part.turns || operand.turns;
    return part;
  }

  /// The expression with the values of its operands, which are constants.
  static Expression with_values(Expression e, const std::vector<Part>& operands) {
    for (std::size_t k = 0; k < operands.size(); ++k) e.operands[k] = number(operands[k].sum.constant);
    return e;
  }

  Part part_of(const Expression& e, const std::vector<Part>& operands) {
    switch (e.kind) {
      case Kind::negate:
        return weighted(operands[0], -1);
      case Kind::add:
        return added(operands[0], operands[1], 1);
      case Kind::subtract:
        return added(operands[0], operands[1], -1);
      case Kind::multiply:
        return multiplied(operands[0], operands[1]);
      case Kind::divide:
        return divided(operands[0], operands[1]);
      case Kind::power:
        return power(operands[0], operands[1]);
      case Kind::less:
      case Kind::less_equal:
        return compared(difference(operands[1], operands[0]));
      case Kind::greater:
      case Kind::greater_equal:
        return compared(difference(operands[0], operands[1]));
      case Kind::logical_and:
        return both(operands[0], operands[1]);
      case Kind::logical_or:
        return negated(both(negated(operands[0]), negated(operands[1])));
      case Kind::logical_not:
        return negated(operands[0]);
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
  static Part smooth() { return {Is::smooth, {}, {}}; }
  static Part circuit(TimeSum sum, bool turns) { return {Is::circuit, {}, std::move(sum), turns}; }

  static Part weighted(const Part& part, double factor) {
    if (part.is == Is::smooth) return smooth();
    return {part.is, {}, scaled(part.sum, factor)};
  }

  Part added(const Part& a, const Part& b, double sign) {
    const Is is = std::max(a.is, b.is);
    if (is == Is::smooth) return smooth();
    return {is, {}, sum_of(sum_in(a), scaled(sum_in(b), sign))};
  }

  TimeSum difference(const Part& a, const Part& b) { return sum_of(sum_in(a), scaled(sum_in(b), -1)); }

  Part multiplied(const Part& a, const Part& b) {
    if (is_constant(a)) return weighted(b, a.sum.constant);
    if (is_constant(b)) return weighted(a, b.sum.constant);
    const Is is = std::max(a.is, b.is);
    if (is == Is::smooth) return smooth();
    return {std::max(is, Is::polynomial), {}, product(sum_in(a), sum_in(b))};
  }

  Part divided(const Part& a, const Part& b) {
    if (is_constant(b)) return weighted(a, 1 / b.sum.constant);
    if (std::max(a.is, b.is) < Is::circuit) return smooth();
    Part reciprocal = function_of(joined(Kind::divide, number(1), named(kArgument)), b);
    reciprocal.formula = joined(Kind::divide, number(1), b.formula);
    return multiplied(a, reciprocal);
  }

  Part power(const Part& base, const Part& exponent) {
    const Is is = std::max(base.is, exponent.is);
    if (is == Is::smooth) return smooth();
    if (!is_constant(exponent)) {
      if (is < Is::circuit) return smooth();
      throw NoCircuit{};
    }
    const double n = exponent.sum.constant;
    if (n == 1) return base;
    constexpr int kMostFactors = 4;
    if (n == 2 || n == 3 || n == kMostFactors) {
      TimeSum factors = product(base.sum, base.sum);
      if (n > 2) factors = product(factors, n == 3 ? base.sum : factors);
      return {std::max(is, Is::polynomial), {}, std::move(factors)};
    }
    return function_of(joined(Kind::power, named(kArgument), number(n)), base);
  }

  /// 1 where a sum is above 0, else 0; a constant where it is so, or not, all the time.
  Part compared(const TimeSum& sum) {
    if (sum.terms.size() == 1 && signals_[sum.terms.front().signal].kind == TimeSignal::Kind::clock) {
      const double turn = -sum.constant / sum.terms.front().weight;
      if (turn <= 0 || turn >= until_) {
        const double value = sum.constant + sum.terms.front().weight * until_ / 2 > 0 ? 1 : 0;
        return {Is::constant, number(value), {value, {}}, false, true};
      }
    }
    Part part = circuit(one(signal({TimeSignal::Kind::comparison, 0, 0, 0, sum, {}, {}})), true);
    part.is_truth = true;
    return part;
  }

  static Part negated(const Part& truth) {
    if (!truth.is_truth) throw NoCircuit{};
    Part part = truth;
    part.sum = sum_of({1, {}}, scaled(truth.sum, -1));
    return part;
  }

  Part both(const Part& a, const Part& b) {
    if (!a.is_truth || !b.is_truth) throw NoCircuit{};
    if (is_constant(a)) return a.sum.constant == 0 ? a : b;
    if (is_constant(b)) return b.sum.constant == 0 ? b : a;
    if (const auto turns = turns_of(a.sum, b.sum)) {
      // What is true of the two between their turns says what of them is enough.
      const auto value = [&](const TimeSum& truth, double t) {
        double total = truth.constant;
        for (const TimeSum::Term& term : truth.terms) {
          const TimeSum& compared = signals_[term.signal].a;
          if (compared.constant + compared.terms.front().weight * t > 0) total += term.weight;
        }
        return total > 0.5;
      };
      bool one_alone[2] = {false, false}, never = true, none = false;
      for (std::size_t k = 1; k < turns->size(); ++k) {
        const double t = ((*turns)[k - 1] + (*turns)[k]) / 2;
        const bool of_a = value(a.sum, t), of_b = value(b.sum, t);
        one_alone[0] = one_alone[0] || (of_a && !of_b);
        one_alone[1] = one_alone[1] || (of_b && !of_a);
        never = never && !(of_a && of_b);
        none = none || (!of_a && !of_b);
      }
      if (never) return {Is::constant, number(0), {0, {}}, false, true};
      if (!one_alone[0]) return a;
      if (!one_alone[1]) return b;
      if (!none) {  // one of them at least
        Part part = circuit(sum_of(sum_of(a.sum, b.sum), {-1, {}}), true);
        part.is_truth = true;
        return part;
      }
    }
    return compared(sum_of(sum_of(a.sum, b.sum), {-1.5, {}}));
  }

  /// When comparisons of the clock turn, with the beginning and the end of the run; nothing where there is
  /// another signal among them.
  std::optional<std::vector<double>> turns_of(const TimeSum& a, const TimeSum& b) const {
    std::vector<double> turns{0, until_};
    for (const TimeSum* const sum : {&a, &b}) {
      for (const TimeSum::Term& term : sum->terms) {
        const TimeSignal& signal = signals_[term.signal];
        const bool of_clock = signal.kind == TimeSignal::Kind::comparison && signal.a.terms.size() == 1 &&
                              signals_[signal.a.terms.front().signal].kind == TimeSignal::Kind::clock;
        if (!of_clock) return std::nullopt;
        turns.push_back(-signal.a.constant / signal.a.terms.front().weight);
      }
    }
    std::sort(turns.begin(), turns.end());
    return turns;
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
        return compared(sum_in(first));
      case Function::sign: {
        const Part above = compared(sum_in(first));
        return {above.is, {}, sum_of({-1, {}}, scaled(above.sum, 2)), above.turns};
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
    const auto one_that_varies = std::find_if(operands.begin(), operands.end(), varies);
    const bool several = std::count_if(operands.begin(), operands.end(), varies) > 1;
    if (several && !is_smooth(operands)) throw NoCircuit{};
    if (several) return smooth();
    Expression of_one = e;
    of_one.operands[static_cast<std::size_t>(one_that_varies - operands.begin())] = named(kArgument);
    return function_of(std::move(of_one), *one_that_varies);
  }

  /// Whether a function of these is no more than a smooth function of the time.
  static bool is_smooth(const std::vector<Part>& parts) {
    return std::all_of(parts.begin(), parts.end(),
                       [](const Part& part) { return part.is < Is::circuit || !part.turns; });
  }

  Part chosen(const std::vector<Part>& operands) {
    if (!operands[0].is_truth) throw NoCircuit{};
    const Part &a = operands[1], &b = operands[2];
    if (is_constant(operands[0])) return operands[0].sum.constant == 0 ? b : a;
    if (is_constant(a) && is_constant(b))
      return circuit(sum_of(scaled(operands[0].sum, a.sum.constant - b.sum.constant), b.sum), true);
    const TimeSum otherwise = sum_in(b);
    const TimeSum change = sum_of(sum_in(a), scaled(otherwise, -1));
    return circuit(sum_of(product(operands[0].sum, change), otherwise), true);
  }

  /// max(a, b) = a + max(b − a, 0), min(a, b) = a + min(b − a, 0).
  Part extreme(const Expression& e, const std::vector<Part>& operands) {
    if (is_smooth(operands)) return smooth();
    Expression beyond = e;
    beyond.operands = {named(kArgument), number(0)};
    TimeSum found = sum_in(operands.front());
    for (std::size_t k = 1; k < operands.size(); ++k) {
      const Part above = circuit(sum_of(sum_in(operands[k]), scaled(found, -1)), true);
      found = sum_of(found, function_of(beyond, above).sum);
    }
    return circuit(found, true);
  }

  /// sin(rate·t + constant), or the cosine.
  Part sine(const TimeSum& angle, bool is_cosine) {
    const double rate = angle.terms.front().weight;
    const double phase = angle.constant + (is_cosine ? std::numbers::pi / 2 : 0);
    return circuit(rate < 0 ? sine(-rate, std::numbers::pi - phase, 0) : sine(rate, phase, 0), true);
  }

  /// exp(growth·t) sin(rate·t + phase) of the one signal of this rate and growth, and the one ahead of it by
  /// a quarter.
  TimeSum sine(double rate, double phase, double growth) {
    constexpr double kSame = 1e-12;
    const auto found = std::find_if(signals_.begin(), signals_.end(), [&](const TimeSignal& signal) {
      return signal.kind == TimeSignal::Kind::sine && signal.growth == growth &&
             std::abs(signal.rate - rate) <= kSame * rate;
    });
    phase = std::remainder(phase, 2 * std::numbers::pi);
    if (found == signals_.end())
      return one(signal({TimeSignal::Kind::sine, rate, phase, growth, {}, {}, {}}));
    TimeSignal quarter = *found;
    quarter.phase = std::remainder(found->phase + std::numbers::pi / 2, 2 * std::numbers::pi);
    const auto first = static_cast<std::size_t>(found - signals_.begin());
    const double ahead = phase - found->phase;
    TimeSum sum;
    if (std::abs(std::cos(ahead)) > kSame) sum.terms.push_back({std::cos(ahead), first});
    if (std::abs(std::sin(ahead)) > kSame) sum.terms.push_back({std::sin(ahead), signal(std::move(quarter))});
    return sum;
  }

  Part exponential(const TimeSum& exponent) {
    const double growth = exponent.terms.front().weight;
    const double at_start = std::exp(exponent.constant);
    if (at_start == 0 || !std::isfinite(at_start)) return smooth();
    return circuit(scaled(exponential(growth), at_start), false);
  }

  TimeSum exponential(double growth) {
    if (growth == 0) return {1, {}};
    return one(signal({TimeSignal::Kind::exponential, 0, 0, growth, {}, {}, {}}));
  }

  /// a·b with the weights of single signals before it. An exponential makes one sine, or exponential, of
  /// another.
  TimeSum product(TimeSum a, TimeSum b) {
    double factor = 1;
    for (TimeSum* const sum : {&a, &b}) {
      if (sum->terms.empty()) return scaled(sum == &a ? b : a, sum->constant * factor);
      if (sum->constant != 0 || sum->terms.size() > 1) continue;
      factor *= sum->terms.front().weight;
      sum->terms.front().weight = 1;
    }
    const auto decays = [&](const TimeSum& sum) {
      return sum.constant == 0 && sum.terms.size() == 1 &&
             signals_[sum.terms.front().signal].kind == TimeSignal::Kind::exponential;
    };
    if (!decays(a)) std::swap(a, b);
    const bool oscillates = std::all_of(b.terms.begin(), b.terms.end(), [&](const TimeSum::Term& term) {
      const TimeSignal::Kind kind = signals_[term.signal].kind;
      return kind == TimeSignal::Kind::exponential || kind == TimeSignal::Kind::sine;
    });
    if (decays(a) && oscillates) {
      const double growth = signals_[a.terms.front().signal].growth;
      TimeSum sum = scaled(a, factor * b.constant);
      for (const TimeSum::Term& term : b.terms) {
        const TimeSignal of = signals_[term.signal];
        const TimeSum both = of.kind == TimeSignal::Kind::sine ? sine(of.rate, of.phase, of.growth + growth)
                                                               : exponential(of.growth + growth);
        sum = sum_of(sum, scaled(both, factor * term.weight));
      }
      return sum;
    }
    return scaled(one(signal({TimeSignal::Kind::product, 0, 0, 0, std::move(a), std::move(b), {}})), factor);
  }

  /// A function of the argument at a part; of a function of one signal, a function of that signal.
  Part function_of(Expression function, const Part& part) {
    if (part.is < Is::circuit || !part.turns) return smooth();
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
    return circuit(
        one(signal({TimeSignal::Kind::function, 0, 0, 0, std::move(argument), {}, std::move(function)})),
        true);
  }

  /// A part as a sum of signals: what is smooth is a function of the clock.
  TimeSum sum_in(const Part& part) {
    if (part.is != Is::smooth) return part.sum;
    const TimeSum clock = part_of(named("time")).sum;
    return one(signal(
        {TimeSignal::Kind::function, 0, 0, 0, clock, {}, with(part.formula, "time", named(kArgument))}));
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

  /// The signal, which is made once.
  std::size_t signal(TimeSignal made) {
    const auto same = std::find_if(signals_.begin(), signals_.end(), [&](const TimeSignal& s) {
      const bool crossed = made.kind == TimeSignal::Kind::product && s.a == made.b && s.b == made.a;
      return s.kind == made.kind && s.rate == made.rate && s.phase == made.phase && s.growth == made.growth &&
             ((s.a == made.a && s.b == made.b) || crossed) && s.function == made.function;
    });
    if (same != signals_.end()) return static_cast<std::size_t>(same - signals_.begin());
    signals_.push_back(std::move(made));
    return signals_.size() - 1;
  }

  double until_;
  std::vector<TimeSignal> signals_;
};

}  // namespace

std::optional<TimeCircuit> time_circuit(const Expression& formula, double until) {
  return Reader(until).read(formula);
}

}  // namespace oblique::machine
