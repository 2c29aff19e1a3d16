// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/patch/slide_dyads.h>
#include <oblique/patch/triad_split.h>

namespace oblique::patch {

/// Class III groups as two triangles and an outer loop.
class TriadPatch : protected SlideDyadPatch {
 protected:
  using SlideDyadPatch::SlideDyadPatch;

  /// By blocks `dyad-rrr-variable` and `dyad-rrr`, each triangle in a scale of its own.
  void add_triad(const mechanism::Group& group, const TriadSplit& split);

  /// Places all that the group carries, once the platform's points b and d have signals.
  void carry_triad(const mechanism::Group& group, std::size_t b, std::size_t d);

  /// Where the loops of a triangle on P, Q with the apex C stand at the start: a group of loops that hang on
  /// each other finds its rest from there.
  struct TriangleStart {
    double length = 0;                        ///< |PQ| [length unit]
    double cosine = 0, sine = 0;              ///< of the direction of P → Q
    double angle_cosine = 0, angle_sine = 0;  ///< of the angle at P, sine ≥ 0
  };
  TriangleStart triangle_start(std::size_t p, std::size_t q, std::size_t c) const;

  /// The servo amplifier named `length` that drives the variable length, from what is summed in `residual`.
  void add_outer_loop(const std::string& length, const Terms& residual, double initial);

 private:
  std::vector<text::Entry> with_start(std::vector<text::Entry> settings, const TriangleStart& start,
                                      double reach) const;
  void add_closing_loop(const mechanism::Condition& closing, const TriadSplit& split,
                        const std::string& length, double reach);
};

}  // namespace oblique::patch
