// SPDX-License-Identifier: MIT
#include "binding.h"

#include <oblique/diagram/machine_profile.h>
#include <oblique/draw/animation/animated_page.h>
#include <oblique/draw/animation/animation.h>
#include <oblique/draw/chart/point_plots.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/report/drive_caption.h>
#include <oblique/report/linkage_scene.h>
#include <oblique/report/magnified.h>
#include <oblique/report/mechanism_report.h>

namespace oblique::python {
namespace {

/// A picture and a remark about its magnified errors; `patch` is None where no patch is drawn over it.
py::tuple drawn(const MechanismModel& model, const Library& library, std::optional<double> at, int positions,
                const std::vector<std::string>& trace, std::optional<double> magnify, const py::object& patch,
                const std::string& theme) {
  const double time = at.value_or(0);
  const patch::PatchOptions options =
      patch.is_none() ? patch::PatchOptions{} : patch_options(patch.cast<py::dict>());
  const draw::Theme colours = theme_of(theme);
  std::string remark;
  const std::string svg = unlocked([&](SignalWatch& watch) {
    const mechanism::Mechanism mechanism = magnify ? patch::within_range(model.mechanism) : model.mechanism;
    const std::vector<std::size_t> traces = report::traced_points(mechanism, trace);
    report::TimedScene timed = report::linkage_scene(mechanism, time, positions);
    if (!timed.scene.motion.empty()) timed.scene.traces = traces;
    if (magnify) {
      const report::MagnifiedAnalog analog(mechanism, *library, options, *magnify, timed, {},
                                           watch.progress());
      timed.scene.analog = analog.overlay(timed);
      remark = analog.remark(python_words());
    }
    return draw::to_svg(draw::draw_linkage(mechanism, timed.scene), colours);
  });
  return py::make_tuple(to_str(svg), to_str(remark));
}

py::str plotted(const MechanismModel& model, const std::string& point, const std::string& theme) {
  const draw::Theme colours = theme_of(theme);
  return to_str(unlocked([&](SignalWatch&) {
    return draw::to_svg(draw::draw_chart(draw::point_plots(report::point_history(model.mechanism, point))),
                        colours);
  }));
}

/// The animation as an SVG and as a page, and a remark about its magnified errors.
py::tuple animated(const MechanismModel& model, const Library& library, int frames, double duration,
                   int width, const std::vector<std::string>& trace, std::optional<double> magnify,
                   const py::object& patch, const std::string& theme) {
  const patch::PatchOptions options =
      patch.is_none() ? patch::PatchOptions{} : patch_options(patch.cast<py::dict>());
  const draw::Theme colours = theme_of(theme);
  std::string svg, page, remark;
  unlocked([&](SignalWatch& watch) {
    if (model.mechanism.drives.empty()) mechanism::period(model.mechanism);  // says that there is no drive
    const mechanism::Mechanism mechanism = magnify ? patch::within_range(model.mechanism) : model.mechanism;
    const std::vector<std::size_t> traces = report::traced_points(mechanism, trace);
    const report::TimedScene timed = report::linkage_scene(mechanism, 0, 1);
    const report::DrawnMotion round = report::drawn_round(mechanism, frames);
    draw::LinkageAnimation animation;
    animation.duration = duration;
    animation.width = width;
    animation.scene = timed.scene;
    animation.scene.traces = traces;
    animation.scene.caption.clear();
    animation.frames = round.rows;
    for (const double time : round.times)
      animation.captions.push_back(report::drive_caption(mechanism, time));
    if (magnify) {
      const report::MagnifiedAnalog analog(mechanism, *library, options, *magnify, timed, round.times,
                                           watch.progress());
      animation.scene.analog = analog.overlay(timed);
      for (std::size_t k = 0; k < round.times.size(); ++k)
        animation.analog_frames.push_back(analog.points(round.times[k], round.rows[k]));
      remark = analog.remark(python_words());
    }
    svg = draw::animated_svg(mechanism, animation, colours);
    page = draw::animated_page(mechanism, animation, colours);
    return 0;
  });
  return py::make_tuple(to_str(svg), to_str(page), to_str(remark));
}

py::str reported(const MechanismModel& model, const Library& library, const py::dict& asked,
                 const std::string& machine, const std::string& theme) {
  report::MechanismReport report{model.mechanism, *library, patch_options(asked),
                                 nullptr,         {},       python_words()};
  if (!machine.empty()) {
    report.machine = diagram::find_machine(machine);
    if (report.machine == nullptr) throw diagram::DiagramError(diagram::unknown_machine(machine));
  }
  const draw::Theme colours = theme_of(theme);
  return to_str(unlocked([&](SignalWatch& watch) {
    report.progress = watch.progress();
    return report.page().text(colours);
  }));
}

}  // namespace

void bind_pictures(py::class_<MechanismModel, std::shared_ptr<MechanismModel>>& model) {
  model.def("draw", &drawn).def("plots", &plotted).def("animate", &animated).def("report", &reported);
}

}  // namespace oblique::python
