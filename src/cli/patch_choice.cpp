// SPDX-License-Identifier: MIT
#include "patch_choice.h"

#include <cmath>

#include <fmt/format.h>

#include "terminal.h"

namespace oblique::cli {

double positive_option(const std::string& option, const std::string& text, std::string_view unit) {
  const double value = quantity_option(option, text, unit);
  if (value > 0 && std::isfinite(value)) return value;
  throw ReadError(Diagnostic{{}, fmt::format("{} {}", option, text), "a finite number above 0", {}});
}

PatchOptions patch_options(const PatchChoice& choice) {
  PatchOptions options;
  options.method = method_option(choice.method);
  options.gain = positive_option("--gain", choice.gain, "1");
  if (!choice.bandwidth.empty()) options.bandwidth = positive_option("--bandwidth", choice.bandwidth, "Hz");
  return options;
}

}  // namespace oblique::cli
