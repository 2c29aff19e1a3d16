// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/sampled_run.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace oblique::ensemble {
namespace {

constexpr std::size_t kPoints = 6;  ///< that a polynomial goes through
constexpr double kSmooth = 0.25;    ///< fourth differences against second ones, at the most
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// The first of the rows whose polynomial is taken between `interval` and the next row.
std::size_t window_of(std::size_t interval, std::size_t rows) {
  return std::min(interval < 2 ? 0 : interval - 2, rows - kPoints);
}

bool smooth(std::span<const double, kPoints> f) {
  double second = 0, fourth = 0;
  for (std::size_t k = 0; k + 2 < kPoints; ++k)
    second = std::max(second, std::abs(f[k] - 2 * f[k + 1] + f[k + 2]));
  for (std::size_t k = 0; k + 4 < kPoints; ++k)
    fourth = std::max(fourth, std::abs(f[k] - 4 * f[k + 1] + 6 * f[k + 2] - 4 * f[k + 3] + f[k + 4]));
  return fourth < kSmooth * second;  // false where one is no number, and of a constant
}

/// The values at x of Lagrange's polynomials of the nodes 0 … 5.
std::array<double, kPoints> lagrange(double x) {
  std::array<double, kPoints> weights{};
  for (std::size_t i = 0; i < kPoints; ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < kPoints; ++j) {
      if (j != i) weight *= (x - static_cast<double>(j)) / (static_cast<double>(i) - static_cast<double>(j));
    }
    weights[i] = weight;
  }
  return weights;
}

/// A point between two rows and its weight in Gauss's rule of three points, exact to degree five.
struct GaussPoint {
  double place, weight;
};
const std::array<GaussPoint, 3> gauss_points{
    {{0.5 - std::sqrt(0.15), 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + std::sqrt(0.15), 5.0 / 18}}};

/// The value of a column between two rows, at a place from 0 to 1. `weights` are those of Lagrange's
/// polynomials there; a constant stays what it is to the last digit.
double between(std::span<const double> f, std::size_t interval, double place,
               const std::array<double, kPoints>& weights) {
  const double here = f[interval];
  if (f.size() >= kPoints) {
    const auto window = f.subspan(window_of(interval, f.size())).first<kPoints>();
    if (smooth(window)) {
      double sum = here;
      for (std::size_t i = 0; i < kPoints; ++i) sum += weights[i] * (window[i] - here);
      return sum;
    }
  }
  return here + place * (f[interval + 1] - here);
}

/// The weights at a place of an interval.
std::array<double, kPoints> weights_at(std::size_t interval, std::size_t rows, double place) {
  if (rows < kPoints) return {};
  return lagrange(static_cast<double>(interval - window_of(interval, rows)) + place);
}

/// The greatest value of a function on [0, 1] that has one maximum there, by golden section and parabolas
/// (Brent, "Algorithms for minimization without derivatives", 1973, chapter 5).
double greatest_within(const std::function<double(double)>& f) {
  constexpr double kGolden = 0.3819660112501051, kNear = 1e-9;
  constexpr int kMost = 60;
  double low = 0, high = 1, x = kGolden, w = x, v = x;
  double fx = -f(x), fw = fx, fv = fx, step = 0, before = 0;
  for (int k = 0; k < kMost; ++k) {
    const double middle = 0.5 * (low + high);
    if (std::abs(x - middle) <= 2 * kNear - 0.5 * (high - low)) break;
    double p = 0, q = 0;
    if (std::abs(before) > kNear) {
      const double r = (x - w) * (fx - fv);
      q = (x - v) * (fx - fw);
      p = (x - v) * q - (x - w) * r;
      q = 2 * (q - r);
      if (q > 0) p = -p;
      q = std::abs(q);
    }
    const double last = std::exchange(before, step);
    if (std::abs(p) < std::abs(0.5 * q * last) && p > q * (low - x) && p < q * (high - x)) {
      step = p / q;
    } else {
      before = (x < middle ? high : low) - x;
      step = kGolden * before;
    }
    const double u = x + (std::abs(step) >= kNear ? step : std::copysign(kNear, step));
    const double fu = -f(u);
    if (fu <= fx) {
      (u < x ? high : low) = x;
      v = std::exchange(w, std::exchange(x, u));
      fv = std::exchange(fw, std::exchange(fx, fu));
    } else {
      (u < x ? low : high) = u;
      if (fu <= fw || w == x) {
        v = std::exchange(w, u);
        fv = std::exchange(fw, fu);
      } else if (fu <= fv || v == x || v == w) {
        v = u;
        fv = fu;
      }
    }
  }
  return -fx;
}

/// Whether a value between the rows beside row k may be above `bar`: it is a row's maximum, and nearer to the
/// bar than to its neighbours.
bool may_pass(std::span<const double> f, std::size_t k, double sign, double bar) {
  const double here = sign * f[k];
  const double before = k > 0 ? sign * f[k - 1] : here;
  const double after = k + 1 < f.size() ? sign * f[k + 1] : here;
  return here >= before && here >= after && here + std::max(here - before, here - after) >= bar;
}

double largest_of(std::span<const double> f) {
  double largest = 0;
  for (const double value : f) largest = std::max(largest, std::abs(value));
  return largest;
}

/// What the straight line misses at the most of the parabola through three rows; nothing where it is not
/// taken.
double missed_beside(std::span<const double> f, std::size_t k) {
  if (k == 0 || k + 1 >= f.size()) return 0;
  if (f.size() >= kPoints && smooth(f.subspan(window_of(k, f.size())).first<kPoints>())) return 0;
  return std::abs(f[k - 1] - 2 * f[k] + f[k + 1]) / 8;
}

}  // namespace

void SampledRun::doubt_extreme(std::span<const double> f, double sign) const {
  std::size_t best = 0;
  for (std::size_t k = 0; k < f.size(); ++k) {
    if (sign * f[k] > sign * f[best]) best = k;
  }
  const double missed = missed_beside(f, best);
  if (missed > 0) doubt_ = std::max(doubt_, missed / largest_of(f));
}

void SampledRun::doubt_integral(std::span<const double> f) const {
  double missed = 0, sum = 0;
  for (std::size_t k = 0; k < f.size(); ++k) {
    missed += 2.0 / 3 * missed_beside(f, k);  // the mean of what a parabola misses, of its greatest
    sum += std::abs(f[k]);
  }
  if (missed > 0) doubt_ = std::max(doubt_, missed / sum);
}

std::vector<double> SampledRun::values(const RowExpression& expression) const {
  std::vector<const double*> columns(columns_.size());
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c] = columns_[c].data();
  std::vector<double> values(rows());
  expression.evaluate(columns, values);
  return values;
}

double SampledRun::value_at(const RowExpression& expression, std::size_t interval, double place) const {
  const auto weights = weights_at(interval, rows(), place);
  std::vector<double> row(columns_.size());
  for (const std::size_t c : expression.columns()) row[c] = between(columns_[c], interval, place, weights);
  return expression.evaluate(row);
}

double SampledRun::extreme(const RowExpression& expression, double sign) const {
  const std::vector<double> f = values(expression);
  double greatest = -std::numeric_limits<double>::infinity();
  for (const double value : f) {
    if (std::isnan(value)) return kNoValue;
    greatest = std::max(greatest, sign * value);
  }
  if (!std::isfinite(greatest)) return sign * greatest;
  doubt_extreme(f, sign);
  const double bar = greatest;
  for (std::size_t k = 0; k < f.size(); ++k) {
    if (!may_pass(f, k, sign, bar)) continue;
    for (std::size_t interval = k > 0 ? k - 1 : 0; interval <= k && interval + 1 < f.size(); ++interval) {
      const double found =
          greatest_within([&](double place) { return sign * value_at(expression, interval, place); });
      if (found > greatest) greatest = found;
    }
  }
  return sign * greatest;
}

double SampledRun::maximum(const RowExpression& expression) const {
  return extreme(expression, 1);
}

double SampledRun::minimum(const RowExpression& expression) const {
  return extreme(expression, -1);
}

double SampledRun::integral(const RowExpression& expression, bool squared) const {
  const std::size_t n = rows() - 1;
  std::vector<double> at_rows = values(expression);
  if (squared) {
    for (double& value : at_rows) value *= value;
  }
  doubt_integral(at_rows);
  double sum = 0;
  for (const GaussPoint& point : gauss_points) {
    std::vector<std::vector<double>> columns(columns_.size());
    std::vector<const double*> begins(columns_.size(), nullptr);
    for (const std::size_t c : expression.columns()) {
      columns[c].resize(n);
      begins[c] = columns[c].data();
    }
    std::array<double, kPoints> weights{};
    for (std::size_t k = 0; k < n; ++k) {
      // in the middle of the run the window moves along with the rows
      if (k <= 2 || k + kPoints > n) weights = weights_at(k, n + 1, point.place);
      for (const std::size_t c : expression.columns())
        columns[c][k] = between(columns_[c], k, point.place, weights);
    }
    std::vector<double> values(n);
    expression.evaluate(begins, values);
    for (const double value : values) sum += point.weight * (squared ? value * value : value);
  }
  return sum * duration() / static_cast<double>(n);
}

double SampledRun::first_time(const RowExpression& condition, std::span<const RowExpression> sides) const {
  constexpr int kParts = 16, kHalvings = 45;
  const std::vector<double> holds = values(condition);
  const auto first = static_cast<std::size_t>(
      std::find_if(holds.begin(), holds.end(), [](double value) { return value != 0; }) - holds.begin());
  if (first == 0) return columns_[0].front();
  // Between rows at none of which it holds it may hold beside a row at which a side turns just before zero.
  std::vector<bool> candidate(rows(), false);
  for (const RowExpression& side : sides) {
    const std::vector<double> f = values(side);
    for (std::size_t k = 0; k < f.size(); ++k) {
      if (!may_pass(f, k, f[k] < 0 ? 1 : -1, 0)) continue;
      if (k > 0) candidate[k - 1] = true;
      candidate[k] = true;
    }
  }
  if (first < rows()) candidate[first - 1] = true;
  const double spacing = duration() / static_cast<double>(rows() - 1);
  for (std::size_t k = 0; k + 1 < rows() && k < first; ++k) {
    if (!candidate[k]) continue;
    for (int part = 1; part <= kParts; ++part) {
      const double end = static_cast<double>(part) / kParts;
      const bool is_row = part == kParts;
      if ((is_row ? holds[k + 1] : value_at(condition, k, end)) == 0) continue;
      double low = end - 1.0 / kParts, high = end;
      for (int halving = 0; halving < kHalvings; ++halving) {
        const double middle = 0.5 * (low + high);
        (value_at(condition, k, middle) != 0 ? high : low) = middle;
      }
      return columns_[0][k] + spacing * high;
    }
  }
  return kNoValue;
}

}  // namespace oblique::ensemble
