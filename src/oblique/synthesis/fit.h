// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <oblique/synthesis/target_path.h>

namespace oblique::synthesis {

struct FitOptions {
  /// Searches begun: the first at the dimensions of the file, the others spread over the bounds, the same at
  /// every call.
  int starts = 8;
  std::function<void(double)> progress;  ///< called with the part that is done
};

/// How far a path is from its targets [length unit].
struct PathError {
  double rms = 0;      ///< root mean square of the distances
  double largest = 0;  ///< largest distance
};

/// What became of a free dimension.
struct FittedDimension {
  std::string name;
  double before = 0;  ///< [length unit], as are the next three
  double after = 0;
  double lower = 0;
  double upper = 0;

  bool changed() const { return after != before; }
  bool at_bound() const { return after <= lower || after >= upper; }
};

/// The mechanism nearest to a path that was found.
struct Fit {
  PathError before;
  PathError after;  ///< of the numbers as they stand in `text`
  std::vector<FittedDimension> dimensions;
  bool improved = false;     ///< otherwise `text` is the file as it was and `after` is `before`
  bool turns_fully = false;  ///< the mechanism turned fully before, and so does this one
  /// Largest angular acceleration of a link over the turn, in squares of the first drive's speed: far above 1
  /// near a dead centre. Known of a mechanism that turns fully and is improved.
  double acceleration_before = 0;
  double acceleration_after = 0;
  bool sketch_moved = false;  ///< the old sketch would have picked another assembly mode
  std::size_t mechanisms_tried = 0;
  /// The file with the changed numbers (10 digits), and a comment as its first line that tells so; every
  /// other byte as it was.
  std::string text;
};

/// Looks for the dimensions that bring the path of a point nearest to its targets, in the sense of least
/// squares over the distances: with the times of the targets, or else to the nearest place of the path. The
/// mechanism keeps its assembly mode, and if it turns fully it still does (PathProblem).
///
/// `text` is the mechanism file, `file` its name; `free` as in DesignSpace. Throws as `parse_mechanism` and
/// `solve_motion`, and SynthesisError: kind `request` where a free dimension makes no sense or has no effect
/// on the path, or where there are fewer targets than free dimensions ask for; kind `nowhere` where no start
/// within the bounds can be assembled and turns.
Fit fit_path(const std::string& text, const std::string& file, std::span<const std::string> free,
             const TargetPath& target, const FitOptions& options = {});

}  // namespace oblique::synthesis
