// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/mechanism/model/mechanism.h>

namespace oblique::patch {

/// Thrown by the `patch` stage: a mechanism that cannot be turned into a diagram.
class PatchError : public text::Error {
 public:
  enum class Kind {
    obstacle,  ///< the mechanism, or what its patch would do, stands in the way
    request,   ///< the options contradict the mechanism or each other
  };

  explicit PatchError(text::Diagnostic diagnostic, Kind kind = Kind::obstacle)
      : text::Error(std::move(diagnostic)), kind_(kind) {}

  Kind kind() const { return kind_; }

  /// Whether PatchOptions::force would patch it all the same.
  bool can_be_forced() const { return can_be_forced_; }
  PatchError&& forcible() && {
    can_be_forced_ = true;
    return std::move(*this);
  }

 private:
  Kind kind_;
  bool can_be_forced_ = false;
};

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
/// moves a slide counts as a crank of the longest link's length.
double default_bandwidth(const mechanism::Mechanism& mechanism);

/// The bandwidth of the servo amplifiers of `patch` with these options [Hz of machine time].
double bandwidth_of(const mechanism::Mechanism& mechanism, const PatchOptions& options);

/// The diagram that simulates a mechanism by servo-tracked triangles over one turn of its first drive: a
/// crank generator for each drive and a dyad of oblique triangles for each pair of links (method:
/// AVM class III). All signals are scaled by the exact motion to stay within ±1 machine unit;
/// `[outputs]` scale back and carry the names of `solve`'s columns ("C.x"). Throws PatchError where a
/// triangle does not close or goes flat on the way, MechanismError as `decompose`.
diagram::Diagram patch_triangles(const mechanism::Mechanism& mechanism, const PatchOptions& options = {});

/// The diagram that simulates any mechanism by the gradient servo: with the unknown coordinates x of the
/// points that a group places and its conditions g = 0 [length],
///
///     ẋ = −K Σ g ∂g/∂x,      K = gain · 2π · bandwidth
///
/// which is stable in every assembly mode, since Σ g² can only fall; its price is a lag of about |ẋ|/(K σ²),
/// σ the least singular value of ∂g/∂x. Multipliers, summers and integrators alone. Scaled, and throws, as
/// above.
diagram::Diagram patch_gradient(const mechanism::Mechanism& mechanism, const PatchOptions& options = {});

/// The diagram of the source (AVM class III) for a mechanism of cranks and triads on three links, so that it
/// can be read beside the source: two equal circuits `four-bar-circuit` with one scale for all lengths, an
/// outer loop that tracks the variable length, and the source's angles among the outputs. The split is the
/// source's unless the options name one: the first leg, that hangs on a crank, carries the variable length,
/// the second one in the file closes the loop. Scaled, and throws, as above.
diagram::Diagram patch_paper(const mechanism::Mechanism& mechanism, const PatchOptions& options = {});

/// The splits of a mechanism's triad that never flip and keep their gain, the most worth first, as
/// PatchOptions::split names them; none where it has no triad on three links, or several.
std::vector<std::vector<std::string>> useful_splits(const mechanism::Mechanism& mechanism);

/// The mechanism as it is patched: one that can turn is left as it is, and so is one with several drives, a
/// drive with a law, or a duration in its file. Any other with a range is swung over nine tenths of it: its
/// drive gets the law of a sine, with the speed of the file in the middle, for one swing there and back.
mechanism::Mechanism within_range(const mechanism::Mechanism& mechanism);

/// By the method of the options, of the mechanism within its range. Throws PatchError for a period where a
/// drive has a law of its own.
diagram::Diagram patch(const mechanism::Mechanism& mechanism, const PatchOptions& options = {});

}  // namespace oblique::patch
