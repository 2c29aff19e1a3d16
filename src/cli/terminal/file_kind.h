// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace oblique::cli {

enum class FileKind { diagram, mechanism };

/// What a file's `format` says it is, for verbs that take both. Throws ReadError where it is neither, and as
/// `parse_document`.
FileKind kind_of_file(const std::string& text, const std::string& file);

}  // namespace oblique::cli
