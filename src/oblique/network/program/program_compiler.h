// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program_code.h>

namespace oblique::network {

/// Differentiates a network, shares and drops expressions, and lays out the tape.
ProgramCode compile(Network network);

}  // namespace oblique::network
