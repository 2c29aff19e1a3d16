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
      switch (group.form.placing) {
        case mechanism::Placing::rotation:
          add_crank(group);
          break;
        case mechanism::Placing::triangle:
          add_dyad(group, scaling_.triangles[g]);
          break;
        case mechanism::Placing::platform:
          add_triad(group, choose_split(mechanism_, group, motion_, options_));
          break;
        case mechanism::Placing::hinged:
        case mechanism::Placing::crossing:
        case mechanism::Placing::about_pivot:
        case mechanism::Placing::iteration:
          add_group(group);
          break;
      }
      for (const std::size_t point : group.points) set_known(point);
    }
    if (options_.derivatives) add_rates();
    add_outputs();
    return std::move(diagram_);
  }

 private:
  static bool can_be_patched(const mechanism::Group& group) {
    switch (group.form.placing) {
      case mechanism::Placing::rotation:
      case mechanism::Placing::triangle:
        return true;
      case mechanism::Placing::platform:
        return group.form.is_triad_on_links();
      case mechanism::Placing::hinged:
      case mechanism::Placing::crossing:
      case mechanism::Placing::about_pivot:
      case mechanism::Placing::iteration:
        break;
    }
    return has_circuit(group);
  }

  void check_groups() const {
    check_split_options(mechanism_, structure_, options_);
    for (const mechanism::Group& group : structure_.groups) {
      if (can_be_patched(group)) continue;
      refuse(group,
             group.form.kind == mechanism::GroupKind::triad
                 ? "has a slide among its legs, so that it cannot be taken apart into triangles"
                 : "is no drive, no dyad and no triad, so that it cannot be taken apart into triangles",
             "drives, dyads, and triads on three links",
             text::Remedy{"patch it with ", text::Setting{"method", "gradient"}, ", which takes any group"});
    }
  }

  void add_dyad(const mechanism::Group& group, const TriangleRange& range) {
    const mechanism::Dyad& dyad = *group.form.dyad;
    const std::string& unit = mechanism_.length_unit;
    const std::string comment = fmt::format(
        "dyad {}: {} is hinged to {} ({:.6g} {}) and {} ({:.6g} {}), on the {} of {} → {}.\n"
        "{}–{} is {:.4g} … {:.4g} {} long; sin γ at {} falls to {:.2g}.",
        group.name, name_of(dyad.c), name_of(dyad.p), dyad.r1, unit, name_of(dyad.q), dyad.r2, unit,
        group.side > 0 ? "left" : "right", name_of(dyad.p), name_of(dyad.q), name_of(dyad.p), name_of(dyad.q),
        range.shortest, range.longest, unit, name_of(dyad.p), range.flattest);
    const std::string block = add_block(
        name_of(dyad.c), "dyad-rrr",
        {diagram::wire_setting("px", {x_of(dyad.p, 1)}), diagram::wire_setting("py", {y_of(dyad.p, 1)}),
         diagram::wire_setting("qx", {x_of(dyad.q, 1)}), diagram::wire_setting("qy", {y_of(dyad.q, 1)}),
         diagram::number_setting("r1", scaled(dyad.r1)), diagram::number_setting("r2", scaled(dyad.r2)),
         diagram::number_setting("side", group.side),
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
