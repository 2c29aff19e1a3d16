// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/tape.h>
#include <oblique/text/interval.h>

namespace oblique::network {

using text::Interval;

/// Runs instructions on intervals: each result holds every value that the instruction has for operands from
/// its intervals, as `text::evaluate` has them, and is the whole line where it is not known.
void run_tape(std::span<const Instruction> instructions, std::span<Interval> slots);

}  // namespace oblique::network
