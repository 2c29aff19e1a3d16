// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/text/diagnostic.h>

namespace oblique::report {

/// "0.0125", "−4.44·10¹¹": four digits, as people write them; "unknown" for what is no number.
std::string readable(double value);

/// What a failure says, for a page: "…; expected …. Remedy: …".
std::string words_of(const text::Error& error, const text::Vocabulary& vocabulary);

/// With a capital letter at the beginning, where that is one of ASCII.
std::string capitalised(std::string text);

}  // namespace oblique::report
