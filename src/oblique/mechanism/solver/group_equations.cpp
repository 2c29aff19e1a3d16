// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/group_equations.h>

#include <algorithm>
#include <cmath>

#include <oblique/mechanism/model/plane.h>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

bool has(const std::vector<std::size_t>& list, std::size_t item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

class Reduction {
 public:
  Reduction(const Mechanism& mechanism, const GroupMembers& members, const std::vector<bool>& known)
      : mechanism_(mechanism), members_(members), known_(known) {}

  GroupEquations run() {
    for (const std::size_t body : members_.bodies) {
      if (is_binary_link(body)) binary_links_.push_back(body);
    }
    find_blocks();
    for (const std::size_t body : members_.bodies) {
      if (!has(binary_links_, body) && !block_slide(body)) result_.platforms.push_back(body);
    }
    for (const std::size_t point : members_.points) {
      if (!known_[point] && !platform_with(point)) result_.free_points.push_back(point);
    }
    add_revolutes();
    for (const std::size_t link : binary_links_) add_binary_link(link);
    for (const auto& [body, slide] : block_slides_) add_block(body, mechanism_.slides[slide]);
    for (const std::size_t s : members_.slides) {
      if (!is_block_slide(s)) add_slide(mechanism_.slides[s]);
    }
    for (const std::size_t d : members_.drives) add_drive(d);
    return std::move(result_);
  }

 private:
  /// The points of a link by which it hangs together with the rest: known ones, and unknowns of the group.
  std::vector<std::size_t> active_points(std::size_t body) const {
    std::vector<std::size_t> active;
    for (const BodyPoint& p : mechanism_.bodies[body].points) {
      if (known_[p.point] || has(members_.points, p.point)) active.push_back(p.point);
    }
    return active;
  }

  bool is_driven(std::size_t body) const {
    return std::any_of(members_.drives.begin(), members_.drives.end(), [&](std::size_t d) {
      return !mechanism_.drives[d].slide && mechanism_.drives[d].body == body;
    });
  }

  bool is_driven_slide(std::size_t slide) const {
    return std::any_of(members_.drives.begin(), members_.drives.end(),
                       [&](std::size_t d) { return mechanism_.drives[d].slide == slide; });
  }

  bool is_binary_link(std::size_t body) const {
    if (is_driven(body) || active_points(body).size() != 2) return false;
    return std::none_of(members_.slides.begin(), members_.slides.end(), [&](std::size_t s) {
      const Slide& slide = mechanism_.slides[s];
      return slide.carrier == body || slide.of == body;
    });
  }

  /// Of a link that takes part in one prismatic joint only, a full one, and otherwise in one revolute joint.
  void find_blocks() {
    for (const std::size_t body : members_.bodies) {
      if (const auto slide = slide_as_block(body)) block_slides_.emplace_back(body, *slide);
    }
  }

  /// The prismatic joint in which a link is a block, of those that are not blocks yet.
  std::optional<std::size_t> slide_as_block(std::size_t body) const {
    if (is_driven(body)) return std::nullopt;
    std::optional<std::size_t> only;
    bool single = true;
    for (const std::size_t s : members_.slides) {
      const Slide& slide = mechanism_.slides[s];
      const bool takes_part =
          slide.carrier == body || slide.of == body || mechanism_.bodies[body].find(slide.point) != nullptr;
      if (!takes_part) continue;
      single = single && !only;
      only = s;
    }
    if (!only || !single || is_driven_slide(*only)) return std::nullopt;
    const Slide& slide = mechanism_.slides[*only];
    if (!slide.of || (slide.of != body && slide.carrier != body)) return std::nullopt;
    const auto other = slide.of == body ? slide.carrier : slide.of;
    if (other && block_slide(*other)) return std::nullopt;
    if (joints(body, slide).size() != 1) return std::nullopt;
    // what it slides on has to be more than a link
    if (other && has(binary_links_, *other)) return std::nullopt;
    return only;
  }

  /// The revolute joints of a link: its active points, but the one that merely slides.
  std::vector<std::size_t> joints(std::size_t body, const Slide& slide) const {
    std::vector<std::size_t> points;
    for (const std::size_t p : active_points(body)) {
      std::size_t others = known_[p] ? 1 : 0;
      for (const std::size_t b : members_.bodies) {
        if (b != body && mechanism_.bodies[b].find(p) != nullptr) ++others;
      }
      if (p != slide.point || others > 0) points.push_back(p);
    }
    return points;
  }

  std::optional<std::size_t> block_slide(std::size_t body) const {
    for (const auto& [block, slide] : block_slides_) {
      if (block == body) return slide;
    }
    return std::nullopt;
  }

  bool is_block_slide(std::size_t slide) const {
    return std::any_of(block_slides_.begin(), block_slides_.end(),
                       [&](const auto& entry) { return entry.second == slide; });
  }

  /// The first platform link with a point, as its index in `platforms`.
  std::optional<std::size_t> platform_with(std::size_t point) const {
    for (std::size_t i = 0; i < result_.platforms.size(); ++i) {
      if (mechanism_.bodies[result_.platforms[i]].find(point) != nullptr) return i;
    }
    return std::nullopt;
  }

  std::optional<std::size_t> platform_index(std::size_t body) const {
    const auto found = std::find(result_.platforms.begin(), result_.platforms.end(), body);
    if (found == result_.platforms.end()) return std::nullopt;
    return static_cast<std::size_t>(found - result_.platforms.begin());
  }

  PointRef carried(std::size_t platform, std::size_t point) const {
    return {PointRef::Kind::carried, point, platform,
            mechanism_.bodies[result_.platforms[platform]].find(point)->local};
  }

  PointRef reference(std::size_t point) const {
    if (known_[point]) return {PointRef::Kind::known, point, 0, Vector2d::Zero()};
    if (const auto platform = platform_with(point)) return carried(*platform, point);
    const auto found = std::find(result_.free_points.begin(), result_.free_points.end(), point);
    return {PointRef::Kind::free, point, static_cast<std::size_t>(found - result_.free_points.begin()),
            Vector2d::Zero()};
  }

  /// A line in the frame of a link of the group or a placed one, or of the frame.
  LineRef line(std::optional<std::size_t> body, const Vector2d& point, const Vector2d& direction) const {
    LineRef line{LineRef::Kind::fixed, 0, 0, point, direction};
    if (!body) return line;
    line.body = *body;
    if (const auto platform = platform_index(*body)) {
      line.kind = LineRef::Kind::carried;
      line.member = *platform;
    } else {
      line.kind = LineRef::Kind::known;
    }
    return line;
  }

  LineRef line(const Slide& slide) const {
    const LineRef at = line_of(mechanism_, slide);
    return line(slide.carrier, at.point, at.direction);
  }

  void add_revolutes() {
    for (std::size_t platform = 0; platform < result_.platforms.size(); ++platform) {
      for (const BodyPoint& p : mechanism_.bodies[result_.platforms[platform]].points) {
        if (!known_[p.point] && !has(members_.points, p.point)) continue;
        const PointRef there = reference(p.point);
        if (there.kind == PointRef::Kind::carried && there.member == platform) continue;
        Condition revolute;
        revolute.kind = Condition::Kind::coincidence;
        revolute.a = carried(platform, p.point);
        revolute.b = there;
        result_.conditions.push_back(revolute);
      }
    }
  }

  void add_binary_link(std::size_t body) {
    const auto ends = active_points(body);
    const Body& bar = mechanism_.bodies[body];
    // from what is known, or stands first in the link
    const std::size_t from = known_[ends[1]] && !known_[ends[0]] ? ends[1] : ends[0];
    const std::size_t to = from == ends[0] ? ends[1] : ends[0];
    const Vector2d bone = bar.find(to)->local - bar.find(from)->local;
    Condition length;
    length.kind = Condition::Kind::distance;
    length.a = reference(to);
    length.b = reference(from);
    length.value = distance(bar, from, to);
    length.link = result_.binary_links.size();
    result_.conditions.push_back(length);
    result_.binary_links.push_back({body, from, to, bone.x() / length.value, bone.y() / length.value});
  }

  /// A block on a line of `other`: its revolute joint H lies on that line, shifted by where H lies beside the
  /// block's own point. A block that carries the line itself: H lies on a line of the link that slides in it.
  void add_block(std::size_t body, const Slide& slide) {
    const LineRef at = line_of(mechanism_, slide);
    const double against = slide.angle + std::atan2(at.direction.y(), at.direction.x());  // of `of` − carrier
    const bool is_guided = slide.of == body;
    const std::size_t revolute = joints(body, slide).front();
    const Body& block = mechanism_.bodies[body];
    Condition condition;
    condition.kind = Condition::Kind::on_line;
    condition.a = reference(revolute);
    double angle = against;
    if (is_guided) {
      const Vector2d beside = turned(block.find(slide.point)->local - block.find(revolute)->local, against);
      const Vector2d normal = left_normal(at.direction);
      condition.line = line(slide.carrier, at.point - normal.dot(beside) * normal, at.direction);
    } else {
      angle = -against;
      const Vector2d direction = turned(Vector2d::UnitX(), -slide.angle);
      const Vector2d normal = left_normal(direction);
      const double beside = left_normal(at.direction).dot(at.point - block.find(revolute)->local);
      const Vector2d sliding = mechanism_.bodies[*slide.of].find(slide.point)->local;
      condition.line = line(slide.of, sliding - beside * normal, direction);
    }
    result_.conditions.push_back(condition);
    result_.blocks.push_back(
        {body, revolute, is_guided ? slide.carrier : slide.of, std::cos(angle), std::sin(angle)});
  }

  void add_slide(const Slide& slide) {
    Condition condition;
    condition.kind = Condition::Kind::on_line;
    condition.a = reference(slide.point);
    condition.line = line(slide);
    result_.conditions.push_back(condition);
    if (!slide.of) return;
    const double against =
        slide.angle + std::atan2(condition.line.direction.y(), condition.line.direction.x());
    Condition orientation;
    orientation.kind = Condition::Kind::orientation;
    if (const auto platform = platform_index(*slide.of)) {
      orientation.member = *platform;
      orientation.line = condition.line;
      orientation.value = against;
    } else {  // the carrier is the unknown link
      orientation.member = platform_index(*slide.carrier).value();
      orientation.line = line(slide.of, Vector2d::Zero(), Vector2d::UnitX());
      orientation.value = -against;
    }
    result_.conditions.push_back(orientation);
  }

  void add_drive(std::size_t d) {
    const Drive& drive = mechanism_.drives[d];
    Condition condition;
    condition.drive = d;
    if (drive.slide) {
      const Slide& slide = mechanism_.slides[*drive.slide];
      condition.kind = Condition::Kind::along;
      condition.a = reference(slide.point);
      condition.line = line(slide);
    } else {
      condition.kind = Condition::Kind::orientation;
      condition.member = platform_index(drive.body).value();
    }
    result_.conditions.push_back(condition);
  }

  const Mechanism& mechanism_;
  const GroupMembers& members_;
  const std::vector<bool>& known_;
  std::vector<std::size_t> binary_links_;
  std::vector<std::pair<std::size_t, std::size_t>> block_slides_;  ///< link and prismatic joint
  GroupEquations result_;
};

}  // namespace

LineRef line_of(const Mechanism& mechanism, const Slide& slide) {
  LineRef line;
  line.kind = slide.carrier ? LineRef::Kind::known : LineRef::Kind::fixed;
  line.body = slide.carrier.value_or(0);
  const auto local = [&](std::size_t point) -> const Vector2d& {
    return slide.carrier ? mechanism.bodies[*slide.carrier].find(point)->local
                         : mechanism.points[point].position;
  };
  const Vector2d along = local(slide.second) - local(slide.first);
  line.direction = along / std::hypot(along.x(), along.y());
  line.point = local(slide.first) + slide.offset * left_normal(line.direction);
  return line;
}

GroupEquations reduce(const Mechanism& mechanism, const GroupMembers& members,
                      const std::vector<bool>& known) {
  return Reduction(mechanism, members, known).run();
}

}  // namespace oblique::mechanism
