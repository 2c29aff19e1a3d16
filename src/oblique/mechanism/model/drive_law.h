// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <oblique/mechanism/model/mechanism.h>
#include <oblique/text/quantity.h>

namespace oblique::mechanism {

/// What a drive gives at one moment: an angle [rad] or a distance [length unit], and its rates by time.
struct DriveState {
  double value = 0;
  double rate = 0;
  double acceleration = 0;
};

/// A speed that varies: an expression of `time` [s] in units of `scale`.
struct SpeedLaw {
  text::Expression speed;
  double scale = 1;
};

/// The law in a text such as "2 + sin(3*time) rad/s", or nothing where the text does not name `time`. Throws
/// ExpressionError for other names, for functions with kinks or jumps (the acceleration would have no value
/// there) and for a unit of another dimension.
std::optional<SpeedLaw> parse_law(std::string_view text, const text::Unit& unit);

/// Rate and acceleration of a drive at time `t` [s] (`value` is not set).
DriveState law_at(const Drive& drive, double t);

/// The drives of a mechanism over time. The values of laws are integrated from time 0 by Gauss and Kronrod's
/// 7 and 15 points on intervals that are halved until both agree to rounding, and until interval arithmetic
/// bounds the speed by what those points show: a short peak between them is not passed over. What was
/// integrated is kept, so one object serves one thread.
class DriveClock {
 public:
  explicit DriveClock(const Mechanism& mechanism);

  /// Sets one state for each drive.
  void at(double t, std::span<DriveState> states);

  /// Where a drive stands at time `t` [s].
  DriveState at(std::size_t drive, double t);

  /// The first time after 0 at which a drive has gone `wanted` [rad or length unit] from its start, in either
  /// direction; nothing within `latest` [s].
  std::optional<double> time_of_way(std::size_t drive, double wanted, double latest);

 private:
  double way(std::size_t drive, double t);

  /// What was integrated from a panel's beginning on, in pieces so short that one rule does for each: a law
  /// that varies many times in a panel is not integrated anew at each moment of it.
  struct Piece {
    double from = 0;  ///< [s]
    double way = 0;   ///< of the drive up to there
  };
  struct Pieces {
    double panel = 0, step = 0;  ///< where it begins and how wide it is (below 0: before time 0) [s]
    std::vector<Piece> all;
  };

  const Mechanism& mechanism_;
  double panel_;                              ///< width of the intervals whose ways are kept [s]
  int parts_left_;                            ///< that a law may be looked at in
  std::vector<std::vector<double>> forward_;  ///< for each drive its way up to k of them
  std::vector<std::vector<double>> backward_;
  std::vector<Pieces> last_;  ///< for each drive, of the panel that was asked for last
};

}  // namespace oblique::mechanism
