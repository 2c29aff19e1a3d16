// SPDX-License-Identifier: MIT
#include <oblique/patch/circuit_frame.h>

#include <optional>

#include <fmt/format.h>

#include <oblique/patch/rate_circuits.h>

namespace oblique::patch {

void begin_circuit(Circuit& circuit, const std::string& method, const std::string& remarks) {
  const PatchSetup& setup = circuit.setup;
  const mechanism::Mechanism& mechanism = setup.mechanism();
  diagram::Diagram& diagram = circuit.writer.diagram();
  diagram.title = mechanism.title.empty() ? "Mechanism" : mechanism.title;
  diagram.title += ", " + method;
  diagram.source = mechanism.source;
  diagram.comment =
      fmt::format("Coordinates: 1 machine unit = {} {}{}. {}", setup.scaling.length, mechanism.length_unit,
                  setup.scaling.origin.isZero(0) ? "" : fmt::format(", from {}", setup.name_of(0)), remarks);
  if (setup.options.period)
    diagram.comment +=
        fmt::format("\nTime: 1 s of the machine is {:.6g} s of the mechanism.", setup.time.factor);
  diagram.run.until = mechanism::period(mechanism);
  diagram.run.tolerance = setup.options.tolerance;
  diagram.run.samples = setup.options.samples;
  circuit.writer.add_reference();
}

std::string span_text(const mechanism::Mechanism& mechanism) {
  return mechanism.motion.until ? fmt::format("the {:.6g} s of its motion", *mechanism.motion.until)
                                : fmt::format("one turn of '{}'", mechanism.drives.front().name);
}

void end_circuit(Circuit& circuit) {
  const PatchSetup& setup = circuit.setup;
  const mechanism::Mechanism& mechanism = setup.mechanism();
  const std::string& length = mechanism.length_unit;
  std::optional<RateCircuits> rates;
  if (setup.options.derivatives) rates = add_rates(circuit);
  std::vector<diagram::OutputSpec>& outputs = circuit.writer.diagram().outputs;
  for (std::size_t point = 0; point < mechanism.points.size(); ++point) {
    if (mechanism.points[point].fixed) continue;
    const std::string& name = setup.name_of(point);
    const PointSignals& at = circuit.places.signals(point);
    const Eigen::Vector2d& origin = setup.scaling.origin;
    outputs.push_back({name + ".x", at.x, setup.scaling.length, length, {}, origin.x()});
    outputs.push_back({name + ".y", at.y, setup.scaling.length, length, {}, origin.y()});
    if (!rates) continue;
    const auto add_rate = [&](const char* axis, const std::string& signal, double unit, const char* per) {
      outputs.push_back({name + axis, signal, unit, length + per, {}});
    };
    const RateSignals& signals = rates->points[point];
    const double factor = setup.time.factor;  // rates stay those of the mechanism
    add_rate(".vx", signals.vx, rates->velocity_unit / factor, "/s");
    add_rate(".vy", signals.vy, rates->velocity_unit / factor, "/s");
    add_rate(".ax", signals.ax, rates->acceleration_unit / (factor * factor), "/s^2");
    add_rate(".ay", signals.ay, rates->acceleration_unit / (factor * factor), "/s^2");
  }
}

}  // namespace oblique::patch
