// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string_view>

// What is fuzzed: each takes any bytes, and may refuse them with the exceptions of its stage and in no other
// way. A broken promise of the stage itself ends the process.
namespace oblique::fuzz {

/// A TOML file: read, or refused at a place.
void document(std::string_view bytes);

/// An expression (printed and read back unchanged) and a quantity.
void expression(std::string_view bytes);

/// A diagram that the bytes make (see whole_way.h), from its text to its trajectory.
void diagram(std::string_view bytes);

/// A mechanism that the bytes make, from its file by its exact motion and its patch to the run of that.
void mechanism(std::string_view bytes);

}  // namespace oblique::fuzz
