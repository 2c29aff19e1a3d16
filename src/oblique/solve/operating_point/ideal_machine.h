// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include <oblique/network/program/program.h>
#include <oblique/solve/stability/linearisation.h>
#include <oblique/solve/stability/signal_flow.h>

namespace oblique::solve {

/// Groups of more states that act on each other are not given to dense eigenvalue methods.
inline constexpr std::size_t kMostStatesForModes = 200;

/// The same diagram on a machine whose amplifiers have infinite gain and bandwidth. An amplifier that is
/// brought to rest then holds its equation exactly: where the real one has τ ẋ_s = −x_s − μ r, the ideal one
/// has r = 0. What remains of df/dx = A is the pencil
///
///     λ x_p = A_pp x_p + A_ps x_s,      0 = R_p x_p + R_s x_s,
///
/// with R the rows of A of these amplifiers for μ → ∞. Its finite eigenvalues are the modes of the problem; a
/// mode of the real machine that is none of them comes from the machine. Where the equation answers its
/// amplifier through lags only, R_s is 0 and the pencil has fewer eigenvalues than states x_p: also those
/// lags' modes are then the loop's.
class IdealMachine {
 public:
  /// `diagram` and `program` belong together and must outlive this.
  IdealMachine(const diagram::FlatDiagram& diagram, const network::Program& program);

  /// Linearises at an instant. `actual` has just evaluated the real machine there. False where the ideal
  /// machine has no linearisation.
  bool look_at(const Instant& instant, const network::Workspace& actual);

  /// Whether any state of the group would be no state on an ideal machine.
  bool differs_in(const std::vector<std::size_t>& group) const;

  /// Those of some states, at the last instant, that are outputs of amplifiers open by themselves: it is the
  /// diagram that closes a loop around them. A summer or multiplier, which follows its inputs whatever the
  /// diagram does, is not.
  std::vector<std::size_t> open_amplifiers(const std::vector<std::size_t>& states);

  /// For each of the `modes` of a group, at the last instant, the mode of the ideal machine that it is: the
  /// problem's own. Nothing for one that comes from the machine. Where the ideal machine has no solution at
  /// all, a mode is the machine's if states that are brought to rest have the greater share in it.
  std::vector<std::optional<std::complex<double>>> problem_modes(const std::vector<std::size_t>& group,
                                                                 const std::vector<Mode>& modes) const;

 private:
  /// M of a group, equations of amplifiers scaled to 1, and which rows are differential.
  struct Pencil {
    Eigen::SparseMatrix<double> matrix;
    std::vector<Eigen::Index> differential;
  };
  Pencil pencil_of(const std::vector<std::size_t>& group) const;
  /// Its finite eigenvalues above and on the real axis; nothing where the pencil is singular.
  std::optional<std::vector<std::complex<double>>> poles(const std::vector<std::size_t>& group) const;
  /// That of a large group which is nearest to `pole`; nothing where none is found.
  std::optional<std::complex<double>> pole_near(const std::vector<std::size_t>& group,
                                                std::complex<double> pole) const;

  const network::Program& real_;
  diagram::FlatDiagram diagram_;
  network::Program program_;
  SignalFlow flow_;
  std::vector<std::optional<std::size_t>> state_of_;    ///< here, of a state of the real machine
  std::vector<std::size_t> real_state_, real_unknown_;  ///< of a state and an unknown here
  network::Workspace workspace_;
  Instant here_;  ///< the last instant, with the states here
  std::optional<Linearisation> linear_;
};

/// For each of the modes of a group the mode of the ideal machine that it is, or nothing where it comes from
/// the machine. The nearest are taken first; none is near where a slow servo has moved it beyond recognition.
/// A mode that grows by more than 1 % a radian (Dow's errors of good amplifiers are below that) and at more
/// than twice the rate that it has on the ideal machine comes from the machine too.
std::vector<std::optional<std::complex<double>>> match_modes(const std::vector<Mode>& modes,
                                                             const std::vector<std::complex<double>>& ideal);

}  // namespace oblique::solve
