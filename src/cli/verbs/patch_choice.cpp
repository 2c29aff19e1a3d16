// SPDX-License-Identifier: MIT
#include "verbs/patch_choice.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "terminal/terminal.h"

namespace oblique::cli {

double positive_option(const std::string& option, const std::string& text, std::string_view unit) {
  const double value = quantity_option(option, text, unit);
  if (value > 0 && std::isfinite(value)) return value;
  throw text::ReadError(
      text::Diagnostic{{}, fmt::format("{} {}", option, text), "a finite number above 0", {}});
}

void take_apart(const TriadChoice& choice, const std::vector<patch::PatchMethod>& methods,
                std::vector<std::string>& split, std::optional<double>& slower) {
  if (!choice.slower.empty()) slower = positive_option("--slower", choice.slower, "1");
  split = choice.split;
  if (split.empty() && !slower) return;
  const auto takes_apart = [](patch::PatchMethod method) { return method != patch::PatchMethod::gradient; };
  if (std::any_of(methods.begin(), methods.end(), takes_apart)) return;
  const std::string option = split.empty() ? fmt::format("--slower {}", choice.slower)
                                           : fmt::format("--split {}", fmt::join(split, ","));
  throw text::ReadError(
      text::Diagnostic{{},
                       fmt::format("{} with --method gradient, which takes no group apart", option),
                       "--method triangles or paper beside it",
                       {}});
}

patch::PatchOptions patch_options(const PatchChoice& choice) {
  patch::PatchOptions options;
  options.method = method_option(choice.method);
  options.gain = positive_option("--gain", choice.gain, "1");
  if (!choice.bandwidth.empty()) options.bandwidth = positive_option("--bandwidth", choice.bandwidth, "Hz");
  take_apart(choice.triads, {options.method}, options.split, options.slower);
  return options;
}

std::optional<double> magnify_option(const std::string& text) {
  if (text.empty()) return std::nullopt;
  return positive_option("--magnify", text, "1");
}

}  // namespace oblique::cli
