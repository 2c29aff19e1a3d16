// SPDX-License-Identifier: MIT
#include <oblique/patch/triad_circuits.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/mechanism/model/plane.h>
#include <oblique/patch/point_circuits.h>

namespace oblique::patch {
namespace {

std::string reason_of(const TriadSplit& split, const PatchOptions& options) {
  if (split.asked_for && !options.split_by_trial) return "This split was asked for.";
  return fmt::format(
      "Of the six splits this one keeps\nfarthest from collinear triangles and from a loop without gain{}.",
      split.asked_for ? ", among those that are stable" : "");
}

std::string comment_of(const PatchSetup& setup, const mechanism::Group& group, const TriadSplit& split) {
  const TriadPoints at = points_of(group, split);
  const std::string &a = setup.name_of(at.a), &b = setup.name_of(at.b), &z = setup.name_of(at.z),
                    &c = setup.name_of(at.c), &e = setup.name_of(at.e), &d = setup.name_of(at.d);
  return fmt::format(
      "triad {}: the distance {}–{} is taken for known, up to {:.4g} {}; then {} is the apex of {}–{}–{},\n"
      "{} that of {}–{}–{}, and {}–{} closes the loop (split {}). {}\n"
      "Its triangles have sines down to {:.2g}, its loop a gain down to {:.2g}{}.",
      group.name, z, b, split.longest, setup.mechanism().length_unit, b, a, b, z, d, b, d, e, z, c,
      split_name(setup.mechanism(), group, split), reason_of(split, setup.options), split.flattest,
      split.least_gain, split.flip == TriadSplit::Flip::none ? "" : ", and it flips");
}

/// The settings of a triangle of the scale `reach`, with its amplifiers and its start.
std::vector<text::Entry> with_start(const PatchSetup& setup, std::vector<text::Entry> settings,
                                    const TriangleStart& start, double reach) {
  settings = with_amplifiers(setup, std::move(settings));
  settings.push_back(diagram::number_setting("start_length", setup.scaled(start.length) / reach));
  settings.push_back(diagram::number_setting("start_cos", start.cosine));
  settings.push_back(diagram::number_setting("start_sin", start.sine));
  settings.push_back(diagram::number_setting("start_angle_cos", start.angle_cosine));
  settings.push_back(diagram::number_setting("start_angle_sin", start.angle_sine));
  return settings;
}

/// What |ZC|² lacks, over l², drives the variable length.
void add_closing_loop(Circuit& circuit, const VectorForm& c, const mechanism::Condition& closing,
                      const TriadSplit& split, const std::string& length, double reach) {
  CircuitWriter& writer = circuit.writer;
  const double l = circuit.setup.scaled(closing.value);
  const VectorForm& z = circuit.places.at(closing.b.point);
  const std::string dx = writer.add_summer(length + "_dx", combined({{1 / l, &c.x}, {-1 / l, &z.x}}));
  const std::string dy = writer.add_summer(length + "_dy", combined({{1 / l, &c.y}, {-1 / l, &z.y}}));
  const std::string dx2 = writer.add_product(length + "_dx2", dx, dx);
  const std::string dy2 = writer.add_product(length + "_dy2", dy, dy);
  const double weight = split.sign * kInputGain;
  add_outer_loop(circuit, length, {{weight, dx2}, {weight, dy2}, {-weight, writer.one()}},
                 circuit.setup.scaled(split.first_w) / reach);
}

}  // namespace

TriadPoints points_of(const mechanism::Group& group, const TriadSplit& split) {
  const auto& conditions = group.equations.conditions;
  const mechanism::Condition &tracked = conditions[split.tracked], &closing = conditions[split.closing],
                             &third = conditions[split.third];
  return {tracked.b.point, tracked.a.point, closing.b.point, closing.a.point, third.b.point, third.a.point};
}

void add_triad(Circuit& circuit, const mechanism::Group& group, const TriadSplit& split) {
  const PatchSetup& setup = circuit.setup;
  CircuitWriter& writer = circuit.writer;
  PointBook& places = circuit.places;
  const auto& conditions = group.equations.conditions;
  const mechanism::Condition& tracked = conditions[split.tracked];
  const mechanism::Condition& third = conditions[split.third];
  const auto [a, b, z, c, e, d] = points_of(group, split);
  const double reach = round_up(setup.scaled(split.reach));
  const double second_reach = round_up(setup.scaled(split.second_reach));
  const std::string length = writer.free_name(setup.name_of(z) + setup.name_of(b));
  const std::string& first_name = setup.name_of(b);
  const std::string first = writer.add_block(
      first_name, "dyad-rrr-variable",
      with_start(
          setup,
          {writer.wire(first_name, "px", places.at(a).x), writer.wire(first_name, "py", places.at(a).y),
           writer.wire(first_name, "qx", places.at(z).x), writer.wire(first_name, "qy", places.at(z).y),
           diagram::wire_setting("r2", {{1, length}}),
           diagram::number_setting("r1", setup.scaled(tracked.value)),
           diagram::number_setting("side", split.first_side), diagram::number_setting("reach", reach)},
          triangle_start(setup.motion, a, z, b), reach),
      comment_of(setup, group, split));
  places.set_signals(b, {first + ".x", first + ".y"});
  const std::string& second_name = setup.name_of(d);
  const std::string second = writer.add_block(
      second_name, "dyad-rrr",
      with_start(
          setup,
          {diagram::wire_setting("px", {x_of(circuit, b, 1)}),
           diagram::wire_setting("py", {y_of(circuit, b, 1)}), writer.wire(second_name, "qx", places.at(e).x),
           writer.wire(second_name, "qy", places.at(e).y),
           diagram::number_setting("r1", setup.scaled((third.a.local - tracked.a.local).norm())),
           diagram::number_setting("r2", setup.scaled(third.value)),
           diagram::number_setting("side", split.second_side),
           diagram::number_setting("reach", second_reach)},
          triangle_start(setup.motion, b, e, d), second_reach));
  places.set_signals(d, {second + ".x", second + ".y"});
  carry_triad(places, group, b, d);
  const VectorForm joint = places.at(c);  // by B and D, without the summer that it gets
  add_formed_points(circuit, group);
  add_closing_loop(circuit, joint, conditions[split.closing], split, length, reach);
}

void carry_triad(PointBook& places, const mechanism::Group& group, std::size_t b, std::size_t d) {
  const std::size_t platform = group.equations.platforms.front();
  places.set_base(platform, b, d);
  places.carry(platform);
  for (const mechanism::BinaryLink& link : group.equations.binary_links) {
    places.set_base(link.body, link.from, link.to);
    places.carry(link.body);
  }
}

TriangleStart triangle_start(const mechanism::Motion& motion, std::size_t p, std::size_t q, std::size_t c) {
  const mechanism::Configuration& start = motion.configurations.front();
  const Eigen::Vector2d d = start.points[q].position - start.points[p].position;
  const Eigen::Vector2d e = start.points[c].position - start.points[p].position;
  const double lengths = d.norm() * e.norm();
  const auto cosine = [](double value) { return std::clamp(value, -1.0, 1.0); };
  return {d.norm(), cosine(d.x() / d.norm()), cosine(d.y() / d.norm()), cosine(d.dot(e) / lengths),
          cosine(std::abs(mechanism::cross(d, e)) / lengths)};
}

void add_outer_loop(Circuit& circuit, const std::string& length, const Terms& residual, double initial) {
  const PatchOptions& options = circuit.setup.options;
  const double slower = options.slower.value_or(kUsualSlower);
  circuit.writer.add_named(
      length, "servo-amplifier",
      {diagram::wire_setting("in", residual), diagram::number_setting("gain", options.gain),
       diagram::number_setting("bandwidth", circuit.setup.bandwidth / slower),
       diagram::number_setting("initial", initial)},
      slower == 1 ? "the outer loop" : fmt::format("the outer loop, {:g} times slower", slower));
}

}  // namespace oblique::patch
