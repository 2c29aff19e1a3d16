// SPDX-License-Identifier: MIT
#include <oblique/patch/patch_builder.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include <fmt/format.h>

namespace oblique {
namespace {

/// Positions over the turn from which the scaling is taken: half a degree apart.
constexpr int kScalingPositions = 721;

Structure structure_of(const Mechanism& mechanism) {
  Structure structure = decompose(mechanism);
  for (const Drive& drive : mechanism.drives) {
    if (!drive.law) continue;
    throw PatchError(Diagnostic{
        drive.place,
        fmt::format("drive '{}' has a speed that varies, which no block of the patch can make", drive.name),
        "constant speeds", "give a number as its speed; `oblique solve` follows the law"});
  }
  return structure;
}

}  // namespace

Motion patch_motion(const Mechanism& mechanism, const Structure& structure) {
  std::vector<double> times;
  times.reserve(kScalingPositions);
  const double turn = period(mechanism);
  for (int k = 0; k < kScalingPositions; ++k) times.push_back(turn * k / (kScalingPositions - 1));
  return solve_motion(mechanism, structure, times);
}

PatchBuilder::PatchBuilder(const Mechanism& mechanism, const PatchOptions& options)
    : mechanism_(mechanism),
      options_(options),
      structure_(structure_of(mechanism)),
      motion_(patch_motion(mechanism, structure_)),
      scaling_(find_scaling(mechanism, structure_, motion_)),
      bandwidth_(options.bandwidth.value_or(default_bandwidth(mechanism))),
      signals_(mechanism.points.size()),
      points_(mechanism.points.size()) {
  if (options.unit) scaling_.length = *options.unit;
  for (std::size_t point = 0; point < points_.size(); ++point) {
    if (mechanism.points[point].fixed) set_known(point);
  }
}

void PatchBuilder::describe(const std::string& method, const std::string& remarks) {
  diagram_.title = mechanism_.title.empty() ? "Mechanism" : mechanism_.title;
  diagram_.title += ", " + method;
  diagram_.source = mechanism_.source;
  diagram_.comment =
      fmt::format("Coordinates: 1 machine unit = {} {}{}. {}", scaling_.length, mechanism_.length_unit,
                  scaling_.origin.isZero(0) ? "" : fmt::format(", from {}", name_of(0)), remarks);
  diagram_.run.until = period(mechanism_);
  diagram_.run.tolerance = options_.tolerance;
  diagram_.run.samples = options_.samples;
}

void PatchBuilder::add_reference() {
  one_ = add_block("one", "constant", {number_setting("value", 1)}, "the reference: 1 machine unit");
}

std::string PatchBuilder::free_name(const std::string& wanted) {
  std::string name = wanted;
  for (int k = 2; is_reserved(name) || !names_.insert(name).second; ++k)
    name = fmt::format("{}_{}", wanted, k);
  return name;
}

std::string PatchBuilder::add_block(const std::string& wanted, std::string type, std::vector<Entry> settings,
                                    std::string comment) {
  BlockInstance block;
  block.name = free_name(wanted);
  block.type = std::move(type);
  block.settings = std::move(settings);
  block.comment = std::move(comment);
  diagram_.blocks.push_back(std::move(block));
  return diagram_.blocks.back().name;
}

WeightedSignal PatchBuilder::x_of(std::size_t point, double weight) const {
  const Point& p = mechanism_.points[point];
  return p.fixed ? WeightedSignal{weight * scaled(p.position.x() - scaling_.origin.x()), one_}
                 : WeightedSignal{weight, signals_[point].x};
}

WeightedSignal PatchBuilder::y_of(std::size_t point, double weight) const {
  const Point& p = mechanism_.points[point];
  return p.fixed ? WeightedSignal{weight * scaled(p.position.y() - scaling_.origin.y()), one_}
                 : WeightedSignal{weight, signals_[point].y};
}

Entry PatchBuilder::sum_of(const Terms& terms) {
  Terms kept;
  for (const WeightedSignal& term : terms) {
    if (term.weight != 0) kept.push_back(term);
  }
  if (kept.empty()) kept.push_back(terms.front());
  return wire_setting("in", kept);
}

void PatchBuilder::add_summed_point(std::size_t point, const Terms& x, const Terms& y,
                                    const std::string& comment) {
  signals_[point].x = add_block(name_of(point) + "_x", "summer", {sum_of(x)}, comment);
  signals_[point].y = add_block(name_of(point) + "_y", "summer", {sum_of(y)});
}

std::string PatchBuilder::add_crank(const Group& crank) {
  const Drive& drive = mechanism_.drives[crank.drives.front()];
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
  return generator;
}

void PatchBuilder::add_carried_points(const Body& body, std::size_t p, std::size_t c) {
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

void PatchBuilder::add_outputs() {
  for (std::size_t point = 0; point < mechanism_.points.size(); ++point) {
    if (mechanism_.points[point].fixed) continue;
    const auto add = [&](const char* axis, const std::string& signal, double origin) {
      diagram_.outputs.push_back(
          {name_of(point) + axis, signal, scaling_.length, mechanism_.length_unit, {}, origin});
    };
    add(".x", signals_[point].x, scaling_.origin.x());
    add(".y", signals_[point].y, scaling_.origin.y());
  }
}

void PatchBuilder::set_known(std::size_t point) {
  const Point& p = mechanism_.points[point];
  VectorForm form;
  if (p.fixed) {
    form.x.constant = scaled(p.position.x() - scaling_.origin.x());
    form.y.constant = scaled(p.position.y() - scaling_.origin.y());
  } else {
    form.x.weights[signals_[point].x] = 1;
    form.y.weights[signals_[point].y] = 1;
  }
  points_[point] = form;
}

const std::pair<BodyPoint, BodyPoint>& PatchBuilder::base_of(std::size_t body) {
  const auto& points = mechanism_.bodies[body].points;
  return bases_.try_emplace(body, points[0], points[1]).first->second;
}

VectorForm PatchBuilder::direction_of(std::size_t body, const Eigen::Vector2d& local) {
  const auto& [p, c] = base_of(body);
  const Eigen::Vector2d base = c.local - p.local;
  const double squared = base.squaredNorm() / scaling_.length;
  const double a = base.dot(local) / squared, b = (base.x() * local.y() - base.y() * local.x()) / squared;
  const VectorForm& from = *points_[p.point];
  const VectorForm& to = *points_[c.point];
  return {combined({{a, &to.x}, {-a, &from.x}, {-b, &to.y}, {b, &from.y}}),
          combined({{a, &to.y}, {-a, &from.y}, {b, &to.x}, {-b, &from.x}})};
}

VectorForm PatchBuilder::point_of(std::size_t body, const Eigen::Vector2d& local) {
  const auto& [p, c] = base_of(body);
  VectorForm way = direction_of(body, (local - p.local) / scaling_.length);
  way.x.add(points_[p.point]->x);
  way.y.add(points_[p.point]->y);
  return way;
}

PatchBuilder::LineForm PatchBuilder::line_form(const std::optional<std::size_t>& carrier,
                                               const LineRef& line) {
  if (carrier) return {point_of(*carrier, line.point), direction_of(*carrier, line.direction)};
  LineForm form;
  form.at.x.constant = scaled(line.point.x() - scaling_.origin.x());
  form.at.y.constant = scaled(line.point.y() - scaling_.origin.y());
  form.direction.x.constant = line.direction.x();
  form.direction.y.constant = line.direction.y();
  return form;
}

PatchBuilder::Terms PatchBuilder::terms_of(const LinearForm& form) const {
  double largest = std::abs(form.constant);
  for (const auto& [signal, weight] : form.weights) largest = std::max(largest, std::abs(weight));
  // the rounding of a cosine of 90° is no potentiometer
  constexpr double kRounding = 1e-15;
  Terms terms;
  for (const auto& [signal, weight] : form.weights) {
    if (std::abs(weight) > kRounding * largest) terms.push_back({weight, signal});
  }
  if (std::abs(form.constant) > kRounding * largest || terms.empty()) terms.push_back({form.constant, one_});
  return terms;
}

void PatchBuilder::refuse(const Group& group, const std::string& why, const std::string& expected,
                          const std::string& remedy) const {
  throw PatchError(Diagnostic{group.bodies.empty() ? mechanism_.slides[group.slides.front()].place
                                                   : mechanism_.bodies[group.bodies.front()].place,
                              fmt::format("the group {} ({}) {}", group.name, kind_name(group.kind), why),
                              expected, remedy});
}

}  // namespace oblique
