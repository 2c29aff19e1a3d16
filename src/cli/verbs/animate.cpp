// SPDX-License-Identifier: MIT
#include <array>
#include <filesystem>

#include <fmt/format.h>

#include <oblique/draw/animation/animation.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>

#include <oblique/draw/animation/animated_page.h>
#include <oblique/report/drive_caption.h>
#include <oblique/report/linkage_scene.h>
#include <oblique/report/magnified.h>
#include "terminal/gif_output.h"
#include "terminal/output_files.h"
#include "terminal/picture_output.h"
#include "terminal/terminal.h"
#include "verbs/animation_timing.h"
#include "verbs/command.h"
#include "verbs/patch_choice.h"

namespace oblique::cli {

ExitStatus animate_mechanism(const Session& session, const AnimateRequest& request) {
  constexpr std::array<std::string_view, 3> kEndings{".svg", ".html", ".gif"};
  check_output(request.output, kEndings);
  const std::string ending = std::filesystem::path(request.output).extension().string();
  const bool gif = ending == ".gif";
  const AnimationTiming timing = timing_of(request, gif);
  const draw::Theme theme = theme_option(request.theme);
  const std::optional<double> magnification = magnify_option(request.magnify);
  if (gif) require_converter(request.output);
  mechanism::Mechanism mechanism = mechanism::read_mechanism(request.mechanism);
  if (mechanism.drives.empty()) mechanism::period(mechanism);  // says that there is no drive
  if (magnification) mechanism = patch::within_range(mechanism);
  const std::vector<std::size_t> traces = report::traced_points(mechanism, request.trace);
  const report::TimedScene timed = report::linkage_scene(mechanism, 0, 1);
  const report::DrawnMotion round = report::drawn_round(mechanism, timing.frames);

  draw::LinkageAnimation animation;
  animation.duration = timing.duration;
  animation.width = request.size.value_or(0);
  animation.scene = timed.scene;
  animation.scene.traces = traces;
  animation.scene.caption.clear();
  animation.frames = round.rows;
  for (const double time : round.times) animation.captions.push_back(report::drive_caption(mechanism, time));
  if (magnification) {
    const report::MagnifiedAnalog analog = [&] {
      Progress progress("running the patch");
      return report::MagnifiedAnalog(mechanism, session.blocks(), patch_options(request.patch),
                                     *magnification, timed, round.times,
                                     [&](double fraction) { progress.show(fraction); });
    }();
    animation.scene.analog = analog.overlay(timed);
    for (std::size_t k = 0; k < round.times.size(); ++k)
      animation.analog_frames.push_back(analog.points(round.times[k], round.rows[k]));
    note(analog.remark(command_line()));
  }

  if (!gif) {
    save(request.output,
         (ending == ".html" ? draw::animated_page : draw::animated_svg)(mechanism, animation, theme));
    return ExitStatus::done;
  }
  save(request.output, gif_of(mechanism, animation, theme, timing.delay, request.output));
  const int frames = static_cast<int>(animation.frames.size()) - 1;
  if (!keeps_pace(request, frames, timing.delay)) {
    note(fmt::format("note: a GIF shows a frame for whole hundredths of a second: {} frames, {}\n", frames,
                     pace_text(frames, timing.delay)));
  }
  return ExitStatus::done;
}

}  // namespace oblique::cli
