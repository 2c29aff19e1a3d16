// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/mechanism/model/mechanism.h>
#include <oblique/patch/patch.h>

namespace oblique::commission {

/// What can be told of a patch before it runs: its servo loops are put at rest at many moments of its motion,
/// whether they would stay there or not, and looked at there.
struct Judgement {
  double slowest_pole =
      0;  ///< largest real part of the servo loops' eigenvalues [1/s]; −inf without servo loops
  double pole_time = 0;              ///< [s]
  std::optional<double> grows_from;  ///< [s] the first moment at which a mode of them grows
  double growth = 0;                 ///< of that mode [1/s]
  std::vector<std::string> growing;  ///< servo amplifiers of the fastest one, the greatest share first

  double damping = 1;                 ///< ζ of the servo loops' mode that has the least of it
  std::vector<std::string> swinging;  ///< its servo amplifiers, the greatest share first

  struct Flip {
    std::string loop;  ///< servo amplifier
    double time = 0;   ///< [s]
  };
  /// Where one grows: loops whose gain changes its sign, the rest of them closed, as a cause of it.
  std::vector<Flip> flips;

  std::string largest_signal;
  double largest = 0;  ///< greatest magnitude of any signal [machine unit]

  std::string no_rest;  ///< why the loops stand nowhere at some moment, or empty

  /// Whether it tracks: its loops stand at rest everywhere and come back to rest.
  bool good() const { return no_rest.empty() && !grows_from; }
  /// Whether errors die within about two swings, too.
  bool well_damped() const;
};

/// What is wrong with a patch that is not good or not well damped, in words.
std::string fault_of(const Judgement& judgement);

/// Judges a diagram. Throws DiagramError where it is not one.
Judgement judge(const diagram::Diagram& diagram, const diagram::BlockLibrary& library);

/// The same at the start alone, which costs next to nothing: one that is not good there is not good.
Judgement judge_start(diagram::Diagram diagram, const diagram::BlockLibrary& library);

/// The same at moments of its own run: where the loops stand, not where they would stand at rest. Throws
/// SolveError where it does not run.
Judgement judge_along_run(const diagram::Diagram& diagram, const diagram::BlockLibrary& library);

/// A patch and what was found about it.
struct JudgedPatch {
  diagram::Diagram diagram;
  patch::PatchOptions options;  ///< with which it was made
  Judgement judgement;
};

/// Patches a mechanism and judges the patch. Where the options leave a triad's split and its outer loop as
/// they come, other splits are tried in the order of their worth, then slower outer loops, until a patch is
/// good (paper: slower outer loops with the source's split). Throws PatchError where none is, with what would
/// help, unless the options force it: then the diagram starts from the exact motion, not from rest, and where
/// it swings up it runs until that fills the machine. Throws as `patch`.
JudgedPatch judged_patch(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                         const patch::PatchOptions& options);

}  // namespace oblique::commission
