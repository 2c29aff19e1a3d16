// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/mechanism/model/mechanism.h>

namespace oblique::patch {

/// How a mechanism becomes equations that amplifiers solve.
enum class PatchMethod {
  triangles,  ///< servo amplifiers track the sides and angles of oblique triangles
  gradient,   ///< integrators descend along the gradient of the squared conditions
  paper,      ///< a class III group as its first source drew it: two equal four-bar circuits and a loop
};

/// "triangles", "gradient", "paper".
std::string_view method_name(PatchMethod method);
std::optional<PatchMethod> parse_patch_method(std::string_view text);

inline constexpr double kUsualSlower = 100;

/// How a mechanism is patched.
struct PatchOptions {
  PatchMethod method = PatchMethod::triangles;
  double gain = 1e6;  ///< μ of every servo amplifier; inf: ideal amplifiers
  std::optional<double>
      bandwidth;  ///< of every servo amplifier [Hz]; inf: algebraic loops; default: `default_bandwidth`
  bool derivatives = false;  ///< velocities and accelerations too, as further circuits
  /// How many times slower than the loops inside it an outer loop is: next to their speed several splits of a
  /// triad are unstable. Default: kUsualSlower, or what a stable patch takes (`judged_patch`).
  std::optional<double> slower = {};
  /// Names of the three legs of a triad: the one whose triangle carries the variable length, the one that
  /// closes the loop, the third; empty: the split that is worth the most.
  std::vector<std::string> split = {};
  bool split_by_trial = false;  ///< nobody asked for `split`: those that are worth more were unstable
  std::optional<double> unit;  ///< 1 machine unit of a coordinate [length unit]; default: by the exact motion
  bool force = false;          ///< patch what flips on the way, too
  /// Seconds of machine time that the motion takes; default: as the mechanism's own. Rates stay those of the
  /// mechanism.
  std::optional<double> period = {};
  double tolerance = 1e-10;  ///< of the run that the diagram asks for
  int samples = 361;         ///< rows of that run
};

/// A hundred times the frequency of the fastest drive, rounded up to 1, 2 or 5 times a power of ten [Hz]: the
/// pole of the open loop then turns the phase of a signal at crank frequency by half a degree. A drive that
/// moves a prismatic joint counts as a crank of the longest link's length.
double default_bandwidth(const mechanism::Mechanism& mechanism);

/// The bandwidth of the servo amplifiers of `patch` with these options [Hz of machine time].
double bandwidth_of(const mechanism::Mechanism& mechanism, const PatchOptions& options);

}  // namespace oblique::patch
