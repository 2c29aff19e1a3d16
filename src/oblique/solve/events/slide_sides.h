// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>

// What a slide mixes (see SlidingMode). Not installed.
namespace oblique::solve {

/// What breaks the event functions of units, so that they may be none to slide on.
struct Breaks {
  /// Of each of these units, up to 64, the others (as bits) whose positions break its event function, itself
  /// or by a switch that follows: one that jumps with that of another, where that makes a difference, is none
  /// to slide on.
  std::vector<std::uint64_t> by_others;
  std::vector<bool> by_itself;     ///< it jumps or bends with its own position: none to slide on
  std::vector<bool> by_followers;  ///< with those that follow it: it must not jump, but may bend
};
Breaks find_breaks(const network::Program& program, const std::vector<std::uint32_t>& units);

/// One combination of sides of the units that slide: bit u of `bits` for unit u.
struct SlideSide {
  std::uint64_t bits = 0;
  std::optional<std::uint32_t> cluster;  ///< nothing for the first side, which is of all
  std::vector<std::pair<std::uint32_t, double>>
      positions;  ///< discrete states, of what slides and what follows
  /// Of each follower: its event function is at zero on the switching surface, where it began or since.
  std::vector<bool> follower_rests;
  std::vector<double> unknowns;  ///< of algebraic loops, as they were solved last with these positions
  std::vector<double> dxdt;
  std::vector<double> event_functions, rates;  ///< of every switch
  double weight = 0;
};

/// All sides of a slide: one with all units below, then of each cluster of coupled units all other
/// combinations.
class SlideSides {
 public:
  /// It must outlive this.
  explicit SlideSides(const network::SwitchStructure& structure) : structure_(structure) {}

  /// Makes them anew for these units. Units are of one cluster where they are coupled, directly or through
  /// others, and those at the places of each of `together`: positions that follow may couple them too.
  void make(const std::vector<std::uint32_t>& units, const std::vector<std::vector<std::size_t>>& together);
  void clear();

  /// Whether no cluster was too large to make all its combinations.
  bool are_all() const;
  std::size_t units() const { return cluster_of_.size(); }
  bool is_coupled(std::size_t unit) const;

  /// Gives each side its weight for these shares of the units: all together are 1.
  void weigh(std::span<const double> shares);

  /// Of values of switches, that of a unit: above zero on its upper side.
  double of_unit(const std::vector<double>& of_switches, std::size_t unit) const;

  std::size_t size() const { return sides_.size(); }
  const SlideSide& operator[](std::size_t side) const { return sides_[side]; }
  auto begin() { return sides_.begin(); }
  auto end() { return sides_.end(); }
  auto begin() const { return sides_.begin(); }
  auto end() const { return sides_.end(); }

 private:
  std::size_t cluster_size(std::size_t unit) const;

  const network::SwitchStructure& structure_;
  std::vector<std::uint32_t> first_switch_;  ///< of each unit
  std::vector<std::uint32_t> cluster_of_;    ///< of each unit
  std::vector<SlideSide> sides_;
};

}  // namespace oblique::solve
