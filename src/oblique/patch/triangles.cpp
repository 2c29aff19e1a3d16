// SPDX-License-Identifier: MIT
// Mechanism → diagram by servo-tracked oblique triangles.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/triad_patch.h>

namespace oblique::patch {
namespace {

class TrianglePatch : private TriadPatch {
 public:
  using TriadPatch::TriadPatch;

  diagram::Diagram make() {
    check_groups();
    describe(
        "patched as servo-tracked triangles",
        fmt::format("Each dyad's triangle has a scale of its own (`reach`), so that its longest\n"
                    "side is about 1 machine unit. Servo amplifiers: gain {}, bandwidth {} Hz. Run over {}.",
                    options_.gain, bandwidth_, span_text()));
    add_reference();
    for (std::size_t g = 0; g < structure_.groups.size(); ++g) {
      const mechanism::Group& group = structure_.groups[g];
      if (group.kind == mechanism::GroupKind::crank) {
        add_crank(group);
      } else if (const auto dyad = mechanism::dyad_of(group)) {
        add_dyad(group.name, *dyad, scaling_.triangles[g]);
      } else if (can_be_split(group)) {
        add_triad(group, choose_split(mechanism_, group, motion_, options_));
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
    check_split_options(mechanism_, structure_, options_);
    for (const mechanism::Group& group : structure_.groups) {
      if (group.kind == mechanism::GroupKind::crank || mechanism::dyad_of(group) || can_be_split(group) ||
          parts_of(group.equations))
        continue;
      refuse(group,
             group.kind == mechanism::GroupKind::triad
                 ? "has a slide among its legs, so that it cannot be taken apart into triangles"
                 : "is no drive, no dyad and no triad, so that it cannot be taken apart into triangles",
             "drives, dyads, and triads on three links",
             text::Remedy{"patch it with ", text::Setting{"method", "gradient"}, ", which takes any group"});
    }
  }

  void add_dyad(const std::string& name, const mechanism::Dyad& dyad, const TriangleRange& range) {
    const std::string& unit = mechanism_.length_unit;
    const std::string comment = fmt::format(
        "dyad {}: {} is hinged to {} ({:.6g} {}) and {} ({:.6g} {}), on the {} of {} → {}.\n"
        "{}–{} is {:.4g} … {:.4g} {} long; sin γ at {} falls to {:.2g}.",
        name, name_of(dyad.c), name_of(dyad.p), dyad.r1, unit, name_of(dyad.q), dyad.r2, unit,
        dyad.side > 0 ? "left" : "right", name_of(dyad.p), name_of(dyad.q), name_of(dyad.p), name_of(dyad.q),
        range.shortest, range.longest, unit, name_of(dyad.p), range.flattest);
    const std::string block = add_block(
        name_of(dyad.c), "dyad-rrr",
        {diagram::wire_setting("px", {x_of(dyad.p, 1)}), diagram::wire_setting("py", {y_of(dyad.p, 1)}),
         diagram::wire_setting("qx", {x_of(dyad.q, 1)}), diagram::wire_setting("qy", {y_of(dyad.q, 1)}),
         diagram::number_setting("r1", scaled(dyad.r1)), diagram::number_setting("r2", scaled(dyad.r2)),
         diagram::number_setting("side", dyad.side),
         diagram::number_setting("reach", round_up(scaled(range.longest))),
         diagram::number_setting("gain", options_.gain), diagram::number_setting("bandwidth", bandwidth_)},
        comment);
    signals_[dyad.c] = {block + ".x", block + ".y"};
    add_carried_points(mechanism_.bodies[dyad.body1], dyad.p, dyad.c);
    add_carried_points(mechanism_.bodies[dyad.body2], dyad.q, dyad.c);
  }
};

}  // namespace

diagram::Diagram patch_triangles(const mechanism::Mechanism& mechanism, const PatchOptions& options) {
  return TrianglePatch(mechanism, options).make();
}

}  // namespace oblique::patch
