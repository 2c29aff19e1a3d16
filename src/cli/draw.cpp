// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <oblique/mechanism/read_mechanism.h>
#include <oblique/text/document.h>

#include "command.h"
#include "linkage_scene.h"
#include "picture_output.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

Picture mechanism_picture(const Mechanism& mechanism, const DrawRequest& request) {
  if (!request.plots.empty()) return draw_point_plots(point_history(mechanism, request.plots));
  const std::vector<std::size_t> traces = trace_option(mechanism, request.trace);
  LinkageScene scene = linkage_scene(mechanism, request.at, request.positions);
  if (!scene.motion.empty()) scene.traces = traces;
  return draw_linkage(mechanism, scene);
}

}  // namespace

ExitStatus draw_file(const Session&, const DrawRequest& request) {
  check_picture_output(request.output);
  check_not_input(request.output, request.file, "mechanism");
  const Theme theme = theme_option(request.theme);
  const std::string text = read_file(request.file);  // once: it may be a pipe
  const Document document = parse_document(text, request.file);
  const Value* const format = document.root.find("format");
  const std::string name = format != nullptr ? format->text : "";
  if (name != "oblique-mechanism/1") {
    throw ReadError(Diagnostic{{request.file, {1, 1}},
                               "this is no mechanism",
                               R"(format = "oblique-mechanism/1" at the head of the file)",
                               {}});
  }
  save_picture(mechanism_picture(parse_mechanism(text, request.file), request), request.output, theme);
  return ExitStatus::done;
}

}  // namespace oblique::cli
