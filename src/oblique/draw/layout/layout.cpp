// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/layout.h>

#include <algorithm>

#include <oblique/draw/layout/fixed_layout.h>
#include <oblique/draw/layout/layered_layout.h>
#include <oblique/draw/layout/measure.h>
#include <oblique/draw/layout/tidy.h>
#include <oblique/draw/layout/wrap.h>

namespace oblique::draw {

DiagramLayout lay_out(const LayoutGraph& graph) {
  DiagramLayout layout;
  if (graph.nodes.empty()) return layout;
  const bool is_given = std::any_of(graph.nodes.begin(), graph.nodes.end(),
                                    [](const LayoutNode& node) { return node.place.has_value(); });
  if (is_given) {
    layout = lay_out_around(graph);
  } else {
    layout = layered::lay_out_in_layers(graph);
    wrap(graph, layout);
    tidy(graph, layout);
  }
  measure(graph, layout);
  return layout;
}

}  // namespace oblique::draw
