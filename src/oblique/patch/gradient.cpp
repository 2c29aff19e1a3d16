// SPDX-License-Identifier: MIT
#include <oblique/patch/gradient.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/solver/kinematics.h>
#include <oblique/patch/circuit_frame.h>
#include <oblique/patch/descent.h>
#include <oblique/patch/drive_circuits.h>
#include <oblique/patch/patch_error.h>
#include <oblique/patch/point_circuits.h>

namespace oblique::patch {
namespace {

/// A coordinate that an integrator tracks: its signal and where it starts [machine unit].
struct Unknown {
  std::string signal;
  double initial = 0;
};

void add_drive(Circuit& circuit, const mechanism::Group& group, std::size_t d) {
  const mechanism::Mechanism& mechanism = circuit.setup.mechanism();
  const mechanism::Drive& drive = mechanism.drives[d];
  if (drive.slide) {
    add_way(circuit, d);
  } else {
    add_generator(circuit, d,
                  fmt::format("drive {} turns {} inside the group {}", drive.name,
                              mechanism.bodies[drive.body].name, group.name));
  }
}

/// The blocks of a residual, and what it pulls at.
void add_residual(Circuit& circuit, const Residual& residual, Gradients& gradients) {
  CircuitWriter& writer = circuit.writer;
  std::vector<std::string> forms;
  for (const auto& [name, form] : residual.forms) {
    forms.push_back(writer.add_summer(name, form, forms.empty() ? residual.comment : std::string()));
    circuit.form_blocks.emplace_back(form, forms.back());
  }
  Terms sum = writer.terms_of(residual.rest);
  if (sum.size() == 1 && sum.front().weight == 0) sum.clear();
  for (const Residual::Product& product : residual.products) {
    const std::string &a = forms[product.a], &b = forms[product.b];
    sum.push_back({product.weight,
                   writer.add_product(product.a == product.b ? a + "2" : fmt::format("{}_{}", a, b), a, b)});
  }
  const std::string gap =
      writer.add_block(residual.name + "_gap", "summer", {diagram::wire_setting("in", sum)},
                       forms.empty() ? residual.comment : std::string());
  add_gradients(writer, residual, forms, gap, gradients);
}

/// The residuals of a group, then the integrators of its unknowns, which run down their squares at `rate`
/// [1/s].
void add_group(Circuit& circuit, const mechanism::Group& group, const mechanism::Configuration& start,
               double rate) {
  CircuitWriter& writer = circuit.writer;
  PointBook& places = circuit.places;
  const PatchSetup& setup = circuit.setup;
  const std::size_t first = writer.diagram().blocks.size();
  for (const std::size_t d : group.drives) add_drive(circuit, group, d);
  std::vector<Unknown> unknowns;
  const std::vector<Residual> residuals =
      residuals_of(group, places, setup.scaling, circuit.drives, [&](std::size_t point) {
        const std::string& name = setup.name_of(point);
        PointSignals signals{writer.free_name(name + "_x"), writer.free_name(name + "_y")};
        const Eigen::Vector2d at = start.points[point].position - setup.scaling.origin;
        unknowns.push_back({signals.x, setup.scaled(at.x())});
        unknowns.push_back({signals.y, setup.scaled(at.y())});
        places.set_signals(point, std::move(signals));
      });
  Gradients gradients;
  for (const Unknown& unknown : unknowns) gradients[unknown.signal];
  for (const Residual& residual : residuals) add_residual(circuit, residual, gradients);
  for (const auto& [signal, initial] : unknowns) {
    Terms& descent = gradients[signal];
    for (diagram::WeightedSignal& term : descent) term.weight = -term.weight;
    writer.add_named(signal, "integrator",
                     {diagram::wire_setting("in", descent), diagram::number_setting("rate", rate),
                      diagram::number_setting("initial", initial)});
  }
  if (first < writer.diagram().blocks.size()) {
    std::string& comment = writer.diagram().blocks[first].comment;
    comment = fmt::format("group {} ({}): {} conditions for {} coordinates{}{}", group.name,
                          mechanism::kind_name(group.form.kind), residuals.size(), unknowns.size(),
                          comment.empty() ? "" : "\n", comment);
  }
  add_formed_points(circuit, group);
}

}  // namespace

diagram::Diagram patch_gradient(const mechanism::Mechanism& mechanism, const PatchOptions& options) {
  const PatchSetup setup(mechanism, options);
  if (!std::isfinite(options.gain * setup.bandwidth)) {
    throw PatchError(text::Diagnostic{{mechanism.file, {}},
                                      "a gradient servo of infinite gain or bandwidth has no time scale",
                                      "a finite gain and bandwidth",
                                      {}},
                     PatchError::Kind::request);
  }
  const double rate = options.gain * 2 * std::numbers::pi * setup.bandwidth;  // K [1/s]
  Circuit circuit(setup);
  begin_circuit(
      circuit, "patched as gradient servos",
      fmt::format(
          "Each unknown coordinate is an integrator that runs down the gradient of the squared\n"
          "conditions of its group, at K = {:.6g} 1/s (gain {} times the bandwidth of {} Hz). Run over {}.",
          rate, options.gain, setup.bandwidth, span_text(setup.mechanism())));
  const mechanism::Configuration start = mechanism::start_configuration(setup.mechanism(), setup.structure);
  for (const mechanism::Group& group : setup.structure.groups) {
    if (group.form.placing == mechanism::Placing::rotation) {
      add_crank(circuit, group);
    } else {
      add_group(circuit, group, start, rate);
    }
  }
  end_circuit(circuit);
  return std::move(circuit.writer.diagram());
}

}  // namespace oblique::patch
