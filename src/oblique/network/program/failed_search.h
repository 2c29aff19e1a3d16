// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/loop_matrix.h>

namespace oblique::network {

/// The last search for a solution of an algebraic loop, where it found none. Where a run seeks its start such
/// a loop is passed over and asked for again thousands of times, mostly with all that it reads unchanged: it
/// would be sought the same way, as far. Not installed.
class FailedSearch {
 public:
  /// Notes a search that began at the unknowns `origin` and ended, without a solution, at those on the slots.
  /// `how` is what else led it.
  void note(const LoopCode& loop, std::span<const Instruction> body, const double* slots,
            const Eigen::VectorXd& origin, int how);
  void forget() { known_ = false; }

  /// Whether a search that begins here is the noted one. The unknowns' slots then hold where it ended.
  bool repeats(const LoopCode& loop, double* slots, int how) const;

 private:
  void list_read(const LoopCode& loop, std::span<const Instruction> body);

  bool known_ = false, listed_ = false;
  bool has_tables_ = false;  ///< what they hold is not on the slots that instructions name
  int how_ = 0;
  std::vector<std::uint32_t> read_;  ///< slots that the body reads and does not compute, but the unknowns
  std::vector<double> read_values_;
  std::vector<double> begin_, end_;  ///< the unknowns
};

}  // namespace oblique::network
