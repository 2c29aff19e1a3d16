// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/sweep.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include <oblique/mechanism/model/plane.h>

namespace oblique::mechanism {
namespace {

constexpr double kBand = 0.01;         ///< of the stroke
constexpr double kShortest = 1.0 / 8;  ///< of the motion range
constexpr double kRests = 1e-9;        ///< of the signal's scale

/// The extremes of a window that moves over samples: the greatest of `sign` times the values.
class WindowExtreme {
 public:
  WindowExtreme(const std::vector<double>& values, double sign) : values_(values), sign_(sign) {}
  void add(std::size_t k) {
    while (!kept_.empty() && value(kept_.back()) <= value(k)) kept_.pop_back();
    kept_.push_back(k);
  }
  void leave(std::size_t k) {
    if (!kept_.empty() && kept_.front() == k) kept_.pop_front();
  }
  double greatest() const { return value(kept_.front()); }

 private:
  double value(std::size_t k) const { return sign_ * values_[k % (values_.size() - 1)]; }
  const std::vector<double>& values_;
  double sign_;
  std::deque<std::size_t> kept_;
};

struct Stretch {
  std::size_t begin, end;  ///< samples; the end may lie in the next turn
  std::size_t length() const { return end - begin; }
};

/// The longest stretch within the band from each sample on.
std::vector<Stretch> stretches(const std::vector<const std::vector<double>*>& coordinates, double band) {
  const std::size_t samples = coordinates.front()->size() - 1;
  std::vector<WindowExtreme> extremes;
  for (const auto* values : coordinates) {
    extremes.emplace_back(*values, 1);
    extremes.emplace_back(*values, -1);
  }
  const auto fits = [&] {
    for (std::size_t i = 0; i < extremes.size(); i += 2) {
      if (extremes[i].greatest() + extremes[i + 1].greatest() > band) return false;
    }
    return true;
  };
  std::vector<Stretch> found;
  std::size_t begin = 0;
  for (std::size_t end = 0; end < 2 * samples && begin < samples; ++end) {
    for (WindowExtreme& extreme : extremes) extreme.add(end);
    while (!fits()) {
      for (WindowExtreme& extreme : extremes) extreme.leave(begin);
      ++begin;
    }
    if (begin >= samples) break;
    if (!found.empty() && found.back().begin == begin) {
      found.back().end = end;
    } else {
      found.push_back({begin, end});
    }
    if (end - begin >= samples) break;  // it never leaves the band
  }
  return found;
}

/// The end of either may lie in the next turn.
bool overlap(const Stretch& a, const Stretch& b, std::size_t samples) {
  const auto meet = [](std::size_t begin, std::size_t end, std::size_t other_begin, std::size_t other_end) {
    return begin <= other_end && other_begin <= end;
  };
  return meet(a.begin, a.end, b.begin, b.end) || meet(a.begin + samples, a.end + samples, b.begin, b.end) ||
         meet(a.begin, a.end, b.begin + samples, b.end + samples);
}

}  // namespace

Signal body_signal(std::size_t body) {
  return {[body](const RangeWalk& walk) {
            const BodyState& state = walk.here().bodies[body];
            return SignalValue{state.angle, state.omega};
          },
          1, true};
}

Signal slide_signal(const Mechanism& mechanism, std::size_t slide) {
  return {[slide](const RangeWalk& walk) {
            const SlideState& state = walk.here().slides[slide];
            return SignalValue{state.position, state.velocity};
          },
          mechanism.largest_length(), true};
}

std::vector<Dwell> find_dwells(const RangeWalk& walk,
                               const std::vector<const std::vector<double>*>& coordinates, double stroke) {
  if (!walk.motion_range().closed || walk.motion_range().kind != MotionRange::Kind::turn) return {};
  const std::size_t samples = walk.motion_range().samples;
  std::vector<Stretch> candidates = stretches(coordinates, kBand * stroke);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Stretch& a, const Stretch& b) { return a.length() > b.length(); });
  std::vector<Stretch> chosen;
  for (const Stretch& stretch : candidates) {
    if (static_cast<double>(stretch.length()) < kShortest * static_cast<double>(samples)) break;
    if (stretch.length() >= samples) return {};  // it rests
    if (std::none_of(chosen.begin(), chosen.end(),
                     [&](const Stretch& other) { return overlap(stretch, other, samples); })) {
      chosen.push_back(stretch);
    }
  }
  std::sort(chosen.begin(), chosen.end(),
            [](const Stretch& a, const Stretch& b) { return a.begin < b.begin; });
  std::vector<Dwell> dwells;
  DriveClock clock(walk.mechanism());
  const auto time = [&](std::size_t k) {
    return walk.motion_range().begin +
           walk.motion_range().duration() * static_cast<double>(k) / static_cast<double>(samples);
  };
  for (const Stretch& stretch : chosen) {
    const double begin = time(stretch.begin), end = time(stretch.end);
    dwells.push_back({begin, end, clock.at(0, begin).value, clock.at(0, end).value});
  }
  return dwells;
}

Sweep sweep_of(const RangeWalk& walk, const SignalScan& scan, bool is_slide, std::size_t index) {
  const double scale = is_slide ? walk.mechanism().largest_length() : 1;
  Sweep sweep;
  sweep.is_slide = is_slide;
  sweep.index = index;
  sweep.least = scan.least;
  sweep.greatest = scan.greatest;
  sweep.gain = scan.last.value - scan.first.value;
  sweep.reversals = scan.turns.size();
  const bool closed = walk.motion_range().closed;
  const double whole = is_slide ? 0 : std::round(sweep.gain / kTurn);
  if (sweep.stroke() < kRests * scale) {
    sweep.kind = Sweep::Kind::stationary;
    sweep.reversals = 0;
    return sweep;
  }
  if (closed && whole != 0) {
    sweep.kind = sweep.reversals == 0 ? Sweep::Kind::turns : Sweep::Kind::turns_with_reversals;
  } else if (!closed && sweep.reversals == 0) {
    sweep.kind = Sweep::Kind::monotone;
  }
  // the times between turning points, those before the first and after the last one as well
  double before = walk.motion_range().begin;
  bool rises = scan.turns.empty() ? sweep.gain > 0 : scan.turns.front().is_greatest;
  for (const TurningPoint& turn : scan.turns) {
    (turn.is_greatest ? sweep.rising : sweep.falling) += turn.time - before;
    before = turn.time;
    rises = !turn.is_greatest;
  }
  (rises ? sweep.rising : sweep.falling) += walk.motion_range().end - before;
  if (closed && sweep.kind == Sweep::Kind::oscillates) {
    if (sweep.reversals == 2) {
      sweep.time_ratio = std::max(sweep.rising, sweep.falling) / std::min(sweep.rising, sweep.falling);
    }
    sweep.dwells = find_dwells(walk, {&scan.values}, sweep.stroke());
  }
  return sweep;
}

}  // namespace oblique::mechanism
