// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <oblique/text/diagnostic.h>
#include <oblique/text/expression.h>

namespace oblique::mechanism {

/// Thrown by the `mechanism` stage; `kind` says which question went wrong.
class MechanismError : public text::Error {
 public:
  enum class Kind {
    file,        ///< the file contradicts itself or the format
    request,     ///< the caller asks for something that has no answer (no drive, one position …)
    mobility,    ///< degrees of freedom and drives do not match
    constraint,  ///< pairs repeat or contradict each other
    sketch,      ///< the sketch does not pick an assembly mode
    assembly,    ///< the links do not reach each other at the start position
  };

  explicit MechanismError(std::vector<text::Diagnostic> diagnostics)
      : MechanismError(Kind::file, std::move(diagnostics)) {}
  MechanismError(Kind kind, std::vector<text::Diagnostic> diagnostics)
      : text::Error(std::move(diagnostics)), kind_(kind) {}
  MechanismError(Kind kind, text::Diagnostic diagnostic) : text::Error(std::move(diagnostic)), kind_(kind) {}

  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// A named point: fixed in the frame, or carried by the bodies that name it (pinned there if several do).
struct Point {
  std::string name;
  bool fixed = false;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [length unit], of a fixed point only
};

/// A point of a body in the body's own frame: origin in its first point, x axis from the first to the second.
struct BodyPoint {
  std::size_t point = 0;                            ///< index in Mechanism::points
  Eigen::Vector2d local = Eigen::Vector2d::Zero();  ///< [length unit]
};

/// A rigid body: its two or three named points, then its marks, in the order of the file.
struct Body {
  std::string name;
  std::vector<BodyPoint> points;
  text::Place place;
  double mass = 0;   ///< [kg]; 0: not given
  double width = 0;  ///< across the bar [length unit]; for its moment of inertia

  /// The body's point with this index in Mechanism::points, or nothing.
  const BodyPoint* find(std::size_t point) const;
};

/// A point that stays on a line of the frame or of a body: one pair, of which the point's body may turn (a
/// pin in a slot), or may not (`angle`: a full prismatic pair).
///
///            point ·
///     - - - - - - - - - - - - -   the line, shifted by `offset` to the left of first → second
///     first ·────────→· second    of `carrier`
struct Slide {
  std::string name;
  std::size_t point = 0;              ///< that slides; index in Mechanism::points
  std::size_t first = 0, second = 0;  ///< the points that name the line; indices in Mechanism::points
  std::optional<std::size_t>
      carrier;                    ///< body that carries the line, index in Mechanism::bodies; none: the frame
  double offset = 0;              ///< of the line to the left of first → second [length unit]
  std::optional<std::size_t> of;  ///< body that keeps `angle` to the line; none: a pin in a slot
  double angle = 0;               ///< from first → second to the first → second point of `of` [rad]
  text::Place place;
};

/// Turns a body, whose angle of first → second point from +x is then given; or moves a prismatic joint, whose
/// distance from the first point of its line is. The given value is start + ∫ speed dt.
struct Drive {
  std::string name;
  std::size_t body = 0;   ///< index in Mechanism::bodies; unused with `slide`
  std::size_t about = 0;  ///< index in Mechanism::points, a point of the body; unused with `slide`
  /// [rad/s] or [length unit/s]; with a law: at the start, or from rest its unit, in the way it sets off.
  double speed = 0;
  double start = 0;  ///< [rad] or [length unit]
  text::Place place;
  std::optional<std::size_t> slide = {};     ///< index in Mechanism::slides
  std::optional<text::Expression> law = {};  ///< speed as an expression of `time`, in units of `law_scale`
  double law_scale = 1;                      ///< [rad/s] or [length unit/s]
};

/// A rough position of a point at the start; picks assembly modes and nothing else.
struct SketchPoint {
  std::size_t point = 0;                               ///< index in Mechanism::points
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [length unit]
};

/// What a mechanism is known to do: a column of its motion at a moment, or its extreme over a turn.
struct MechanismExpectation {
  enum class Kind { at_time, at_value, maximum, minimum };
  std::string text;    ///< the key as written, "P.x at 90 deg"
  std::string column;  ///< as `motion_columns` names it
  Kind kind = Kind::at_time;
  double at = 0;  ///< [s]; `at_value`: of the first drive [rad] or [length unit], the first time it is there
  double value = 0;
  double within = 0;
  text::Place place;
};

/// What happens where a mechanism can go no further.
enum class AtLimit {
  open,     ///< the drives go on; rows beyond have no numbers
  stop,     ///< the motion ends
  reverse,  ///< the drives run backwards from there, up to the other limit
};

/// "open", "stop", "reverse"; nothing for other texts.
std::optional<AtLimit> parse_at_limit(std::string_view text);

/// How long a motion lasts unless the request says otherwise.
struct MotionSettings {
  std::optional<double> until;  ///< [s]; none: a turn of the first drive
  std::optional<AtLimit> at_limit;
};

/// A plane mechanism as its file has it (oblique-mechanism/1). Lengths and coordinates are in `length_unit`.
struct Mechanism {
  std::string file;
  std::string title;
  std::string source;
  std::string length_unit = "m";
  std::vector<Point> points;  ///< those of the frame first, then in the order in which the bodies name them
  std::vector<Body> bodies;
  std::vector<Slide> slides;
  std::vector<Drive> drives;
  std::vector<SketchPoint> sketch;
  MotionSettings motion;
  std::vector<MechanismExpectation> expectations;

  /// Indices by name, or nothing.
  std::optional<std::size_t> find_point(std::string_view name) const;
  std::optional<std::size_t> find_body(std::string_view name) const;
  std::optional<std::size_t> find_slide(std::string_view name) const;

  /// The drive that turns a body, or nothing.
  std::optional<std::size_t> drive_of(std::size_t body) const;
  /// The bodies that name a point, in file order; the frame is not counted.
  std::vector<std::size_t> bodies_at(std::size_t point) const;

  /// Largest distance between two points of one body [length unit]; 0 without bodies.
  double largest_length() const;
};

/// The names of points, bodies, slides … in their order, for `suggest`.
template <class Items>
std::vector<std::string> names_of(const Items& items) {
  std::vector<std::string> names;
  names.reserve(items.size());
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

/// Distance between two points of one body [length unit]; both must be points of it.
double distance(const Body& body, std::size_t first, std::size_t second);

}  // namespace oblique::mechanism
