// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/solver/assembly.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::synthesis {

/// A mechanism file that picks an assembly mode.
struct ModeChoice {
  /// Nothing where no sketch picks it, or the mechanism cannot be assembled with it.
  std::optional<std::string> text;
  mechanism::Configuration start;  ///< of that mechanism
  std::string why;                 ///< there is no text
};

/// The file with a sketch that picks a mode of `mode.points`, one that the mechanism has at its start: the
/// points that it sketches already are put where they stand in the mode, and only if that does not do all of
/// the group's. Every other byte stays.
ModeChoice choose_mode(const std::string& text, const mechanism::Mechanism& mechanism,
                       const mechanism::AssemblyMode& mode);

}  // namespace oblique::synthesis
