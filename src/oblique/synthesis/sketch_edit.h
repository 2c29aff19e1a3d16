// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/mechanism/model/mechanism.h>

// Not installed.
namespace oblique::synthesis {

/// Whether points that [sketch] does not have yet are written into it.
enum class NewPoints { leave_out, add };

/// The text of a mechanism file with these points of its sketch where they stand in `points` (6 digits);
/// others stay, and so does every other byte. What is added goes to the end of the sketch, or of the file
/// where it has none.
std::string with_sketch(const std::string& text, const mechanism::Mechanism& mechanism,
                        const std::vector<mechanism::SketchPoint>& points, NewPoints new_points);

}  // namespace oblique::synthesis
