// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/mechanism/model/mechanism.h>

namespace oblique::patch {

/// The mechanism as it is patched: one that can turn is left as it is, and so is one with several drives, a
/// drive with a law, or a duration in its file. Any other with a range is swung over nine tenths of it: its
/// drive gets the law of a sine, with the speed of the file in the middle, for one swing there and back.
mechanism::Mechanism within_range(const mechanism::Mechanism& mechanism);

}  // namespace oblique::patch
