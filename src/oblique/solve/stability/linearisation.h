// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// Below this part of the largest entry of a matrix, or of its norm, a pole is rounding.
inline constexpr double kZeroPole = 1e-13;

/// A moment of a run.
struct Instant {
  double t = 0;                              ///< [s]
  std::vector<double> states;                ///< n_states
  std::vector<double> discrete_states = {};  ///< as many as the program has; none: as before the run
};

/// The states in groups that act on each other, ascending in each; each after the groups whose signals it
/// follows. The matrix df/dx is block triangular in this order: its eigenvalues are those of the diagonal
/// blocks, and no mode has a participation outside its block.
std::vector<std::vector<std::size_t>> coupled_groups(const network::Program& program);

/// df/dx of a program at an instant, all signals frozen there; algebraic loops are closed in it.
class Linearisation {
 public:
  /// Nothing where an algebraic loop has no solution or a derivative is no number.
  static std::optional<Linearisation> at(const network::Program& program, network::Workspace& workspace,
                                         const Instant& instant);

  /// The rows and columns of `group`, whose states ascend [1/s].
  Eigen::MatrixXd block(const std::vector<std::size_t>& group) const;
  /// The same, of a large group.
  Eigen::SparseMatrix<double> sparse_block(const std::vector<std::size_t>& group) const;
  /// The greatest magnitude in the row of every state [1/s].
  std::vector<double> largest_in_rows() const;

 private:
  Linearisation(const network::Program& program, std::vector<double> values)
      : program_(&program), values_(std::move(values)) {}
  const network::Program* program_;
  std::vector<double> values_;  ///< in the order of the program's pattern
};

/// How much a state takes part in a mode.
struct Participation {
  std::size_t state = 0;
  double share = 0;  ///< all of a mode together are 1
};

/// A mode of a linear system, e^(pole t); of a conjugate pair the one above the real axis.
struct Mode {
  std::complex<double> pole;                ///< [1/s]
  std::vector<Participation> participants;  ///< of every state of its group, the greatest share first
  /// How far rounding may have moved the pole [1/s]: ε‖A‖ times the condition of the eigenvalue, or √ε‖A‖
  /// where that is less (a double pole).
  double rounding = 0;

  double natural_frequency() const { return std::abs(pole); }  ///< ω₀ [rad/s]
  /// ζ = −Re p/|p|: 1 and above for a decay, 0 for an undamped oscillation, negative where the mode grows.
  double damping_ratio() const { return -pole.real() / std::abs(pole); }
};

/// A diagonal matrix D, of powers of 2, for which the rows and columns of D⁻¹ `matrix` D are about alike
/// (Osborne 1960): slow modes beside fast ones then lose less to rounding.
Eigen::VectorXd balance(const Eigen::MatrixXd& matrix);

/// The modes of dx/dt = `block` x. `group` names the states of its rows. Poles that are 0 to rounding, of
/// integrators that no feedback reaches, are left out. The share of state k in a mode with right eigenvector
/// v and left eigenvector w is |w_k v_k|/Σ|w_j v_j| (participation factors: Pérez-Arriaga, Verghese and
/// Schweppe, IEEE Trans. PAS 101, 1982), which depends on no scaling of the states.
std::vector<Mode> modes_of(const Eigen::MatrixXd& block, const std::vector<std::size_t>& group);

}  // namespace oblique::solve
