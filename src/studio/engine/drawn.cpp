// SPDX-License-Identifier: MIT
#include "studio/engine/drawn.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/draw/linkage/linkage.h>
#include <oblique/draw/picture/svg.h>
#include <oblique/draw/schematic/diagram_drawing.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/report/file_kind.h>
#include <oblique/report/linkage_scene.h>

#include "studio/engine/options.h"

namespace oblique::studio {
namespace {

[[noreturn]] void refuse(std::string what, std::string expected) {
  throw text::ReadError(text::Diagnostic{{}, std::move(what), std::move(expected), {}});
}

draw::Theme theme_of(const Options& options) {
  const std::string theme = options.word("theme").value_or("auto");
  if (theme == "auto") return draw::Theme::automatic;
  if (theme == "light") return draw::Theme::light;
  if (theme == "dark") return draw::Theme::dark;
  refuse(fmt::format("'theme' is '{}'", theme), "auto, light or dark");
}

std::string drawn_diagram(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                          const Options& options) {
  constexpr int kDeepest = 100;
  draw::DiagramDrawing drawing;
  const std::string symbols = options.word("symbols").value_or("classic");
  if (symbols != "classic" && symbols != "din")
    refuse(fmt::format("'symbols' is '{}'", symbols), "classic or din");
  if (symbols == "din") drawing.symbols = draw::SymbolStyle::din;
  drawing.depth = options.whole("depth", 0, kDeepest).value_or(0);
  return draw::to_svg(draw::draw_diagram(diagram, library, drawing), theme_of(options), 1,
                      options.flag("data"));
}

std::string drawn_mechanism(const mechanism::Mechanism& mechanism, const Options& options) {
  constexpr int kMostPositions = 100;
  const std::vector<std::size_t> traces = report::traced_points(mechanism, {});
  report::TimedScene timed = report::linkage_scene(mechanism, options.quantity("time", "s").value_or(0),
                                                   options.whole("positions", 1, kMostPositions).value_or(1));
  if (!timed.scene.motion.empty()) timed.scene.traces = traces;
  return draw::to_svg(draw::draw_linkage(mechanism, timed.scene), theme_of(options));
}

}  // namespace

Json drawn(const std::string& text, const std::string& name, const diagram::BlockLibrary& library,
           const std::string& options) {
  const bool is_diagram = report::kind_of_file(text, name) == report::FileKind::diagram;
  Json json;
  json["svg"] = is_diagram ? drawn_diagram(diagram::parse_diagram(text, name), library,
                                           Options(options, {"theme", "symbols", "depth", "data"}))
                           : drawn_mechanism(mechanism::parse_mechanism(text, name),
                                             Options(options, {"theme", "time", "positions"}));
  return json;
}

}  // namespace oblique::studio
