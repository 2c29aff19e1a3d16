// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/patch_builder.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include <fmt/format.h>

namespace oblique::patch {
namespace {

/// Positions over the turn from which the scaling is taken: half a degree apart.
constexpr int kScalingPositions = 721;

}  // namespace

mechanism::Motion patch_motion(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure) {
  std::vector<double> times;
  times.reserve(kScalingPositions);
  const double turn = mechanism::period(mechanism);
  for (int k = 0; k < kScalingPositions; ++k) times.push_back(turn * k / (kScalingPositions - 1));
  return mechanism::solve_motion(mechanism, structure, times);
}

PatchBuilder::PatchBuilder(const mechanism::Mechanism& mechanism, const PatchOptions& options)
    : MachineTime(mechanism, options),
      PointForms(slowed),
      options_(options),
      structure_(mechanism::decompose(mechanism_)),
      motion_(patch_motion(mechanism_, structure_)),
      scaling_(find_scaling(mechanism_, structure_, motion_)),
      bandwidth_(options.bandwidth.value_or(default_bandwidth(mechanism_))),
      signals_(mechanism.points.size()),
      drives_(mechanism.drives.size()),
      speeds_(mechanism.drives.size()) {
  if (options.unit) scaling_.length = *options.unit;
  set_scale(scaling_);
}

void PatchBuilder::describe(const std::string& method, const std::string& remarks) {
  diagram_.title = mechanism_.title.empty() ? "Mechanism" : mechanism_.title;
  diagram_.title += ", " + method;
  diagram_.source = mechanism_.source;
  diagram_.comment =
      fmt::format("Coordinates: 1 machine unit = {} {}{}. {}", scaling_.length, mechanism_.length_unit,
                  scaling_.origin.isZero(0) ? "" : fmt::format(", from {}", name_of(0)), remarks);
  if (options_.period)
    diagram_.comment += fmt::format("\nTime: 1 s of the machine is {:.6g} s of the mechanism.", factor);
  diagram_.run.until = mechanism::period(mechanism_);
  diagram_.run.tolerance = options_.tolerance;
  diagram_.run.samples = options_.samples;
}

std::string PatchBuilder::span_text() const {
  return mechanism_.motion.until ? fmt::format("the {:.6g} s of its motion", *mechanism_.motion.until)
                                 : fmt::format("one turn of '{}'", mechanism_.drives.front().name);
}

void PatchBuilder::add_reference() {
  one_ = add_block("one", "constant", {diagram::number_setting("value", 1)}, "the reference: 1 machine unit");
}

std::string PatchBuilder::free_name(const std::string& wanted) {
  std::string name = wanted;
  for (int k = 2; diagram::is_reserved(name) || !names_.insert(name).second; ++k)
    name = fmt::format("{}_{}", wanted, k);
  return name;
}

std::string PatchBuilder::add_block(const std::string& wanted, std::string type,
                                    std::vector<text::Entry> settings, std::string comment) {
  diagram::BlockInstance block;
  block.name = free_name(wanted);
  block.type = std::move(type);
  block.settings = std::move(settings);
  block.comment = std::move(comment);
  diagram_.blocks.push_back(std::move(block));
  return diagram_.blocks.back().name;
}

diagram::WeightedSignal PatchBuilder::x_of(std::size_t point, double weight) const {
  const mechanism::Point& p = mechanism_.points[point];
  return p.fixed ? diagram::WeightedSignal{weight * scaled(p.position.x() - scaling_.origin.x()), one_}
                 : diagram::WeightedSignal{weight, signals_[point].x};
}

diagram::WeightedSignal PatchBuilder::y_of(std::size_t point, double weight) const {
  const mechanism::Point& p = mechanism_.points[point];
  return p.fixed ? diagram::WeightedSignal{weight * scaled(p.position.y() - scaling_.origin.y()), one_}
                 : diagram::WeightedSignal{weight, signals_[point].y};
}

text::Entry PatchBuilder::sum_of(const Terms& terms) {
  Terms kept;
  for (const diagram::WeightedSignal& term : terms) {
    if (term.weight != 0) kept.push_back(term);
  }
  if (kept.empty()) kept.push_back(terms.front());
  return diagram::wire_setting("in", kept);
}

void PatchBuilder::add_summed_point(std::size_t point, const Terms& x, const Terms& y,
                                    const std::string& comment) {
  signals_[point].x = add_block(name_of(point) + "_x", "summer", {sum_of(x)}, comment);
  signals_[point].y = add_block(name_of(point) + "_y", "summer", {sum_of(y)});
}

VectorForm PatchBuilder::crank_point(const mechanism::Group& crank, const mechanism::BodyPoint& point) const {
  const std::size_t d = crank.drives.front();
  const std::size_t pivot = mechanism::pivot_of(crank);
  const Eigen::Vector2d arm = point.local - mechanism_.bodies[mechanism_.drives[d].body].find(pivot)->local;
  const double along = scaled(arm.x()), left = scaled(arm.y());
  const VectorForm& at = *points_[pivot];
  const VectorForm& axis = drives_[d].axis;
  return {combined({{1, &at.x}, {along, &axis.x}, {-left, &axis.y}}),
          combined({{1, &at.y}, {along, &axis.y}, {left, &axis.x}})};
}

std::string PatchBuilder::add_crank(const mechanism::Group& crank) {
  const std::size_t d = crank.drives.front();
  const mechanism::Drive& drive = mechanism_.drives[d];
  const mechanism::Body& body = mechanism_.bodies[drive.body];
  const std::size_t pivot = mechanism::pivot_of(crank);
  std::string generator = add_generator(
      d, fmt::format("crank {}: turns about {} at {}", body.name, name_of(pivot), speed_text(drive)));
  for (const mechanism::BodyPoint& point : body.points) {
    if (point.point == pivot || is_known(point.point)) continue;
    const VectorForm form = crank_point(crank, point);
    add_summed_point(point.point, terms_of(form.x), terms_of(form.y), {});
  }
  return generator;
}

void PatchBuilder::add_carried_points(const mechanism::Body& body, std::size_t p, std::size_t c) {
  const auto local = [&](std::size_t point) {
    const Eigen::Vector2d& at = body.find(point)->local;
    return std::complex<double>(at.x(), at.y());
  };
  for (const mechanism::BodyPoint& point : body.points) {
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
    if (rate_signals_.empty()) continue;
    const std::string& length = mechanism_.length_unit;
    const auto add_rate = [&](const char* axis, const std::string& signal, double unit, const char* per) {
      diagram_.outputs.push_back({name_of(point) + axis, signal, unit, length + per, {}});
    };
    const RateSignals& rates = rate_signals_[point];
    const double velocity_unit = velocity_unit_ / factor;  // rates stay those of the mechanism
    const double acceleration_unit = acceleration_unit_ / (factor * factor);
    add_rate(".vx", rates.vx, velocity_unit, "/s");
    add_rate(".vy", rates.vy, velocity_unit, "/s");
    add_rate(".ax", rates.ax, acceleration_unit, "/s^2");
    add_rate(".ay", rates.ay, acceleration_unit, "/s^2");
  }
}

void PatchBuilder::set_known(std::size_t point) {
  set_signals(point, signals_[point].x, signals_[point].y);
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

void PatchBuilder::refuse(const mechanism::Group& group, const std::string& why, const std::string& expected,
                          const text::Remedy& remedy) const {
  throw PatchError(text::Diagnostic{
      group.bodies.empty() ? mechanism_.slides[group.slides.front()].place
                           : mechanism_.bodies[group.bodies.front()].place,
      fmt::format("the group {} ({}) {}", group.name, mechanism::kind_name(group.form.kind), why), expected,
      remedy});
}

}  // namespace oblique::patch
