// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <oblique/text/diagnostic.h>

#include <oblique/report/diagram_check.h>

namespace oblique::report {

/// The report for people: what the diagram is made of, then loops, stability, overloads, scaling.
std::string to_text(const DiagramCheck& check, const text::Vocabulary& vocabulary = text::plain_vocabulary());

/// What the verdict on the stability means, in a sentence without its full stop.
std::string verdict_text(const solve::StabilityReport& report);

/// "grows", "undamped", "badly damped", "well damped".
std::string_view verdict_name(solve::ModeVerdict verdict);
/// "no feedback", "stable", "stable when frozen", "undamped", "grows", "grows at times",
/// "servo loops unstable", "not told".
std::string_view verdict_name(solve::StabilityVerdict verdict);
/// "linear", "varying", "non-linear".
std::string_view kind_name(solve::LoopKind kind);

}  // namespace oblique::report
