// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>

namespace oblique::text {

/// Reads a number from the front of a text as `std::from_chars` does, in every locale: the end of what was
/// read, and invalid_argument where nothing was, or result_out_of_range, of which `value` keeps what it had.
std::from_chars_result read_decimal(const char* begin, const char* end, double& value);

/// The same where the standard library has no such function for numbers with a point, in a program that never
/// leaves the C locale: it finds the end and leaves the value to `strtod`.
std::from_chars_result read_decimal_by_strtod(const char* begin, const char* end, double& value);

}  // namespace oblique::text
