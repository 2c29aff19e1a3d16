// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <oblique/draw/animation.h>
#include <oblique/mechanism/motion.h>
#include <oblique/mechanism/read_mechanism.h>

#include "command.h"
#include "drive_place.h"
#include "linkage_scene.h"
#include "picture_output.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

/// The frames of a round: a closed motion once, another one to its end and back.
void add_frames(LinkageAnimation& animation, const Mechanism& mechanism, int frames) {
  const Structure structure = decompose(mechanism);
  DrawnMotion motion = drawn_motion(mechanism, structure, frames + 1);
  const bool closed = motion.closed;
  if (!closed) motion = drawn_motion(mechanism, structure, frames / 2 + 1);
  const auto add = [&](std::size_t k) {
    if (motion.rows[k].status == oblique::Status::open) return;
    animation.frames.push_back(motion.rows[k]);
    animation.captions.push_back(drive_caption(mechanism, motion.times[k]));
  };
  for (std::size_t k = 0; k < motion.rows.size(); ++k) add(k);
  if (closed) return;
  for (std::size_t k = motion.rows.size() - 1; k-- > 0;) add(k);
}

double duration_of(const AnimateRequest& request) {
  const double duration = quantity_option("--duration", request.duration, "s");
  if (duration > 0 && std::isfinite(duration)) return duration;
  throw ReadError(Diagnostic{{}, fmt::format("--duration {}", request.duration), "a time above 0", {}});
}

}  // namespace

ExitStatus animate_mechanism(const Session&, const AnimateRequest& request) {
  constexpr std::array<std::string_view, 2> kEndings{".svg", ".html"};
  check_output(request.output, kEndings);
  check_not_input(request.output, request.mechanism, "mechanism");
  const Theme theme = theme_option(request.theme);
  LinkageAnimation animation;
  animation.duration = duration_of(request);
  const Mechanism mechanism = read_mechanism(request.mechanism);
  if (mechanism.drives.empty()) period(mechanism);  // says that there is no drive
  const std::vector<std::size_t> traces = trace_option(mechanism, request.trace);
  animation.scene = linkage_scene(mechanism, "", 1);
  animation.scene.traces = traces;
  animation.scene.caption.clear();
  add_frames(animation, mechanism, request.frames);
  const bool page = std::filesystem::path(request.output).extension() == ".html";
  save(request.output, (page ? animated_page : animated_svg)(mechanism, animation, theme));
  return ExitStatus::done;
}

}  // namespace oblique::cli
