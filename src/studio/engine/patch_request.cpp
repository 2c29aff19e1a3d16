// SPDX-License-Identifier: MIT
#include "studio/engine/patch_request.h"

#include <fmt/format.h>

namespace oblique::studio {
namespace {

std::optional<double> positive(const Options& asked, const char* key, std::string_view unit) {
  const std::optional<double> value = asked.quantity(key, unit);
  if (value && !(*value > 0))
    throw text::ReadError(
        text::Diagnostic{{}, fmt::format("'{}' is {}", key, *value), "a number above 0", {}});
  return value;
}

}  // namespace

patch::PatchOptions patch_options(const Options& asked) {
  patch::PatchOptions how;
  if (const auto method = asked.word("method")) {
    const auto known = patch::parse_patch_method(*method);
    if (!known)
      throw text::ReadError(
          text::Diagnostic{{}, fmt::format("'method' is '{}'", *method), "triangles, gradient or paper", {}});
    how.method = *known;
  }
  how.gain = positive(asked, "gain", "1").value_or(how.gain);
  how.bandwidth = positive(asked, "bandwidth", "Hz");
  how.slower = positive(asked, "slower", "1");
  how.period = positive(asked, "period", "s");
  how.split = asked.words("split");
  return how;
}

}  // namespace oblique::studio
