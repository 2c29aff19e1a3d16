// SPDX-License-Identifier: MIT
#include <oblique/compare/analog_motion.h>

#include <fmt/format.h>

#include <oblique/commission/judge.h>
#include <oblique/compare/patched_run.h>

namespace oblique::compare {

AnalogPlaces analog_places(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                           const patch::PatchOptions& options, const std::vector<double>& moments,
                           const std::function<void(double fraction)>& progress) {
  const commission::JudgedPatch judged = commission::judged_patch(mechanism, library, options);
  const PatchedMechanism patched(judged.diagram, library);
  const RecordedRun recorded = run_recorded(patched, fmt::format("amplifiers of gain {:.6g}", options.gain),
                                            judged.options.tolerance, progress, moments);
  const std::vector<PointOutputs> outputs = point_outputs(mechanism, patched.flat);
  AnalogPlaces places;
  for (std::size_t row = 0; row < moments.size(); ++row) {
    std::vector<Eigen::Vector2d>& here = places.emplace_back();
    for (const mechanism::Point& point : mechanism.points) here.push_back(point.position);
    for (const PointOutputs& point : outputs) here[point.point] = place_of(point, recorded.run.extra, row);
  }
  return places;
}

}  // namespace oblique::compare
