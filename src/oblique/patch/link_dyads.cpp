// SPDX-License-Identifier: MIT
#include <oblique/patch/link_dyads.h>

#include <fmt/format.h>

#include <oblique/patch/point_circuits.h>

namespace oblique::patch {

void add_link_dyad(Circuit& circuit, const mechanism::Group& group, const TriangleRange& range) {
  const PatchSetup& setup = circuit.setup;
  const mechanism::Dyad& dyad = group.form.dyad.value();
  const std::string& unit = setup.mechanism().length_unit;
  const std::string &p = setup.name_of(dyad.p), &q = setup.name_of(dyad.q), &c = setup.name_of(dyad.c);
  const std::string comment = fmt::format(
      "dyad {}: {} is linked to {} ({:.6g} {}) and {} ({:.6g} {}), on the {} of {} → {}.\n"
      "{}–{} is {:.4g} … {:.4g} {} long; sin γ at {} falls to {:.2g}.",
      group.name, c, p, dyad.r1, unit, q, dyad.r2, unit, group.side > 0 ? "left" : "right", p, q, p, q,
      range.shortest, range.longest, unit, p, range.flattest);
  const auto wire = [](const char* port, const diagram::WeightedSignal& term) {
    return diagram::wire_setting(port, {term});
  };
  const std::string block = circuit.writer.add_block(
      c, "dyad-rrr",
      with_amplifiers(setup, {wire("px", x_of(circuit, dyad.p, 1)), wire("py", y_of(circuit, dyad.p, 1)),
                              wire("qx", x_of(circuit, dyad.q, 1)), wire("qy", y_of(circuit, dyad.q, 1)),
                              diagram::number_setting("r1", setup.scaled(dyad.r1)),
                              diagram::number_setting("r2", setup.scaled(dyad.r2)),
                              diagram::number_setting("side", group.side),
                              diagram::number_setting("reach", round_up(setup.scaled(range.longest)))}),
      comment);
  circuit.places.set_signals(dyad.c, {block + ".x", block + ".y"});
  add_carried_points(circuit, setup.mechanism().bodies[dyad.body1], dyad.p, dyad.c);
  add_carried_points(circuit, setup.mechanism().bodies[dyad.body2], dyad.q, dyad.c);
}

}  // namespace oblique::patch
