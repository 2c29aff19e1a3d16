// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/mechanism/model/read_mechanism.h>

namespace oblique::test {

/// The mechanism of this name in diagrams/mechanisms.
inline mechanism::Mechanism shipped(const std::string& name) {
  return mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + name +
                                   ".toml");
}

}  // namespace oblique::test
