// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/machine_profile.h>

namespace oblique::machine {

/// Thrown by the `machine` stage: a diagram that cannot be put into a machine's elements.
class RealiseError : public text::Error {
 public:
  using text::Error::Error;
};

/// A diagram in the elements of a machine.
struct Realisation {
  diagram::Diagram diagram;   ///< of primitive blocks alone; `profile` and `inverting` are the machine's
  std::size_t inverters = 0;  ///< elements that only change a sign
  /// The names of the active elements, in the order of the circuit that was written (`reduce`).
  std::vector<std::string> elements;
};

/// Puts a diagram into a machine's elements. Its outputs stay what they are, with ideal elements.
///
/// - Composites are flattened; a signal `C.direction.side` is called C_direction_side, and minus_… where the
///   machine carries its negative. What only multiplies by a constant becomes part of the weights (`reduce`).
/// - A weight w becomes a potentiometer of |w|/g before an input of the machine's least gain g ≥ |w|. Where
///   no gain is as large, inputs of the greatest gain stand in parallel: a further amplifier would have to
///   carry w times the signal, while a summing junction adds currents and has no range. A potentiometer of
///   setting 1 is left out, and one signal with one setting has one potentiometer.
/// - Where the machine inverts and its coefficients have no sign, each signal is carried as it is or as its
///   negative, whichever takes fewer inverters in all (`choose_signs`).
/// - Integrators take the least time factor k0 of the machine at which one input for each term suffices;
///   where there is none (`choose_rate`) the component list misses the one they get. Their initial value is
///   a potentiometer at `start`, unless the machine's coefficients have signs (those are set digitally).
/// - Servo amplifiers are open amplifiers and keep their bandwidth and capacitor, and their gain where the
///   machine's is not known.
///
/// Elements are written as the blocks of the library that have their roles.
///
/// `[expect]` is kept. Throws DiagramError as `flatten`; RealiseError for modes that the machine has not, for
/// potentiometers and gains with imperfections of their own, and a role that no block has.
Realisation realise(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                    const diagram::MachineProfile& machine);

}  // namespace oblique::machine
