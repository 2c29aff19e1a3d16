// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>

#include <oblique/report/file_kind.h>
#include <oblique/report/linkage_scene.h>
#include <oblique/report/magnified.h>
#include <oblique/text/file.h>
#include "terminal/picture_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"
#include "verbs/drive_place.h"
#include "verbs/patch_choice.h"

namespace oblique::cli {
namespace {

draw::Picture mechanism_picture(const Session& session, const mechanism::Mechanism& read,
                                const DrawRequest& request) {
  if (!request.plots.empty())
    return draw::draw_chart(draw::point_plots(report::point_history(read, request.plots)));
  const std::optional<double> magnification = magnify_option(request.magnify);
  const mechanism::Mechanism mechanism = magnification ? patch::within_range(read) : read;
  const std::vector<std::size_t> traces = report::traced_points(mechanism, request.trace);
  report::TimedScene timed =
      report::linkage_scene(mechanism, time_option_at(mechanism, request.at), request.positions);
  if (!timed.scene.motion.empty()) timed.scene.traces = traces;
  if (magnification) {
    const report::MagnifiedAnalog analog = [&] {
      Progress progress("running the patch");
      return report::MagnifiedAnalog(mechanism, session.blocks(), patch_options(request.patch),
                                     *magnification, timed, {},
                                     [&](double fraction) { progress.show(fraction); });
    }();
    timed.scene.analog = analog.overlay(timed);
    note(analog.remark(command_line()));
  }
  return draw::draw_linkage(mechanism, timed.scene);
}

void refuse_drawing(bool given, const std::string& option, const std::string& file, const char* kind,
                    const char* other) {
  if (!given) return;
  throw text::ReadError(text::Diagnostic{
      {file, {}}, fmt::format("{} is for {}s, and this is a {}", option, other, kind), {}, "leave it out"});
}

void check_options_of_diagram(const DrawRequest& request) {
  const auto refuse_option = [&](bool given, const char* option) {
    refuse_drawing(given, option, request.file, "diagram", "mechanism");
  };
  refuse_option(!request.at.empty(), "--at");
  refuse_option(request.positions != 1, "--positions");
  refuse_option(!request.trace.empty(), "--trace");
  refuse_option(!request.plots.empty(), "--plots");
  refuse_option(!request.magnify.empty(), "--magnify");
}

void check_options_of_mechanism(const DrawRequest& request) {
  refuse_drawing(!request.symbols.empty(), "--symbols", request.file, "mechanism", "diagram");
  refuse_drawing(request.depth.has_value(), "--depth", request.file, "mechanism", "diagram");
  refuse_drawing(request.layout, "--layout", request.file, "mechanism", "diagram");
}

}  // namespace

ExitStatus draw_file(const Session& session, const DrawRequest& request) {
  if (!request.layout) {
    if (request.output.empty())
      throw text::ReadError(
          text::Diagnostic{{}, "--output is required", "-o PICTURE.svg or PICTURE.png, or --layout", {}});
    check_picture_output(request.output);
  }
  const draw::Theme theme = theme_option(request.theme);
  const std::string text = text::read_file(request.file);  // once: it may be a pipe
  const bool is_diagram = report::kind_of_file(text, request.file) == report::FileKind::diagram;
  if (is_diagram) {
    check_options_of_diagram(request);
    return draw_diagram_file(session, request, text);
  }
  check_options_of_mechanism(request);
  save_picture(mechanism_picture(session, mechanism::parse_mechanism(text, request.file), request),
               request.output, theme);
  return ExitStatus::done;
}

}  // namespace oblique::cli
