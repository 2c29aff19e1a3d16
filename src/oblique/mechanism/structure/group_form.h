// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <oblique/mechanism/solver/group_equations.h>

namespace oblique::mechanism {

/// What a group is called. The letters of a class II group are its pairs, from one known element to the
/// other: R a revolute joint, P a prismatic joint.
enum class GroupKind : std::uint8_t {
  crank,    ///< class I: a link turned by a drive about a known point
  slider,   ///< class I: a point or a link moved by a drive along a known line
  rrr,      ///< a point at two distances
  rrp,      ///< a point at a distance and on a line
  prp,      ///< a point on two lines
  rpr,      ///< a link pinned to a known point, whose line passes through another
  rpp,      ///< a link that keeps its direction, whose line passes through a known point
  triad,    ///< class III: a link on three legs
  general,  ///< everything else
};

/// "crank", "RRR", "triad" …
std::string_view kind_name(GroupKind kind);

/// How a group gets its place once the groups before have theirs.
enum class Placing : std::uint8_t {
  rotation,     ///< a crank: its drive gives the angle about a known point
  triangle,     ///< two links on two known points: `GroupForm::dyad`
  pinned,       ///< a link of known direction, pinned to a known point
  crossing,     ///< a point, or a link of known direction, where two circles or lines meet
  about_pivot,  ///< a link pinned to a known point, with one condition on its angle
  platform,     ///< a triad: a link on three legs
  iteration,    ///< several links or points at once, or conditions between unknowns
};

/// An RRR dyad by its triangle: body1 pinned to the known P, body2 to the known Q, both to each other in C.
///
///            C             C lies left of P → Q: Group::side = +1
///      r₁  /   \  r₂
///     P ---- L ---- Q
struct Dyad {
  std::size_t body1 = 0, p = 0;  ///< body1 stands before body2 in the file
  std::size_t body2 = 0, q = 0;
  std::size_t c = 0;
  double r1 = 0, r2 = 0;  ///< |PC|, |QC| [length unit]
};

/// What a group is and which of its conditions does what, as `form_of` reads it off its equations. Conditions
/// are indices in GroupEquations::conditions.
struct GroupForm {
  GroupKind kind = GroupKind::general;
  Placing placing = Placing::iteration;
  std::optional<std::size_t> revolute;  ///< rotation, pinned, about_pivot: to the known point
  std::optional<std::size_t> angle;     ///< rotation, pinned, crossing of a link: what gives its direction
  /// The other conditions, each between something known and an unknown. Crossing: two, circles first;
  /// about_pivot: one; platform: its three legs.
  std::vector<std::size_t> loci;
  std::size_t circles = 0;   ///< how many of `loci` are distances, and so links
  std::optional<Dyad> dyad;  ///< triangle

  /// Whether it is a triad of which all legs are links.
  bool is_triad_on_links() const { return placing == Placing::platform && circles == loci.size(); }
};

/// The form of a group. This is the one place that recognises it: solvers, circuits and reports read it.
GroupForm form_of(const GroupEquations& equations);

}  // namespace oblique::mechanism
