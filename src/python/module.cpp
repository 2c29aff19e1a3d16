// SPDX-License-Identifier: MIT
#include "binding.h"

PYBIND11_MODULE(_oblique, module) {
  using namespace oblique::python;
  module.doc() = "The library of Oblique, as the package `oblique` uses it.";
  module.attr("__version__") = OBLIQUE_VERSION;
  bind_errors(module);
  bind_libraries(module);
  bind_runs(module);
  bind_diagrams(module);
  bind_consoles(module);
  bind_ensembles(module);
  bind_mechanisms(module);
}
