# SPDX-License-Identifier: MIT
# Writes the text files FILES as string literals into the C++ file OUTPUT, whose function NAME gives them (see
# shipped_files.h).
set(entries "")
foreach(file IN LISTS FILES)
  get_filename_component(stem "${file}" NAME_WLE)
  file(READ "${file}" text)
  string(APPEND entries "    {\"${stem}\", R\"toml-text(${text})toml-text\"},\n")
endforeach()
list(LENGTH FILES count)
file(WRITE "${OUTPUT}" "// Made from text files by embed_files.cmake; edit those.
#include <oblique/diagram/shipped_files.h>

#include <array>

namespace oblique::diagram {

std::span<const ShippedFile> ${NAME}() {
  static constexpr std::array<ShippedFile, ${count}> kFiles{{
${entries}  }};
  return kFiles;
}

}  // namespace oblique::diagram
")
