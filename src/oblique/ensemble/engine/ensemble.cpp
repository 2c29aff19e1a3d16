// SPDX-License-Identifier: MIT
#include <oblique/ensemble/engine/ensemble.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include <oblique/ensemble/engine/work_queue.h>
#include <oblique/ensemble/lanes/lane_kernels.h>
#include <oblique/ensemble/lanes/lane_program.h>
#include <oblique/ensemble/lanes/lane_runner.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/network/program/program.h>
#include <oblique/text/diagnostic.h>

namespace oblique::ensemble {
namespace {

constexpr int kWidth = 16;  ///< lanes

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

void EnsembleCount::warn(std::uint64_t number, const std::string& warning) {
  ++warned;
  if (!first_warned || number < first_warned->first) first_warned.emplace(number, warning);
}

void EnsembleCount::measured(double part) {
  constexpr double kCoarse = 1e-3;
  if (part > kCoarse) ++coarse;
  doubt = std::max(doubt, part);
}

EnsembleCount& EnsembleCount::operator+=(const EnsembleCount& others) {
  in_lanes += others.in_lanes;
  by_cvodes += others.by_cvodes;
  failed += others.failed;
  warned += others.warned;
  coarse += others.coarse;
  doubt = std::max(doubt, others.doubt);
  for (const auto& [why, how_many] : others.reasons) reasons[why] += how_many;
  if (others.first_warned && (!first_warned || others.first_warned->first < first_warned->first))
    first_warned = others.first_warned;
  return *this;
}

struct Ensemble::Parts {
  diagram::FlatDiagram diagram;
  std::vector<std::uint32_t> varied;
  EnsembleOptions options;
  network::ParameterNumbers numbers;
  std::vector<double> base;  ///< of each varied parameter: that of the diagram
  LaneCompilation lanes;

  /// Runs one machine by CVODES, compiled by itself.
  void run_alone(std::span<const double> values, MachineRun& done, solve::Run& run) const {
    diagram::FlatDiagram machine = diagram;
    try {
      network::set_parameters(machine, numbers, varied, values);
      run = solve::run(network::Program(network::assemble(machine)), machine, options.run);
      done.rows = run.trajectory.values();
      done.steps = static_cast<std::size_t>(run.statistics.steps);
      if (!run.warnings.empty()) done.warning = first_line(run.warnings.front().what);
    } catch (const text::Error& error) {
      done.failure = first_line(error.diagnostics().front().what);
    }
  }
};

Ensemble::Ensemble(diagram::FlatDiagram diagram, std::vector<std::uint32_t> varied, EnsembleOptions options) {
  network::ParameterNumbers numbers(diagram);
  const std::vector<double> all = network::parameter_values(diagram);
  std::vector<double> base;
  base.reserve(varied.size());
  for (const std::uint32_t number : varied) base.push_back(all[number]);
  LaneCompilation lanes{nullptr, "asked for"};
  if (options.lanes) lanes = compile_for_lanes(diagram, varied, options.run);
  parts_ = std::make_unique<const Parts>(Parts{std::move(diagram), std::move(varied), std::move(options),
                                               std::move(numbers), std::move(base), std::move(lanes)});
}

Ensemble::~Ensemble() = default;
Ensemble::Ensemble(Ensemble&&) noexcept = default;

const diagram::FlatDiagram& Ensemble::diagram() const {
  return parts_->diagram;
}

std::size_t Ensemble::columns() const {
  return 1 + parts_->diagram.outputs.size();
}

EnsembleCount Ensemble::run(std::uint64_t first, std::uint64_t count, const Values& values, const Take& take,
                            const Progress& progress) const {
  EnsembleCount all;
  std::mutex guard;
  const auto work = [&](const Next& next) {
    EnsembleCount mine;
    solve::Run run;
    MachineRun done;
    const auto by_cvodes = [&](std::uint64_t number, std::span<const double> drawn, const std::string& why) {
      done.number = number;
      done.rows = {};
      done.failure.clear();
      done.warning.clear();
      done.no_lane = why;
      parts_->run_alone(drawn, done, run);
      ++mine.by_cvodes;
      ++mine.reasons[why];
      if (!done.failure.empty()) ++mine.failed;
      if (!done.warning.empty()) mine.warn(number, done.warning);
      take(done);
    };
    if (parts_->lanes.program) {
      const LaneKernels& kernels =
          *lane_kernels(parts_->options.width > 0 ? parts_->options.width : kWidth,
                        parts_->options.set.empty() ? nullptr : parts_->options.set.c_str());
      LaneRunner lanes(*parts_->lanes.program, parts_->base, kernels);
      const auto from_lane = [&](std::uint64_t number, std::span<const double> rows, std::size_t steps) {
        done.number = number;
        done.rows = rows;
        done.steps = steps;
        done.failure.clear();
        done.warning.clear();
        done.no_lane.clear();
        ++mine.in_lanes;
        take(done);
      };
      lanes.work(next, values, from_lane, by_cvodes);
    } else {
      std::vector<double> drawn;
      std::uint64_t number = 0;
      while (next(number)) {
        drawn = parts_->base;
        values(number, drawn);
        by_cvodes(number, drawn, parts_->lanes.why_not);
      }
    }
    const std::lock_guard lock(guard);
    all += mine;
  };
  work_off(first, count, parts_->options.threads, work, progress);
  return all;
}

}  // namespace oblique::ensemble
