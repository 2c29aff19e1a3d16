// SPDX-License-Identifier: MIT
// Mechanism → diagram by servo-tracked oblique triangles.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include <oblique/patch/slide_dyads.h>
#include <oblique/patch/triad_split.h>

namespace oblique {
namespace {

class TrianglePatch : private SlideDyadPatch {
 public:
  using SlideDyadPatch::SlideDyadPatch;

  Diagram make() {
    check_groups();
    describe(
        "patched as servo-tracked triangles",
        fmt::format("Each dyad's triangle has a scale of its own (`reach`), so that its longest\n"
                    "side is about 1 machine unit. Servo amplifiers: gain {}, bandwidth {} Hz. Run over {}.",
                    options_.gain, bandwidth_, span_text()));
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
    if (options_.derivatives) add_rates();
    add_outputs();
    return std::move(diagram_);
  }

 private:
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
        with_start(
            with_amplifiers({wire(name_of(b), "px", points_[tracked.b.point]->x),
                             wire(name_of(b), "py", points_[tracked.b.point]->y),
                             wire(name_of(b), "qx", points_[closing.b.point]->x),
                             wire(name_of(b), "qy", points_[closing.b.point]->y),
                             wire_setting("r2", {{1, length}}), number_setting("r1", scaled(tracked.value)),
                             number_setting("side", split.first_side), number_setting("reach", reach)}),
            tracked.b.point, closing.b.point, b, reach),
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
    const double second_reach = round_up(scaled(longest));
    const std::string second = add_block(
        name_of(d), "dyad-rrr",
        with_start(with_amplifiers({wire_setting("px", {x_of(b, 1)}), wire_setting("py", {y_of(b, 1)}),
                                    wire(name_of(d), "qx", points_[third.b.point]->x),
                                    wire(name_of(d), "qy", points_[third.b.point]->y),
                                    number_setting("r1", scaled((third.a.local - tracked.a.local).norm())),
                                    number_setting("r2", scaled(third.value)),
                                    number_setting("side", split.second_side),
                                    number_setting("reach", second_reach)}),
                   b, third.b.point, d, second_reach));
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

  /// Where the loops of a dyad on P and Q with the apex C stand at the start: a group of loops that hang on
  /// each other finds its rest from there.
  std::vector<Entry> with_start(std::vector<Entry> settings, std::size_t p, std::size_t q, std::size_t c,
                                double reach) const {
    const Configuration& start = motion_.configurations.front();
    const Eigen::Vector2d d = start.points[q].position - start.points[p].position;
    const Eigen::Vector2d e = start.points[c].position - start.points[p].position;
    const double lengths = d.norm() * e.norm();
    const auto cosine = [](double value) { return std::clamp(value, -1.0, 1.0); };
    settings.push_back(number_setting("start_length", scaled(d.norm()) / reach));
    settings.push_back(number_setting("start_cos", cosine(d.x() / d.norm())));
    settings.push_back(number_setting("start_sin", cosine(d.y() / d.norm())));
    settings.push_back(number_setting("start_angle_cos", cosine(d.dot(e) / lengths)));
    settings.push_back(
        number_setting("start_angle_sin", cosine(std::abs(d.x() * e.y() - d.y() * e.x()) / lengths)));
    return settings;
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
};

}  // namespace

Diagram patch_triangles(const Mechanism& mechanism, const PatchOptions& options) {
  return TrianglePatch(mechanism, options).make();
}

}  // namespace oblique
