// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <oblique/ensemble/engine/work_queue.h>
#include <oblique/ensemble/lanes/lane_method.h>
#include <oblique/ensemble/lanes/lane_starts.h>
#include <oblique/ensemble/lanes/signal_watch.h>
#include <oblique/ensemble/lanes/trough_watch.h>

// Not installed.
namespace oblique::ensemble {

/// Runs machines in lanes, in one thread.
///
/// A lane is a machine with a time and a step of its own; all lanes take their next step together, and one
/// that has come to its end takes the next machine of the queue. Nothing that one lane does depends on
/// another: the numbers of a machine are the same whatever runs beside it.
///
/// Machines come in batches: what they draw becomes constants (the prologue), and their servo loops and
/// algebraic loops are brought to rest together. The states at the rows are kept until a batch of machines is
/// done, whose outputs are then evaluated together.
class LaneRunner {
 public:
  /// All must outlive this.
  LaneRunner(const LaneProgram& program, std::span<const double> base, const LaneKernels& kernels);

  /// What a machine drew.
  using Values = std::function<void(std::uint64_t number, std::span<double> values)>;
  /// Gets a machine that has come to its end: `t` and the outputs, row by row.
  using Take = std::function<void(std::uint64_t number, std::span<const double> rows, std::size_t steps)>;
  /// Gets one that no lane can run, and why.
  using Refuse =
      std::function<void(std::uint64_t number, std::span<const double> values, const std::string& why)>;

  void work(const Next& next, const Values& values, const Take& take, const Refuse& refuse);

 private:
  /// A machine on its way.
  struct Machine {
    std::uint64_t number = 0;
    std::vector<double> values, draws;
    std::vector<double> start;  ///< of all variables
    std::vector<double> rows;   ///< of all variables, row by row
    double first_step = 0, longest_step = 0;
    std::size_t steps = 0;
    bool is_near = true;  ///< to the typical machine, where there is to be a rest
    std::string refused;
  };
  /// A lane's place in its machine's run.
  struct Lane {
    std::size_t machine = 0;  ///< in `machines_`
    bool busy = false;
    bool rejected = false;  ///< the last step
    int row = 0;            ///< the next one
  };

  std::vector<double> typical_draws();
  bool prepare(const Next& next, const Values& values, const Refuse& refuse);
  bool draw(Machine& machine);
  bool is_near(std::span<const double> values) const;
  void put(std::size_t lane, std::size_t machine);
  void occupy_idle_lanes();
  void judge(const Take& take, const Refuse& refuse);
  void keep_rows();
  void end(std::size_t lane, const Take& take, const Refuse& refuse);
  void refuse_lane(std::size_t lane, const std::string& why, const Refuse& refuse);
  void evaluate(std::span<const std::size_t> batch, const Take& take, const Refuse& refuse);
  double row_time(int row) const;
  double longest_step(const Machine& machine) const;

  const LaneProgram& program_;
  std::span<const double> base_;
  const LaneKernels& kernels_;
  std::size_t width_, n_;

  std::vector<Machine> machines_;  ///< all that are on their way, and free places
  std::vector<std::size_t> free_, ready_, done_;
  std::vector<Lane> lanes_;
  std::vector<double> scratch_, table_;

  LaneStates at_;
  std::unique_ptr<LaneMethod> method_;
  LaneStarts starts_;
  TroughWatch troughs_;
  SignalWatch signals_;
  LaneArray output_slots_;
  LaneArray taken_;  ///< 1 in lanes whose step was taken
};

}  // namespace oblique::ensemble
