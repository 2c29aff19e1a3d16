// SPDX-License-Identifier: MIT
#include <oblique/solve/operating_point/ideal_machine.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>

#include <Eigen/LU>

#include <oblique/solve/stability/eigenvalues.h>
#include <oblique/solve/stability/sparse_factors.h>

#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/quasi_steady.h>

namespace oblique::solve {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// What an infinite gain leaves of an amplifier's own pole in its equation is below this part of the rest.
constexpr double kVanished = 1e-13;
/// A pole of the ideal machine that is further away, as a part of the larger of the two, is another one.
constexpr double kSamePole = 0.5;
/// What a mode may grow a radian by the small errors of good amplifiers without being theirs.
constexpr double kSmallGrowth = 0.01;

using Complex = std::complex<double>;

/// Finite eigenvalues by shift and invert about `shift`: with T the rows and columns x_p of (M − σE)⁻¹ they
/// are σ + 1/ν for the eigenvalues ν of T, and those at infinity have ν = 0.
std::optional<std::vector<Complex>> poles_about(const Eigen::MatrixXd& matrix,
                                                const std::vector<Eigen::Index>& differential, double shift) {
  Eigen::MatrixXd shifted = matrix;
  for (const Eigen::Index i : differential) shifted(i, i) -= shift;
  for (Eigen::Index i = 0; i < shifted.rows(); ++i) {
    const double size = shifted.row(i).cwiseAbs().maxCoeff();
    if (!(size > 0) || !std::isfinite(size)) return std::nullopt;
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(shifted);
  if (!lu.isInvertible()) return std::nullopt;
  const Eigen::MatrixXd inverse = lu.inverse();
  const Eigen::MatrixXd map = inverse(differential, differential);
  if (!map.allFinite()) return std::nullopt;
  std::vector<Complex> poles;
  if (map.rows() == 0) return poles;
  const Eigen::VectorXcd values = eigenvalues_of(map);
  for (const Complex& value : values) {
    if (std::abs(value) > kVanished * map.cwiseAbs().maxCoeff()) poles.push_back(shift + 1.0 / value);
  }
  return poles;
}

diagram::FlatDiagram idealised(diagram::FlatDiagram diagram) {
  constexpr double kHighGain = 1e18;  // still a state where the amplifier has a bandwidth
  for (diagram::FlatBlock& block : diagram.blocks) {
    const auto gain = block.definition->find_parameter("gain");
    const auto bandwidth = block.definition->find_parameter("bandwidth");
    if (!bandwidth) continue;
    if (is_brought_to_rest(*block.definition)) {
      if (gain && std::isfinite(block.parameters[*gain])) block.parameters[*gain] = kHighGain;
      continue;
    }
    if (!gain) continue;
    block.parameters[*gain] = block.parameters[*bandwidth] = kInfinity;
    block.choose_behaviour();
  }
  return diagram;
}

}  // namespace

IdealMachine::IdealMachine(const diagram::FlatDiagram& diagram, const network::Program& program)
    : real_(program),
      diagram_(idealised(diagram)),
      program_(network::assemble(diagram_)),
      flow_(diagram_, program_),
      state_of_(program.n_states()),
      workspace_(program_) {
  std::unordered_map<std::string_view, std::size_t> states, unknowns;
  for (std::size_t i = 0; i < program.n_states(); ++i) states.emplace(program.states()[i].name, i);
  for (std::size_t u = 0; u < program.unknowns().size(); ++u) unknowns.emplace(program.unknowns()[u].name, u);
  for (const network::State& state : program_.states()) {
    const auto found = states.find(state.name);
    real_state_.push_back(found == states.end() ? program.n_states() : found->second);
    if (found != states.end()) state_of_[found->second] = real_state_.size() - 1;
  }
  for (const network::Unknown& unknown : program_.unknowns()) {
    const auto found = unknowns.find(unknown.name);
    real_unknown_.push_back(found == unknowns.end() ? program.unknowns().size() : found->second);
  }
}

bool IdealMachine::look_at(const Instant& instant, const network::Workspace& actual) {
  linear_.reset();
  if (program_.discrete_states().size() != real_.discrete_states().size()) return false;
  here_ = {instant.t, program_.start(), instant.discrete_states};
  for (std::size_t i = 0; i < here_.states.size(); ++i) {
    if (real_state_[i] < real_.n_states()) here_.states[i] = instant.states[real_state_[i]];
  }
  for (std::size_t u = 0; u < real_unknown_.size(); ++u) {
    if (real_unknown_[u] < real_.unknowns().size())
      workspace_.set_unknown(u, actual.unknown(real_unknown_[u]));
  }
  linear_ = Linearisation::at(program_, workspace_, here_);
  return linear_.has_value();
}

bool IdealMachine::differs_in(const std::vector<std::size_t>& group) const {
  return std::any_of(group.begin(), group.end(), [&](std::size_t i) {
    return !state_of_[i] || program_.states()[*state_of_[i]].at_rest;
  });
}

std::vector<std::size_t> IdealMachine::open_amplifiers(const std::vector<std::size_t>& states) {
  std::vector<std::size_t> found;
  std::vector<double> signals(program_.n_signals());
  if (!linear_ || !program_.signals(here_.t, here_.states.data(), signals.data(), workspace_)) return found;
  const std::vector<double> largest = linear_->largest_in_rows();
  constexpr double kOpen = 1e-9;  // far above the rounding of own_derivative, far below a follower's 1
  for (const std::size_t state : states) {
    if (!state_of_[state] || !real_.states()[state].at_rest) continue;
    const auto own = flow_.own_derivative(real_.states()[state].name, here_.t, signals);
    if (own && std::abs(*own) < kOpen * largest[*state_of_[state]]) found.push_back(state);
  }
  return found;
}

std::vector<std::optional<Complex>> IdealMachine::problem_modes(const std::vector<std::size_t>& group,
                                                                const std::vector<Mode>& modes) const {
  std::vector<std::optional<Complex>> found(modes.size());
  if (!differs_in(group)) {
    for (std::size_t m = 0; m < modes.size(); ++m) found[m] = modes[m].pole;
    return found;
  }
  if (linear_ && group.size() > kMostStatesForModes) {
    for (std::size_t m = 0; m < modes.size(); ++m) {
      if (const auto near = pole_near(group, modes[m].pole))
        found[m] = match_modes({modes[m]}, {*near}).front();
    }
    return found;
  }
  if (linear_) {
    if (const auto ideal = poles(group)) return match_modes(modes, *ideal);
  }
  for (std::size_t m = 0; m < modes.size(); ++m) {
    double share = 0;
    for (const Participation& p : modes[m].participants)
      share += real_.states()[p.state].at_rest ? p.share : 0;
    if (share < 0.5) found[m] = modes[m].pole;
  }
  return found;
}

IdealMachine::Pencil IdealMachine::pencil_of(const std::vector<std::size_t>& group) const {
  std::vector<std::size_t> here;
  for (const std::size_t i : group) {
    if (state_of_[i]) here.push_back(*state_of_[i]);
  }
  std::sort(here.begin(), here.end());
  Pencil pencil;
  pencil.matrix = linear_->sparse_block(here);
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(pencil.matrix.rows());
  for (Eigen::Index c = 0; c < pencil.matrix.outerSize(); ++c) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(pencil.matrix, c); entry; ++entry)
      scale[entry.row()] = std::max(scale[entry.row()], std::abs(entry.value()));
  }
  for (std::size_t k = 0; k < here.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    if (program_.states()[here[k]].at_rest) continue;
    pencil.differential.push_back(row);
    scale[row] = 0;
  }
  for (Eigen::Index c = 0; c < pencil.matrix.outerSize(); ++c) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(pencil.matrix, c); entry; ++entry) {
      if (scale[entry.row()] == 0) continue;
      const double value = entry.value() / scale[entry.row()];
      entry.valueRef() = std::abs(value) < kVanished ? 0 : value;
    }
  }
  return pencil;
}

std::optional<std::vector<Complex>> IdealMachine::poles(const std::vector<std::size_t>& group) const {
  if (!linear_) return std::nullopt;
  const Pencil pencil = pencil_of(group);
  const Eigen::MatrixXd matrix = pencil.matrix;
  // Two shifts of the size of the rates that remain: an eigenvalue at infinity is an artefact of each of its
  // own, wherever rounding has put it.
  double size = 0;
  for (const Eigen::Index i : pencil.differential) size = std::max(size, matrix.row(i).cwiseAbs().maxCoeff());
  if (size == 0) size = 1;
  const auto first = poles_about(matrix, pencil.differential, 0.618 * size);
  const auto second = poles_about(matrix, pencil.differential, 1.447 * size);
  if (!first || !second) return std::nullopt;
  std::vector<Complex> found;
  constexpr double kAgree = 1e-3;
  for (const Complex& pole : *first) {
    const bool again = std::any_of(second->begin(), second->end(), [&](const Complex& other) {
      return std::abs(other - pole) <= kAgree * (std::abs(pole) + 1e-9 * size);
    });
    if (again && pole.imag() >= 0) found.push_back(pole);
  }
  return found;
}

std::optional<Complex> IdealMachine::pole_near(const std::vector<std::size_t>& group, Complex pole) const {
  if (!linear_) return std::nullopt;
  const Pencil pencil = pencil_of(group);
  Eigen::SparseMatrix<Complex> shifted = pencil.matrix.cast<Complex>();
  Eigen::VectorXcd weight = Eigen::VectorXcd::Zero(shifted.rows());
  const Complex shift = pole * (1.0 + 1e-3);  // where it is one of the ideal machine's, not on it
  for (const Eigen::Index i : pencil.differential) {
    shifted.coeffRef(i, i) -= shift;
    weight[i] = 1;
  }
  shifted.makeCompressed();
  const SparseFactors<Complex> lu(shifted);
  if (!lu.exist()) return std::nullopt;
  // The power method on (M − σE)⁻¹E, whose greatest eigenvalue is that of the pole nearest to σ.
  Eigen::VectorXcd x(shifted.rows());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    x[i] = weight[i] * std::polar(1.0, static_cast<double>(i) * 0.7548776662466927);
  if (x.norm() == 0) return std::nullopt;
  x.normalize();
  constexpr int kPowers = 30;
  Complex value = 0;
  for (int k = 0; k < kPowers; ++k) {
    const Eigen::VectorXcd next = weight.cwiseProduct(lu.solve(x));
    value = x.dot(next);
    if (!(next.norm() > 0) || !std::isfinite(next.norm())) return std::nullopt;
    x = next.normalized();
  }
  if (value == 0.0) return std::nullopt;
  return shift + 1.0 / value;
}

std::vector<std::optional<Complex>> match_modes(const std::vector<Mode>& modes,
                                                const std::vector<Complex>& ideal) {
  struct Pair {
    double distance;
    std::size_t mode, pole;
  };
  std::vector<Pair> pairs;
  for (std::size_t m = 0; m < modes.size(); ++m) {
    for (std::size_t p = 0; p < ideal.size(); ++p) {
      const double larger = std::max(std::abs(modes[m].pole), std::abs(ideal[p]));
      const double distance = std::abs(modes[m].pole - ideal[p]) / larger;
      if (distance <= kSamePole) pairs.push_back({distance, m, p});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<std::optional<Complex>> problem(modes.size());
  std::vector<bool> taken(ideal.size(), false), matched(modes.size(), false);
  for (const Pair& pair : pairs) {
    if (matched[pair.mode] || taken[pair.pole]) continue;
    matched[pair.mode] = taken[pair.pole] = true;
    const Complex pole = modes[pair.mode].pole;
    const bool grows_slowly = pole.real() <= kSmallGrowth * std::abs(pole);
    if (grows_slowly || ideal[pair.pole].real() >= pole.real() / 2) problem[pair.mode] = ideal[pair.pole];
  }
  return problem;
}

}  // namespace oblique::solve
