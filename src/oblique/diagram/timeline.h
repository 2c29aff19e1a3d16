// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {

/// Reads `[groups]`: each a list of blocks, or a table of `blocks` and the mode lines `initial` and `hold`.
std::vector<ModeGroup> read_groups(const std::string& file, const text::Value& table,
                                   text::Diagnostics& diagnostics);

/// Reads `[timeline]`: `phases` and `cycles`; `machine` is the profile whose volts count in conditions.
Timeline read_timeline(const std::string& file, const text::Value& table,
                       const std::vector<ModeGroup>& groups, const std::string& machine,
                       text::Diagnostics& diagnostics);

/// How long all phases together take [s]; infinite where a phase ends by a condition alone.
double duration_of(const Timeline& timeline);

/// "{ mode = "hold", for = 1 }": a phase as a file has it.
std::string to_string(const Phase& phase);

/// Finds the signal that a path names; reports it where there is none.
using FindSignal = std::function<std::optional<SignalRef>(const std::string& path, const text::Place& place,
                                                          const std::string& subject)>;

/// Resolves groups and phases of a diagram whose blocks are laid out.
void lay_out_timeline(const Diagram& diagram, FlatDiagram& flat, const FindSignal& find_signal,
                      text::Diagnostics& diagnostics);

}  // namespace oblique::diagram
