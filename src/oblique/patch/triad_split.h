// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/patch_options.h>

namespace oblique::patch {

/// A triad on three links taken apart into two triangles and an outer loop (AVM class III): the
/// distance w from the closing leg's anchor Z to the platform's point B of the tracked leg is taken for
/// known. Then B is the apex of A–B–Z, the third leg's point D that of B–D–E, the closing leg's point C
/// follows rigidly, and what |ZC|² lacks drives w.
struct TriadSplit {
  std::size_t tracked = 0, closing = 1, third = 2;  ///< indices of Group::equations.conditions
  int first_side = 0;                               ///< of B over A → Z at the start, +1: left
  int second_side = 0;                              ///< of D over B → E
  int sign = 0;                                     ///< of d|ZC|²/dw
  double flattest = 0;                              ///< smallest sine of the apex's angle in either triangle
  double least_gain = 0;                            ///< smallest |d(|ZC|/l)²/d(w/reach)|
  double longest = 0;                               ///< largest w [length unit]
  double reach = 0;                                 ///< largest of |AZ| and w [length unit]
  double second_reach = 0;                          ///< largest |BE| [length unit]
  double first_w = 0;                               ///< w at the start [length unit]
  bool asked_for = false;                           ///< by the options, for this triad

  /// A moment at which a triangle becomes collinear or the loop loses its gain, so that the analog does not
  /// come past it.
  enum class Flip { none, first_triangle, second_triangle, loop };
  Flip flip = Flip::none;
  double flip_time = 0;  ///< [s]

  /// What it is worth: the smaller of `flattest` and `least_gain`; 0 where it flips.
  double worth() const;
};

/// The six splits of a triad on links, the most worth first.
std::vector<TriadSplit> splits_of(const mechanism::Group& group, const mechanism::Motion& motion);

/// A split of less worth is as good as collinear, or without gain, at some position.
inline constexpr double kLeastWorth = 0.02;

/// The link of a leg, by its condition: its index in Mechanism::bodies.
std::size_t leg_of(const mechanism::Group& triad, std::size_t condition);

/// "AB, O1C, DE": the legs of a split, the one that carries the variable length first, then the one that
/// closes the loop.
std::string split_name(const mechanism::Mechanism& mechanism, const mechanism::Group& triad,
                       const TriadSplit& split);

/// The split that the options name for this triad, otherwise the one that is worth the most. Throws
/// PatchError where that one flips, or none is worth kLeastWorth, unless the options force it.
TriadSplit choose_split(const mechanism::Mechanism& mechanism, const mechanism::Group& triad,
                        const mechanism::Motion& motion, const PatchOptions& options);

/// A split with the names of its legs, as PatchOptions::split has them.
struct NamedSplit {
  std::vector<std::string> legs;
  TriadSplit split;
};

/// The six splits of a mechanism's triad, the most worth first; none where it has no triad on three links, or
/// several.
std::vector<NamedSplit> all_splits(const mechanism::Mechanism& mechanism);

/// The splits of a mechanism's triad that never flip and keep their gain, the most worth first, as
/// PatchOptions::split names them; none where it has no triad on three links, or several.
std::vector<std::vector<std::string>> useful_splits(const mechanism::Mechanism& mechanism);

/// Throws PatchError where the options name a split and no triad of the structure has these three legs, or
/// an outer loop's speed and there is no triad.
void check_split_options(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                         const PatchOptions& options);

}  // namespace oblique::patch
