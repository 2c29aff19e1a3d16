// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace oblique::report {

enum class FileKind { diagram, mechanism };

/// What a text's `format` says it is, for whoever takes both. Throws ReadError where it is neither, and as
/// `parse_document`.
FileKind kind_of_file(const std::string& text, const std::string& file);

}  // namespace oblique::report
