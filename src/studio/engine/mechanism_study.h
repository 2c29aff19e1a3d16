// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "studio/engine/engine.h"

namespace oblique::studio {

/// What a page asks of a mechanism once; as the functions of Engine these throw nothing.

/// The groups that can be assembled in several ways at the start: {"groups": [{"name", "class", "complete":
/// whether these are all, "modes": [{"selected", "points": {name: [x, y]}, "svg": the mechanism with it,
/// "text": the file whose sketch picks it, or "why" there is none}]}]}. The file may have a sketch that does
/// not decide.
Answer modes(const Engine& engine, const std::string& text, const std::string& name);

/// How the one triad of a mechanism may be split: {"splits": [{"legs": [names], "worth", "flips": when it
/// does [s], or null}]}, the most worth first; none where it has no triad on three links, or several.
Answer splits(const Engine& engine, const std::string& text, const std::string& name);

/// The closed system of a patch, frozen at some moments of its motion with its loops at rest: {"rows",
/// "columns", "signals": the states' names, "split", "slower", "bandwidth" [Hz], "outer": the amplifiers
/// whose bandwidth `slower` divides, "growing": how many eigenvalues grow, "rightmost": {"real", "imaginary",
/// "time", "drive", "signal"} of the loops, "no_rest": why they stand nowhere, or null}, and as numbers a row
/// for each eigenvalue (of a pair the one above the axis): time [s], first drive, real part, imaginary part
/// [1/s], number in "signals" of the state that takes the greatest part, 1 where it is the problem's own and
/// no loop's. Options as Engine::patch has them (unstable patches are looked at too), and "moments".
Answer loops(const Engine& engine, const std::string& text, const std::string& name,
             const std::string& options);

}  // namespace oblique::studio
