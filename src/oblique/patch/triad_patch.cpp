// SPDX-License-Identifier: MIT
#include <oblique/patch/triad_patch.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/mechanism/model/plane.h>

namespace oblique::patch {
namespace {

std::string reason_of(const TriadSplit& split, const PatchOptions& options) {
  if (split.asked_for && !options.split_by_trial) return "This split was asked for.";
  return fmt::format(
      "Of the six splits this one keeps\nfarthest from collinear triangles and from a loop without gain{}.",
      split.asked_for ? ", among those that are stable" : "");
}

}  // namespace

void TriadPatch::add_triad(const mechanism::Group& group, const TriadSplit& split) {
  const auto& conditions = group.equations.conditions;
  const mechanism::Condition& tracked = conditions[split.tracked];
  const mechanism::Condition& closing = conditions[split.closing];
  const mechanism::Condition& third = conditions[split.third];
  const std::size_t a = tracked.b.point, b = tracked.a.point;
  const std::size_t z = closing.b.point, c = closing.a.point;
  const std::size_t e = third.b.point, d = third.a.point;
  const double reach = round_up(scaled(split.reach));
  const double second_reach = round_up(scaled(split.second_reach));
  const std::string length = free_name(name_of(z) + name_of(b));
  const std::string comment = fmt::format(
      "triad {}: the distance {}–{} is taken for known, up to {:.4g} {}; then {} is the apex of {}–{}–{},\n"
      "{} that of {}–{}–{}, and {}–{} closes the loop (split {}). {}\n"
      "Its triangles have sines down to {:.2g}, its loop a gain down to {:.2g}{}.",
      group.name, name_of(z), name_of(b), split.longest, mechanism_.length_unit, name_of(b), name_of(a),
      name_of(b), name_of(z), name_of(d), name_of(b), name_of(d), name_of(e), name_of(z), name_of(c),
      split_name(mechanism_, group, split), reason_of(split, options_), split.flattest, split.least_gain,
      split.flip == TriadSplit::Flip::none ? "" : ", and it flips");
  const std::string& first_name = name_of(b);
  const std::string first = add_block(
      first_name, "dyad-rrr-variable",
      with_start(
          with_amplifiers({wire(first_name, "px", points_[a]->x), wire(first_name, "py", points_[a]->y),
                           wire(first_name, "qx", points_[z]->x), wire(first_name, "qy", points_[z]->y),
                           diagram::wire_setting("r2", {{1, length}}),
                           diagram::number_setting("r1", scaled(tracked.value)),
                           diagram::number_setting("side", split.first_side),
                           diagram::number_setting("reach", reach)}),
          triangle_start(a, z, b), reach),
      comment);
  signals_[b] = {first + ".x", first + ".y"};
  const std::string& second_name = name_of(d);
  const std::string second = add_block(
      second_name, "dyad-rrr",
      with_start(with_amplifiers(
                     {diagram::wire_setting("px", {x_of(b, 1)}), diagram::wire_setting("py", {y_of(b, 1)}),
                      wire(second_name, "qx", points_[e]->x), wire(second_name, "qy", points_[e]->y),
                      diagram::number_setting("r1", scaled((third.a.local - tracked.a.local).norm())),
                      diagram::number_setting("r2", scaled(third.value)),
                      diagram::number_setting("side", split.second_side),
                      diagram::number_setting("reach", second_reach)}),
                 triangle_start(b, e, d), second_reach));
  signals_[d] = {second + ".x", second + ".y"};
  carry_triad(group, b, d);
  add_closing_loop(closing, split, length, reach);
}

void TriadPatch::carry_triad(const mechanism::Group& group, std::size_t b, std::size_t d) {
  set_known(b);
  set_known(d);
  const std::size_t core = group.equations.cores.front();
  const mechanism::Body& platform = mechanism_.bodies[core];
  bases_[core] = {*platform.find(b), *platform.find(d)};
  for (const mechanism::BodyPoint& p : platform.points) {
    if (!points_[p.point]) points_[p.point] = point_of(core, p.local);
  }
  for (const mechanism::Link& link : group.equations.links) {
    const mechanism::Body& body = mechanism_.bodies[link.body];
    bases_[link.body] = {*body.find(link.from), *body.find(link.to)};
    for (const mechanism::BodyPoint& p : body.points) {
      if (!points_[p.point]) points_[p.point] = point_of(link.body, p.local);
    }
  }
  for (const std::size_t point : group.points) {
    if (signals_[point].x.empty())
      add_summed_point(point, terms_of(points_[point]->x), terms_of(points_[point]->y), {});
  }
}

TriadPatch::TriangleStart TriadPatch::triangle_start(std::size_t p, std::size_t q, std::size_t c) const {
  const mechanism::Configuration& start = motion_.configurations.front();
  const Eigen::Vector2d d = start.points[q].position - start.points[p].position;
  const Eigen::Vector2d e = start.points[c].position - start.points[p].position;
  const double lengths = d.norm() * e.norm();
  const auto cosine = [](double value) { return std::clamp(value, -1.0, 1.0); };
  return {d.norm(), cosine(d.x() / d.norm()), cosine(d.y() / d.norm()), cosine(d.dot(e) / lengths),
          cosine(std::abs(mechanism::cross(d, e)) / lengths)};
}

std::vector<text::Entry> TriadPatch::with_start(std::vector<text::Entry> settings, const TriangleStart& start,
                                                double reach) const {
  settings.push_back(diagram::number_setting("start_length", scaled(start.length) / reach));
  settings.push_back(diagram::number_setting("start_cos", start.cosine));
  settings.push_back(diagram::number_setting("start_sin", start.sine));
  settings.push_back(diagram::number_setting("start_angle_cos", start.angle_cosine));
  settings.push_back(diagram::number_setting("start_angle_sin", start.angle_sine));
  return settings;
}

void TriadPatch::add_outer_loop(const std::string& length, const Terms& residual, double initial) {
  const double slower = options_.slower.value_or(kUsualSlower);
  diagram::BlockInstance loop;
  loop.name = length;
  loop.type = "servo-amplifier";
  loop.settings = {diagram::wire_setting("in", residual), diagram::number_setting("gain", options_.gain),
                   diagram::number_setting("bandwidth", bandwidth_ / slower),
                   diagram::number_setting("initial", initial)};
  loop.comment = slower == 1 ? "the outer loop" : fmt::format("the outer loop, {:g} times slower", slower);
  diagram_.blocks.push_back(std::move(loop));
}

/// What |ZC|² lacks, over l², drives the variable length.
void TriadPatch::add_closing_loop(const mechanism::Condition& closing, const TriadSplit& split,
                                  const std::string& length, double reach) {
  const double l = scaled(closing.value);
  const VectorForm& c = *points_[closing.a.point];
  const VectorForm& z = *points_[closing.b.point];
  const std::string dx =
      add_block(length + "_dx", "summer", {sum_of(terms_of(combined({{1 / l, &c.x}, {-1 / l, &z.x}})))});
  const std::string dy =
      add_block(length + "_dy", "summer", {sum_of(terms_of(combined({{1 / l, &c.y}, {-1 / l, &z.y}})))});
  const std::string dx2 =
      add_block(length + "_dx2", "multiplier", {diagram::wire_setting("in", {{1, dx}, {1, dx}})});
  const std::string dy2 =
      add_block(length + "_dy2", "multiplier", {diagram::wire_setting("in", {{1, dy}, {1, dy}})});
  const double weight = split.sign * kInputGain;
  add_outer_loop(length, {{weight, dx2}, {weight, dy2}, {-weight, one_}}, scaled(split.first_w) / reach);
}

}  // namespace oblique::patch
