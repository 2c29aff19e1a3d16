// SPDX-License-Identifier: MIT
// Mechanism → diagram by servo-tracked oblique triangles.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include <oblique/patch/patch_builder.h>
#include <oblique/patch/triad_split.h>

namespace oblique {
namespace {

class TrianglePatch : private PatchBuilder {
 public:
  using PatchBuilder::PatchBuilder;

  Diagram make() {
    check_groups();
    describe(
        "patched as servo-tracked triangles",
        fmt::format(
            "Each dyad's triangle has a scale of its own (`reach`), so that its longest\n"
            "side is about 1 machine unit. Servo amplifiers: gain {}, bandwidth {} Hz. Run over one turn "
            "of '{}'.",
            options_.gain, bandwidth_, mechanism_.drives.front().name));
    add_reference();
    for (std::size_t g = 0; g < structure_.groups.size(); ++g) {
      const Group& group = structure_.groups[g];
      if (group.kind == GroupKind::crank) {
        add_crank(group);
      } else if (const auto dyad = dyad_of(group)) {
        add_dyad(group.name, *dyad, scaling_.triangles[g]);
      } else if (group.kind == GroupKind::triad) {
        add_triad(group, *choose_split(group, motion_));
      } else {
        add_group(group);
      }
      for (const std::size_t point : group.points) set_known(point);
    }
    add_outputs();
    return std::move(diagram_);
  }

 private:
  /// The conditions of a group of one unknown point or body, by what they do.
  struct Parts {
    const Condition* hinge = nullptr;
    const Condition* angle = nullptr;
    const Condition* along = nullptr;
    std::vector<const Condition*> loci;
  };

  /// Nothing where the conditions are others than those of a dyad or a drive.
  static std::optional<Parts> parts_of(const GroupEquations& equations) {
    if (equations.unknowns() > 3) return std::nullopt;
    Parts parts;
    for (const Condition& c : equations.conditions) {
      const bool is_line = c.kind == Condition::Kind::on_line || c.kind == Condition::Kind::along;
      const bool point_known = c.a.kind == PointRef::Kind::known;
      const bool line_known = c.line.kind != LineRef::Kind::carried;
      if (c.kind == Condition::Kind::orientation ? !line_known
          : is_line                              ? point_known == line_known
                                                 : c.b.kind != PointRef::Kind::known)
        return std::nullopt;
      switch (c.kind) {
        case Condition::Kind::coincidence:
          parts.hinge = &c;
          break;
        case Condition::Kind::orientation:
          parts.angle = &c;
          break;
        case Condition::Kind::along:
          parts.along = &c;
          break;
        default:
          parts.loci.push_back(&c);
      }
    }
    const bool is_body = !equations.cores.empty();
    const std::size_t wanted = parts.hinge != nullptr ? (parts.angle != nullptr ? 0 : 1) : 2;
    const std::size_t found = parts.loci.size() + (parts.along != nullptr ? 1 : 0);
    if (found != wanted || (is_body && parts.angle == nullptr && parts.hinge == nullptr)) return std::nullopt;
    const auto circles = std::count_if(parts.loci.begin(), parts.loci.end(), [](const Condition* c) {
      return c->kind == Condition::Kind::distance;
    });
    if (parts.hinge != nullptr && wanted == 1) {  // only a line of its own has a block
      const bool own_line = parts.loci.size() == 1 && parts.loci[0]->line.kind == LineRef::Kind::carried &&
                            parts.loci[0]->kind == Condition::Kind::on_line;
      return own_line ? std::optional(parts) : std::nullopt;
    }
    return circles <= 1 ? std::optional(parts) : std::nullopt;
  }

  void check_groups() const {
    for (const Group& group : structure_.groups) {
      if (group.kind == GroupKind::crank || dyad_of(group) || choose_split(group, motion_)) continue;
      if (group.kind == GroupKind::triad) {
        refuse(group,
               "has no split into two triangles that never go flat and a loop that keeps its sign on the way",
               "a triad on three links with such a split",
               "patch it with --method gradient, which takes any group");
      }
      if (parts_of(group.equations)) continue;
      refuse(group, "cannot be patched as triangles", "drives, dyads and triads",
             "patch it with --method gradient, which takes any group");
    }
  }

  // --- class III: two triangles and a loop

  /// The loop that tracks the variable length is slower than its triangles by this: next to their speed
  /// several splits are unstable (003_69ea068b7b221c3d.txt does not speak of it).
  static constexpr double kSlower = 100;

  void add_triad(const Group& group, const TriadSplit& split) {
    const auto& conditions = group.equations.conditions;
    const Condition& tracked = conditions[split.tracked];
    const Condition& closing = conditions[split.closing];
    const Condition& third = conditions[split.third];
    const std::string& unit = mechanism_.length_unit;
    const std::size_t b = tracked.a.point, c = closing.a.point, d = third.a.point;
    const std::size_t core = group.equations.cores.front();
    const double reach = round_up(scaled(split.reach));
    const std::string length = free_name(name_of(closing.b.point) + name_of(b));
    const std::string first = add_block(
        name_of(b), "dyad-rrr-variable",
        with_amplifiers({wire(name_of(b), "px", points_[tracked.b.point]->x),
                         wire(name_of(b), "py", points_[tracked.b.point]->y),
                         wire(name_of(b), "qx", points_[closing.b.point]->x),
                         wire(name_of(b), "qy", points_[closing.b.point]->y),
                         wire_setting("r2", {{1, length}}), number_setting("r1", scaled(tracked.value)),
                         number_setting("side", split.first_side), number_setting("reach", reach)}),
        fmt::format(
            "triad {}: the distance {}–{} is taken for known, up to {:.4g} {}; then {} is the apex of "
            "{}–{}–{},\n{} that of {}–{}–{}, and {}–{} closes the loop. Of the six splits this one keeps "
            "farthest "
            "from flat\ntriangles and from a loop without gain: sines down to {:.2g}, gain down to {:.2g}.",
            group.name, name_of(closing.b.point), name_of(b), split.longest, unit, name_of(b),
            name_of(tracked.b.point), name_of(b), name_of(closing.b.point), name_of(d), name_of(b),
            name_of(d), name_of(third.b.point), name_of(closing.b.point), name_of(c), split.flattest,
            split.least_gain));
    signals_[b] = {first + ".x", first + ".y"};
    set_known(b);
    double longest = 0;
    for (const Configuration& here : motion_.configurations)
      longest = std::max(longest, (here.points[third.b.point].position - here.points[b].position).norm());
    const std::string second = add_block(
        name_of(d), "dyad-rrr",
        with_amplifiers({wire_setting("px", {x_of(b, 1)}), wire_setting("py", {y_of(b, 1)}),
                         wire(name_of(d), "qx", points_[third.b.point]->x),
                         wire(name_of(d), "qy", points_[third.b.point]->y),
                         number_setting("r1", scaled((third.a.local - tracked.a.local).norm())),
                         number_setting("r2", scaled(third.value)), number_setting("side", split.second_side),
                         number_setting("reach", round_up(scaled(longest)))}));
    signals_[d] = {second + ".x", second + ".y"};
    set_known(d);
    const Body& platform = mechanism_.bodies[core];
    bases_[core] = {*platform.find(b), *platform.find(d)};
    for (const BodyPoint& p : platform.points) {
      if (!points_[p.point]) points_[p.point] = point_of(core, p.local);
    }
    add_closing_loop(closing, split, length, reach);
    for (const Link& link : group.equations.links) {
      const Body& body = mechanism_.bodies[link.body];
      bases_[link.body] = {*body.find(link.from), *body.find(link.to)};
      for (const BodyPoint& p : body.points) {
        if (!points_[p.point]) points_[p.point] = point_of(link.body, p.local);
      }
    }
    for (const std::size_t point : group.points) {
      if (signals_[point].x.empty())
        add_summed_point(point, terms_of(points_[point]->x), terms_of(points_[point]->y), {});
    }
  }

  /// What |ZC|² lacks, over l², drives the variable length.
  void add_closing_loop(const Condition& closing, const TriadSplit& split, const std::string& length,
                        double reach) {
    const double l = scaled(closing.value);
    const VectorForm& c = *points_[closing.a.point];
    const VectorForm& z = *points_[closing.b.point];
    const std::string dx =
        add_block(length + "_dx", "summer", {sum_of(terms_of(combined({{1 / l, &c.x}, {-1 / l, &z.x}})))});
    const std::string dy =
        add_block(length + "_dy", "summer", {sum_of(terms_of(combined({{1 / l, &c.y}, {-1 / l, &z.y}})))});
    const std::string dx2 =
        add_block(length + "_dx2", "multiplier", {wire_setting("in", {{1, dx}, {1, dx}})});
    const std::string dy2 =
        add_block(length + "_dy2", "multiplier", {wire_setting("in", {{1, dy}, {1, dy}})});
    constexpr double kInputGain = 10;
    const double weight = split.sign * kInputGain;
    BlockInstance loop;
    loop.name = length;
    loop.type = "servo-amplifier";
    loop.settings = {wire_setting("in", {{weight, dx2}, {weight, dy2}, {-weight, one_}}),
                     number_setting("gain", options_.gain), number_setting("bandwidth", bandwidth_ / kSlower),
                     number_setting("initial", scaled(split.first_w) / reach)};
    loop.comment = fmt::format("the outer loop, {:.0f} times slower", kSlower);
    diagram_.blocks.push_back(std::move(loop));
  }

  // --- groups of one unknown point or body

  static LinearForm constant(double value) {
    LinearForm form;
    form.constant = value;
    return form;
  }

  /// local [length unit] turned by the axis of the unknown body [machine unit].
  VectorForm arm(const Eigen::Vector2d& local) const {
    const double x = scaled(local.x()), y = scaled(local.y());
    return {combined({{x, &axis_.x}, {-y, &axis_.y}}), combined({{x, &axis_.y}, {y, &axis_.x}})};
  }
  static Eigen::Vector2d turned(const Eigen::Vector2d& v, const BodyState& by) {
    return {by.cosine * v.x() - by.sine * v.y(), by.sine * v.x() + by.cosine * v.y()};
  }

  static VectorForm sum(const VectorForm& a, double factor, const VectorForm& b) {
    return {combined({{1, &a.x}, {factor, &b.x}}), combined({{1, &a.y}, {factor, &b.y}})};
  }

  /// Where an unknown point lies, as signals, and where that is in a configuration [length unit].
  struct Locus {
    bool circle = false;
    VectorForm at, direction;
    double radius = 0;
    std::function<Eigen::Vector2d(const Configuration&)> place, heading;
  };

  Locus locus(const Group& group, const Condition& c) {
    Locus locus;
    const bool is_body = !group.equations.cores.empty();
    const std::size_t core = is_body ? group.equations.cores.front() : 0;
    const auto body = [core](const Configuration& here) -> const BodyState& { return here.bodies[core]; };
    if (c.kind == Condition::Kind::distance) {
      locus.circle = true;
      locus.radius = c.value;
      locus.at = *points_[c.b.point];
      if (is_body) locus.at = sum(locus.at, -1, arm(c.a.local));
      locus.place = [=](const Configuration& here) -> Eigen::Vector2d {
        const Eigen::Vector2d at = here.points[c.b.point].position;
        return is_body ? Eigen::Vector2d(at - turned(c.a.local, body(here))) : at;
      };
      return locus;
    }
    if (c.line.kind == LineRef::Kind::carried) {
      const VectorForm unit = arm(c.line.direction);
      locus.direction = {combined({{scaling_.length, &unit.x}}), combined({{scaling_.length, &unit.y}})};
      locus.at = sum(*points_[c.a.point], -1, arm(c.line.point));
      locus.place = [=](const Configuration& here) -> Eigen::Vector2d {
        return here.points[c.a.point].position - turned(c.line.point, body(here));
      };
      locus.heading = [=](const Configuration& here) { return turned(c.line.direction, body(here)); };
      return locus;
    }
    const auto carrier = c.line.kind == LineRef::Kind::known ? std::optional(c.line.body) : std::nullopt;
    const LineForm line = line_form(carrier, c.line);
    locus.at = line.at;
    locus.direction = line.direction;
    if (is_body) locus.at = sum(locus.at, -1, arm(c.a.local));
    const std::size_t base = carrier ? mechanism_.bodies[*carrier].points.front().point : 0;
    locus.place = [=](const Configuration& here) -> Eigen::Vector2d {
      Eigen::Vector2d at = c.line.point;
      if (carrier) at = here.points[base].position + turned(at, here.bodies[*carrier]);
      return is_body ? Eigen::Vector2d(at - turned(c.a.local, body(here))) : at;
    };
    locus.heading = [=](const Configuration& here) -> Eigen::Vector2d {
      return carrier ? turned(c.line.direction, here.bodies[*carrier]) : c.line.direction;
    };
    return locus;
  }

  /// The direction of the unknown body's x axis, where it is given.
  void set_axis(const Condition& angle) {
    if (angle.drive) {
      const Drive& drive = mechanism_.drives[*angle.drive];
      const std::string generator = add_block(
          drive.name, "crank-generator",
          {wire_setting("speed", {{1, one_}}), number_setting("rate", drive.speed),
           number_setting("start", drive.start)},
          fmt::format("drive {}: the direction of {}", drive.name, mechanism_.bodies[drive.body].name));
      axis_ = {};
      axis_.x.weights[generator + ".cos"] = 1;
      axis_.y.weights[generator + ".sin"] = 1;
      return;
    }
    const Eigen::Vector2d heading(std::cos(angle.value), std::sin(angle.value));
    if (angle.line.kind == LineRef::Kind::known) {
      axis_ = direction_of(angle.line.body, heading);
    } else {
      axis_ = {constant(heading.x()), constant(heading.y())};
    }
  }

  template <class Length>
  double largest_over_motion(Length length) const {
    double largest = 0;
    for (const Configuration& here : motion_.configurations) largest = std::max(largest, length(here));
    return round_up(scaled(std::max(largest, scaling_.length * 1e-3)));
  }

  std::vector<Entry> with_amplifiers(std::vector<Entry> settings) const {
    settings.push_back(number_setting("gain", options_.gain));
    settings.push_back(number_setting("bandwidth", bandwidth_));
    return settings;
  }

  /// A form for an input that takes one signal: a summer stands before it where it has more terms.
  Entry wire(const std::string& block, const char* port, const LinearForm& form) {
    const Terms terms = terms_of(form);
    if (terms.size() == 1) return wire_setting(port, terms);
    return wire_setting(port, {{1, add_block(block + "_" + port, "summer", {sum_of(terms)})}});
  }

  /// Places the unknown point or body of a group and all that it carries.
  void add_group(const Group& group) {
    const GroupEquations& equations = group.equations;
    const Parts parts = *parts_of(equations);
    const bool is_body = !equations.cores.empty();
    const std::string& name =
        is_body ? mechanism_.bodies[equations.cores.front()].name : name_of(equations.free_points.front());
    if (parts.angle != nullptr) set_axis(*parts.angle);
    VectorForm unknown;
    if (parts.hinge != nullptr) {
      if (parts.angle == nullptr) add_own_line(group, *parts.hinge, *parts.loci[0], name);
      unknown = sum(*points_[parts.hinge->b.point], -1, arm(parts.hinge->a.local));
    } else if (parts.along != nullptr) {
      unknown = add_slider(group, *parts.along, name);
    } else {
      unknown = add_crossing(group, locus(group, *parts.loci[0]), locus(group, *parts.loci[1]), name);
    }
    if (!is_body) {
      points_[equations.free_points.front()] = unknown;
    } else {
      carry(equations.cores.front(), mechanism_.bodies[equations.cores.front()].points.front().point,
            unknown);
    }
    for (const Link& link : equations.links) {
      const Body& body = mechanism_.bodies[link.body];
      bases_[link.body] = {*body.find(link.from), *body.find(link.to)};
      for (const BodyPoint& p : body.points) {
        if (!points_[p.point]) points_[p.point] = point_of(link.body, p.local);
      }
    }
    const VectorForm core_axis = axis_;
    for (const Block& block : equations.blocks) {
      const bool on_core = block.on && is_body && *block.on == equations.cores.front();
      const VectorForm on = on_core    ? core_axis
                            : block.on ? direction_of(*block.on, Eigen::Vector2d::UnitX())
                                       : VectorForm{constant(1), constant(0)};
      axis_ = {combined({{block.cosine, &on.x}, {-block.sine, &on.y}}),
               combined({{block.cosine, &on.y}, {block.sine, &on.x}})};
      carry(block.body, block.hinge, *points_[block.hinge]);
    }
    for (const std::size_t point : group.points) {
      if (signals_[point].x.empty())
        add_summed_point(point, terms_of(points_[point]->x), terms_of(points_[point]->y), {});
    }
  }

  /// The points of a body whose axis and one point are known.
  void carry(std::size_t index, std::size_t base, const VectorForm& at) {
    const Body& body = mechanism_.bodies[index];
    for (const BodyPoint& p : body.points) {
      if (!points_[p.point]) points_[p.point] = sum(at, 1, arm(p.local - body.find(base)->local));
    }
  }

  /// RPR: the axis of a body hinged to P from its line through Q.
  void add_own_line(const Group& group, const Condition& hinge, const Condition& on_line,
                    const std::string& name) {
    const Eigen::Vector2d& u = on_line.line.direction;
    const Eigen::Vector2d normal(-u.y(), u.x());
    const VectorForm& p = *points_[hinge.b.point];
    const VectorForm& q = *points_[on_line.a.point];
    const double reach = largest_over_motion([&](const Configuration& here) {
      return (here.points[on_line.a.point].position - here.points[hinge.b.point].position).norm();
    });
    const std::string block = add_block(
        name + "_line", "dyad-rpr",
        with_amplifiers({wire(name + "_line", "px", p.x), wire(name + "_line", "py", p.y),
                         wire(name + "_line", "qx", q.x), wire(name + "_line", "qy", q.y),
                         number_setting("offset", scaled(normal.dot(on_line.line.point - hinge.a.local))),
                         number_setting("side", group.side), number_setting("reach", reach)}),
        fmt::format("dyad {} (RPR): {} turns about {}, and its line passes through {}", group.name, name,
                    name_of(hinge.b.point), name_of(on_line.a.point)));
    LinearForm cosine, sine;
    cosine.weights[block + ".cos"] = 1;
    sine.weights[block + ".sin"] = 1;
    axis_ = {combined({{u.x(), &cosine}, {u.y(), &sine}}), combined({{u.x(), &sine}, {-u.y(), &cosine}})};
  }

  /// RRP and PRP: where a circle or a line meets a line.
  VectorForm add_crossing(const Group& group, Locus first, Locus second, const std::string& name) {
    if (!first.circle && second.circle) std::swap(first, second);
    const bool is_body = !group.equations.cores.empty();
    const std::size_t point = is_body ? mechanism_.bodies[group.equations.cores.front()].points.front().point
                                      : group.equations.free_points.front();
    const auto place = [&](const Configuration& here) { return here.points[point].position; };
    std::string block;
    if (first.circle) {
      const double reach = largest_over_motion([&](const Configuration& here) {
        const Eigen::Vector2d a = second.place(here);
        return std::max({first.radius, (first.place(here) - a).norm(), (place(here) - a).norm()});
      });
      block = add_block(
          name + "_slide", "dyad-rrp",
          with_amplifiers({wire(name + "_slide", "px", first.at.x), wire(name + "_slide", "py", first.at.y),
                           wire(name + "_slide", "ax", second.at.x), wire(name + "_slide", "ay", second.at.y),
                           wire(name + "_slide", "ux", second.direction.x),
                           wire(name + "_slide", "uy", second.direction.y),
                           number_setting("r", scaled(first.radius)), number_setting("side", group.side),
                           number_setting("reach", reach)}),
          fmt::format("dyad {} (RRP): at {:.6g} {} from a point, and on a line", group.name, first.radius,
                      mechanism_.length_unit));
    } else {
      const double reach = largest_over_motion([&](const Configuration& here) {
        const Eigen::Vector2d a = first.place(here);
        return std::max((second.place(here) - a).norm(), (place(here) - a).norm());
      });
      const Configuration& start = motion_.configurations.front();
      const Eigen::Vector2d u = first.heading(start), v = second.heading(start);
      block = add_block(
          name + "_slide", "dyad-prp",
          with_amplifiers({wire(name + "_slide", "ax", first.at.x), wire(name + "_slide", "ay", first.at.y),
                           wire(name + "_slide", "ux", first.direction.x),
                           wire(name + "_slide", "uy", first.direction.y),
                           wire(name + "_slide", "bx", second.at.x), wire(name + "_slide", "by", second.at.y),
                           wire(name + "_slide", "vx", second.direction.x),
                           wire(name + "_slide", "vy", second.direction.y),
                           number_setting("side", u.x() * v.y() - u.y() * v.x() > 0 ? 1 : -1),
                           number_setting("reach", reach)}),
          fmt::format("dyad {} ({}): where two lines meet", group.name, kind_name(group.kind)));
    }
    VectorForm unknown;
    unknown.x.weights[block + ".x"] = 1;
    unknown.y.weights[block + ".y"] = 1;
    return unknown;
  }

  /// A point that a drive moves along a line.
  VectorForm add_slider(const Group& group, const Condition& along, const std::string& name) {
    const Drive& drive = mechanism_.drives[*along.drive];
    const double reach = largest_over_motion(
        [&](const Configuration& here) { return std::abs(here.slides[*drive.slide].position); });
    const std::string way =
        add_block(drive.name, "integrator",
                  {wire_setting("in", {{scaled(drive.speed) / reach, one_}}),
                   number_setting("initial", scaled(drive.start) / reach)},
                  fmt::format("drive {}: {:.6g} {}/s along {}", drive.name, drive.speed,
                              mechanism_.length_unit, mechanism_.slides[*drive.slide].name));
    const Locus line = locus(group, along);
    VectorForm unknown = line.at;
    const auto add = [&](LinearForm& to, const LinearForm& direction, const char* axis) {
      LinearForm product;
      if (direction.weights.empty()) {
        product.weights[way] = direction.constant * reach;
      } else {
        const std::string heading = add_block(name + "_u" + axis, "summer", {sum_of(terms_of(direction))});
        product.weights[add_block(name + "_way_" + axis, "multiplier",
                                  {wire_setting("in", {{1, way}, {1, heading}})})] = reach;
      }
      to.add(product);
    };
    add(unknown.x, line.direction.x, "x");
    add(unknown.y, line.direction.y, "y");
    return unknown;
  }

  void add_dyad(const std::string& name, const Dyad& dyad, const TriangleRange& range) {
    const std::string& unit = mechanism_.length_unit;
    const std::string comment = fmt::format(
        "dyad {}: {} is hinged to {} ({:.6g} {}) and {} ({:.6g} {}), on the {} of {} → {}.\n"
        "{}–{} is {:.4g} … {:.4g} {} long; sin γ at {} falls to {:.2g}.",
        name, name_of(dyad.c), name_of(dyad.p), dyad.r1, unit, name_of(dyad.q), dyad.r2, unit,
        dyad.side > 0 ? "left" : "right", name_of(dyad.p), name_of(dyad.q), name_of(dyad.p), name_of(dyad.q),
        range.shortest, range.longest, unit, name_of(dyad.p), range.flattest);
    const std::string block = add_block(
        name_of(dyad.c), "dyad-rrr",
        {wire_setting("px", {x_of(dyad.p, 1)}), wire_setting("py", {y_of(dyad.p, 1)}),
         wire_setting("qx", {x_of(dyad.q, 1)}), wire_setting("qy", {y_of(dyad.q, 1)}),
         number_setting("r1", scaled(dyad.r1)), number_setting("r2", scaled(dyad.r2)),
         number_setting("side", dyad.side), number_setting("reach", round_up(scaled(range.longest))),
         number_setting("gain", options_.gain), number_setting("bandwidth", bandwidth_)},
        comment);
    signals_[dyad.c] = {block + ".x", block + ".y"};
    add_carried_points(mechanism_.bodies[dyad.body1], dyad.p, dyad.c);
    add_carried_points(mechanism_.bodies[dyad.body2], dyad.q, dyad.c);
  }

  VectorForm axis_;  ///< of the body that is being placed
};

}  // namespace

Diagram patch_triangles(const Mechanism& mechanism, const PatchOptions& options) {
  return TrianglePatch(mechanism, options).make();
}

}  // namespace oblique
