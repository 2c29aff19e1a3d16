// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/text/diagnostic.h>

namespace oblique::solve {

/// From so many machine units on a signal has left any machine.
inline constexpr double kFarOutside = 100;

/// The largest |signal| in each eighth of a run, and whether it grows without end, as RunawayWatch has it.
using SizeAlong = std::array<double, 8>;
bool grows_without_end(const SizeAlong& largest);
/// The eighth in which this part of the run lies, from 0 on.
std::size_t eighth_of(double part);

/// Notices signals that leave the machine by far. Where no machine unit binds them, as on an ideal machine
/// with a problem in its own units, large numbers alone mean nothing: then only those count that grow without
/// end: in each of the last eighths of the run by at least a factor √2 and in the very last one about as fast
/// as before, which no power of the time does.
class RunawayWatch {
 public:
  /// The run goes from `begin` to `end` [s]. `any_size`: signals are bound to the machine unit.
  RunawayWatch(const network::Program& program, double begin, double end, bool any_size);

  /// Takes a row.
  void look_at(double t, std::span<const double> signals);

  /// One warning at most, about the signal that went furthest and how many others did.
  std::vector<text::Diagnostic> warnings(const std::string& file) const;

 private:
  struct Record {
    SizeAlong largest{};
    double peak = 0, peak_time = 0;  ///< with its sign
    double left = -1;                ///< [s] when it passed kFarOutside
  };

  const network::Program& program_;
  double begin_, end_;
  bool any_size_;
  std::vector<Record> records_;
};

}  // namespace oblique::solve
