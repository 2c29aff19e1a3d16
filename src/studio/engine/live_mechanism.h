// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <oblique/draw/linkage/live_linkage.h>
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/synthesis/path_curve.h>

#include "studio/engine/answer.h"
#include "studio/engine/live_console.h"

namespace oblique::studio {

/// A mechanism that a page shows and lets be dragged. As the functions of Engine its own throw nothing;
/// before `open` has succeeded they refuse. Places are in pixels of its picture.
class LiveMechanism {
 public:
  /// The engine must outlive it.
  explicit LiveMechanism(const Engine& engine) : engine_(engine) {}

  /// A mechanism in place of the one before, as it is patched (swung within its range where it cannot turn):
  /// {"title", "unit", "size", "span" [s], "closed", "drive": {"name", "slide"} (the first; null without),
  /// "points": [{"name", "fixed"}], "width", "height", "svg"}, of which the last is what stands still.
  Answer open(const std::string& text, const std::string& name);

  /// The exact mechanism at a moment [s]: {"time", "drive", "status", "svg"}, elements to be laid over the
  /// picture; and as numbers x and y of every point [px], NaN where it cannot be assembled.
  Answer at(double time);

  /// The same for as long as a machine that is held has been in operation, and over it the mechanism as that
  /// machine has it, its error so many times as large: also {"analog": whether the machine has these points,
  /// "away": the largest error, "worst": its point, "suggested": a magnification that shows it well}.
  Answer follow(LiveConsole& console, double magnification);

  /// The moment of the motion at which a point is nearest to (x, y), on the way from `time` unless another
  /// one is much nearer: {"time", "drive", "distance" [length unit]}.
  Answer nearest(const std::string& point, double x, double y, double time);

  /// Other lengths, with which a point comes to (x, y) (synthesis::drag): {"text", "changed": [{"name",
  /// "before", "after"}], "drive", "sketch_moved", "svg": elements of the mechanism that this makes}.
  Answer drag(const std::string& point, double x, double y, double time);

  /// When the first drive stands at a value first: {"time"}, null where it never does.
  Answer time_of(double drive);

  /// What the mechanism meets, in the order of time: {"events": [{"kind", "what", "group", "time": null
  /// where the motion does not come there, "drive"}], "from", "to": least and greatest value of the drive}.
  Answer events();

 private:
  struct Held {
    mechanism::Mechanism file;   ///< as it is written
    mechanism::Mechanism moved;  ///< as it is patched
    mechanism::Structure structure;
    mechanism::Motion motion;  ///< some rows over `span`
    double span = 0;           ///< [s]
    bool closed = false;       ///< it ends as it begins, and goes on so
    std::optional<draw::LiveLinkage> linkage;
    std::optional<mechanism::Follower> follower;
    std::optional<synthesis::PathCurve> path;  ///< of `path_of`
    std::size_t path_of = 0;
  };

  Held& held();
  std::size_t point_named(const std::string& name);
  double within_span(double time);
  const mechanism::Configuration& go(double time);
  double drive_value();
  Answer shown(double time, const std::vector<Eigen::Vector2d>& analog, double magnification);
  mechanism::Motion around(double time);

  const Engine& engine_;
  std::string text_;
  std::unique_ptr<Held> held_;
};

}  // namespace oblique::studio
