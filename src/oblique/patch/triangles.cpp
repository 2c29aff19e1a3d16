// SPDX-License-Identifier: MIT
#include <oblique/patch/triangles.h>

#include <stdexcept>

#include <fmt/format.h>

#include <oblique/patch/circuit_frame.h>
#include <oblique/patch/drive_circuits.h>
#include <oblique/patch/link_dyads.h>
#include <oblique/patch/slide_dyads.h>
#include <oblique/patch/triad_circuits.h>

namespace oblique::patch {
namespace {

bool has_circuit(const mechanism::Group& group) {
  switch (group.form.placing) {
    case mechanism::Placing::rotation:
    case mechanism::Placing::triangle:
      return true;
    case mechanism::Placing::pinned:
    case mechanism::Placing::crossing:
    case mechanism::Placing::about_pivot:
      return has_slide_dyad(group);
    case mechanism::Placing::platform:
      return group.form.is_triad_on_links();
    case mechanism::Placing::iteration:
      break;
  }
  return false;
}

void check_groups(const PatchSetup& setup) {
  check_split_options(setup.mechanism(), setup.structure, setup.options);
  for (const mechanism::Group& group : setup.structure.groups) {
    if (has_circuit(group)) continue;
    refuse(setup.mechanism(), group,
           group.form.placing == mechanism::Placing::platform
               ? "has a slide among its legs, so that it cannot be taken apart into triangles"
               : "is no drive, no dyad and no triad, so that it cannot be taken apart into triangles",
           "drives, dyads, and triads on three links",
           text::Remedy{"patch it with ", text::Setting{"method", "gradient"}, ", which takes any group"});
  }
}

void add_group(Circuit& circuit, std::size_t g) {
  const PatchSetup& setup = circuit.setup;
  const mechanism::Group& group = setup.structure.groups[g];
  switch (group.form.placing) {
    case mechanism::Placing::rotation:
      add_crank(circuit, group);
      return;
    case mechanism::Placing::triangle:
      add_link_dyad(circuit, group, setup.scaling.triangles[g]);
      return;
    case mechanism::Placing::pinned:
    case mechanism::Placing::crossing:
    case mechanism::Placing::about_pivot:
      add_slide_dyad(circuit, group);
      return;
    case mechanism::Placing::platform:
      add_triad(circuit, group, choose_split(setup.mechanism(), group, setup.motion, setup.options));
      return;
    case mechanism::Placing::iteration:
      break;
  }
  throw std::logic_error("a group that check_groups has refused");
}

}  // namespace

diagram::Diagram patch_triangles(const mechanism::Mechanism& mechanism, const PatchOptions& options) {
  const PatchSetup setup(mechanism, options);
  check_groups(setup);
  Circuit circuit(setup);
  begin_circuit(
      circuit, "patched as servo-tracked triangles",
      fmt::format("Each dyad's triangle has a scale of its own (`reach`), so that its longest\n"
                  "side is about 1 machine unit. Servo amplifiers: gain {}, bandwidth {} Hz. Run over {}.",
                  options.gain, setup.bandwidth, span_text(setup.mechanism())));
  for (std::size_t g = 0; g < setup.structure.groups.size(); ++g) add_group(circuit, g);
  end_circuit(circuit);
  return std::move(circuit.writer.diagram());
}

}  // namespace oblique::patch
