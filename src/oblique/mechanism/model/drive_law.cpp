// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/drive_law.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <oblique/text/expression_parser.h>
#include <oblique/text/interval.h>
#include <oblique/text/partial_derivative.h>

namespace oblique::mechanism {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool names_time(const text::Expression& e) {
  return (e.kind == text::Expression::Kind::name && e.name == "time") ||
         std::any_of(e.operands.begin(), e.operands.end(), names_time);
}

/// Noise is smooth, but its derivative has no expression that a patch could hold.
bool is_lawful(text::Function function) {
  return text::smooth_operation(function) && function != text::Function::noise;
}

/// "sin, cos or hypot": all functions that a law may have.
std::string lawful_functions() {
  std::vector<std::string_view> names;
  for (const text::FunctionInfo& info : text::functions()) {
    if (is_lawful(info.function)) names.push_back(info.name);
  }
  return fmt::format("{} or {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back());
}

/// Refuses what has no smooth value.
void check(const text::Expression& e) {
  using Kind = text::Expression::Kind;
  if (e.kind == Kind::name && e.name != "time" && e.name != "pi") {
    throw text::ExpressionError{e.column,
                                fmt::format("there is no '{}' in the speed of a drive", e.name),
                                "numbers, pi, time and smooth functions of them",
                                {}};
  }
  if (e.kind >= Kind::less || (e.kind == Kind::call && !is_lawful(e.function))) {
    throw text::ExpressionError{e.column, "the speed of a drive may have no kinks or jumps",
                                lawful_functions(),
                                "give a smooth law: where the speed jumps the acceleration has no value"};
  }
  for (const text::Expression& operand : e.operands) check(operand);
}

/// A number as what the table of operations writes derivatives of. Zero times what is not known is zero.
struct Number {
  double value;

  Number number(double other) const { return {other}; }
  Number apply(text::Operation operation, const Number& second) const {
    if (operation == text::Operation::multiply && (value == 0 || second.value == 0)) return {0};
    return {text::evaluate(operation, value, second.value)};
  }
};

/// A value and its derivative by time.
struct Dual {
  double value, rate;
};

double value_of_name(const text::Expression& e, double time) {
  return e.name == "time" ? time : std::numbers::pi;
}

/// The operation at the root of a call or an operator: `check` lets nothing through that has none.
text::Operation operation_of(const text::Expression& e) {
  return text::smooth_operation(e).value();
}

double value_at(const text::Expression& e, double time) {
  using Kind = text::Expression::Kind;
  if (e.kind == Kind::number) return e.number;
  if (e.kind == Kind::name) return value_of_name(e, time);
  const double a = value_at(e.operands[0], time);
  return text::evaluate(operation_of(e), a, e.operands.size() > 1 ? value_at(e.operands[1], time) : 0);
}

Dual evaluate_at(const text::Expression& e, double time) {
  using Kind = text::Expression::Kind;
  if (e.kind == Kind::number) return {e.number, 0};
  if (e.kind == Kind::name) return {value_of_name(e, time), e.name == "time" ? 1.0 : 0.0};
  std::array<Dual, 2> x{};
  for (std::size_t i = 0; i < e.operands.size() && i < x.size(); ++i) x[i] = evaluate_at(e.operands[i], time);
  const text::Operation operation = operation_of(e);
  const Number a{x[0].value}, b{x[1].value}, f{text::evaluate(operation, a.value, b.value)};
  Dual result{f.value, 0};
  for (int i = 0; i < 2; ++i) {
    const double rate = x[static_cast<std::size_t>(i)].rate;
    if (rate != 0) result.rate += text::partial_derivative(operation, i, a, b, f).value * rate;
  }
  return result;
}

/// The range of a law, or what holds it, over a time.
text::Interval range_over(const text::Expression& e, const text::Interval& time) {
  using Kind = text::Expression::Kind;
  if (e.kind == Kind::number) return {e.number, e.number};
  if (e.kind == Kind::name && e.name == "time") return time;
  if (e.kind == Kind::name) return {value_of_name(e, 0), value_of_name(e, 0)};
  const text::Interval a = range_over(e.operands[0], time);
  return text::evaluate(operation_of(e), a,
                        e.operands.size() > 1 ? range_over(e.operands[1], time) : text::Interval{});
}

/// Gauss and Kronrod's rule with 7 and 15 points on [a, b]: both sums, and the values of the law that were
/// seen.
struct Sums {
  double kronrod = 0, gauss = 0;
  text::Interval seen;
};
Sums gauss_kronrod(const Drive& drive, double a, double b) {
  constexpr std::array kNodes{0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                              0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                              0.586087235467691130294144691258287, 0.405845151377397166906606412076961,
                              0.207784955007898467600689403773245, 0.0};
  constexpr std::array kKronrod{0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
  constexpr std::array kGauss{0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
                              0.381830050505118944950369775488975, 0.417959183673469387755102040816327};
  const double middle = (a + b) / 2, half = (b - a) / 2;
  double kronrod = 0, gauss = 0, low = kInfinity, high = -kInfinity;
  const auto value = [&](double time) {
    const double speed = value_at(*drive.law, time);
    low = std::min(low, speed);
    high = std::max(high, speed);
    return speed;
  };
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    double sum = value(middle + half * kNodes[i]);
    if (kNodes[i] != 0) sum += value(middle - half * kNodes[i]);
    kronrod += kKronrod[i] * sum;
    if (i % 2 == 1) gauss += kGauss[i / 2] * sum;
  }
  value(a);
  value(b);
  return {kronrod * half, gauss * half, {low, high}};
}

/// The width of the intervals whose ways are kept [s]: a second, or more where the motion takes hours.
double panel_of(const Mechanism& mechanism) {
  constexpr double kMostPanels = 4096;
  const double least = mechanism.motion.until.value_or(0) / kMostPanels;
  return least > 1 ? std::exp2(std::ceil(std::log2(least))) : 1;
}

/// Whether a law does nothing over [a, b] that the values `seen` do not show: bounds say so, or that it is
/// too little to matter.
bool is_shown(const Drive& drive, double a, double b, const text::Interval& seen) {
  constexpr double kPlain = 2;      // of what was seen
  constexpr double kLittle = 1e-6;  // of the speed
  const text::Interval range = range_over(*drive.law, {std::min(a, b), std::max(a, b)});
  const double size = std::max(std::abs(seen.low), std::abs(seen.high));
  return range.width() <= kPlain * seen.width() + kLittle * size;
}

/// So often a panel is halved where the rules differ, and where bounds tell nothing; each part beyond is
/// taken from those that there are for the whole motion, and what each panel adds.
constexpr int kHalvings = 12, kHalvingsForBounds = 6, kMostHalvings = 40;
constexpr int kMostParts = 100'000, kPartsOfPanel = 256;

/// Over [a, b], piece by piece from a on; `done` is told the end of each piece and the integral over it.
template <class Done>
void integrate(const Drive& drive, double a, double b, const Done& done, int& parts_left, int halvings = 0) {
  const Sums sums = gauss_kronrod(drive, a, b);
  // the coarse rule errs by this, the fine one by about its square
  constexpr double kAgree = 1e-9;
  const double middle = (a + b) / 2;
  const bool agree = !(std::abs(sums.kronrod - sums.gauss) > kAgree * std::abs(sums.kronrod));
  const bool is_free = halvings < (agree ? kHalvingsForBounds : kHalvings);
  const bool may_halve = is_free || (halvings < kMostHalvings && parts_left > 0);
  const bool is_known = std::isfinite(sums.kronrod);
  if (!is_known || !may_halve || middle == a || middle == b || (agree && is_shown(drive, a, b, sums.seen))) {
    done(b, sums.kronrod);
    return;
  }
  if (!is_free) --parts_left;
  integrate(drive, a, middle, done, parts_left, halvings + 1);
  integrate(drive, middle, b, done, parts_left, halvings + 1);
}

}  // namespace

std::optional<SpeedLaw> parse_law(std::string_view text, const text::Unit& unit) {
  std::size_t rest = 0;
  SpeedLaw law{text::parse_expression_prefix(text, rest), 1};
  if (!names_time(law.speed)) return std::nullopt;
  check(law.speed);
  law.scale = text::unit_factor(text, rest, unit);
  return law;
}

DriveState law_at(const Drive& drive, double t) {
  if (!drive.law) return {0, drive.speed, 0};
  const Dual speed = evaluate_at(*drive.law, t);
  return {0, drive.law_scale * speed.value, drive.law_scale * speed.rate};
}

DriveClock::DriveClock(const Mechanism& mechanism)
    : mechanism_(mechanism),
      panel_(panel_of(mechanism)),
      parts_left_(kMostParts),
      forward_(mechanism.drives.size(), {0}),
      backward_(mechanism.drives.size(), {0}),
      last_(mechanism.drives.size()) {}

double DriveClock::way(std::size_t d, double t) {
  const Drive& drive = mechanism_.drives[d];
  if (!drive.law) return drive.speed * t;
  std::vector<double>& kept = t < 0 ? backward_[d] : forward_[d];
  const double panel = t < 0 ? -panel_ : panel_;
  const auto whole = static_cast<std::size_t>(std::abs(t) / panel_);
  Pieces& last = last_[d];
  const auto enter = [&](std::size_t k) {
    if (last.panel == panel * static_cast<double>(k) && !last.all.empty() && last.step == panel) return;
    last.panel = panel * static_cast<double>(k);
    last.step = panel;
    last.all = {{last.panel, kept[k]}};
    parts_left_ = std::min(parts_left_ + kPartsOfPanel, kMostParts);
    integrate(
        drive, last.panel, last.panel + panel,
        [&](double end, double integral) {
          last.all.push_back({end, last.all.back().way + drive.law_scale * integral});
        },
        parts_left_);
    if (kept.size() == k + 1) kept.push_back(last.all.back().way);
  };
  while (kept.size() <= whole) enter(kept.size() - 1);
  enter(whole);
  const auto after = std::upper_bound(last.all.begin(), last.all.end(), std::abs(t),
                                      [](double time, const Piece& p) { return time < std::abs(p.from); });
  const Piece& piece = *(after - 1);
  double way = piece.way;
  // Within a piece one rule does.
  if (t != piece.from) way += drive.law_scale * gauss_kronrod(drive, piece.from, t).kronrod;
  return way;
}

DriveState DriveClock::at(std::size_t drive, double t) {
  DriveState state = law_at(mechanism_.drives[drive], t);
  state.value = mechanism_.drives[drive].start + way(drive, t);
  return state;
}

void DriveClock::at(double t, std::span<DriveState> states) {
  for (std::size_t d = 0; d < states.size(); ++d) states[d] = at(d, t);
}

std::optional<double> DriveClock::time_of_way(std::size_t drive, double wanted, double latest) {
  const Drive& d = mechanism_.drives[drive];
  if (!d.law) {
    const double time = std::abs(wanted / d.speed);
    return time <= latest ? std::optional(time) : std::nullopt;
  }
  constexpr int kSteps = 4096;
  double before = 0;
  for (int k = 1; k <= kSteps; ++k) {
    double after = latest * k / kSteps;
    if (std::abs(way(drive, after)) < std::abs(wanted)) {
      before = after;
      continue;
    }
    for (int i = 0; i < 200 && before < after; ++i) {  // halves until no number lies between
      const double middle = before + (after - before) / 2;
      if (middle == before || middle == after) break;
      (std::abs(way(drive, middle)) < std::abs(wanted) ? before : after) = middle;
    }
    return after;
  }
  return std::nullopt;
}

}  // namespace oblique::mechanism
