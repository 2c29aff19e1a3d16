// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

namespace oblique {

/// A file of blocks/, as the build embeds it (blocks/CMakeLists.txt).
struct ShippedBlock {
  std::string_view name;  ///< the file's stem
  std::string_view text;
};

/// All shipped block files, in the order of the list in blocks/CMakeLists.txt.
std::span<const ShippedBlock> shipped_blocks();

}  // namespace oblique
