// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/compare/patched_run.h>
#include <oblique/mechanism/structure/structure.h>

// Not installed.
namespace oblique::compare {

/// Knows how near each group of a mechanism comes to a dead centre along the rows of its exact motion, to say
/// why a patched run errs most where it does.
class WorstReasons {
 public:
  /// All must outlive this. Throws as `decompose`.
  WorstReasons(const mechanism::Mechanism& mechanism, const mechanism::Motion& exact);

  /// Of the groups and the servo loops that the worst point hangs on, the one whose own worst position lies
  /// near the error's, in words: "the triangle B–C–D is nearest to collinear there (sin γ = 0.19)". A group
  /// nearest to its dead centre goes before a loop of the least gain, and the point's own group before
  /// others. Empty where none is near, or changes little along the turn.
  std::string reason(const PatchedMechanism& patched, const patch::PatchOptions& options,
                     const RecordedRun& recorded, const Distances& error) const;

 private:
  std::string flat_group(std::size_t point, std::size_t row, patch::PatchMethod method) const;
  std::string weak_loop(const PatchedMechanism& patched, double gain, const RecordedRun& recorded,
                        const Distances& error) const;
  bool is_near(double a, double b) const;
  std::vector<double> flatness(std::size_t group, patch::PatchMethod method) const;
  std::vector<std::size_t> groups_behind(std::size_t point) const;

  const mechanism::Mechanism& mechanism_;
  const mechanism::Motion& exact_;
  mechanism::Structure structure_;
  std::vector<std::vector<double>> determinants_;  ///< of each group in each row
};

}  // namespace oblique::compare
