// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/block_definition.h>
#include <oblique/text/document.h>

namespace oblique::diagram {

/// A wire of a block as its file has it.
struct WrittenWire {
  std::string port;                    ///< empty where the block's type is not known
  std::size_t term = 0;                ///< which one of the port
  std::string key;                     ///< of the setting
  std::optional<std::size_t> element;  ///< of the setting's list; none where the wire stands alone
  std::string text;                    ///< "-2*abc"
  std::string signal;                  ///< "abc"; empty where the text names none or several
  text::SourcePosition position;
};

/// The wires of a block, in the order of its ports; `definition` may be null.
std::vector<WrittenWire> wires_of(const std::vector<text::Entry>& settings,
                                  const BlockDefinition* definition);

}  // namespace oblique::diagram
