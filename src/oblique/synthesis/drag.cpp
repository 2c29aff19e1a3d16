// SPDX-License-Identifier: MIT
#include <oblique/synthesis/drag.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/synthesis/design_space.h>
#include <oblique/synthesis/fitted_text.h>
#include <oblique/synthesis/path_problem.h>
#include <oblique/synthesis/synthesis_error.h>
#include <oblique/text/document.h>

namespace oblique::synthesis {
namespace {

using Eigen::Vector2d;

using mechanism::kTurn;

class Dragging {
 public:
  Dragging(const text::Document& document, const mechanism::Mechanism& mechanism, const DraggedPoint& dragged)
      : document_(document),
        mechanism_(mechanism),
        point_(dragged.point),
        to_(dragged.to),
        drive_(dragged.drive) {
    places_.reserve(mechanism.points.size());
    for (const mechanism::PointState& point : dragged.here.points) places_.push_back(point.position);
  }

  /// Finds the dimensions and where the point and the drive come to stand.
  void measure() {
    const mechanism::Point& dragged = mechanism_.points[point_];
    if (dragged.fixed) {
      add(dragged.name + ".x", dragged.position.x(), to_.x());
      add(dragged.name + ".y", dragged.position.y(), to_.y());
    } else {
      stay_on_lines();
    }
    const std::vector<Vector2d> before = places_;
    places_[point_] = to_;
    const std::vector<std::size_t> bodies = mechanism_.bodies_at(point_);
    for (const std::size_t b : bodies) {
      const auto drive = mechanism_.drive_of(b);
      if (drive && mechanism_.drives[*drive].about != point_)
        return measure_crank(mechanism_.bodies[b], *drive, before);
    }
    for (const std::size_t b : bodies) {
      if (!mechanism_.drive_of(b)) measure_body(mechanism_.bodies[b]);
    }
  }

  const std::vector<ChangedNumber>& numbers() const { return numbers_; }
  const Vector2d& to() const { return to_; }
  double drive() const { return drive_; }
  const std::vector<Vector2d>& places() const { return places_; }

  [[noreturn]] void refuse(std::string what, std::string remedy) const {
    throw SynthesisError(SynthesisError::Kind::request,
                         text::Diagnostic{{mechanism_.file, {}}, std::move(what), {}, std::move(remedy)});
  }

 private:
  const std::string& name() const { return mechanism_.points[point_].name; }

  /// Puts `to` on the lines that the point may not leave.
  void stay_on_lines() {
    for (std::size_t s = 0; s < mechanism_.slides.size(); ++s) {
      const mechanism::Slide& slide = mechanism_.slides[s];
      if (slide.of && mechanism_.bodies[*slide.of].find(point_) != nullptr) {
        refuse(fmt::format("'{}' cannot be dragged: body '{}' keeps an angle to the line of '{}'", name(),
                           mechanism_.bodies[*slide.of].name, slide.name),
               "drag another point, or change the numbers of the file");
      }
      const bool of_line = slide.carrier && (slide.first == point_ || slide.second == point_);
      if (slide.point != point_ && !of_line) continue;
      const bool driven = std::any_of(mechanism_.drives.begin(), mechanism_.drives.end(),
                                      [&](const mechanism::Drive& drive) { return drive.slide == s; });
      if (driven) {
        refuse(
            fmt::format("'{}' cannot be dragged to another length: a drive moves it along its line", name()),
            "lock the lengths, and the drive follows");
      }
      const Vector2d first = places_[slide.first];
      const Vector2d along = (places_[slide.second] - first).normalized();
      // the point of a line may go along the line, the joint's point along its parallel
      const Vector2d on = of_line ? first : Vector2d(first + slide.offset * mechanism::left_normal(along));
      to_ = on + along.dot(to_ - on) * along;
    }
  }

  /// The body's dimensions with its points where they stand now.
  void measure_body(const mechanism::Body& body) {
    const std::size_t base = body.points[0].point, tip = body.points[1].point;
    const Vector2d way = places_[tip] - places_[base];
    const double length = way.norm();
    check_length(body, length);
    const Vector2d along = way / length;
    const bool turned = base == point_ || tip == point_;
    const bool triangle = has_sides(body);
    if (!triangle && turned) add(body.name, body.points[1].local.x(), length);
    for (std::size_t i = 2; i < body.points.size(); ++i) {
      const mechanism::BodyPoint& mark = body.points[i];
      if (!turned && mark.point != point_) continue;
      const Vector2d arm = places_[mark.point] - places_[base];
      const Vector2d local(along.dot(arm), mechanism::cross(along, arm));
      if (triangle && i == 2) {
        if (local.y() * mark.local.y() < 0 || local.y() == 0)
          refuse(fmt::format("'{}' cannot be dragged there: the triangle of body '{}' would turn over",
                             name(), body.name),
                 "change its 'turn' in the file first");
        const Vector2d far = mark.local - body.points[1].local;
        add(body.name + ".sides.1", body.points[1].local.x(), length);
        add(body.name + ".sides.2", far.norm(), (places_[mark.point] - places_[tip]).norm());
        add(body.name + ".sides.3", mark.local.norm(), arm.norm());
        continue;
      }
      const std::string& of = mechanism_.points[mark.point].name;
      add(fmt::format("{}.{}.x", body.name, of), mark.local.x(), local.x());
      add(fmt::format("{}.{}.y", body.name, of), mark.local.y(), local.y());
    }
  }

  /// A crank turns with its pin; what hangs on it follows with the lengths that it has.
  void measure_crank(const mechanism::Body& body, std::size_t drive, const std::vector<Vector2d>& before) {
    const std::size_t base = body.points[0].point, tip = body.points[1].point;
    if (base != point_ && tip != point_) return measure_body(body);
    const std::size_t about = mechanism_.drives[drive].about;
    if (has_sides(body) || (about != base && about != tip) || drive != 0) {
      refuse(fmt::format("'{}' cannot be dragged: what drives body '{}' would have to start elsewhere",
                         name(), body.name),
             "lock the lengths, or change the numbers of the file");
    }
    const double length = (to_ - places_[about]).norm();
    check_length(body, length);
    add(body.name, body.points[1].local.x(), length);
    const Vector2d old_way = before[tip] - before[base], way = places_[tip] - places_[base];
    drive_ += std::atan2(mechanism::cross(old_way, way), old_way.dot(way));
  }

  /// Whether the file gives it by three sides.
  bool has_sides(const mechanism::Body& body) const {
    return document_.root.find("bodies")->find(body.name)->find("sides") != nullptr;
  }

  void check_length(const mechanism::Body& body, double length) const {
    if (length > 1e-4 * mechanism_.largest_length()) return;
    refuse(fmt::format("'{}' cannot be dragged there: body '{}' would have no length", name(), body.name),
           "drag it elsewhere");
  }

  void add(std::string number, double old_value, double value) {
    const int digits = 4 - static_cast<int>(std::floor(std::log10(mechanism_.largest_length())));
    // by a power of ten that is a whole number, so that it is the number nearest to what is written
    const double power = std::pow(10, std::abs(digits));
    const double rounded = digits > 0 ? std::round(value * power) / power : std::round(value / power) * power;
    if (std::abs(rounded - old_value) * (digits > 0 ? power : 1 / power) < 0.5) return;
    numbers_.push_back({std::move(number), old_value, rounded});
  }

  const text::Document& document_;
  const mechanism::Mechanism& mechanism_;
  std::size_t point_;
  Vector2d to_;
  double drive_;
  std::vector<Vector2d> places_;
  std::vector<ChangedNumber> numbers_;
};

/// Where the moving points stand at the start once the dimensions have gone to `values`, in steps so short
/// that the nearest mode is the same one.
StartConfiguration walk(const DesignSpace& space, const Eigen::VectorXd& values) {
  constexpr double kStep = 0.05;  // of the largest length
  const Eigen::VectorXd from = space.values();
  const auto start = start_configuration_of(space.original());
  const double way = (values - from).cwiseAbs().maxCoeff() / space.original().largest_length();
  const int steps = std::clamp(static_cast<int>(std::ceil(way / kStep)), 1, 40);
  StartConfiguration here = start.value();  // it stands somewhere already
  for (int k = 1; k <= steps; ++k) {
    mechanism::Mechanism member = space.mechanism(from + (values - from) * k / steps);
    member.sketch = here;
    here = start_configuration_of(member).value_or(here);
  }
  return here;
}

/// When the first drive stands at a value; before 0 where it lies behind.
std::optional<double> time_of(const mechanism::Mechanism& mechanism, double value) {
  const mechanism::Drive& drive = mechanism.drives.front();
  if (drive.law) return mechanism::time_at_value(mechanism, value);
  double way = value - drive.start;
  if (!drive.slide && std::abs(way) > kTurn) way = std::fmod(way, kTurn);
  return way / drive.speed;
}

}  // namespace

DraggedMechanism drag(const std::string& text, const mechanism::Mechanism& mechanism,
                      const DraggedPoint& dragged) {
  const text::Document document = text::parse_document(text, mechanism.file);
  Dragging dragging(document, mechanism, dragged);
  dragging.measure();
  DraggedMechanism result{text, dragging.numbers(), dragging.drive(), dragging.to(), false, dragged.here};
  const double near = 1e-3 * mechanism.largest_length();
  if (result.numbers.empty()) {
    result.place = dragged.here.points[dragged.point].position;
    if ((result.place - dragging.to()).norm() > near) {
      dragging.refuse(fmt::format("'{}' cannot be dragged there: no length of the file moves it",
                                  mechanism.points[dragged.point].name),
                      "lock the lengths, and the drive follows");
    }
    return result;
  }
  std::vector<std::string> names;
  names.reserve(result.numbers.size());
  for (const ChangedNumber& number : result.numbers) names.push_back(number.name);
  const DesignSpace space(text, mechanism.file, names);
  Eigen::VectorXd values(std::ssize(names));
  for (Eigen::Index k = 0; k < values.size(); ++k)
    values[k] = result.numbers[static_cast<std::size_t>(k)].after;
  const StartConfiguration start = walk(space, values);
  FittedText fitted = fitted_text(space, values, start);
  result.text = std::move(fitted.text);
  result.sketch_moved = fitted.sketch_moved;
  if (mechanism.drives.empty()) return result;
  mechanism::Mechanism made = space.mechanism(values);
  made.sketch = start;
  const auto time = time_of(made, result.drive);
  if (time) {
    const mechanism::Configuration there =
        mechanism::solve_motion(made, std::vector<double>{*time}).configurations.front();
    const Vector2d& place = there.points[dragged.point].position;
    if (there.status != mechanism::Status::open && (place - result.place).norm() <= near) {
      result.place = place;
      result.there = there;
      return result;
    }
  }
  throw SynthesisError(
      SynthesisError::Kind::nowhere,
      text::Diagnostic{
          {mechanism.file, {}},
          fmt::format("'{}' cannot be dragged there: with these lengths the mechanism comes there in "
                      "another assembly mode, or not at all",
                      mechanism.points[dragged.point].name),
          {},
          "drag it less far"});
}

}  // namespace oblique::synthesis
