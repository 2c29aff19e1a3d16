// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/mechanism/model/read_mechanism.h>

namespace oblique::mechanism {

/// The mechanism of a file's text without its line of the format.
inline Mechanism mechanism(const std::string& text) {
  return parse_mechanism("format = \"oblique-mechanism/1\"\n" + text, "test.toml");
}

}  // namespace oblique::mechanism
