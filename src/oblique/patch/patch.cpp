// SPDX-License-Identifier: MIT
#include <oblique/patch/patch.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include <oblique/patch/scaling.h>

namespace oblique {
namespace {

/// Positions over the turn from which the scaling is taken: half a degree apart.
constexpr int kScalingPositions = 721;

class TrianglePatch {
 public:
  TrianglePatch(const Mechanism& mechanism, const PatchOptions& options)
      : mechanism_(mechanism),
        options_(options),
        structure_(decompose(mechanism)),
        scaling_(find_scaling(mechanism, structure_, scaling_motion())),
        bandwidth_(options.bandwidth.value_or(default_bandwidth(mechanism))),
        signals_(mechanism.points.size()) {}

  Diagram make() {
    describe();
    one_ = add_block("one", "constant", {number_setting("value", 1)}, "the reference: 1 machine unit");
    for (std::size_t g = 0; g < structure_.groups.size(); ++g) {
      const Group& group = structure_.groups[g];
      if (group.kind == GroupKind::crank) {
        add_crank(group);
      } else if (const auto dyad = dyad_of(group)) {
        add_dyad(group.name, *dyad, scaling_.triangles[g]);
      } else {
        refuse(group);
      }
    }
    for (std::size_t p = 0; p < mechanism_.points.size(); ++p) add_outputs(p);
    return std::move(diagram_);
  }

 private:
  using Terms = std::vector<WeightedSignal>;
  struct PointSignals {
    std::string x, y;
  };

  Motion scaling_motion() const {
    std::vector<double> times;
    times.reserve(kScalingPositions);
    const double turn = period(mechanism_);
    for (int k = 0; k < kScalingPositions; ++k) times.push_back(turn * k / (kScalingPositions - 1));
    return solve_motion(mechanism_, structure_, times);
  }

  void describe() {
    diagram_.title = mechanism_.title.empty() ? "Mechanism" : mechanism_.title;
    diagram_.title += ", patched as servo-tracked triangles";
    diagram_.source = mechanism_.source;
    diagram_.comment = fmt::format(
        "Coordinates: 1 machine unit = {0} {1}{5}. Each dyad's triangle has a scale of its own (`reach`), so "
        "that its longest\n"
        "side is about 1 machine unit. Servo amplifiers: gain {2}, bandwidth {3} Hz. Run over one turn of "
        "'{4}'.",
        scaling_.length, mechanism_.length_unit, options_.gain, bandwidth_, mechanism_.drives.front().name,
        scaling_.origin.isZero(0) ? "" : fmt::format(", from {}", name_of(0)));
    diagram_.run.until = period(mechanism_);
    diagram_.run.tolerance = options_.tolerance;
    diagram_.run.samples = options_.samples;
  }

  const std::string& name_of(std::size_t point) const { return mechanism_.points[point].name; }
  double scaled(double length) const { return length / scaling_.length; }

  /// Adds a block under `wanted`, or under the next free name that a block may have, and returns the name it
  /// has.
  std::string add_block(const std::string& wanted, std::string type, std::vector<Entry> settings,
                        std::string comment = {}) {
    std::string name = wanted;
    for (int k = 2; is_reserved(name) || !names_.insert(name).second; ++k)
      name = fmt::format("{}_{}", wanted, k);
    BlockInstance block;
    block.name = name;
    block.type = std::move(type);
    block.settings = std::move(settings);
    block.comment = std::move(comment);
    diagram_.blocks.push_back(std::move(block));
    return name;
  }

  /// weight · coordinate as a term; a fixed point is a weight on the reference.
  WeightedSignal x_of(std::size_t point, double weight) const {
    const Point& p = mechanism_.points[point];
    return p.fixed ? WeightedSignal{weight * scaled(p.position.x() - scaling_.origin.x()), one_}
                   : WeightedSignal{weight, signals_[point].x};
  }
  WeightedSignal y_of(std::size_t point, double weight) const {
    const Point& p = mechanism_.points[point];
    return p.fixed ? WeightedSignal{weight * scaled(p.position.y() - scaling_.origin.y()), one_}
                   : WeightedSignal{weight, signals_[point].y};
  }

  static Entry sum_of(const Terms& terms) {
    Terms kept;
    for (const WeightedSignal& term : terms) {
      if (term.weight != 0) kept.push_back(term);
    }
    if (kept.empty()) kept.push_back(terms.front());
    return wire_setting("in", kept);
  }

  void add_summed_point(std::size_t point, const Terms& x, const Terms& y, const std::string& comment) {
    signals_[point].x = add_block(name_of(point) + "_x", "summer", {sum_of(x)}, comment);
    signals_[point].y = add_block(name_of(point) + "_y", "summer", {sum_of(y)});
  }

  [[noreturn]] void refuse(const Group& group) const {
    throw PatchError(
        Diagnostic{group.bodies.empty() ? mechanism_.slides[group.slides.front()].place
                                        : mechanism_.bodies[group.bodies.front()].place,
                   fmt::format("the group {} ({}) cannot be patched as triangles by this version", group.name,
                               kind_name(group.kind)),
                   "cranks at constant speed and RRR dyads",
                   "`oblique solve` and `oblique check` work for every group"});
  }

  void add_crank(const Group& crank) {
    const Drive& drive = mechanism_.drives[crank.drives.front()];
    if (drive.law) refuse(crank);
    const Body& body = mechanism_.bodies[drive.body];
    const std::size_t pivot = pivot_of(crank);
    const std::string comment =
        fmt::format("crank {}: turns about {} at {:.6g} rad/s", body.name, name_of(pivot), drive.speed);
    const std::string generator =
        add_block(drive.name, "crank-generator",
                  {wire_setting("speed", {{1, one_}}), number_setting("rate", drive.speed),
                   number_setting("start", drive.start)},
                  comment);
    const std::string cosine = generator + ".cos", sine = generator + ".sin";
    const Eigen::Vector2d origin = body.find(pivot)->local;
    for (const BodyPoint& point : body.points) {
      if (point.point == pivot || is_known(point.point)) continue;
      const double along = scaled(point.local.x() - origin.x());
      const double left = scaled(point.local.y() - origin.y());
      add_summed_point(point.point, {x_of(pivot, 1), {along, cosine}, {-left, sine}},
                       {y_of(pivot, 1), {along, sine}, {left, cosine}}, {});
    }
  }

  bool is_known(std::size_t point) const {
    return mechanism_.points[point].fixed || !signals_[point].x.empty();
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

  /// Points of a body of which P and C are known: M − P = (a + i b)(C − P), with a + i b from the body's own
  /// frame.
  void add_carried_points(const Body& body, std::size_t p, std::size_t c) {
    const auto local = [&](std::size_t point) {
      const Eigen::Vector2d& at = body.find(point)->local;
      return std::complex<double>(at.x(), at.y());
    };
    for (const BodyPoint& point : body.points) {
      if (is_known(point.point)) continue;
      const std::complex<double> ratio = (local(point.point) - local(p)) / (local(c) - local(p));
      const double a = ratio.real(), b = ratio.imag();
      add_summed_point(point.point, {x_of(p, 1 - a), x_of(c, a), y_of(c, -b), y_of(p, b)},
                       {y_of(p, 1 - a), y_of(c, a), x_of(c, b), x_of(p, -b)},
                       fmt::format("{}, carried by {}", name_of(point.point), body.name));
    }
  }

  void add_outputs(std::size_t point) {
    if (mechanism_.points[point].fixed) return;
    const auto add = [&](const char* axis, const std::string& signal, double origin) {
      diagram_.outputs.push_back(
          {name_of(point) + axis, signal, scaling_.length, mechanism_.length_unit, {}, origin});
    };
    add(".x", signals_[point].x, scaling_.origin.x());
    add(".y", signals_[point].y, scaling_.origin.y());
  }

  const Mechanism& mechanism_;
  const PatchOptions& options_;
  Structure structure_;
  Scaling scaling_;
  double bandwidth_;
  std::vector<PointSignals> signals_;
  std::set<std::string> names_;
  std::string one_;
  Diagram diagram_;
};

}  // namespace

double default_bandwidth(const Mechanism& mechanism) {
  double fastest = 0;
  for (const Drive& drive : mechanism.drives) fastest = std::max(fastest, std::abs(drive.speed));
  const double wanted = 100 * fastest / (2 * std::numbers::pi);
  const double decade = std::pow(10, std::floor(std::log10(wanted)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * decade >= wanted) return step * decade;
  }
  return 10 * decade;
}

Diagram patch_triangles(const Mechanism& mechanism, const PatchOptions& options) {
  return TrianglePatch(mechanism, options).make();
}

}  // namespace oblique
