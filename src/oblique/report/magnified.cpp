// SPDX-License-Identifier: MIT
#include <oblique/report/magnified.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/report/drive_caption.h>

namespace oblique::report {
namespace {

using Eigen::Vector2d;

/// All moments in order, each once.
std::vector<double> moments_of(const TimedScene& timed, std::vector<double> moments) {
  moments.insert(moments.end(), timed.times.begin(), timed.times.end());
  moments.push_back(timed.time);
  std::sort(moments.begin(), moments.end());
  moments.erase(std::unique(moments.begin(), moments.end()), moments.end());
  return moments;
}

/// "1000", "1e+12".
std::string factor_text(double factor) {
  constexpr double kWritten = 1e9;
  const bool plain = factor < kWritten && factor == std::floor(factor);
  return plain ? fmt::format("{:.0f}", factor) : fmt::format("{:.6g}", factor);
}

/// "3e5": one digit and a power of ten, the next smaller one.
std::string rough_number(double value) {
  const double power = std::floor(std::log10(value));
  return fmt::format("{:.0f}e{:.0f}", std::floor(value / std::pow(10, power)), power);
}

}  // namespace

MagnifiedAnalog::MagnifiedAnalog(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                                 const patch::PatchOptions& options, double magnification,
                                 const TimedScene& timed, const std::vector<double>& moments,
                                 const std::function<void(double fraction)>& progress)
    : mechanism_(mechanism),
      magnification_(magnification),
      moments_(moments_of(timed, moments)),
      places_(compare::analog_places(mechanism, library, options, moments_, progress)) {
  measure(timed.time, timed.scene.shown);
  for (std::size_t k = 0; k < timed.times.size(); ++k) measure(timed.times[k], timed.scene.motion[k]);
}

std::vector<Vector2d> MagnifiedAnalog::points(double time, const mechanism::Configuration& exact) const {
  const auto row = std::lower_bound(moments_.begin(), moments_.end(), time) - moments_.begin();
  std::vector<Vector2d> points = places_[static_cast<std::size_t>(row)];
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vector2d& place = exact.points[p].position;
    points[p] = place + magnification_ * (points[p] - place);
  }
  return points;
}

void MagnifiedAnalog::measure(double time, const mechanism::Configuration& exact) {
  const std::vector<Vector2d> here = points(time, exact);
  for (std::size_t p = 0; p < here.size(); ++p) {
    const double error = (here[p] - exact.points[p].position).norm() / magnification_;
    if (!(error > largest_)) continue;
    largest_ = error;
    worst_time_ = time;
    worst_point_ = p;
  }
}

draw::AnalogOverlay MagnifiedAnalog::overlay(const TimedScene& timed) const {
  draw::AnalogOverlay overlay;
  for (std::size_t k = 0; k < timed.times.size(); ++k)
    overlay.motion.push_back(points(timed.times[k], timed.scene.motion[k]));
  overlay.shown = points(timed.time, timed.scene.shown);
  overlay.legend = "analog, error ×" + factor_text(magnification_);
  overlay.caption = fmt::format("largest error {:.3g} {} at {}, {}", largest_, mechanism_.length_unit,
                                mechanism_.points[worst_point_].name, drive_caption(mechanism_, worst_time_));
  return overlay;
}

std::string MagnifiedAnalog::remark(const text::Vocabulary& vocabulary) const {
  constexpr double kSeen = 0.002, kGood = 0.05, kTooMuch = 2;  // of the longest link
  const double size = mechanism_.largest_length(), shown = magnification_ * largest_;
  if (largest_ == 0 || (shown >= kSeen * size && shown <= kTooMuch * size)) return {};
  const char* const how = shown < kSeen * size ? "still too small to be seen" : "larger than the mechanism";
  return fmt::format("note: the largest error, {:.3g} {}, is {} at {} times its size; {} shows it well\n",
                     largest_, mechanism_.length_unit, how, factor_text(magnification_),
                     vocabulary.setting({"magnify", rough_number(kGood * size / largest_)}));
}

}  // namespace oblique::report
