// SPDX-License-Identifier: MIT
#include <oblique/patch/point_circuits.h>

#include <complex>

#include <fmt/format.h>

namespace oblique::patch {
namespace {

diagram::WeightedSignal term(const LinearForm& form, double weight, const std::string& one) {
  if (form.weights.empty()) return {weight * form.constant, one};
  return {weight, form.weights.begin()->first};
}

}  // namespace

diagram::WeightedSignal x_of(const Circuit& circuit, std::size_t point, double weight) {
  return term(circuit.places.at(point).x, weight, circuit.writer.one());
}

diagram::WeightedSignal y_of(const Circuit& circuit, std::size_t point, double weight) {
  return term(circuit.places.at(point).y, weight, circuit.writer.one());
}

void add_summed_point(Circuit& circuit, std::size_t point, const Terms& x, const Terms& y,
                      const std::string& comment) {
  const std::string& name = circuit.setup.name_of(point);
  std::string of_x = circuit.writer.add_block(name + "_x", "summer", {sum_of(x)}, comment);
  std::string of_y = circuit.writer.add_block(name + "_y", "summer", {sum_of(y)});
  circuit.places.set_signals(point, {std::move(of_x), std::move(of_y)});
}

void add_formed_points(Circuit& circuit, const mechanism::Group& group) {
  for (const std::size_t point : group.points) {
    if (circuit.places.has_signals(point)) continue;
    const VectorForm& at = circuit.places.at(point);
    add_summed_point(circuit, point, circuit.writer.terms_of(at.x), circuit.writer.terms_of(at.y), {});
  }
}

void add_carried_points(Circuit& circuit, const mechanism::Body& body, std::size_t p, std::size_t c) {
  const auto local = [&](std::size_t point) {
    const Eigen::Vector2d& at = body.find(point)->local;
    return std::complex<double>(at.x(), at.y());
  };
  const auto x = [&](std::size_t point, double weight) { return x_of(circuit, point, weight); };
  const auto y = [&](std::size_t point, double weight) { return y_of(circuit, point, weight); };
  for (const mechanism::BodyPoint& point : body.points) {
    if (circuit.places.has(point.point)) continue;
    const std::complex<double> ratio = (local(point.point) - local(p)) / (local(c) - local(p));
    const double a = ratio.real(), b = ratio.imag();
    add_summed_point(circuit, point.point, {x(p, 1 - a), x(c, a), y(c, -b), y(p, b)},
                     {y(p, 1 - a), y(c, a), x(c, b), x(p, -b)},
                     fmt::format("{}, carried by {}", circuit.setup.name_of(point.point), body.name));
  }
}

std::vector<text::Entry> with_amplifiers(const PatchSetup& setup, std::vector<text::Entry> settings) {
  settings.push_back(diagram::number_setting("gain", setup.options.gain));
  settings.push_back(diagram::number_setting("bandwidth", setup.bandwidth));
  return settings;
}

}  // namespace oblique::patch
