// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// States that act on each other, and the eigenvalues of their part of the Jacobian [1/s]: none where they
/// are too many, or the Jacobian is not finite.
struct CoupledModes {
  std::vector<std::size_t> states;
  std::vector<std::complex<double>> eigenvalues;
};

/// Finds the modes of the equations linearised, group by group. Taken by groups, the eigenvalues of a chain
/// of integrators are zero: those of the whole matrix would be the n-th root of rounding. Which states act on
/// each other is found anew only where other elements of the Jacobian than before are zero. Not installed.
class ModeFinder {
 public:
  /// `pattern` must outlive this.
  explicit ModeFinder(const network::SparsePattern& pattern) : pattern_(pattern) {}

  /// Those of `among` alone (the others are held). `jacobian` has the values of the pattern. The groups stay
  /// until the next call.
  const std::vector<CoupledModes>& find(std::span<const double> jacobian, const std::vector<bool>& among);

 private:
  /// An element of the Jacobian by its place in the block of a group.
  struct Element {
    std::size_t entry;
    std::uint32_t row, column;
  };

  void find_groups();

  const network::SparsePattern& pattern_;
  std::vector<bool> among_, acts_, acts_now_;
  std::vector<CoupledModes> groups_;
  std::vector<std::vector<Element>> elements_;  ///< of each group
};

/// The modes once.
std::vector<CoupledModes> coupled_modes(const network::SparsePattern& pattern,
                                        std::span<const double> jacobian, const std::vector<bool>& among);

/// The modes of the whole group that some states which act on each other belong to, the others of it let go.
CoupledModes closed_modes(const network::SparsePattern& pattern, std::span<const double> jacobian,
                          std::size_t member);

}  // namespace oblique::solve
