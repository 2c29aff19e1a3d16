# SPDX-License-Identifier: MIT
# Writes the block files BLOCKS as string literals into the C++ file OUTPUT (see shipped_blocks.h).
set(entries "")
foreach(file IN LISTS BLOCKS)
  get_filename_component(name "${file}" NAME_WLE)
  file(READ "${file}" text)
  string(APPEND entries "    {\"${name}\", R\"toml-text(${text})toml-text\"},\n")
endforeach()
list(LENGTH BLOCKS count)
file(WRITE "${OUTPUT}" "// Made from blocks/*.toml by embed_blocks.cmake; edit those.
#include <oblique/diagram/shipped_blocks.h>

#include <array>

namespace oblique {

std::span<const ShippedBlock> shipped_blocks() {
  static constexpr std::array<ShippedBlock, ${count}> kBlocks{{
${entries}  }};
  return kBlocks;
}

}  // namespace oblique
")
