// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {

/// Reads `[published]`; `diagram` holds its outputs already. Times must lie within a run of `until` [s].
Published read_published(const Diagram& diagram, const text::Value& table, double until,
                         text::Diagnostics& diagnostics);

/// Reads a `set` table, parameter = value, as `--set` takes them; `what` names it in messages.
std::vector<ParameterOverride> read_settings(const std::string& file, const text::Value& table,
                                             const std::string& what, text::Diagnostics& diagnostics);

/// "{ "x.in[1]" = "0.5" }": settings as a file has them.
std::string settings_text(const std::vector<ParameterOverride>& settings);

/// `[published]` and its `[[published.value]]` as a file has them.
std::string write_published(const Published& published);

/// What is true of a diagram with other blocks and the same outputs: all but the values that set something;
/// nothing where none is left to hold a run against.
std::optional<Published> without_settings(const std::optional<Published>& published);

/// "E. N. Lorenz, Deterministic nonperiodic flow, Journal of the Atmospheric Sciences 20, 1963, p. 130": as
/// people cite.
std::string citation(const Published& published);

/// What a value is called: its label, or the text of what is expected and what is set for it.
std::string name_of(const PublishedValue& value);

}  // namespace oblique::diagram
