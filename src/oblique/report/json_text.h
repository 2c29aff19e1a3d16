// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace oblique::report {

/// JSON as it is printed and saved, two spaces a level. Names that are not UTF-8 (a file may have such a one)
/// carry replacement characters, as JSON knows nothing else.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace oblique::report
