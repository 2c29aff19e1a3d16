// SPDX-License-Identifier: MIT
#include <oblique/report/study/effects.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

/// The rows in which a measure has a finite value.
std::vector<std::size_t> known_rows(const StudyResult& result, std::size_t measure) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < result.done.rows.size(); ++row) {
    if (std::isfinite(result.measure(row, measure))) rows.push_back(row);
  }
  return rows;
}

/// The ranks of values, equal ones sharing theirs.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double rank = 0.5 * static_cast<double>(begin + end - 1);
    for (std::size_t k = begin; k < end; ++k) ranks[order[k]] = rank;
    begin = end;
  }
  return ranks;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / n;
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    ab += (a[k] - mean_a) * (b[k] - mean_b);
    aa += (a[k] - mean_a) * (a[k] - mean_a);
    bb += (b[k] - mean_b) * (b[k] - mean_b);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

Effect effect_on_a_grid(const StudyResult& result, std::size_t measure, std::size_t name,
                        const std::vector<std::size_t>& rows) {
  struct Sum {
    double sum = 0, count = 0;
  };
  std::map<double, Sum> sums;
  for (const std::size_t row : rows) {
    Sum& sum = sums[result.done.rows[row].values[name]];
    sum.sum += result.measure(row, measure);
    ++sum.count;
  }
  Effect effect;
  effect.name = name;
  bool first = true;
  for (const auto& [value, sum] : sums) {
    const double mean = sum.sum / sum.count;
    if (first || mean < effect.low) {
      effect.low = mean;
      effect.low_at = value;
    }
    if (first || mean > effect.high) {
      effect.high = mean;
      effect.high_at = value;
    }
    first = false;
  }
  return effect;
}

Effect effect_by_ranks(const StudyResult& result, std::size_t measure, std::size_t name,
                       const std::vector<std::size_t>& rows) {
  std::vector<double> xs, ys;
  for (const std::size_t row : rows) {
    xs.push_back(result.done.rows[row].values[name]);
    ys.push_back(result.measure(row, measure));
  }
  Effect effect;
  effect.name = name;
  const double found = xs.size() > 1 ? correlation(ranks_of(xs), ranks_of(ys)) : 0;
  effect.low = std::min(found, 0.0);
  effect.high = std::max(found, 0.0);
  return effect;
}

}  // namespace

std::vector<Effect> effects_of(const StudyResult& result, std::size_t measure) {
  const std::vector<std::size_t> rows = known_rows(result, measure);
  std::vector<Effect> effects;
  for (std::size_t name = 0; name < result.n_varied; ++name) {
    effects.push_back(result.grid ? effect_on_a_grid(result, measure, name, rows)
                                  : effect_by_ranks(result, measure, name, rows));
  }
  std::stable_sort(effects.begin(), effects.end(),
                   [](const Effect& a, const Effect& b) { return a.size() > b.size(); });
  return effects;
}

double mean_of(const StudyResult& result, std::size_t measure) {
  double sum = 0;
  const std::vector<std::size_t> rows = known_rows(result, measure);
  for (const std::size_t row : rows) sum += result.measure(row, measure);
  return rows.empty() ? 0 : sum / static_cast<double>(rows.size());
}

std::string effects_text(const StudyResult& result) {
  std::string text;
  for (std::size_t measure = 0; measure < result.n_measures(); ++measure) {
    const std::string& column = result.columns[result.n_varied + measure].name;
    Table table(result.grid
                    ? std::vector<std::string>{column + " by", "least mean", "at", "greatest mean", "at"}
                    : std::vector<std::string>{column + " by", "rank correlation"});
    for (const Effect& effect : effects_of(result, measure)) {
      const std::string& name = result.columns[effect.name].name;
      if (result.grid) {
        table.add({name, short_number(effect.low), short_number(effect.low_at), short_number(effect.high),
                   short_number(effect.high_at)});
      } else {
        table.add({name, fmt::format("{:.3f}", effect.low + effect.high)});
      }
    }
    text += (text.empty() ? "" : "\n") + table.text(1);
  }
  return text;
}

}  // namespace oblique::report
