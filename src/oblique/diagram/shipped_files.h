// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

namespace oblique::diagram {

/// A text file that the build embeds (embed_files.cmake).
struct ShippedFile {
  std::string_view name;  ///< the file's stem
  std::string_view text;
};

/// All files of blocks/, of src/machines/ and of src/machines/elements/, in the order of the lists in their
/// CMakeLists.txt.
std::span<const ShippedFile> shipped_blocks();
std::span<const ShippedFile> shipped_machines();
std::span<const ShippedFile> shipped_elements();

}  // namespace oblique::diagram
