// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/motion/motion_event.h>

namespace oblique::mechanism {

struct Structure;

/// An exact motion as a table: row k stands for times[k], drives[k] and configurations[k]. Angles of links
/// are continuous from row to row, not wrapped; those of the start are in (−π, π], except for driven links,
/// which have their drive's angle.
struct Motion {
  std::vector<double> times;                    ///< [s]
  std::vector<std::vector<DriveState>> drives;  ///< one for each drive in every row
  std::vector<Configuration> configurations;
  std::vector<MotionEvent> events;
};

struct MotionOptions {
  int positions = 361;              ///< rows, both ends included
  std::optional<double> until;      ///< end of the motion [s]; default: that of the file, or `cycle`
  std::optional<AtLimit> at_limit;  ///< default: that of the file, or `open`
};

/// How far a mechanism can go from its start, within one turn of its first drive each way: nothing where it
/// meets no limit.
struct MotionLimits {
  std::optional<MotionEvent> backward, forward;
};

/// Time of the motion [s]: that of the file, or one turn of the first drive. Throws MechanismError (kind
/// `request`) without a drive, for one that moves a prismatic joint, and for a law that makes no full turn.
double period(const Mechanism& mechanism);

/// How long a motion lasts by itself: `period`, or for a first drive that moves a prismatic joint the way to
/// both limits and back.
double cycle(const Mechanism& mechanism, const Structure& structure);

/// So many rows over `cycle`, both ends included, that each turn of the fastest drive in it has
/// `over_a_turn`; with more than `most` intervals between them only where one turn has. (Of a prime no two
/// turns are looked at in the same places.) Throws as `period`.
int rows_over_motion(const Mechanism& mechanism, int over_a_turn, int most = 3607);

/// Throws MechanismError (kind `request`) where a drive turns so often in `duration` [s] that nobody would
/// wait for a motion that follows it: more than kMostTurns times.
void check_travel(const Mechanism& mechanism, double duration);
inline constexpr double kMostTurns = 1e4;

/// The limits before and after the start.
MotionLimits find_range(const Mechanism& mechanism, const Structure& structure);

/// The moment at which the first drive first stands at `value` [rad] or [length unit]: whole turns are taken
/// off or added where it lies behind. Nothing where it does not come there within a hundred turns (or longest
/// links).
std::optional<double> time_at_value(const Mechanism& mechanism, double value);

/// One row of a motion while it is made.
struct MotionRow {
  double time = 0;
  std::span<const DriveState> drives;
  const Configuration& configuration;
};

/// Makes a motion row by row, without keeping it; otherwise as `solve_motion`. Gives the events.
std::vector<MotionEvent> visit_motion(const Mechanism& mechanism, const Structure& structure,
                                      const MotionOptions& options,
                                      const std::function<void(const MotionRow&)>& visit);

/// A motion in `options.positions` ≥ 2 rows at equal distances of time, both ends included. A first drive
/// that moves a prismatic joint is reversed at its limits unless the options say otherwise. Throws
/// MechanismError (kind `request`) without a drive or for fewer than two positions, and as `decompose`.
Motion solve_motion(const Mechanism& mechanism, const MotionOptions& options);
Motion solve_motion(const Mechanism& mechanism, int positions);

/// As above at any times [s] (finite, in any order). Throws as `check_travel` for the way from each time to
/// the next, taken together.
Motion solve_motion(const Mechanism& mechanism, std::span<const double> times);
Motion solve_motion(const Mechanism& mechanism, const Structure& structure, std::span<const double> times);

/// Name and unit of a column of a motion.
struct MotionColumnName {
  std::string name;
  std::string unit;
};

/// `t`; each drive; `P.x P.y P.vx P.vy P.ax P.ay` of every moving point; `b.angle b.omega b.alpha` of every
/// link; `s.position s.velocity s.acceleration` of every prismatic joint. The last column of the file,
/// `status`, is text and not among these.
std::vector<MotionColumnName> motion_column_names(const Mechanism& mechanism);

/// The values of these columns in one row; NaN where there is no value.
void motion_values(const Mechanism& mechanism, const MotionRow& row, std::span<double> values);

/// A column of a motion with its values, one for each row.
struct MotionColumn {
  std::string name;
  std::string unit;
  std::vector<double> values;
};
std::vector<MotionColumn> motion_columns(const Mechanism& mechanism, const Motion& motion);

}  // namespace oblique::mechanism
