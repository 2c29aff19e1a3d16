// SPDX-License-Identifier: MIT
#include "verbs/animation_timing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "terminal/terminal.h"
#include "verbs/patch_choice.h"

namespace oblique::cli {
namespace {

constexpr double kDuration = 4, kRate = 25;  // where nothing is asked for: [s], [1/s]
constexpr double kHundredths = 100;          // of a second
constexpr int kLeastDelay = 2;               // browsers slow down what is faster
constexpr int kMostDelay = 65535;            // what a GIF can hold

std::optional<double> rate_of(const AnimateRequest& request) {
  if (request.rate.empty()) return std::nullopt;
  return positive_option("--rate", request.rate, "1/s");
}

std::optional<double> duration_of(const AnimateRequest& request) {
  if (request.duration.empty()) return std::nullopt;
  const double duration = quantity_option("--duration", request.duration, "s");
  if (duration > 0 && std::isfinite(duration)) return duration;
  throw text::ReadError(
      text::Diagnostic{{}, fmt::format("--duration {}", request.duration), "a finite time above 0", {}});
}

[[noreturn]] void refuse_timing(const std::string& what, const std::string& expected,
                                const std::string& remedy) {
  throw text::ReadError(text::Diagnostic{{}, what, expected, remedy});
}

AnimationTiming gif_timing(const std::optional<int>& frames, const std::optional<double>& duration,
                           const std::optional<double>& asked_rate) {
  const double seconds = duration.value_or(kDuration);
  if (frames && duration && asked_rate && std::abs(*duration * *asked_rate - *frames) > 0.5) {
    refuse_timing(
        fmt::format("--frames {}, --duration {:.6g} s and --rate {:.6g} contradict each other: {:.6g} s at "
                    "{:.6g} frames a second are {:.6g} frames",
                    *frames, *duration, *asked_rate, *duration, *asked_rate, *duration * *asked_rate),
        "", "leave one of the three out");
  }
  const double rate = asked_rate ? *asked_rate : frames ? *frames / seconds : kRate;
  const double delay = std::round(kHundredths / rate);
  if (rate > kHundredths / kLeastDelay || delay > kMostDelay) {
    refuse_timing(fmt::format("{:.6g} frames a second in a GIF", rate),
                  "at most 50, and at least one in 655 s",
                  asked_rate ? "" : "choose other --frames or another --duration");
  }
  const double count = frames ? *frames : std::round(seconds * kHundredths / delay);
  if (count < kLeastFrames || count > kMostFrames) {
    refuse_timing(fmt::format("{:.6g} s at {:.6g} frames a second are {:.6g} frames", seconds,
                              kHundredths / delay, count),
                  fmt::format("{} to {} frames", kLeastFrames, kMostFrames),
                  "choose another --duration or another --rate");
  }
  return {static_cast<int>(count), count * delay / kHundredths, static_cast<int>(delay)};
}

}  // namespace

AnimationTiming timing_of(const AnimateRequest& request, bool gif) {
  const std::optional<double> duration = duration_of(request), rate = rate_of(request);
  if (gif) return gif_timing(request.frames, duration, rate);
  if (rate) {
    refuse_timing(
        fmt::format("--rate {} is for a .gif: others move evenly between their frames", request.rate), "",
        "leave it out; --frames says how many positions are computed");
  }
  AnimationTiming timing;
  timing.frames = request.frames.value_or(timing.frames);
  timing.duration = duration.value_or(kDuration);
  return timing;
}

std::string pace_text(int frames, int delay) {
  return fmt::format("{:.4g} frames a second, {:.6g} s a round", kHundredths / delay,
                     frames * delay / kHundredths);
}

bool keeps_pace(const AnimateRequest& request, int frames, int delay) {
  constexpr double kSame = 0.005;
  const auto differs = [&](double asked, double is) { return std::abs(is - asked) > kSame * asked; };
  const std::optional<double> duration = duration_of(request), rate = rate_of(request);
  if (request.frames && frames != *request.frames) return false;
  if (rate && differs(*rate, kHundredths / delay)) return false;
  const bool round_is_free = request.frames && rate && !duration;
  return round_is_free || !differs(duration.value_or(kDuration), frames * delay / kHundredths);
}

}  // namespace oblique::cli
