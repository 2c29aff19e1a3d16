// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/solve/run.h>

namespace oblique::ensemble {

/// How the machines of an ensemble are run.
struct EnsembleOptions {
  solve::RunOptions run;  ///< of each machine: until, tolerance, rows, the most steps; nothing that is called
  int threads = 1;        ///< the results do not depend on it
  bool lanes = true;      ///< else every machine is run by CVODES
  int width = 0;          ///< machines side by side: 4, 8 or 16; 0: as many as are fastest
  std::string set;        ///< instructions: "sse2", "avx2", "avx512"; else the best that there are
};

/// What came out of one machine.
struct MachineRun {
  std::uint64_t number = 0;
  /// The table of a run, row by row: `t` and the outputs of the diagram; empty where the machine failed.
  std::span<const double> rows;
  std::string failure;    ///< why it failed, in a line; else empty
  std::string warning;    ///< the first one of its run, in a line; of a lane none
  std::string no_lane;    ///< why CVODES ran it, in a line; empty where a lane did
  std::size_t steps = 0;  ///< of the solver
};

/// How many machines were run, and by what.
struct EnsembleCount {
  std::uint64_t in_lanes = 0;
  std::uint64_t by_cvodes = 0;  ///< the failed ones among them
  std::uint64_t failed = 0;
  std::map<std::string, std::uint64_t> reasons;  ///< why CVODES ran how many
  std::uint64_t warned = 0;                      ///< how many ran with a warning
  /// The warned machine of the least number, and of what.
  std::optional<std::pair<std::uint64_t, std::string>> first_warned;

  /// Machines some measure of which may err by more than a thousandth because of few rows, and the most it
  /// may: a part of its size.
  std::uint64_t coarse = 0;
  double doubt = 0;

  /// Counts a machine whose measures may err by this part.
  void measured(double part);
  /// Counts a machine that ran with a warning.
  void warn(std::uint64_t number, const std::string& warning);
  /// Adds those of other machines.
  EnsembleCount& operator+=(const EnsembleCount& others);
};

/// The same diagram many times over, each machine with other values of some parameters.
///
/// Machines are known by their numbers. What comes out of one depends on its values alone: not on the other
/// machines, nor on threads, lanes, or the order.
class Ensemble {
 public:
  /// `diagram`: a machine as most are, whose cases of blocks and equations the lanes are made for. `varied`:
  /// numbers of parameters (network::ParameterNumbers). Throws what assembling the diagram throws.
  Ensemble(diagram::FlatDiagram diagram, std::vector<std::uint32_t> varied, EnsembleOptions options);
  ~Ensemble();
  Ensemble(Ensemble&&) noexcept;

  const diagram::FlatDiagram& diagram() const;
  std::size_t columns() const;  ///< of the rows of a MachineRun

  /// Gives the values of a machine, one for each varied parameter; they come as those of the diagram. Called
  /// from any of the threads.
  using Values = std::function<void(std::uint64_t number, std::span<double> values)>;
  /// Gets what came out of a machine, while it is there. Called from any of the threads, in any order.
  using Take = std::function<void(const MachineRun& run)>;
  /// Called from the calling thread; what it throws ends the runs of all threads.
  using Progress = std::function<void(std::uint64_t done)>;

  /// Runs the machines `first` to `first + count − 1`. What `values` and `take` throw ends the runs.
  EnsembleCount run(std::uint64_t first, std::uint64_t count, const Values& values, const Take& take,
                    const Progress& progress = {}) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace oblique::ensemble
