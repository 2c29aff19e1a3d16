// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/sheet.h>

#include <algorithm>
#include <cmath>

#include <oblique/draw/schematic/sheet_places.h>

namespace oblique::draw::schematic {
namespace {

using Eigen::Vector2d;

constexpr int kLoopWeight = 3;  // servo loops stay together

LayoutGraph graph_of(const Schematic& schematic, const std::vector<Shape>& shapes) {
  LayoutGraph graph;
  for (const Shape& shape : shapes) graph.nodes.push_back(shape.node);
  for (std::size_t b = 0; b < schematic.blocks.size(); ++b) {
    const auto& inputs = schematic.blocks[b].inputs;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      if (!inputs[k].signal) continue;
      const std::size_t from = inputs[k].signal->block;
      graph.wires.push_back({from, inputs[k].signal->output, b, k, inputs[k].in_loop ? kLoopWeight : 1});
    }
  }
  return graph;
}

/// The frame of an open composite: its pins are where the terminals stand inside.
Shape open_shape(const Block& block, const Sheet& inside) {
  std::vector<double> inputs, outputs;
  const auto& blocks = inside.schematic->blocks;
  for (const Input& input : block.inputs) {
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (blocks[b].kind == Block::Kind::input && blocks[b].name == input.port)
        inputs.push_back(inside.layout.corners[b].y() + inside.shapes[b].node.outputs[0]);
    }
  }
  for (const std::string& output : block.outputs) {
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (blocks[b].kind == Block::Kind::output && blocks[b].name == output)
        outputs.push_back(inside.layout.corners[b].y() + inside.shapes[b].node.inputs[0]);
    }
  }
  return frame_shape(block, inside.layout.size, inputs, outputs);
}

bool same_signal(const std::optional<Signal>& a, const std::optional<Signal>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->block == b->block && a->output == b->output;
}

bool wired_alike(const Schematic& a, const Schematic& b);

bool alike(const Block& a, const Block& b) {
  return a.kind == b.kind && a.name == b.name && a.definition == b.definition && a.outputs == b.outputs &&
         std::equal(a.inputs.begin(), a.inputs.end(), b.inputs.begin(), b.inputs.end(),
                    [](const Input& p, const Input& q) {
                      return p.port == q.port && same_signal(p.signal, q.signal);
                    }) &&
         std::equal(a.inside.begin(), a.inside.end(), b.inside.begin(), b.inside.end(), wired_alike);
}

bool wired_alike(const Schematic& a, const Schematic& b) {
  return std::equal(a.blocks.begin(), a.blocks.end(), b.blocks.begin(), b.blocks.end(), alike);
}

/// Gives the shapes of one block on several sheets the same sizes: texts in them may be of other lengths.
void make_equal(std::vector<Sheet>& sheets, std::size_t block) {
  double left = 0, body = 0, right = 0;
  for (const Sheet& sheet : sheets) {
    const Shape& shape = sheet.shapes[block];
    left = std::max(left, shape.corner.x());
    body = std::max(body, shape.body.x());
    right = std::max(right, shape.node.size.x() - shape.corner.x() - shape.body.x());
  }
  for (Sheet& sheet : sheets) {
    Shape& shape = sheet.shapes[block];
    if (shape.form != Form::terminal) shape.body.x() = body;
    shape.corner.x() = left;
    shape.node.size.x() = left + body + right;
  }
}

std::vector<Sheet> make_sheets(const std::vector<const Schematic*>& schematics, SymbolStyle style);

/// Lays out the insides of open composites, those alike together.
void open_composites(std::vector<Sheet>& sheets, SymbolStyle style) {
  struct Opened {
    Sheet* sheet;
    std::size_t block;
    const Schematic* inside;
  };
  std::vector<Opened> opened;
  for (Sheet& sheet : sheets) {
    sheet.inside.resize(sheet.schematic->blocks.size());
    for (std::size_t b = 0; b < sheet.inside.size(); ++b) {
      const auto& inside = sheet.schematic->blocks[b].inside;
      if (!inside.empty()) opened.push_back({&sheet, b, &inside.front()});
    }
  }
  while (!opened.empty()) {
    const auto others = std::stable_partition(opened.begin(), opened.end(), [&](const Opened& other) {
      return wired_alike(*opened.front().inside, *other.inside);
    });
    std::vector<const Schematic*> schematics;
    for (auto o = opened.begin(); o != others; ++o) schematics.push_back(o->inside);
    std::vector<Sheet> insides = make_sheets(schematics, style);
    for (auto o = opened.begin(); o != others; ++o)
      o->sheet->inside[o->block] = std::move(insides[static_cast<std::size_t>(o - opened.begin())]);
    opened.erase(opened.begin(), others);
  }
}

/// The sheets of schematics that are wired alike.
std::vector<Sheet> make_sheets(const std::vector<const Schematic*>& schematics, SymbolStyle style) {
  std::vector<Sheet> sheets(schematics.size());
  for (std::size_t k = 0; k < sheets.size(); ++k) sheets[k].schematic = schematics[k];
  open_composites(sheets, style);
  for (Sheet& sheet : sheets) {
    for (std::size_t b = 0; b < sheet.inside.size(); ++b) {
      const Block& block = sheet.schematic->blocks[b];
      sheet.shapes.push_back(block.inside.empty() ? shape_of(block, style)
                                                  : open_shape(block, sheet.inside[b]));
    }
  }
  for (std::size_t b = 0; b < sheets.front().shapes.size(); ++b) make_equal(sheets, b);
  const Sheet& first = sheets.front();
  LayoutGraph graph = graph_of(*first.schematic, first.shapes);
  give_places(*first.schematic, first.shapes, style, graph);
  const DiagramLayout layout = lay_out(graph);
  check_wires(*first.schematic, layout);
  for (Sheet& sheet : sheets) sheet.layout = layout;
  return sheets;
}

}  // namespace

Sheet make_sheet(const Schematic& schematic, SymbolStyle style) {
  return std::move(make_sheets({&schematic}, style).front());
}

Sheet sketch_sheet(const Schematic& schematic, SymbolStyle style, const std::string& held) {
  Sheet sheet;
  sheet.schematic = &schematic;
  sheet.inside.resize(schematic.blocks.size());
  for (const Block& block : schematic.blocks) sheet.shapes.push_back(shape_of(block, style));
  LayoutGraph graph = graph_of(schematic, sheet.shapes);
  sheet.moved = give_room(schematic, sheet.shapes, held, graph);
  sheet.layout = lay_out(graph);
  for (std::size_t b = 0; b < graph.nodes.size(); ++b) {
    if (graph.nodes[b].place) sheet.origin = sheet.layout.corners[b] - *graph.nodes[b].place;
  }
  return sheet;
}

std::vector<diagram::BlockPlace> places_of(const Sheet& sheet) {
  std::vector<diagram::BlockPlace> places;
  for (std::size_t b = 0; b < sheet.shapes.size(); ++b) {
    const Block& block = sheet.schematic->blocks[b];
    if (block.kind != Block::Kind::block) continue;
    const Vector2d middle =
        (sheet.layout.corners[b] - sheet.origin + sheet.shapes[b].corner + sheet.shapes[b].body / 2) /
        kPlaceUnit;
    places.push_back({block.name, middle.x(), middle.y(), {}});
  }
  return places;
}

}  // namespace oblique::draw::schematic
