// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <oblique/mechanism/model/mechanism.h>
#include <oblique/mechanism/solver/group_equations.h>
#include <oblique/mechanism/structure/group_form.h>

namespace oblique::mechanism {

/// Links that only together have a definite place, once the groups before have theirs: a drive, or an Assur
/// group.
struct Group {
  std::string name;  ///< "BC-CD": of its links
  GroupForm form;
  /// Assur's and Artobolevsky's class, 1 for drives: the number of pairs in its largest closed contour, which
  /// is a link or a loop of links.
  int assur_class = 2;
  int order = 2;                    ///< pairs by which it hangs on what is placed before
  std::vector<std::size_t> bodies;  ///< in file order
  std::vector<std::size_t> points;  ///< that it places, in the order of Mechanism::points
  std::vector<std::size_t> slides;  ///< whose pairs belong to it
  std::vector<std::size_t> drives;
  GroupEquations equations;
  /// Which of two assembly modes: +1 or −1; 0 where there is one mode or more than two, and before
  /// `choose_modes`. RRR: +1 where the revolute joint lies left of P → Q; other kinds: as in
  /// closed_forms.cpp.
  int side = 0;
  GroupPose start;  ///< at time 0, as `choose_modes` picked it
};

/// The known point that a crank turns about (Placing::rotation), index in Mechanism::points.
std::size_t pivot_of(const Group& crank);

/// The groups of a mechanism in an order in which each needs only the ones before it.
struct Structure {
  std::vector<Group> groups;
};

/// Degrees of freedom by Chebyshev's and Grübler's formula W = 3n − 2p − q: n moving links; p revolute
/// joints, where a point that k links share (the frame is one of them) counts as k − 1; q prismatic joints
/// and pins in slots, of which one that keeps an angle counts twice.
int mobility(const Mechanism& mechanism);

/// Takes a mechanism apart into drives and Assur groups, in file order wherever there is a choice: a perfect
/// matching of conditions with unknowns orients the graph of links and points, and its strongly connected
/// components are the groups, whatever the matching (A. Shai, A. Sljoka, W. Whiteley, "Directed graphs,
/// decompositions, and spatial linkages", 2013; A. Dulmage, N. Mendelsohn 1958). No assembly modes are
/// chosen. Throws MechanismError: kind `mobility` where mobility and drives do not match, in the whole or in
/// a part.
Structure find_groups(const Mechanism& mechanism);

/// `find_groups`, and the assembly mode of each group as the sketch picks it at the start position
/// (`choose_modes`). Throws MechanismError: as both; of conditions that are too many it says whether they
/// hold all the same (`redundancy_findings`).
Structure decompose(const Mechanism& mechanism);

}  // namespace oblique::mechanism
