// SPDX-License-Identifier: MIT
#include <oblique/patch/slide_dyads.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include <oblique/mechanism/model/plane.h>
#include <oblique/patch/drive_circuits.h>
#include <oblique/patch/point_circuits.h>
#include <oblique/patch/unit_vector.h>

namespace oblique::patch {
namespace {

Eigen::Vector2d turned_by(const Eigen::Vector2d& v, const mechanism::BodyState& by) {
  return mechanism::turned(v, by.cosine, by.sine);
}

/// Where an unknown point lies, as signals, and where that is in a configuration [length unit].
struct Locus {
  bool circle = false;
  VectorForm at, direction;
  double radius = 0;
  std::function<Eigen::Vector2d(const mechanism::Configuration&)> place, heading;
};

class SlideDyad {
 public:
  SlideDyad(Circuit& circuit, const mechanism::Group& group)
      : circuit_(circuit),
        setup_(circuit.setup),
        mechanism_(setup_.mechanism()),
        writer_(circuit.writer),
        places_(circuit.places),
        group_(group) {}

  void run() {
    const mechanism::GroupEquations& equations = group_.equations;
    const mechanism::GroupForm& form = group_.form;
    const auto condition = [&](std::size_t index) -> const mechanism::Condition& {
      return equations.conditions[index];
    };
    const bool is_body = !equations.platforms.empty();
    const std::string& name = is_body ? mechanism_.bodies[equations.platforms.front()].name
                                      : setup_.name_of(equations.free_points.front());
    if (form.angle) set_axis(condition(*form.angle));
    VectorForm unknown;
    if (form.revolute) {
      const mechanism::Condition& revolute = condition(*form.revolute);
      if (!form.angle) add_own_line(revolute, condition(form.loci.front()), name);
      unknown = sum(places_.at(revolute.b.point), -1, arm(revolute.a.local));
    } else if (condition(form.loci.back()).kind == mechanism::Condition::Kind::along) {
      unknown = add_slider(condition(form.loci.back()), name);
    } else {
      unknown = add_crossing(locus(condition(form.loci[0])), locus(condition(form.loci[1])), name);
    }
    if (!is_body) {
      places_.set(equations.free_points.front(), unknown);
    } else {
      carry(equations.platforms.front(), mechanism_.bodies[equations.platforms.front()].points.front().point,
            unknown);
    }
    for (const mechanism::BinaryLink& link : equations.binary_links) {
      places_.set_base(link.body, link.from, link.to);
      places_.carry(link.body);
    }
    const VectorForm platform_axis = axis_;
    for (const mechanism::SliderBlock& block : equations.blocks) {
      const bool on_platform = block.on && is_body && *block.on == equations.platforms.front();
      const VectorForm on = on_platform ? platform_axis
                            : block.on  ? places_.direction_of(*block.on, Eigen::Vector2d::UnitX())
                                        : VectorForm{constant(1), constant(0)};
      axis_ = {combined({{block.cosine, &on.x}, {-block.sine, &on.y}}),
               combined({{block.cosine, &on.y}, {block.sine, &on.x}})};
      carry(block.body, block.revolute, places_.at(block.revolute));
    }
    add_formed_points(circuit_, group_);
  }

 private:
  /// local [length unit] turned by the axis of the unknown link [machine unit].
  VectorForm arm(const Eigen::Vector2d& local) const {
    const double x = setup_.scaled(local.x()), y = setup_.scaled(local.y());
    return {combined({{x, &axis_.x}, {-y, &axis_.y}}), combined({{x, &axis_.y}, {y, &axis_.x}})};
  }

  Locus locus(const mechanism::Condition& c) {
    Locus locus;
    const bool is_body = !group_.equations.platforms.empty();
    const std::size_t platform = is_body ? group_.equations.platforms.front() : 0;
    const auto body = [platform](const mechanism::Configuration& here) -> const mechanism::BodyState& {
      return here.bodies[platform];
    };
    if (c.kind == mechanism::Condition::Kind::distance) {
      locus.circle = true;
      locus.radius = c.value;
      locus.at = places_.at(c.b.point);
      if (is_body) locus.at = sum(locus.at, -1, arm(c.a.local));
      locus.place = [=](const mechanism::Configuration& here) -> Eigen::Vector2d {
        const Eigen::Vector2d at = here.points[c.b.point].position;
        return is_body ? Eigen::Vector2d(at - turned_by(c.a.local, body(here))) : at;
      };
      return locus;
    }
    if (c.line.kind == mechanism::LineRef::Kind::carried) {
      const VectorForm unit = arm(c.line.direction);
      locus.direction = {combined({{setup_.scaling.length, &unit.x}}),
                         combined({{setup_.scaling.length, &unit.y}})};
      locus.at = sum(places_.at(c.a.point), -1, arm(c.line.point));
      locus.place = [=](const mechanism::Configuration& here) -> Eigen::Vector2d {
        return here.points[c.a.point].position - turned_by(c.line.point, body(here));
      };
      locus.heading = [=](const mechanism::Configuration& here) {
        return turned_by(c.line.direction, body(here));
      };
      return locus;
    }
    const auto carrier =
        c.line.kind == mechanism::LineRef::Kind::known ? std::optional(c.line.body) : std::nullopt;
    const PointBook::LineForm line = places_.line_form(carrier, c.line);
    locus.at = line.at;
    locus.direction = line.direction;
    if (is_body) locus.at = sum(locus.at, -1, arm(c.a.local));
    const std::size_t base = carrier ? mechanism_.bodies[*carrier].points.front().point : 0;
    locus.place = [=](const mechanism::Configuration& here) -> Eigen::Vector2d {
      Eigen::Vector2d at = c.line.point;
      if (carrier) at = here.points[base].position + turned_by(at, here.bodies[*carrier]);
      return is_body ? Eigen::Vector2d(at - turned_by(c.a.local, body(here))) : at;
    };
    locus.heading = [=](const mechanism::Configuration& here) -> Eigen::Vector2d {
      return carrier ? turned_by(c.line.direction, here.bodies[*carrier]) : c.line.direction;
    };
    return locus;
  }

  /// The direction of the unknown link's x axis, where it is given.
  void set_axis(const mechanism::Condition& angle) {
    if (angle.drive) {
      const mechanism::Drive& drive = mechanism_.drives[*angle.drive];
      add_generator(
          circuit_, *angle.drive,
          fmt::format("drive {}: the direction of {}", drive.name, mechanism_.bodies[drive.body].name));
      axis_ = circuit_.drives[*angle.drive].axis;
      return;
    }
    const Eigen::Vector2d heading = unit_vector(angle.value);
    if (angle.line.kind == mechanism::LineRef::Kind::known) {
      axis_ = places_.direction_of(angle.line.body, heading);
    } else {
      axis_ = {constant(heading.x()), constant(heading.y())};
    }
  }

  /// The points of a link whose axis and one point are known.
  void carry(std::size_t index, std::size_t base, const VectorForm& at) {
    const mechanism::Body& body = mechanism_.bodies[index];
    for (const mechanism::BodyPoint& p : body.points) {
      if (!places_.has(p.point)) places_.set(p.point, sum(at, 1, arm(p.local - body.find(base)->local)));
    }
  }

  /// RPR: the axis of a link pinned to P from its line through Q.
  void add_own_line(const mechanism::Condition& revolute, const mechanism::Condition& on_line,
                    const std::string& name) {
    const Eigen::Vector2d& u = on_line.line.direction;
    const Eigen::Vector2d normal(-u.y(), u.x());
    const VectorForm& p = places_.at(revolute.b.point);
    const VectorForm& q = places_.at(on_line.a.point);
    const double reach = largest_over_motion([&](const mechanism::Configuration& here) {
      return (here.points[on_line.a.point].position - here.points[revolute.b.point].position).norm();
    });
    const std::string block = writer_.add_block(
        name + "_line", "dyad-rpr",
        with_amplifiers(
            setup_, {writer_.wire(name + "_line", "px", p.x), writer_.wire(name + "_line", "py", p.y),
                     writer_.wire(name + "_line", "qx", q.x), writer_.wire(name + "_line", "qy", q.y),
                     diagram::number_setting(
                         "offset", setup_.scaled(normal.dot(on_line.line.point - revolute.a.local))),
                     diagram::number_setting("side", group_.side), diagram::number_setting("reach", reach)}),
        fmt::format("dyad {} (RPR): {} turns about {}, and its line passes through {}", group_.name, name,
                    setup_.name_of(revolute.b.point), setup_.name_of(on_line.a.point)));
    LinearForm cosine, sine;
    cosine.weights[block + ".cos"] = 1;
    sine.weights[block + ".sin"] = 1;
    axis_ = {combined({{u.x(), &cosine}, {u.y(), &sine}}), combined({{u.x(), &sine}, {-u.y(), &cosine}})};
  }

  /// RRP and PRP: where a circle or a line meets a line.
  VectorForm add_crossing(const Locus& first, const Locus& second, const std::string& name) {
    const bool is_body = !group_.equations.platforms.empty();
    const std::size_t point = is_body
                                  ? mechanism_.bodies[group_.equations.platforms.front()].points.front().point
                                  : group_.equations.free_points.front();
    const auto place = [&](const mechanism::Configuration& here) { return here.points[point].position; };
    std::string block;
    if (first.circle) {
      const double reach = largest_over_motion([&](const mechanism::Configuration& here) {
        const Eigen::Vector2d a = second.place(here);
        return std::max({first.radius, (first.place(here) - a).norm(), (place(here) - a).norm()});
      });
      block = writer_.add_block(
          name + "_slide", "dyad-rrp",
          with_amplifiers(setup_, {writer_.wire(name + "_slide", "px", first.at.x),
                                   writer_.wire(name + "_slide", "py", first.at.y),
                                   writer_.wire(name + "_slide", "ax", second.at.x),
                                   writer_.wire(name + "_slide", "ay", second.at.y),
                                   writer_.wire(name + "_slide", "ux", second.direction.x),
                                   writer_.wire(name + "_slide", "uy", second.direction.y),
                                   diagram::number_setting("r", setup_.scaled(first.radius)),
                                   diagram::number_setting("side", group_.side),
                                   diagram::number_setting("reach", reach)}),
          fmt::format("dyad {} (RRP): at {:.6g} {} from a point, and on a line", group_.name, first.radius,
                      mechanism_.length_unit));
    } else {
      const double reach = largest_over_motion([&](const mechanism::Configuration& here) {
        const Eigen::Vector2d a = first.place(here);
        return std::max((second.place(here) - a).norm(), (place(here) - a).norm());
      });
      const mechanism::Configuration& start = setup_.motion.configurations.front();
      const Eigen::Vector2d u = first.heading(start), v = second.heading(start);
      block = writer_.add_block(
          name + "_slide", "dyad-prp",
          with_amplifiers(setup_,
                          {writer_.wire(name + "_slide", "ax", first.at.x),
                           writer_.wire(name + "_slide", "ay", first.at.y),
                           writer_.wire(name + "_slide", "ux", first.direction.x),
                           writer_.wire(name + "_slide", "uy", first.direction.y),
                           writer_.wire(name + "_slide", "bx", second.at.x),
                           writer_.wire(name + "_slide", "by", second.at.y),
                           writer_.wire(name + "_slide", "vx", second.direction.x),
                           writer_.wire(name + "_slide", "vy", second.direction.y),
                           diagram::number_setting("side", u.x() * v.y() - u.y() * v.x() > 0 ? 1 : -1),
                           diagram::number_setting("reach", reach)}),
          fmt::format("dyad {} ({}): where two lines meet", group_.name,
                      mechanism::kind_name(group_.form.kind)));
    }
    VectorForm unknown;
    unknown.x.weights[block + ".x"] = 1;
    unknown.y.weights[block + ".y"] = 1;
    return unknown;
  }

  /// A point that a drive moves along a line.
  VectorForm add_slider(const mechanism::Condition& along, const std::string& name) {
    const std::string way = add_way(circuit_, *along.drive);
    const double reach = circuit_.drives[*along.drive].way.weights.at(way);
    const Locus line = locus(along);
    VectorForm unknown = line.at;
    const auto add = [&](LinearForm& to, const LinearForm& direction, const char* axis) {
      LinearForm product;
      if (direction.weights.empty()) {
        product.weights[way] = direction.constant * reach;
      } else {
        const std::string heading = writer_.add_summer(name + "_u" + axis, direction);
        product.weights[writer_.add_product(name + "_way_" + axis, way, heading)] = reach;
      }
      to.add(product);
    };
    add(unknown.x, line.direction.x, "x");
    add(unknown.y, line.direction.y, "y");
    return unknown;
  }

  template <class Length>
  double largest_over_motion(Length length) const {
    double largest = 0;
    for (const mechanism::Configuration& here : setup_.motion.configurations)
      largest = std::max(largest, length(here));
    return round_up(setup_.scaled(std::max(largest, setup_.scaling.length * 1e-3)));
  }

  Circuit& circuit_;
  const PatchSetup& setup_;
  const mechanism::Mechanism& mechanism_;
  CircuitWriter& writer_;
  PointBook& places_;
  const mechanism::Group& group_;
  VectorForm axis_;  ///< of the link that is being placed
};

}  // namespace

bool has_slide_dyad(const mechanism::Group& group) {
  const mechanism::GroupForm& form = group.form;
  switch (form.placing) {
    case mechanism::Placing::pinned:
      return true;
    case mechanism::Placing::crossing:
      return form.circles < 2;
    case mechanism::Placing::about_pivot: {  // a line of its own
      const mechanism::Condition& c = group.equations.conditions[form.loci.front()];
      return c.kind == mechanism::Condition::Kind::on_line &&
             c.line.kind == mechanism::LineRef::Kind::carried;
    }
    case mechanism::Placing::rotation:
    case mechanism::Placing::triangle:
    case mechanism::Placing::platform:
    case mechanism::Placing::iteration:
      break;
  }
  return false;
}

void add_slide_dyad(Circuit& circuit, const mechanism::Group& group) {
  SlideDyad(circuit, group).run();
}

}  // namespace oblique::patch
