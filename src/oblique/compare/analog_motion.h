// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include <oblique/diagram/block_library.h>
#include <oblique/mechanism/model/mechanism.h>
#include <oblique/patch/patch.h>

namespace oblique::compare {

/// All points of a mechanism as its patch gives them, one row for each moment [length unit]. Those of the
/// frame stand where they stand.
using AnalogPlaces = std::vector<std::vector<Eigen::Vector2d>>;

/// Patches a mechanism as `judged_patch` does and runs the diagram from its start. `moments` [s] ascend from
/// 0 or later; the run goes on as long as they do. A mechanism with a range must be `within_range`, as it is
/// patched. Throws as `judged_patch` and, with the gain in the message, as `run`.
AnalogPlaces analog_places(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                           const patch::PatchOptions& options, const std::vector<double>& moments,
                           const std::function<void(double fraction)>& progress = {});

}  // namespace oblique::compare
