// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// A link of a loop, from joint to joint; no link: the frame.
struct LoopLink {
  std::optional<std::size_t> body;  ///< index in Mechanism::bodies
  std::size_t from = 0, to = 0;     ///< indices in Mechanism::points
  double length = 0;                ///< [length unit]
};

/// What F. Grashof's rule says of a four-bar loop whose shortest and longest links are s and l, the others
/// p and q (Theoretische Maschinenlehre II, 1883).
enum class GrashofClass {
  crank_rocker,   ///< s + l < p + q and the shortest link is pinned to the frame: it turns fully
  double_crank,   ///< the frame is the shortest: both its neighbours turn fully
  double_rocker,  ///< the coupler is the shortest and turns fully, its neighbours swing
  change_point,   ///< s + l = p + q: all four links can lie on one line
  triple_rocker,  ///< s + l > p + q: no link turns fully against another
  grashof,        ///< s + l < p + q in a loop without the frame: the shortest turns fully against the others
};

/// "crank-rocker" …
std::string_view grashof_name(GrashofClass type);

/// Four links pinned in a ring:   frame – input – coupler – output – frame.
struct FourBarLoop {
  std::size_t group = 0;          ///< the RRR dyad that closes it, index in Structure::groups
  std::array<LoopLink, 4> links;  ///< the frame (of a loop without it: a link), input, coupler, output
  GrashofClass type = GrashofClass::triple_rocker;
  double shortest_and_longest = 0, others = 0;  ///< s + l, p + q [length unit]
  std::vector<std::size_t> shortest;            ///< indices in `links`
};

/// The class of lengths of frame, input, coupler and output; sums that differ by less than 1e-9 of the
/// longest count as equal.
GrashofClass grashof_class(const std::array<double, 4>& lengths);

/// A crank about a fixed pivot, a rod or lever, and a prismatic joint.
///
///     slider-crank: the rod l joins the crank's pin to a point on a fixed line, e away from the pivot
///         crank turns fully: l ≥ r + e;   rod turns fully: r ≥ l + e
///     slotted lever: a line e beside the pin of a lever passes the crank's pin, or the other way round;
///     d between the two pivots
///         crank turns fully: |r − d| ≥ e;   then the lever turns fully for r > d, and swings for r < d
struct SliderLoop {
  enum class Type {
    crank_turns,   ///< slider-crank: the crank turns fully
    rod_turns,     ///< slider-crank: the rod turns fully, the crank swings
    lever_turns,   ///< slotted lever: crank and lever turn fully (Whitworth's)
    lever_swings,  ///< slotted lever: the crank turns fully, the lever swings (crank shaper)
    change_point,  ///< between two of these
    none_turns,    ///< no link turns fully
  };
  std::size_t group = 0;
  bool is_lever = false;
  std::size_t crank = 0;  ///< links
  std::size_t rod = 0;
  double radius = 0;  ///< r [length unit]
  double length = 0;  ///< l, or d of a slotted lever
  double offset = 0;  ///< e ≥ 0
  Type type = Type::none_turns;
};

/// "the crank turns fully" …
std::string_view slider_loop_name(SliderLoop::Type type);

/// Every four-bar loop that an RRR dyad closes: its outer revolute joints sit on two links that are pinned to
/// each other, of which one may be the frame.
std::vector<FourBarLoop> four_bar_loops(const Mechanism& mechanism, const Structure& structure);

/// Every slider-crank and slotted lever that an RRP or RPR dyad closes about a crank with a fixed pivot.
std::vector<SliderLoop> slider_loops(const Mechanism& mechanism, const Structure& structure);

}  // namespace oblique::mechanism
