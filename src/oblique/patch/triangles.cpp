// SPDX-License-Identifier: MIT
// Mechanism → diagram by servo-tracked oblique triangles.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include <oblique/patch/triad_patch.h>

namespace oblique {
namespace {

class TrianglePatch : private TriadPatch {
 public:
  using TriadPatch::TriadPatch;

  Diagram make() {
    check_groups();
    describe(
        "patched as servo-tracked triangles",
        fmt::format("Each dyad's triangle has a scale of its own (`reach`), so that its longest\n"
                    "side is about 1 machine unit. Servo amplifiers: gain {}, bandwidth {} Hz. Run over {}.",
                    options_.gain, bandwidth_, span_text()));
    add_reference();
    for (std::size_t g = 0; g < structure_.groups.size(); ++g) {
      const Group& group = structure_.groups[g];
      if (group.kind == GroupKind::crank) {
        add_crank(group);
      } else if (const auto dyad = dyad_of(group)) {
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
    for (const Group& group : structure_.groups) {
      if (group.kind == GroupKind::crank || dyad_of(group) || can_be_split(group) ||
          parts_of(group.equations))
        continue;
      refuse(group,
             group.kind == GroupKind::triad
                 ? "has a slide among its leads, so that it cannot be taken apart into triangles"
                 : "is no drive, no dyad and no triad, so that it cannot be taken apart into triangles",
             "drives, dyads, and triads on three links",
             "patch it with --method gradient, which takes any group");
    }
  }

  void add_dyad(const std::string& name, const Dyad& dyad, const TriangleRange& range) {
    const std::string& unit = mechanism_.length_unit;
    const std::string comment = fmt::format(
        "dyad {}: {} is hinged to {} ({:.6g} {}) and {} ({:.6g} {}), on the {} of {} → {}.\n"
        "{}–{} is {:.4g} … {:.4g} {} long; sin γ at {} falls to {:.2g}.",
        name, name_of(dyad.c), name_of(dyad.p), dyad.r1, unit, name_of(dyad.q), dyad.r2, unit,
        dyad.side > 0 ? "left" : "right", name_of(dyad.p), name_of(dyad.q), name_of(dyad.p), name_of(dyad.q),
        range.shortest, range.longest, unit, name_of(dyad.p), range.flattest);
    const std::string block = add_block(
        name_of(dyad.c), "dyad-rrr",
        {wire_setting("px", {x_of(dyad.p, 1)}), wire_setting("py", {y_of(dyad.p, 1)}),
         wire_setting("qx", {x_of(dyad.q, 1)}), wire_setting("qy", {y_of(dyad.q, 1)}),
         number_setting("r1", scaled(dyad.r1)), number_setting("r2", scaled(dyad.r2)),
         number_setting("side", dyad.side), number_setting("reach", round_up(scaled(range.longest))),
         number_setting("gain", options_.gain), number_setting("bandwidth", bandwidth_)},
        comment);
    signals_[dyad.c] = {block + ".x", block + ".y"};
    add_carried_points(mechanism_.bodies[dyad.body1], dyad.p, dyad.c);
    add_carried_points(mechanism_.bodies[dyad.body2], dyad.q, dyad.c);
  }
};

}  // namespace

Diagram patch_triangles(const Mechanism& mechanism, const PatchOptions& options) {
  return TrianglePatch(mechanism, options).make();
}

}  // namespace oblique
