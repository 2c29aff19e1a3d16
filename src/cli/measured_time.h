// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>

#include <nlohmann/json.hpp>

namespace oblique::cli {

/// Seconds that were measured, for JSON: nothing where SOURCE_DATE_EPOCH asks for the same bytes each time
/// (https://reproducible-builds.org/specs/source-date-epoch/).
inline nlohmann::ordered_json measured_seconds(double seconds) {
  if (std::getenv("SOURCE_DATE_EPOCH") != nullptr) return nullptr;
  return seconds;
}

}  // namespace oblique::cli
