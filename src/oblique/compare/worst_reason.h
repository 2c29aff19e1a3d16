// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/compare/patched_run.h>
#include <oblique/mechanism/structure.h>

// Not installed.
namespace oblique {

/// Knows how near each group of a mechanism comes to a dead centre along the rows of its exact motion, to say
/// why a patched run errs most where it does.
class WorstReasons {
 public:
  /// All must outlive this. Throws as `decompose`.
  WorstReasons(const Mechanism& mechanism, const Motion& exact);

  /// Of the groups and the servo loops that the worst point hangs on, the one whose own worst position lies
  /// near the error's, in words: "the triangle B–C–D is flattest there (sin γ = 0.19)". A group nearest to
  /// its dead centre goes before a loop of the least gain, and the point's own group before others. Empty
  /// where none is near, or changes little along the turn.
  std::string reason(const PatchedMechanism& patched, const PatchOptions& options,
                     const RecordedRun& recorded, const Distances& error) const;

 private:
  std::string flat_group(std::size_t point, std::size_t row, PatchMethod method) const;
  std::string weak_loop(const PatchedMechanism& patched, double gain, const RecordedRun& recorded,
                        const Distances& error) const;
  bool is_near(double a, double b) const;
  std::vector<double> flatness(std::size_t group, PatchMethod method) const;
  std::vector<std::size_t> groups_behind(std::size_t point) const;

  const Mechanism& mechanism_;
  const Motion& exact_;
  Structure structure_;
  std::vector<std::vector<double>> regularities_;  ///< of each group in each row
};

}  // namespace oblique
