// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <oblique/commission/judge.h>
#include <oblique/diagram/machine_profile.h>

namespace oblique::commission {

/// A patch in a machine's own elements.
struct MachinePatch {
  diagram::Diagram ideal;  ///< the same patch in ideal elements
  diagram::Diagram realised;
  patch::PatchOptions options;  ///< with which it was made
  Judgement judgement;          ///< of `realised`
  /// Where the bandwidth had to be less than the usual one, since the elements of the machine are slow beside
  /// the servo loops.
  struct Usual {
    double bandwidth = 0;  ///< [Hz]
    std::string fault;     ///< with it (`fault_of`)
  };
  std::optional<Usual> usual;
};

/// Puts a patch into a machine's elements and judges it there. Where its options leave the bandwidth open, it
/// becomes the greatest of 1, 2, 5 times a power of ten with which the loops are well damped, or, where there
/// is none, stable; what is slow enough is taken to stay so with less. Throws PatchError where it is not
/// stable, with a bandwidth that would do if the options exclude it, unless they force it; RealiseError as
/// `realise`.
MachinePatch put_on_machine(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                            const diagram::MachineProfile& machine, JudgedPatch patched);

}  // namespace oblique::commission
