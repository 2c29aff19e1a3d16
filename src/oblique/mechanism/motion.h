// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <oblique/mechanism/configuration.h>

namespace oblique {

/// An exact motion as a table: row k stands for times[k], drive_angles[k] and configurations[k].
/// Angles of bodies are continuous from row to row, not wrapped; those of the first row that can be assembled
/// are in (−π, π], except for driven bodies, which have their drive's angle.
struct Motion {
  std::vector<double> times;                      ///< [s]
  std::vector<std::vector<double>> drive_angles;  ///< [rad], one for each drive in every row
  std::vector<Configuration> configurations;
};

/// Time of one turn of the first drive, 2π/|speed| [s]. Throws MechanismError (kind `request`) without a
/// drive.
double period(const Mechanism& mechanism);

/// Throws MechanismError (kind `request`) where a drive turns so often in `duration` [s] that nobody would
/// wait for a motion that follows it: more than kMostTurns times.
void check_travel(const Mechanism& mechanism, double duration);
inline constexpr double kMostTurns = 1e4;

/// One turn of the first drive in `positions` ≥ 2 rows t_k = T·k/(positions − 1), both ends included.
/// Assembly modes keep their side of P → Q, also through a dead centre. Throws as `decompose`, and
/// MechanismError (kind `request`) without a drive or for fewer than two positions.
Motion solve_motion(const Mechanism& mechanism, int positions);

/// As above at any times [s] (finite, in any order). Throws as `check_travel` for the way from each time to
/// the next, taken together.
Motion solve_motion(const Mechanism& mechanism, std::span<const double> times);
Motion solve_motion(const Mechanism& mechanism, const Structure& structure, std::span<const double> times);

/// A named column of a motion.
struct MotionColumn {
  std::string name;
  std::string unit;
  std::vector<double> values;  ///< one for each row; NaN where there is no value
};

/// `t`; each drive; `P.x P.y P.vx P.vy P.ax P.ay` of every moving point; `b.angle b.omega b.alpha` of every
/// body. The last column of the file, `status`, is text and not among these.
std::vector<MotionColumn> motion_columns(const Mechanism& mechanism, const Motion& motion);

/// The columns and `status` as CSV: a header of names, then a line for each row; numbers read back to the
/// same bits, what has no value is empty.
std::string motion_csv(const Mechanism& mechanism, const Motion& motion);

}  // namespace oblique
