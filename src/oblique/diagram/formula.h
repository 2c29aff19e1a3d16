// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>

#include <oblique/diagram/block_definition.h>

namespace oblique::diagram {

/// Reads a parameter that is a formula: an expression of `time` and numbers. Reports what is wrong with it;
/// `subject` names it in messages.
std::optional<text::Expression> read_formula(const std::string& file, const text::Value& value,
                                             const std::string& subject, text::Diagnostics& diagnostics);

/// The equations with the formulas in the place of their names.
Behaviour with_formulas(const Behaviour& behaviour, const std::map<std::string, text::Expression>& formulas);

}  // namespace oblique::diagram
