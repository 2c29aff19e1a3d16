// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/model/mechanism.h>

namespace oblique::synthesis {

/// Where a point of a mechanism is wanted.
struct TargetPath {
  std::string file;
  std::size_t point = 0;                   ///< index in Mechanism::points
  std::vector<Eigen::Vector2d> positions;  ///< [length unit]
  std::string timing;         ///< the column that tells when: a drive, or "t"; empty: timing is free
  std::vector<double> times;  ///< [s], ascending, one for each position; empty: timing is free
};

/// Reads a table (CSV) with the columns `P.x` and `P.y` [length unit] of one moving point P, and at most one
/// of `t` [s] and the name of a drive [rad]. Throws ReadError, and SynthesisError (kind `request`) where
/// columns or numbers make no such path, or where its times span more than one turn of the first drive.
TargetPath read_target_path(std::string_view csv, const std::string& file,
                            const mechanism::Mechanism& mechanism);

}  // namespace oblique::synthesis
