// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <oblique/ensemble/lanes/lane_method.h>

// Not installed.
namespace oblique::ensemble {

/// Watches the lanes for states that come near their absolute tolerance and grow again: they are known to few
/// digits, for down there a method looks at the tolerance alone. (A single run begins anew, finer.) The same
/// of all of them together. What others drive through 0 is no such state, nor what rises from an exact 0.
class TroughWatch {
 public:
  /// Both must outlive this.
  TroughWatch(const LaneProgram& program, const LaneKernels& kernels);

  /// A machine begins in a lane, with these variables.
  void begin(std::size_t lane, std::span<const double> start);
  /// Looks at the steps from `u` to `after` in the lanes where `taken` is not 0. Writes to the slots.
  void look(LaneStates& lanes, const LaneArray& taken);
  /// Whether a state of the lane has risen so in the step that was looked at.
  bool has_risen(std::size_t lane) const { return risen_[lane] != 0; }

 private:
  /// A state that is not at rest and depends on a state, with the slots of the derivative of its rate by
  /// itself.
  struct Watched {
    std::size_t state;
    std::vector<std::uint32_t> own_growth;
  };
  /// The least magnitude so far while it sank, and when.
  struct Trough {
    double size, time;
  };

  void look_at(std::size_t place, std::size_t lane, double before, double after, double tolerance,
               LaneStates& lanes);
  bool grows_by_itself(const Watched& watched, double since, std::size_t lane, LaneStates& lanes);
  /// Of the watched one with this number; behind the last one, of all together.
  Trough& trough(std::size_t place, std::size_t lane) { return troughs_[place * width_ + lane]; }

  const LaneProgram& program_;
  const LaneKernels& kernels_;
  std::size_t width_;
  std::vector<Watched> watched_;
  std::vector<Trough> troughs_;
  std::vector<char> risen_;
  bool evaluated_ = false;  ///< the derivatives stand in the slots, at the ends of the steps
};

}  // namespace oblique::ensemble
