// SPDX-License-Identifier: MIT
#include <oblique/ensemble/engine/ensemble.h>

#include <mutex>
#include <utility>

#include <oblique/ensemble/engine/work_queue.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/network/program/program.h>
#include <oblique/text/diagnostic.h>

namespace oblique::ensemble {

struct Ensemble::Parts {
  diagram::FlatDiagram diagram;
  std::vector<std::uint32_t> varied;
  EnsembleOptions options;
  network::ParameterNumbers numbers;
  std::vector<double> base;  ///< of each varied parameter: that of the diagram

  /// Runs one machine by CVODES, compiled by itself.
  void run_alone(std::span<const double> values, MachineRun& done, solve::Run& run) const {
    diagram::FlatDiagram machine = diagram;
    try {
      network::set_parameters(machine, numbers, varied, values);
      run = solve::run(network::Program(network::assemble(machine)), machine, options.run);
      done.rows = run.trajectory.values();
      done.steps = static_cast<std::size_t>(run.statistics.steps);
    } catch (const text::Error& error) {
      const std::string& what = error.diagnostics().front().what;
      done.failure = what.substr(0, what.find('\n'));
    }
  }
};

Ensemble::Ensemble(diagram::FlatDiagram diagram, std::vector<std::uint32_t> varied, EnsembleOptions options) {
  network::ParameterNumbers numbers(diagram);
  const std::vector<double> all = network::parameter_values(diagram);
  std::vector<double> base;
  for (const std::uint32_t number : varied) base.push_back(all[number]);
  parts_ = std::make_unique<const Parts>(
      Parts{std::move(diagram), std::move(varied), std::move(options), std::move(numbers), std::move(base)});
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
    std::vector<double> drawn;
    solve::Run run;
    MachineRun done;
    while (next(done.number)) {
      drawn = parts_->base;
      values(done.number, drawn);
      done.rows = {};
      done.failure.clear();
      done.no_lane = "asked for";
      parts_->run_alone(drawn, done, run);
      take(done);
      const std::lock_guard lock(guard);
      ++all.by_cvodes;
      ++all.reasons[done.no_lane];
      if (!done.failure.empty()) ++all.failed;
    }
  };
  work_off(first, count, parts_->options.threads, work, progress);
  return all;
}

}  // namespace oblique::ensemble
