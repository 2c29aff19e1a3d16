// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/text/diagnostic.h>

namespace oblique::report {

/// "0.0125", "−4.44·10¹¹": four digits, as people write them; "unknown" for what is no number.
std::string readable(double value);

/// An expression as it is printed in books: "10·y − 1.5·10⁸·x" of "10*y - 1.5e+08*x".
std::string printed_expression(const std::string& expression);

/// "dx/dt", and "d(speed)/dt", which would else read as a name.
std::string derivative_of(const std::string& name);

/// What a failure says, for a page: "…; expected …. Remedy: …".
std::string words_of(const text::Error& error, const text::Vocabulary& vocabulary);

/// With a capital letter at the beginning, where that is one of ASCII.
std::string capitalised(std::string text);

}  // namespace oblique::report
