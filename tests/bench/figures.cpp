// SPDX-License-Identifier: MIT
#include "figures.h"

#include <time.h>

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace oblique::bench {
namespace {

std::vector<Figure>& figures() {
  static std::vector<Figure> all;
  return all;
}

}  // namespace

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

void record(Figure figure) {
  for (Figure& known : figures()) {
    if (known.name != figure.name) continue;
    known = std::move(figure);
    return;
  }
  figures().push_back(std::move(figure));
}

void print_figures() {
  for (const Figure& figure : figures()) {
    const std::string value = fmt::format("{:.3f} {}", figure.value, figure.unit);
    fmt::print("{:<62} {:>9}  {} {:.2f} {}\n", figure.name, value,
               figure.value <= figure.bound ? "met: <=" : "MISSED: >", figure.bound, figure.unit);
  }
}

}  // namespace oblique::bench
