// SPDX-License-Identifier: MIT
// The verbs that make pictures.
#include "verbs/verbs.h"

namespace oblique::cli {
namespace {

template <class Request>
void add_looks(CLI::App* verb, Request& request) {
  verb->add_option("--trace", request.trace,
                   "points whose paths are drawn, or none (default: the points of couplers)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("POINT,...");
  verb->add_option("--theme", request.theme, "auto: light or dark as the reader's screen")
      ->capture_default_str()
      ->type_name("auto|light|dark");
}

/// --magnify, and how the patch is made that it is about.
template <class Request>
void add_magnify(CLI::App* verb, Request& request) {
  CLI::Option* const magnify =
      verb->add_option("--magnify", request.magnify,
                       "patch the mechanism, run it, and draw it over the exact one with its errors N times "
                       "as large")
          ->type_name("N");
  add_patch_choice(verb, request.patch, magnify);
}

}  // namespace

void add_draw(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<DrawRequest>();
  CLI::App* const verb =
      app.add_subcommand("draw", "Draw a mechanism, the six plots of one of its points, or a block diagram");
  verb->add_option("FILE", request->file, "mechanism or diagram (oblique-mechanism/1, oblique-diagram/1)")
      ->required();
  CLI::Option* const output =
      verb->add_option("-o,--output", request->output, "write to PICTURE.svg or PICTURE.png")
          ->type_name("PICTURE");
  CLI::Option* const at =
      verb->add_option("--at", request->at,
                       "where the first drive stands, for example \"80 deg\" (default: its start)")
          ->type_name("VALUE");
  CLI::Option* const positions =
      verb->add_option("--positions", request->positions, "positions over the motion, one over the other")
          ->capture_default_str()
          ->check(whole_number(1, 1000));
  add_looks(verb, *request);
  add_magnify(verb, *request);
  verb->add_option("--plots", request->plots,
                   "instead of the mechanism, the path, coordinates, velocity and acceleration of a point")
      ->type_name("POINT")
      ->excludes(at)
      ->excludes(positions)
      ->excludes(verb->get_option("--trace"))
      ->excludes(verb->get_option("--magnify"));
  verb->add_option("--symbols", request->symbols,
                   "of a diagram: classic, triangles and circles (default), or din, boxes")
      ->type_name("classic|din");
  CLI::Option* const depth =
      verb->add_option("--depth", request->depth,
                       "of a diagram: levels of composite blocks that are shown open (default 0)")
          ->type_name("N")
          ->check(whole_number(0, 100));
  verb->add_flag(
          "--layout", request->layout,
          "of a diagram: print where its blocks stand, as the [layout] of its file, in place of a picture")
      ->excludes(output)
      ->excludes(depth)
      ->excludes(verb->get_option("--theme"));
  choose(verb, chosen, request, draw_file);
}

void add_animate(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<AnimateRequest>();
  CLI::App* const verb =
      app.add_subcommand("animate", "Animate a mechanism over its motion, again and again");
  verb->add_option("MECHANISM", request->mechanism, "mechanism file (oblique-mechanism/1)")->required();
  verb->add_option("-o,--output", request->output,
                   "write to FILE.svg, which moves by itself, FILE.html with play, pause and slider, or "
                   "FILE.gif")
      ->required()
      ->type_name("FILE");
  verb->add_option("--frames", request->frames,
                   "positions computed for a round (default 90, of a GIF what duration and rate make)")
      ->check(whole_number(kLeastFrames, kMostFrames))
      ->type_name("N");
  verb->add_option("--duration", request->duration, "how long a round lasts on the screen (default 4 s)")
      ->type_name("T");
  verb->add_option("--rate", request->rate,
                   "of a GIF: frames a second, the next of 50, 33.3, 25, 20 … (default 25, or --frames in "
                   "--duration)")
      ->type_name("R");
  verb->add_option("--size", request->size, "width on the screen in pixels (default 760)")
      ->check(whole_number(100, 4000))
      ->type_name("W");
  add_magnify(verb, *request);
  add_looks(verb, *request);
  choose(verb, chosen, request, animate_mechanism);
}

void add_studio(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<StudioRequest>();
  CLI::App* const verb = app.add_subcommand(
      "studio", "Write the studio, a page with the whole machine in it, and open it in a browser");
  verb->add_option("FILE", request->file,
                   "diagram or mechanism that the page opens with, put inside with the files it names "
                   "(default: a class III mechanism)");
  verb->add_option("-o,--output", request->output,
                   "write to PAGE.html (default: into the user's cache, by the name of FILE)")
      ->type_name("PAGE");
  verb->add_flag("--stay", request->stay, "open no browser");
  choose(verb, chosen, request, write_studio);
}

}  // namespace oblique::cli
