// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <oblique/ensemble/lanes/lane_code.h>
#include <oblique/network/program/tape.h>

// Not installed.
namespace oblique::ensemble {

/// A tape for lanes: the same operations, so ordered that those of one kind stand in a row, as far as what
/// they need allows. The kernel then asks once a row what to do, and not once an operation.
class LaneTape {
 public:
  LaneTape() = default;
  /// `slot_of` gives the slot in the lanes of a slot of the instructions. Each result is written once.
  LaneTape(std::span<const network::Instruction> instructions,
           const std::function<std::uint32_t(std::uint32_t)>& slot_of);

  LaneTapeCode code() const {
    return {ranges_.data(), static_cast<std::uint32_t>(ranges_.size()), steps_.data()};
  }
  std::size_t size() const { return steps_.size(); }

  /// Lets results of tapes that run one after the other have the same slot where they do not live at the same
  /// time: what is small stays near the processor. `kept` are read afterwards. Gives the new slot of each of
  /// the `n_slots`: first those that are no results, in their order.
  static std::vector<std::uint32_t> share_slots(std::span<LaneTape* const> tapes,
                                                std::span<const std::uint32_t> kept, std::size_t n_slots);

 private:
  std::vector<LaneRange> ranges_;
  std::vector<LaneStep> steps_;
};

/// Whether lanes can run all of them.
bool lanes_can_run(std::span<const network::Instruction> instructions);

}  // namespace oblique::ensemble
