// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <span>
#include <vector>

#include <oblique/network/program.h>

namespace oblique {

/// States that act on each other, and the eigenvalues of their part of the Jacobian [1/s]: none where they
/// are too many, or the Jacobian is not finite.
struct CoupledModes {
  std::vector<std::size_t> states;
  std::vector<std::complex<double>> eigenvalues;
};

/// The modes of the equations linearised, group by group, those of `among` alone (the others are held).
/// `jacobian` has the values of `pattern`. Taken by groups, the eigenvalues of a chain of integrators are
/// zero: those of the whole matrix would be the n-th root of rounding. Not installed.
std::vector<CoupledModes> coupled_modes(const SparsePattern& pattern, std::span<const double> jacobian,
                                        const std::vector<bool>& among);

/// The modes of the whole group that some states which act on each other belong to, the others of it let go.
CoupledModes closed_modes(const SparsePattern& pattern, std::span<const double> jacobian, std::size_t member);

}  // namespace oblique
