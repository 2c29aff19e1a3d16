// SPDX-License-Identifier: MIT
// How many random class III mechanisms that turn fully are patched and tracked, by triangles and by gradient;
// what is not is named. class_three_bench [HOW MANY]
#include <chrono>
#include <cstdlib>
#include <map>

#include <fmt/format.h>

#include "../support/random_class_three.h"

int main(int argc, char** argv) {
  using namespace oblique;
  const long wanted = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 1000;
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  for (const patch::PatchMethod method : {patch::PatchMethod::triangles, patch::PatchMethod::gradient}) {
    const auto begin = std::chrono::steady_clock::now();
    long tracked = 0;
    double worst = 0;
    for (long seed = 1; seed <= wanted; ++seed) {
      const testing::Tracking result =
          testing::track(testing::random_class_three(static_cast<std::uint64_t>(seed)), method, library);
      if (result.tracks) {
        ++tracked;
        worst = std::max(worst, result.error);
      } else {
        fmt::print("  seed {}, {}: {} (split {})\n", seed, patch::method_name(method), result.explanation,
                   result.split);
      }
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    fmt::print(
        "class III by {}: {} of {} tracked at gain 1e4, errors up to {:.2g} of the largest link; {:.1f} s\n",
        patch::method_name(method), tracked, wanted, worst, seconds);
  }
  return 0;
}
