// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <oblique/diagram/diagram.h>
#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/draw/schematic/diagram_drawing.h>

#include "terminal/picture_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

draw::SymbolStyle symbols_option(const std::string& text) {
  if (text.empty() || text == "classic") return draw::SymbolStyle::classic;
  if (text == "din") return draw::SymbolStyle::din;
  throw text::ReadError(text::Diagnostic{
      {}, fmt::format("--symbols {}", text), "classic or din", text::suggest(text, {"classic", "din"})});
}

}  // namespace

ExitStatus draw_diagram_file(const Session& session, const DrawRequest& request, const std::string& text) {
  const draw::Theme theme = theme_option(request.theme);
  draw::DiagramDrawing drawing;
  drawing.symbols = symbols_option(request.symbols);
  drawing.depth = request.depth.value_or(0);
  const diagram::Diagram diagram = diagram::parse_diagram(text, request.file);
  const diagram::BlockLibrary library = session.blocks();
  if (request.layout) {
    const std::string table = diagram::write_layout(draw::drawn_places(diagram, library, drawing.symbols));
    print(std::string_view(table).substr(1));  // without the empty line above it
    return ExitStatus::done;
  }
  save_picture(draw::draw_diagram(diagram, library, drawing), request.output, theme);
  return ExitStatus::done;
}

}  // namespace oblique::cli
