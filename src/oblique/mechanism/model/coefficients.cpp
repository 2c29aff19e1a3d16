// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/coefficients.h>

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/mechanism/analysis/instant_centre.h>
#include <oblique/mechanism/analysis/transmission.h>
#include <oblique/mechanism/model/inertia.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The unit of a derivative by the drive: "mm/rad^2", "rad/mm", "1".
std::string quotient(const std::string& unit, const std::string& by, int order) {
  if (unit == by && order == 1) return "1";
  if (unit == by) return "1/" + by;
  return unit + "/" + by + (order == 2 ? "^2" : "");
}

class Columns {
 public:
  Columns(const Mechanism& mechanism, const Motion& motion)
      : mechanism_(mechanism),
        motion_(motion),
        by_(mechanism.drives.front().slide ? mechanism.length_unit : "rad") {}

  template <class Value>
  void add(std::string name, std::string unit, Value&& value) {
    MotionColumn column{std::move(name), std::move(unit), {}};
    column.values.reserve(motion_.times.size());
    for (std::size_t row = 0; row < motion_.times.size(); ++row) column.values.push_back(value(row));
    columns_.push_back(std::move(column));
  }

  /// Two columns of coefficients from a function that gives rate and acceleration in a configuration.
  template <class Rates>
  void add_coefficients(const std::string& owner, const std::string& quantity, const std::string& unit,
                        Rates&& rates) {
    const auto of_row = [this, &rates](std::size_t row) {
      const auto [rate, acceleration] = rates(motion_.configurations[row]);
      return kinematic_coefficients(rate, acceleration, motion_.drives[row].front());
    };
    add(fmt::format("{}.d{}", owner, quantity), quotient(unit, by_, 1),
        [&](std::size_t row) { return of_row(row).first; });
    add(fmt::format("{}.dd{}", owner, quantity), quotient(unit, by_, 2),
        [&](std::size_t row) { return of_row(row).second; });
  }

  void add_points() {
    for (std::size_t p = 0; p < mechanism_.points.size(); ++p) {
      if (mechanism_.points[p].fixed) continue;
      for (const int axis : {0, 1}) {
        add_coefficients(mechanism_.points[p].name, axis == 0 ? "x" : "y", mechanism_.length_unit,
                         [p, axis](const Configuration& here) {
                           const PointState& state = here.points[p];
                           return std::pair{state.velocity(axis), state.acceleration(axis)};
                         });
      }
    }
  }

  void add_bodies() {
    for (std::size_t b = 0; b < mechanism_.bodies.size(); ++b) {
      const std::string& name = mechanism_.bodies[b].name;
      add_coefficients(name, "angle", "rad", [b](const Configuration& here) {
        return std::pair{here.bodies[b].omega, here.bodies[b].alpha};
      });
      for (const int axis : {0, 1}) {
        add(name + (axis == 0 ? ".icx" : ".icy"), mechanism_.length_unit, [&](std::size_t row) {
          const auto centre = instant_centre(mechanism_, motion_.configurations[row], std::nullopt, b);
          return centre.position ? (*centre.position)(axis) : kNaN;
        });
      }
    }
    for (std::size_t s = 0; s < mechanism_.slides.size(); ++s) {
      add_coefficients(mechanism_.slides[s].name, "position", mechanism_.length_unit,
                       [s](const Configuration& here) {
                         return std::pair{here.slides[s].velocity, here.slides[s].acceleration};
                       });
    }
  }

  void add_groups(const Structure& structure) {
    for (const Group& group : structure.groups) {
      const auto measure = measure_of(group);
      if (!measure || *measure == Transmission::Measure::determinant) continue;
      const bool pressure = *measure == Transmission::Measure::pressure_angle;
      add(group.name + (pressure ? ".pressure" : ".transmission"), "rad", [&](std::size_t row) {
        return transmission_in(group, motion_.configurations[row]).value_or(kNaN);
      });
    }
  }

  void add_inertia() {
    if (!has_masses(mechanism_)) return;
    const Drive& drive = mechanism_.drives.front();
    add(drive.name + ".inertia", drive.slide ? "kg" : "kg*m^2", [&](std::size_t row) {
      return reduced_inertia(mechanism_, motion_.configurations[row], motion_.drives[row].front());
    });
    add(drive.name + ".energy", "J",
        [&](std::size_t row) { return kinetic_energy(mechanism_, motion_.configurations[row]); });
  }

  std::vector<MotionColumn> take() { return std::move(columns_); }

 private:
  const Mechanism& mechanism_;
  const Motion& motion_;
  std::string by_;
  std::vector<MotionColumn> columns_;
};

}  // namespace

Coefficients kinematic_coefficients(double rate, double acceleration, const DriveState& drive) {
  if (drive.rate == 0) return {kNaN, kNaN};
  const double first = rate / drive.rate;
  return {first, (acceleration - first * drive.acceleration) / (drive.rate * drive.rate)};
}

std::vector<MotionColumn> analysis_columns(const Mechanism& mechanism, const Structure& structure,
                                           const Motion& motion) {
  Columns columns(mechanism, motion);
  columns.add_points();
  columns.add_bodies();
  columns.add_groups(structure);
  columns.add_inertia();
  return columns.take();
}

}  // namespace oblique::mechanism
