// SPDX-License-Identifier: MIT
#include "agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::fuzz {
namespace {

/// Moments at which the outputs of a run may not be compared.
class Events {
 public:
  Events(const solve::Run& run, double time, double around) : run_(run), time_(time), around_(around) {
    if (run.event_count > static_cast<long>(run.events.size()) && !run.events.empty())
      last_ = run.events.back().time * time - around;
  }

  bool hide(double t) const {
    if (t >= last_) return true;
    const auto& events = run_.events;
    auto next =
        std::lower_bound(events.begin(), events.end(), (t - around_) / time_,
                         [](const solve::EventRecord& event, double from) { return event.time < from; });
    return next != events.end() && next->time * time_ <= t + around_;
  }

 private:
  const solve::Run& run_;
  double time_, around_;
  double last_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::optional<Difference> find_difference(const Beside& runs, double tolerance,
                                          const std::function<double(std::size_t, std::size_t)>& allowed) {
  const solve::Trajectory &a = runs.a.trajectory, &b = runs.b.trajectory;
  // Events are as exact as the states are; a thousand tolerances leave room for slow crossings.
  const double around = 1e3 * tolerance * std::max(1.0, runs.a.state.time);
  const Events of_a(runs.a, 1, around), of_b(runs.b, 1 / runs.time, around);
  for (std::size_t k = 0; k < b.rows() && runs.first + k < a.rows(); ++k) {
    const std::size_t row = runs.first + k;
    const double t = a.at(row, 0);
    if (of_a.hide(t) || of_b.hide(t)) continue;
    for (std::size_t c = 1; c < a.columns().size(); ++c) {
      const double most = allowed(row, c);
      if (!(std::abs(a.at(row, c) - b.at(k, c)) <= most))
        return Difference{t, row, c, a.at(row, c), b.at(k, c), most};
    }
  }
  return std::nullopt;
}

double size_of(const solve::Run& run) {
  double size = 0;
  const solve::Trajectory& table = run.trajectory;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t c = 1; c < table.columns().size(); ++c)
      size = std::max(size, std::abs(table.at(row, c)));
  }
  return size;
}

}  // namespace oblique::fuzz
