// SPDX-License-Identifier: MIT
#include <oblique/patch/slide_dyads.h>

#include <cmath>

#include <fmt/format.h>

#include <oblique/patch/unit_vector.h>

namespace oblique::patch {

bool SlideDyadPatch::has_circuit(const mechanism::Group& group) {
  const mechanism::GroupForm& form = group.form;
  switch (form.placing) {
    case mechanism::Placing::hinged:
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

LinearForm SlideDyadPatch::constant(double value) {
  LinearForm form;
  form.constant = value;
  return form;
}

VectorForm SlideDyadPatch::arm(const Eigen::Vector2d& local) const {
  const double x = scaled(local.x()), y = scaled(local.y());
  return {combined({{x, &axis_.x}, {-y, &axis_.y}}), combined({{x, &axis_.y}, {y, &axis_.x}})};
}

Eigen::Vector2d SlideDyadPatch::turned(const Eigen::Vector2d& v, const mechanism::BodyState& by) {
  return {by.cosine * v.x() - by.sine * v.y(), by.sine * v.x() + by.cosine * v.y()};
}

VectorForm SlideDyadPatch::sum(const VectorForm& a, double factor, const VectorForm& b) {
  return {combined({{1, &a.x}, {factor, &b.x}}), combined({{1, &a.y}, {factor, &b.y}})};
}

SlideDyadPatch::Locus SlideDyadPatch::locus(const mechanism::Group& group, const mechanism::Condition& c) {
  Locus locus;
  const bool is_body = !group.equations.cores.empty();
  const std::size_t core = is_body ? group.equations.cores.front() : 0;
  const auto body = [core](const mechanism::Configuration& here) -> const mechanism::BodyState& {
    return here.bodies[core];
  };
  if (c.kind == mechanism::Condition::Kind::distance) {
    locus.circle = true;
    locus.radius = c.value;
    locus.at = *points_[c.b.point];
    if (is_body) locus.at = sum(locus.at, -1, arm(c.a.local));
    locus.place = [=](const mechanism::Configuration& here) -> Eigen::Vector2d {
      const Eigen::Vector2d at = here.points[c.b.point].position;
      return is_body ? Eigen::Vector2d(at - turned(c.a.local, body(here))) : at;
    };
    return locus;
  }
  if (c.line.kind == mechanism::LineRef::Kind::carried) {
    const VectorForm unit = arm(c.line.direction);
    locus.direction = {combined({{scaling_.length, &unit.x}}), combined({{scaling_.length, &unit.y}})};
    locus.at = sum(*points_[c.a.point], -1, arm(c.line.point));
    locus.place = [=](const mechanism::Configuration& here) -> Eigen::Vector2d {
      return here.points[c.a.point].position - turned(c.line.point, body(here));
    };
    locus.heading = [=](const mechanism::Configuration& here) {
      return turned(c.line.direction, body(here));
    };
    return locus;
  }
  const auto carrier =
      c.line.kind == mechanism::LineRef::Kind::known ? std::optional(c.line.body) : std::nullopt;
  const LineForm line = line_form(carrier, c.line);
  locus.at = line.at;
  locus.direction = line.direction;
  if (is_body) locus.at = sum(locus.at, -1, arm(c.a.local));
  const std::size_t base = carrier ? mechanism_.bodies[*carrier].points.front().point : 0;
  locus.place = [=](const mechanism::Configuration& here) -> Eigen::Vector2d {
    Eigen::Vector2d at = c.line.point;
    if (carrier) at = here.points[base].position + turned(at, here.bodies[*carrier]);
    return is_body ? Eigen::Vector2d(at - turned(c.a.local, body(here))) : at;
  };
  locus.heading = [=](const mechanism::Configuration& here) -> Eigen::Vector2d {
    return carrier ? turned(c.line.direction, here.bodies[*carrier]) : c.line.direction;
  };
  return locus;
}

void SlideDyadPatch::set_axis(const mechanism::Condition& angle) {
  if (angle.drive) {
    const mechanism::Drive& drive = mechanism_.drives[*angle.drive];
    add_generator(*angle.drive, fmt::format("drive {}: the direction of {}", drive.name,
                                            mechanism_.bodies[drive.body].name));
    axis_ = drives_[*angle.drive].axis;
    return;
  }
  const Eigen::Vector2d heading = unit_vector(angle.value);
  if (angle.line.kind == mechanism::LineRef::Kind::known) {
    axis_ = direction_of(angle.line.body, heading);
  } else {
    axis_ = {constant(heading.x()), constant(heading.y())};
  }
}

std::vector<text::Entry> SlideDyadPatch::with_amplifiers(std::vector<text::Entry> settings) const {
  settings.push_back(diagram::number_setting("gain", options_.gain));
  settings.push_back(diagram::number_setting("bandwidth", bandwidth_));
  return settings;
}

text::Entry SlideDyadPatch::wire(const std::string& block, const char* port, const LinearForm& form) {
  const Terms terms = terms_of(form);
  if (terms.size() == 1) return diagram::wire_setting(port, terms);
  return diagram::wire_setting(port, {{1, add_block(block + "_" + port, "summer", {sum_of(terms)})}});
}

void SlideDyadPatch::add_group(const mechanism::Group& group) {
  const mechanism::GroupEquations& equations = group.equations;
  const mechanism::GroupForm& form = group.form;
  const auto condition = [&](std::size_t index) -> const mechanism::Condition& {
    return equations.conditions[index];
  };
  const bool is_body = !equations.cores.empty();
  const std::string& name =
      is_body ? mechanism_.bodies[equations.cores.front()].name : name_of(equations.free_points.front());
  if (form.angle) set_axis(condition(*form.angle));
  VectorForm unknown;
  if (form.hinge) {
    const mechanism::Condition& hinge = condition(*form.hinge);
    if (!form.angle) add_own_line(group, hinge, condition(form.loci.front()), name);
    unknown = sum(*points_[hinge.b.point], -1, arm(hinge.a.local));
  } else if (condition(form.loci.back()).kind == mechanism::Condition::Kind::along) {
    unknown = add_slider(group, condition(form.loci.back()), name);
  } else {
    unknown = add_crossing(group, locus(group, condition(form.loci[0])),
                           locus(group, condition(form.loci[1])), name);
  }
  if (!is_body) {
    points_[equations.free_points.front()] = unknown;
  } else {
    carry(equations.cores.front(), mechanism_.bodies[equations.cores.front()].points.front().point, unknown);
  }
  for (const mechanism::Link& link : equations.links) {
    const mechanism::Body& body = mechanism_.bodies[link.body];
    bases_[link.body] = {*body.find(link.from), *body.find(link.to)};
    for (const mechanism::BodyPoint& p : body.points) {
      if (!points_[p.point]) points_[p.point] = point_of(link.body, p.local);
    }
  }
  const VectorForm core_axis = axis_;
  for (const mechanism::SliderBlock& block : equations.blocks) {
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

void SlideDyadPatch::carry(std::size_t index, std::size_t base, const VectorForm& at) {
  const mechanism::Body& body = mechanism_.bodies[index];
  for (const mechanism::BodyPoint& p : body.points) {
    if (!points_[p.point]) points_[p.point] = sum(at, 1, arm(p.local - body.find(base)->local));
  }
}

void SlideDyadPatch::add_own_line(const mechanism::Group& group, const mechanism::Condition& hinge,
                                  const mechanism::Condition& on_line, const std::string& name) {
  const Eigen::Vector2d& u = on_line.line.direction;
  const Eigen::Vector2d normal(-u.y(), u.x());
  const VectorForm& p = *points_[hinge.b.point];
  const VectorForm& q = *points_[on_line.a.point];
  const double reach = largest_over_motion([&](const mechanism::Configuration& here) {
    return (here.points[on_line.a.point].position - here.points[hinge.b.point].position).norm();
  });
  const std::string block = add_block(
      name + "_line", "dyad-rpr",
      with_amplifiers(
          {wire(name + "_line", "px", p.x), wire(name + "_line", "py", p.y), wire(name + "_line", "qx", q.x),
           wire(name + "_line", "qy", q.y),
           diagram::number_setting("offset", scaled(normal.dot(on_line.line.point - hinge.a.local))),
           diagram::number_setting("side", group.side), diagram::number_setting("reach", reach)}),
      fmt::format("dyad {} (RPR): {} turns about {}, and its line passes through {}", group.name, name,
                  name_of(hinge.b.point), name_of(on_line.a.point)));
  LinearForm cosine, sine;
  cosine.weights[block + ".cos"] = 1;
  sine.weights[block + ".sin"] = 1;
  axis_ = {combined({{u.x(), &cosine}, {u.y(), &sine}}), combined({{u.x(), &sine}, {-u.y(), &cosine}})};
}

VectorForm SlideDyadPatch::add_crossing(const mechanism::Group& group, const Locus& first,
                                        const Locus& second, const std::string& name) {
  const bool is_body = !group.equations.cores.empty();
  const std::size_t point = is_body ? mechanism_.bodies[group.equations.cores.front()].points.front().point
                                    : group.equations.free_points.front();
  const auto place = [&](const mechanism::Configuration& here) { return here.points[point].position; };
  std::string block;
  if (first.circle) {
    const double reach = largest_over_motion([&](const mechanism::Configuration& here) {
      const Eigen::Vector2d a = second.place(here);
      return std::max({first.radius, (first.place(here) - a).norm(), (place(here) - a).norm()});
    });
    block = add_block(
        name + "_slide", "dyad-rrp",
        with_amplifiers(
            {wire(name + "_slide", "px", first.at.x), wire(name + "_slide", "py", first.at.y),
             wire(name + "_slide", "ax", second.at.x), wire(name + "_slide", "ay", second.at.y),
             wire(name + "_slide", "ux", second.direction.x), wire(name + "_slide", "uy", second.direction.y),
             diagram::number_setting("r", scaled(first.radius)), diagram::number_setting("side", group.side),
             diagram::number_setting("reach", reach)}),
        fmt::format("dyad {} (RRP): at {:.6g} {} from a point, and on a line", group.name, first.radius,
                    mechanism_.length_unit));
  } else {
    const double reach = largest_over_motion([&](const mechanism::Configuration& here) {
      const Eigen::Vector2d a = first.place(here);
      return std::max((second.place(here) - a).norm(), (place(here) - a).norm());
    });
    const mechanism::Configuration& start = motion_.configurations.front();
    const Eigen::Vector2d u = first.heading(start), v = second.heading(start);
    block = add_block(
        name + "_slide", "dyad-prp",
        with_amplifiers(
            {wire(name + "_slide", "ax", first.at.x), wire(name + "_slide", "ay", first.at.y),
             wire(name + "_slide", "ux", first.direction.x), wire(name + "_slide", "uy", first.direction.y),
             wire(name + "_slide", "bx", second.at.x), wire(name + "_slide", "by", second.at.y),
             wire(name + "_slide", "vx", second.direction.x), wire(name + "_slide", "vy", second.direction.y),
             diagram::number_setting("side", u.x() * v.y() - u.y() * v.x() > 0 ? 1 : -1),
             diagram::number_setting("reach", reach)}),
        fmt::format("dyad {} ({}): where two lines meet", group.name, mechanism::kind_name(group.form.kind)));
  }
  VectorForm unknown;
  unknown.x.weights[block + ".x"] = 1;
  unknown.y.weights[block + ".y"] = 1;
  return unknown;
}

VectorForm SlideDyadPatch::add_slider(const mechanism::Group& group, const mechanism::Condition& along,
                                      const std::string& name) {
  const std::string way = add_way(*along.drive);
  const double reach = drives_[*along.drive].way.weights.at(way);
  const Locus line = locus(group, along);
  VectorForm unknown = line.at;
  const auto add = [&](LinearForm& to, const LinearForm& direction, const char* axis) {
    LinearForm product;
    if (direction.weights.empty()) {
      product.weights[way] = direction.constant * reach;
    } else {
      const std::string heading = add_block(name + "_u" + axis, "summer", {sum_of(terms_of(direction))});
      product.weights[add_block(name + "_way_" + axis, "multiplier",
                                {diagram::wire_setting("in", {{1, way}, {1, heading}})})] = reach;
    }
    to.add(product);
  };
  add(unknown.x, line.direction.x, "x");
  add(unknown.y, line.direction.y, "y");
  return unknown;
}

}  // namespace oblique::patch
