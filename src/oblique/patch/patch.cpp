// SPDX-License-Identifier: MIT
#include <oblique/patch/patch.h>

#include <stdexcept>

namespace oblique::patch {

diagram::Diagram patch(const mechanism::Mechanism& mechanism, const PatchOptions& options) {
  const mechanism::Mechanism ranged = within_range(mechanism);
  switch (options.method) {
    case PatchMethod::triangles:
      return patch_triangles(ranged, options);
    case PatchMethod::gradient:
      return patch_gradient(ranged, options);
    case PatchMethod::paper:
      return patch_paper(ranged, options);
  }
  throw std::logic_error("a patch by no method");
}

}  // namespace oblique::patch
