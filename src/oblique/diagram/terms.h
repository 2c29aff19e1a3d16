// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <oblique/diagram/scope.h>

namespace oblique::diagram::wiring {

/// One `[sign][weight*]signal` of an input. Reports what is wrong with it.
std::optional<Term> read_term(const Scope& scope, const text::Value& value, const std::string& subject,
                              text::Diagnostics& diagnostics);

/// The value of a parameter in its unit. Reports what is wrong with it, also a fixed value out of range.
std::optional<Constant> read_parameter(const Scope& scope, const text::Value& value,
                                       const ParameterDefinition& parameter, const std::string& subject,
                                       text::Diagnostics& diagnostics);

/// Reports a value that the parameter does not allow.
void check_range(const ParameterDefinition& parameter, double value, const std::string& subject,
                 const text::Place& place, const std::string& remedy, text::Diagnostics& diagnostics);

}  // namespace oblique::diagram::wiring
