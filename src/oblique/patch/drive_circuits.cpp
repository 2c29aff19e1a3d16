// SPDX-License-Identifier: MIT
#include <oblique/patch/drive_circuits.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/patch/point_circuits.h>
#include <oblique/text/expression_printer.h>

namespace oblique::patch {
namespace {

constexpr double kBetweenRows = 1.001;  ///< how much more there may be between two positions of the motion

/// "2 rad/s", or the law, for comments.
std::string speed_text(const mechanism::Mechanism& mechanism, const mechanism::Drive& drive) {
  const std::string unit = drive.slide ? mechanism.length_unit + "/s" : "rad/s";
  if (!drive.law) return fmt::format("{:.6g} {}", drive.speed, unit);
  const std::string law = text::to_string(*drive.law);
  return drive.law_scale == 1 ? fmt::format("{} {}", law, unit)
                              : fmt::format("({})*{:.6g} {}", law, drive.law_scale, unit);
}

const DriveSpeed& add_speed(Circuit& circuit, std::size_t d) {
  const mechanism::Drive& drive = circuit.setup.mechanism().drives[d];
  DriveSpeed& speed = circuit.speeds[d];
  if (!drive.law) return speed = {circuit.writer.one(), drive.speed};
  double fastest = 0;
  for (const std::vector<mechanism::DriveState>& row : circuit.setup.motion.drives)
    fastest = std::max(fastest, std::abs(row[d].rate));
  const double unit = fastest > 0 ? round_up(kBetweenRows * fastest) : 1;
  speed.signal = circuit.writer.add_block(drive.name + "_speed", "time-function",
                                          {diagram::text_setting("formula", text::to_string(*drive.law)),
                                           diagram::number_setting("scale", drive.law_scale / unit)});
  speed.unit = unit;
  return speed;
}

}  // namespace

std::string add_generator(Circuit& circuit, std::size_t d, const std::string& comment) {
  const DriveSpeed& speed = add_speed(circuit, d);
  const mechanism::Drive& drive = circuit.setup.mechanism().drives[d];
  std::string generator = circuit.writer.add_block(
      drive.name, "crank-generator",
      {diagram::wire_setting("speed", {{1, speed.signal}}), diagram::number_setting("rate", speed.unit),
       diagram::number_setting("start", drive.start)},
      comment);
  circuit.drives[d].axis = {weighted(generator + ".cos"), weighted(generator + ".sin")};
  return generator;
}

std::string add_way(Circuit& circuit, std::size_t d) {
  const PatchSetup& setup = circuit.setup;
  const mechanism::Drive& drive = setup.mechanism().drives[d];
  const double margin = drive.law ? kBetweenRows : 1;
  const double reach = round_up(
      setup.scaled(std::max(margin * setup.scaling.slides[*drive.slide], setup.scaling.length / 1000)));
  const DriveSpeed& speed = add_speed(circuit, d);
  std::string way = circuit.writer.add_block(
      drive.name, "integrator",
      {diagram::wire_setting("in", {{setup.scaled(speed.unit) / reach, speed.signal}}),
       diagram::number_setting("initial", setup.scaled(drive.start) / reach)},
      fmt::format("drive {}: {} along {}", drive.name, speed_text(setup.mechanism(), drive),
                  setup.mechanism().slides[*drive.slide].name));
  circuit.drives[d].way = weighted(way, reach);
  return way;
}

VectorForm crank_point(const PointBook& places, const DriveForms& drive, const mechanism::Group& crank,
                       const mechanism::BodyPoint& point) {
  const std::size_t pivot = mechanism::pivot_of(crank);
  const mechanism::Body& body = places.mechanism().bodies[crank.equations.platforms.front()];
  const Eigen::Vector2d arm = point.local - body.find(pivot)->local;
  const double along = places.scaled(arm.x()), left = places.scaled(arm.y());
  const VectorForm& at = places.at(pivot);
  return {combined({{1, &at.x}, {along, &drive.axis.x}, {-left, &drive.axis.y}}),
          combined({{1, &at.y}, {along, &drive.axis.y}, {left, &drive.axis.x}})};
}

std::string add_crank(Circuit& circuit, const mechanism::Group& crank) {
  const mechanism::Mechanism& mechanism = circuit.setup.mechanism();
  const std::size_t d = crank.drives.front();
  const mechanism::Drive& drive = mechanism.drives[d];
  const mechanism::Body& body = mechanism.bodies[drive.body];
  const std::string& pivot = circuit.setup.name_of(mechanism::pivot_of(crank));
  std::string generator = add_generator(
      circuit, d,
      fmt::format("crank {}: turns about {} at {}", body.name, pivot, speed_text(mechanism, drive)));
  for (const mechanism::BodyPoint& point : body.points) {
    if (circuit.places.has(point.point)) continue;
    const VectorForm form = crank_point(circuit.places, circuit.drives[d], crank, point);
    add_summed_point(circuit, point.point, circuit.writer.terms_of(form.x), circuit.writer.terms_of(form.y),
                     {});
  }
  return generator;
}

}  // namespace oblique::patch
