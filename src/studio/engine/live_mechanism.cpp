// SPDX-License-Identifier: MIT
#include "studio/engine/live_mechanism.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/draw/picture/svg.h>
#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/patch/range.h>
#include <oblique/report/linkage_scene.h>
#include <oblique/synthesis/drag.h>

namespace oblique::studio {
namespace {

using Eigen::Vector2d;

std::string elements_of(const std::vector<draw::Mark>& marks) {
  std::string text;
  for (const draw::Mark& mark : marks) text += draw::svg_element(mark) + "\n";
  return text;
}

/// Whether a motion ends as it begins, and does so again.
bool repeats(const mechanism::Mechanism& file, const mechanism::Mechanism& moved,
             const mechanism::Motion& motion) {
  constexpr double kSame = 1e-6;  // of the size
  const bool has_law = std::any_of(file.drives.begin(), file.drives.end(),
                                   [](const mechanism::Drive& drive) { return drive.law.has_value(); });
  if (has_law || moved.drives.empty()) return false;
  const auto& first = motion.configurations.front().points;
  const auto& last = motion.configurations.back().points;
  return std::equal(first.begin(), first.end(), last.begin(), [&](const auto& a, const auto& b) {
    return (a.position - b.position).norm() <= kSame * moved.largest_length();
  });
}

/// "dead centre of BC-CD, where it can go no further".
std::string words_of(mechanism::MotionEvent::Kind kind, const std::string& group) {
  using Kind = mechanism::MotionEvent::Kind;
  switch (kind) {
    case Kind::limit:
      return fmt::format("dead centre of {}, where it can go no further", group);
    case Kind::return_:
      return fmt::format("{} can be assembled again", group);
    case Kind::change:
      return fmt::format("change point of {}: two assembly modes cross", group);
    case Kind::infinity:
      return fmt::format("{} goes to infinity", group);
    case Kind::lost:
      break;
  }
  return fmt::format("no step leads {} on", group);
}

[[noreturn]] void refuse_question(std::string what, std::string expected, text::Remedy remedy = {}) {
  throw text::ReadError(text::Diagnostic{{}, std::move(what), std::move(expected), std::move(remedy)});
}

}  // namespace

LiveMechanism::Held& LiveMechanism::held() {
  if (held_) return *held_;
  refuse_question("no mechanism is held", "a mechanism", "open one");
}

std::size_t LiveMechanism::point_named(const std::string& name) {
  const mechanism::Mechanism& mechanism = held().moved;
  if (const auto point = mechanism.find_point(name)) return *point;
  refuse_question(fmt::format("there is no point '{}'", name), {},
                  text::suggest(name, mechanism::names_of(mechanism.points)));
}

Answer LiveMechanism::open(const std::string& text, const std::string& name) {
  return answer([&] {
    engine_.check_size(text, name);
    auto made = std::make_unique<Held>();
    made->file = mechanism::parse_mechanism(text, name);
    made->moved = made->file.drives.empty() ? made->file : patch::within_range(made->file);
    made->structure = mechanism::decompose(made->moved);
    report::TimedScene timed = report::linkage_scene(made->moved, 0, 1);
    draw::LinkageScene& scene = timed.scene;
    scene.caption.clear();  // it would stand still
    scene.analog = draw::AnalogOverlay{{}, {}, "analog, its error magnified", {}};
    scene.traces = report::traced_points(made->moved, {});
    if (scene.motion.empty()) scene.traces.clear();
    made->linkage.emplace(made->moved, scene);
    if (!timed.times.empty()) {
      made->motion.times = std::move(timed.times);
      made->motion.configurations = std::move(scene.motion);
      made->span = made->motion.times.back();
      made->closed = repeats(made->file, made->moved, made->motion);
    }
    const draw::Picture background = made->linkage->background();
    Answer opened;
    Json& json = opened.object;
    json["title"] = made->file.title;
    json["unit"] = made->file.length_unit;
    json["size"] = made->file.largest_length();
    json["span"] = made->span;
    json["closed"] = made->closed;
    json["drive"] = nullptr;
    if (!made->file.drives.empty()) {
      const mechanism::Drive& drive = made->file.drives.front();
      json["drive"] = {{"name", drive.name}, {"slide", drive.slide.has_value()}};
    }
    json["points"] = Json::array();
    for (const mechanism::Point& point : made->file.points)
      json["points"].push_back({{"name", point.name}, {"fixed", point.fixed}});
    json["width"] = background.width;
    json["height"] = background.height;
    json["svg"] = draw::to_svg(background);
    text_ = text;
    held_ = std::move(made);
    return opened;
  });
}

double LiveMechanism::within_span(double time) {
  const Held& now = held();
  if (!now.closed || !(now.span > 0)) return time;
  const double within = std::fmod(time, now.span);
  return within < 0 ? within + now.span : within;
}

/// Where the mechanism stands; round after round of a closed motion it is the same one.
const mechanism::Configuration& LiveMechanism::go(double time) {
  Held& now = held();
  const double wanted = within_span(time);
  if (!std::isfinite(wanted)) refuse_question(fmt::format("the time is {} s", wanted), "a finite time");
  mechanism::check_travel(now.moved, wanted);
  // from the start it is nearer than all the way back
  if (!now.follower || wanted < now.follower->time() / 2) now.follower.emplace(now.moved, now.structure);
  return now.follower->advance(wanted);
}

double LiveMechanism::drive_value() {
  const Held& now = held();
  return now.follower->drives().empty() ? 0 : now.follower->drives().front().value;
}

Answer LiveMechanism::shown(double time, const std::vector<Vector2d>& analog, double magnification) {
  const mechanism::Configuration& here = go(time);
  const Held& now = held();
  const bool stands = here.status != mechanism::Status::open;
  Answer seen;
  Json& json = seen.object;
  json["time"] = time;
  json["drive"] = drive_value();
  json["status"] = mechanism::status_name(here.status);
  std::string svg = stands ? elements_of(now.linkage->exact(here)) : "";
  for (const mechanism::PointState& point : here.points) {
    const Vector2d at = stands ? now.linkage->pixel(point.position) : Vector2d::Constant(std::nan(""));
    seen.numbers.insert(seen.numbers.end(), {at.x(), at.y()});
  }
  if (analog.empty()) {
    json["svg"] = std::move(svg);
    return seen;
  }
  std::vector<Vector2d> places = analog;
  double error = 0;
  std::size_t worst = 0;
  for (std::size_t p = 0; stands && p < places.size(); ++p) {
    const Vector2d exact = here.points[p].position, away = places[p] - exact;
    if (away.norm() > error) {
      error = away.norm();
      worst = p;
    }
    places[p] = exact + magnification * away;
  }
  svg += elements_of(now.linkage->analog(places));
  json["svg"] = std::move(svg);
  if (!stands) return seen;
  constexpr double kGood = 0.05;  // of the size
  json["away"] = error;
  json["worst"] = now.moved.points[worst].name;
  if (error > 0)
    json["suggested"] = std::pow(10, std::floor(std::log10(kGood * now.moved.largest_length() / error)));
  return seen;
}

Answer LiveMechanism::at(double time) {
  return answer([&] { return shown(time, {}, 1); });
}

Answer LiveMechanism::follow(LiveConsole& console, double magnification) {
  return answer([&] {
    if (!(magnification > 0 && std::isfinite(magnification)))
      refuse_question(fmt::format("the magnification is {}", magnification), "a finite number above 0");
    const Held& now = held();
    std::vector<std::string> names;
    names.reserve(2 * now.moved.points.size());
    for (const mechanism::Point& point : now.moved.points) {
      if (point.fixed) continue;
      names.push_back(point.name + ".x");
      names.push_back(point.name + ".y");
    }
    const std::optional<std::vector<double>> values = console.outputs(names);
    std::vector<Vector2d> places;
    places.reserve(now.moved.points.size());
    if (values) {
      std::size_t k = 0;
      for (const mechanism::Point& point : now.moved.points) {
        places.emplace_back(point.position);
        if (point.fixed) continue;
        places.back() = {(*values)[k], (*values)[k + 1]};
        k += 2;
      }
    }
    Answer followed = shown(console.time_of_operation(), places, magnification);
    followed.object["analog"] = values.has_value();
    return followed;
  });
}

/// A sixth of the motion to either side of a moment, on a clock that goes on beyond a round.
mechanism::Motion LiveMechanism::around(double time) {
  const mechanism::Motion& whole = held().motion;
  const double reach = held().span / 6;
  mechanism::Motion part;
  for (const int round : {-1, 0, 1}) {
    if (round != 0 && !held().closed) continue;
    for (std::size_t k = 0; k < whole.times.size(); ++k) {
      const double at = whole.times[k] + round * held().span;
      if (std::abs(at - time) > reach || (!part.times.empty() && at <= part.times.back())) continue;
      part.times.push_back(at);
      part.configurations.push_back(whole.configurations[k]);
    }
  }
  return part;
}

Answer LiveMechanism::nearest(const std::string& point, double x, double y, double time) {
  return answer([&] {
    constexpr double kMuchNearer = 0.05;  // of the size
    Held& now = held();
    const std::size_t p = point_named(point);
    if (now.motion.times.empty()) refuse_question("the mechanism has no drive that could follow", "a drive");
    if (!now.path || now.path_of != p) now.path.emplace(now.motion, p);
    now.path_of = p;
    const Vector2d target = now.linkage->place({x, y});
    const double from = within_span(time);
    const auto anywhere = now.path->nearest(target);
    const auto beside = synthesis::PathCurve(around(from), p).nearest(target);
    if (!anywhere && !beside)
      refuse_question(fmt::format("'{}' has no path", point), "a mechanism that moves");
    const bool leaps =
        !beside || (anywhere && anywhere->difference.norm() <
                                    beside->difference.norm() - kMuchNearer * now.moved.largest_length());
    const synthesis::PathCurve::Foot& foot = leaps ? *anywhere : *beside;
    Answer found;
    found.object["time"] = within_span(foot.time);
    go(foot.time);
    found.object["drive"] = drive_value();
    found.object["distance"] = foot.difference.norm();
    return found;
  });
}

Answer LiveMechanism::drag(const std::string& point, double x, double y, double time) {
  return answer([&] {
    const std::size_t p = point_named(point);
    const mechanism::Configuration here = go(time);
    if (here.status == mechanism::Status::open)
      refuse_question(fmt::format("'{}' stands nowhere: the mechanism is open", point),
                      "a mechanism that is assembled");
    const Held& now = held();
    const synthesis::DraggedMechanism dragged =
        synthesis::drag(text_, now.file, {p, now.linkage->place({x, y}), drive_value(), here});
    Answer made;
    Json& json = made.object;
    json["text"] = dragged.text;
    json["changed"] = Json::array();
    for (const synthesis::ChangedNumber& number : dragged.numbers)
      json["changed"].push_back({{"name", number.name}, {"before", number.before}, {"after", number.after}});
    json["drive"] = dragged.drive;
    json["sketch_moved"] = dragged.sketch_moved;
    std::vector<Vector2d> places;
    places.reserve(dragged.there.points.size());
    for (const mechanism::PointState& state : dragged.there.points) places.push_back(state.position);
    json["svg"] = elements_of(now.linkage->analog(places));
    return made;
  });
}

Answer LiveMechanism::time_of(double drive) {
  return answer([&] {
    const mechanism::Mechanism& moved = held().moved;
    if (moved.drives.empty()) refuse_question("the mechanism has no drive", "a drive");
    // of a drive that turns on and on the same angle within its first turn
    const mechanism::Drive& first = moved.drives.front();
    double value = drive;
    if (!first.slide && !first.law) value = first.start + std::fmod(drive - first.start, mechanism::kTurn);
    const auto time = mechanism::time_at_value(moved, value);
    Answer found;
    found.object["time"] = time ? Json(*time) : Json();
    return found;
  });
}

Answer LiveMechanism::events() {
  return answer([&] {
    const Held& now = held();
    Answer met;
    Json& json = met.object;
    json["events"] = Json::array();
    if (now.moved.drives.empty()) return met;
    mechanism::DriveClock clock(now.moved), file_clock(now.file);
    mechanism::MotionOptions options;
    options.positions = 2;
    options.until = now.span;
    options.at_limit = mechanism::AtLimit::open;
    const auto add = [&](const mechanism::MotionEvent& event, bool reached, double drive) {
      const std::string& group = now.structure.groups[event.group].name;
      json["events"].push_back({{"kind", event_name(event.kind)},
                                {"what", words_of(event.kind, group)},
                                {"group", group},
                                {"time", reached ? Json(event.time) : Json()},
                                {"drive", drive}});
    };
    const std::vector<mechanism::MotionEvent> reached =
        mechanism::visit_motion(now.moved, now.structure, options, [](const mechanism::MotionRow&) {});
    for (const mechanism::MotionEvent& event : reached) add(event, true, clock.at(0, event.time).value);
    // what lies beyond the way that is patched
    const mechanism::MotionLimits limits = mechanism::find_range(now.file, now.structure);
    for (const auto& limit : {limits.backward, limits.forward}) {
      if (!limit) continue;
      const double drive = file_clock.at(0, limit->time).value;
      const bool known =
          std::any_of(reached.begin(), reached.end(), [&](const mechanism::MotionEvent& event) {
            return event.group == limit->group && std::abs(clock.at(0, event.time).value - drive) < 1e-6;
          });
      if (!known) add(*limit, false, drive);
    }
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double time : now.motion.times) {
      const double value = clock.at(0, time).value;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    json["from"] = low;
    json["to"] = high;
    return met;
  });
}

}  // namespace oblique::studio
