// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include <oblique/solve/stability/linearisation.h>

namespace oblique::solve {

/// Above every real part of the eigenvalues of `a` [1/s], or infinity. By Gershgorin no real part is above
/// max_i a_ii + Σ_j |a_ij| d_j/d_i, whatever the weights d > 0. Those are made better by powers of the matrix
/// |a_ij|/|a_ii|, which tend to its Perron vector; the bound falls below zero if any weights do that.
double real_part_bound(const Eigen::SparseMatrix<double>& a);

/// Whether every eigenvalue of `a` is proven to lie left of the imaginary axis: by the bound, or because
/// a + aᵀ is negative definite. False proves nothing.
bool is_proven_stable(const Eigen::SparseMatrix<double>& a);

/// Modes of a large sparse dx/dt = a x, of the states `group`: the rightmost and the least damped that
/// Arnoldi's method finds about shifts σ > 0 in every decade of rates. With (a − σ)⁻¹ an eigenvalue right of
/// the axis lies outside the disc that holds all others, and outer ones are found first (Meerbergen, Spence
/// and Roose, BIT 34, 1994). Each is then iterated to rounding. One that hides among many as fast and hardly
/// damped may be missed. The first has the largest real part; none where nothing converges.
std::vector<Mode> rightmost_modes(const Eigen::SparseMatrix<double>& a,
                                  const std::vector<std::size_t>& group);

}  // namespace oblique::solve
