// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/drive_law.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace oblique::mechanism {
namespace {

bool names_time(const text::Expression& e) {
  return (e.kind == text::Expression::Kind::name && e.name == "time") ||
         std::any_of(e.operands.begin(), e.operands.end(), names_time);
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
  const bool smooth_call = e.kind == Kind::call &&
                           !text::functions()[static_cast<std::size_t>(e.function)].switches &&
                           e.function != text::Function::table && e.function != text::Function::noise &&
                           e.function != text::Function::weights;
  if (e.kind >= Kind::less || (e.kind == Kind::call && !smooth_call)) {
    throw text::ExpressionError{e.column, "the speed of a drive may have no kinks or jumps",
                                "sin, cos, tan, asin, acos, atan, atan2, exp, log, sqrt or hypot",
                                "give a smooth law: where the speed jumps the acceleration has no value"};
  }
  for (const text::Expression& operand : e.operands) check(operand);
}

/// A value and its derivative by time.
struct Dual {
  double value, rate;
};

Dual call(text::Function function, std::span<const Dual> x) {
  const double v = x[0].value, r = x[0].rate;
  switch (function) {
    case text::Function::sin:
      return {std::sin(v), std::cos(v) * r};
    case text::Function::cos:
      return {std::cos(v), -std::sin(v) * r};
    case text::Function::tan:
      return {std::tan(v), r / (std::cos(v) * std::cos(v))};
    case text::Function::asin:
      return {std::asin(v), r / std::sqrt(1 - v * v)};
    case text::Function::acos:
      return {std::acos(v), -r / std::sqrt(1 - v * v)};
    case text::Function::atan:
      return {std::atan(v), r / (1 + v * v)};
    case text::Function::exp:
      return {std::exp(v), std::exp(v) * r};
    case text::Function::log:
      return {std::log(v), r / v};
    case text::Function::sqrt:
      return {std::sqrt(v), r / (2 * std::sqrt(v))};
    case text::Function::atan2: {
      const double w = x[1].value;
      return {std::atan2(v, w), (w * r - v * x[1].rate) / (v * v + w * w)};
    }
    case text::Function::hypot: {
      const double h = std::hypot(v, x[1].value);
      return {h, (v * r + x[1].value * x[1].rate) / h};
    }
    default:
      return {std::numeric_limits<double>::quiet_NaN(), 0};  // `check` lets none through
  }
}

Dual evaluate_at(const text::Expression& e, double time) {
  using Kind = text::Expression::Kind;
  if (e.kind == Kind::number) return {e.number, 0};
  if (e.kind == Kind::name) return e.name == "time" ? Dual{time, 1} : Dual{std::numbers::pi, 0};
  std::array<Dual, 2> x{};
  for (std::size_t i = 0; i < e.operands.size() && i < x.size(); ++i) x[i] = evaluate_at(e.operands[i], time);
  const auto& [a, b] = x;
  switch (e.kind) {
    case Kind::negate:
      return {-a.value, -a.rate};
    case Kind::add:
      return {a.value + b.value, a.rate + b.rate};
    case Kind::subtract:
      return {a.value - b.value, a.rate - b.rate};
    case Kind::multiply:
      return {a.value * b.value, a.rate * b.value + a.value * b.rate};
    case Kind::divide:
      return {a.value / b.value, (a.rate * b.value - a.value * b.rate) / (b.value * b.value)};
    case Kind::power: {
      const double value = std::pow(a.value, b.value);
      const double base_part = b.value == 0 ? 0 : b.value * std::pow(a.value, b.value - 1) * a.rate;
      return {value, base_part + (b.rate == 0 ? 0 : value * std::log(a.value) * b.rate)};
    }
    default:
      return call(e.function, x);
  }
}

/// Gauss and Kronrod's rule with 7 and 15 points on [a, b]; both sums.
std::array<double, 2> gauss_kronrod(const Drive& drive, double a, double b) {
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
  double kronrod = 0, gauss = 0;
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    double sum = evaluate_at(*drive.law, middle + half * kNodes[i]).value;
    if (kNodes[i] != 0) sum += evaluate_at(*drive.law, middle - half * kNodes[i]).value;
    kronrod += kKronrod[i] * sum;
    if (i % 2 == 1) gauss += kGauss[i / 2] * sum;
  }
  return {kronrod * half, gauss * half};
}

constexpr int kMostHalvings = 12;

/// Over [a, b], piece by piece from a on; `done` is told the end of each piece and the integral over it.
template <class Done>
void integrate(const Drive& drive, double a, double b, const Done& done, int halvings = kMostHalvings) {
  const auto [fine, coarse] = gauss_kronrod(drive, a, b);
  // the coarse rule errs by this, the fine one by about its square
  constexpr double kAgree = 1e-9;
  if (halvings == 0 || !(std::abs(fine - coarse) > kAgree * std::abs(fine))) {
    done(b, fine);
    return;
  }
  const double middle = (a + b) / 2;
  integrate(drive, a, middle, done, halvings - 1);
  integrate(drive, middle, b, done, halvings - 1);
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
      forward_(mechanism.drives.size(), {0}),
      backward_(mechanism.drives.size(), {0}),
      last_(mechanism.drives.size()) {}

double DriveClock::way(std::size_t d, double t) {
  const Drive& drive = mechanism_.drives[d];
  if (!drive.law) return drive.speed * t;
  std::vector<double>& kept = t < 0 ? backward_[d] : forward_[d];
  const double panel = t < 0 ? -panel_ : panel_;
  const auto whole = static_cast<std::size_t>(t / panel);
  Pieces& last = last_[d];
  const auto enter = [&](std::size_t k) {
    if (last.panel == panel * static_cast<double>(k) && !last.all.empty() && last.step == panel) return;
    last.panel = panel * static_cast<double>(k);
    last.step = panel;
    last.all = {{last.panel, kept[k]}};
    integrate(drive, last.panel, last.panel + panel, [&](double end, double integral) {
      last.all.push_back({end, last.all.back().way + drive.law_scale * integral});
    });
    if (kept.size() == k + 1) kept.push_back(last.all.back().way);
  };
  while (kept.size() <= whole) enter(kept.size() - 1);
  enter(whole);
  const auto after = std::upper_bound(last.all.begin(), last.all.end(), std::abs(t),
                                      [](double time, const Piece& p) { return time < std::abs(p.from); });
  const Piece& piece = *(after - 1);
  double way = piece.way;
  if (t != piece.from)
    integrate(drive, piece.from, t, [&](double, double integral) { way += drive.law_scale * integral; });
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
