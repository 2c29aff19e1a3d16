// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <oblique/text/diagnostic.h>

namespace oblique::studio {

using Json = nlohmann::ordered_json;

/// What the page is told: an object, and beside it numbers that no text carries as well.
struct Answer {
  Json object = Json::object();
  std::vector<double> numbers;  ///< row by row where the object says that there are rows
};

/// {"file", "line", "column", "what", "expected", "remedy", "message"}: line and column count from 1, 0 means
/// "not known"; "message" is all of it as the program prints it, with settings named as the library does.
Json to_json(const text::Diagnostic& diagnostic);
Json to_json(const std::vector<text::Diagnostic>& diagnostics);

/// What `work` gives, with "ok": true; or, whatever it throws, "ok": false, "error" (the exception's name),
/// "kind" where it has one, "time" [s] of a run that failed, and "diagnostics", at least one. Throws nothing
/// but where not even that can be said.
Answer answer(const std::function<Answer()>& work);

/// A JSON text as it is handed over; what is no UTF-8 in it stands as replacement characters.
std::string to_text(const Json& json);

}  // namespace oblique::studio
