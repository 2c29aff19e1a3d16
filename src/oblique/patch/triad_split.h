// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>

#include <oblique/mechanism/motion.h>
#include <oblique/mechanism/structure.h>

namespace oblique {

/// A triad on three links taken apart into two triangles and an outer loop (003_69ea068b7b221c3d.txt): the
/// distance w from the closing lead's anchor Z to the platform's point B of the tracked lead is taken for
/// known. Then B is the apex of A–B–Z, the third lead's point D that of B–D–E, the closing lead's point C
/// follows rigidly, and what |ZC|² lacks drives w.
struct TriadSplit {
  std::size_t tracked = 0, closing = 1, third = 2;  ///< indices of Group::equations.conditions
  int first_side = 0;                               ///< of B over A → Z, +1: left
  int second_side = 0;                              ///< of D over B → E
  int sign = 0;                                     ///< of d|ZC|²/dw
  double flattest = 0;                              ///< smallest sine of the apex's angle in either triangle
  double least_gain = 0;                            ///< smallest |d(|ZC|/l)²/d(w/reach)|
  double longest = 0;                               ///< largest w [length unit]
  double reach = 0;                                 ///< largest of |AZ| and w [length unit]
  double first_w = 0;                               ///< w at the start [length unit]
};

/// The split whose triangles never go flat and whose loop never loses its sign along the motion; of several,
/// the one with the largest smallest value of sines and gain. Nothing where there is none, or where a lead is
/// no link.
std::optional<TriadSplit> choose_split(const Group& group, const Motion& motion);

}  // namespace oblique
