// SPDX-License-Identifier: MIT
#include <oblique/mechanism/analysis/analysis.h>

#include <algorithm>

#include <oblique/mechanism/model/inertia.h>
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {
namespace {

bool drives_slide(const Mechanism& mechanism, std::size_t slide) {
  return std::any_of(mechanism.drives.begin(), mechanism.drives.end(),
                     [&](const Drive& drive) { return drive.slide == slide; });
}

Signal coordinate(const Mechanism& mechanism, std::size_t point, int axis) {
  return {[point, axis](const RangeWalk& walk) {
            const PointState& state = walk.here().points[point];
            return SignalValue{state.position(axis), state.velocity(axis)};
          },
          mechanism.largest_length(), true};
}

/// All signals of an analysis in one pass, and what becomes of their scans.
class Study {
 public:
  Study(const Mechanism& mechanism, const Structure& structure, const MotionRange& motion_range,
        MechanismAnalysis& analysis)
      : mechanism_(mechanism),
        structure_(structure),
        walk_(mechanism, structure, motion_range),
        analysis_(analysis) {}

  void run() {
    list();
    scans_ = scan(walk_, signals_);
    std::size_t at = 0;
    for (const auto& [is_slide, index] : movers_)
      analysis_.swings.push_back(sweep_of(walk_, scans_[at++], is_slide, index));
    for (Transmission& transmission : analysis_.transmissions) {
      transmission.least = scans_[at].least;
      transmission.greatest = scans_[at++].greatest;
    }
    for (const PathMeasure& measure : measure_paths(walk_)) {
      report_path(measure, scans_[at], scans_[at + 1]);
      at += 2;
    }
    if (has_masses(mechanism_)) report_inertia(scans_[at], scans_[at + 1]);
  }

 private:
  void list() {
    for (std::size_t b = 0; b < mechanism_.bodies.size(); ++b) {
      if (mechanism_.drive_of(b)) continue;
      movers_.emplace_back(false, b);
      signals_.push_back(body_signal(b));
    }
    for (std::size_t s = 0; s < mechanism_.slides.size(); ++s) {
      if (drives_slide(mechanism_, s)) continue;
      movers_.emplace_back(true, s);
      signals_.push_back(slide_signal(mechanism_, s));
    }
    for (std::size_t g = 0; g < structure_.groups.size(); ++g) {
      const auto measure = measure_of(structure_.groups[g]);
      if (!measure) continue;
      analysis_.transmissions.push_back({g, *measure, {}, {}});
      signals_.push_back(transmission_signal(structure_, g));
    }
    for (std::size_t p = 0; p < mechanism_.points.size(); ++p) {
      if (mechanism_.points[p].fixed) continue;
      for (const int axis : {0, 1}) signals_.push_back(coordinate(mechanism_, p, axis));
    }
    if (!has_masses(mechanism_)) return;
    signals_.push_back({[](const RangeWalk& walk) {
                          return SignalValue{
                              reduced_inertia(walk.mechanism(), walk.here(), walk.drives().front())};
                        },
                        1, false});
    signals_.push_back(
        {[](const RangeWalk& walk) { return SignalValue{kinetic_energy(walk.mechanism(), walk.here())}; }, 1,
         false});
  }

  void report_path(const PathMeasure& measure, const SignalScan& x, const SignalScan& y) {
    PathReport path{measure, x.least, x.greatest, y.least, y.greatest, {}};
    const double stroke = std::max(path.right.value - path.left.value, path.top.value - path.bottom.value);
    constexpr double kMoves = 1e-9;
    if (stroke > kMoves * mechanism_.largest_length())
      path.dwells = find_dwells(walk_, {&x.values, &y.values}, stroke);
    analysis_.paths.push_back(std::move(path));
  }

  void report_inertia(const SignalScan& inertia, const SignalScan& energy) {
    InertiaReport report;
    for (std::size_t b = 0; b < mechanism_.bodies.size(); ++b) {
      if (mechanism_.bodies[b].mass > 0)
        report.bars.push_back({b, mechanism_.bodies[b].mass, bar_inertia(mechanism_, b)});
    }
    report.least = inertia.least;
    report.greatest = inertia.greatest;
    report.least_energy = energy.least;
    report.greatest_energy = energy.greatest;
    analysis_.inertia = std::move(report);
  }

  const Mechanism& mechanism_;
  const Structure& structure_;
  RangeWalk walk_;
  MechanismAnalysis& analysis_;
  std::vector<std::pair<bool, std::size_t>> movers_;  ///< whether a prismatic joint, and its index
  std::vector<Signal> signals_;
  std::vector<SignalScan> scans_;
};

/// At the start, and where the drive has no speed there, as if it had.
std::vector<InstantCentre> centres_at_start(Mechanism mechanism, const Structure& structure) {
  DriveClock clock(mechanism);
  if (mechanism.drives.size() == 1 && clock.at(0, 0.0).rate == 0) {
    mechanism.drives.front().law.reset();
    mechanism.drives.front().speed = 1;
  }
  return instant_centres(mechanism, Follower(mechanism, structure).advance(0));
}

}  // namespace

MechanismAnalysis analyse(const Mechanism& mechanism, const Structure& structure) {
  MechanismAnalysis analysis;
  analysis.mobility = mobility_report(mechanism, structure);
  analysis.four_bars = four_bar_loops(mechanism, structure);
  analysis.sliders = slider_loops(mechanism, structure);
  if (mechanism.drives.empty()) return analysis;
  analysis.motion_range = plan_motion_range(mechanism, structure);
  Study(mechanism, structure, *analysis.motion_range, analysis).run();
  analysis.centres = centres_at_start(mechanism, structure);
  return analysis;
}

}  // namespace oblique::mechanism
