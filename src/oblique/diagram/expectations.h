// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {

/// Reads a table of expectations, which messages call `what`; a value may be given in the unit of its output,
/// which `diagram` holds already. Times must lie within a run of `until` [s].
std::vector<Expectation> read_expectations(const Diagram& diagram, const text::Value& table,
                                           const std::string& what, double until,
                                           text::Diagnostics& diagnostics);

/// Reads the time of an expectation, which `what` names; nothing where it lies outside the run.
std::optional<double> read_expected_time(const std::string& file, const text::Value& time,
                                         const text::Place& place, const std::string& what, double until,
                                         text::Diagnostics& diagnostics);

/// The unit in which what is expected may be given: that of the output, "1" where it is any text for people;
/// of a period seconds.
text::Unit unit_of(const Diagram& diagram, const Expectation& expectation);

/// "side at 3.5", "side maximum": the key of an expectation that has no text of its own.
std::string expectation_key(const Expectation& expectation);

/// Lines of a table as `[expect]` has them: the key in quotes and `{ value = …, within = … }`.
std::vector<std::pair<std::string, std::string>> expectation_lines(
    const std::vector<Expectation>& expectations);

/// Reports every expectation about an output that is not among `outputs`: of `[expect]`, `[published]` and
/// `[lesson]`.
void check_expected_outputs(const Diagram& diagram, const std::vector<std::string>& outputs,
                            text::Diagnostics& diagnostics);

}  // namespace oblique::diagram
