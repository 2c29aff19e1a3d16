// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/rightmost_modes.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SparseCholesky>

#include <oblique/solve/stability/eigenvalues.h>
#include <oblique/solve/stability/sparse_factors.h>

namespace oblique::solve {
namespace {

using Complex = std::complex<double>;
using Sparse = Eigen::SparseMatrix<double>;
using ComplexSparse = Eigen::SparseMatrix<Complex>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Eigen::Index kSubspace = 60;   ///< of Arnoldi's method about one shift
constexpr int kDecades = 9;              ///< of rates, down from the norm
constexpr double kPromising = 1e-2;      ///< relative residual of a guess that is worth iterating
constexpr std::size_t kMostRefined = 4;  ///< of the rightmost, and of the least damped
constexpr std::size_t kMostTried = 12;
constexpr double kZeroGuess = 1e-11;  ///< of the norm: a guess that will be 0

/// Numbers without a pattern, the same in every run: multiples of an irrational number.
Eigen::VectorXd start_vector(Eigen::Index n) {
  Eigen::VectorXd start(n);
  for (Eigen::Index i = 0; i < n; ++i)
    start[i] = std::sin(1 + 0.7548776662466927 * static_cast<double>(i * i % 9973));
  return start.normalized();
}

double largest_row_sum(const Sparse& a) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(a.rows());
  for (Eigen::Index c = 0; c < a.outerSize(); ++c) {
    for (Sparse::InnerIterator entry(a, c); entry; ++entry) sums[entry.row()] += std::abs(entry.value());
  }
  return sums.lpNorm<Eigen::Infinity>();
}

template <class Matrix, class Scalar>
Matrix minus_shift(const Sparse& a, Scalar shift) {
  Matrix identity(a.rows(), a.cols());
  identity.setIdentity();
  Matrix shifted = a.cast<typename Matrix::Scalar>() - shift * identity;
  shifted.makeCompressed();
  return shifted;
}

struct Guess {
  Complex pole;
  Eigen::VectorXcd vector;
};

/// Ritz values of Arnoldi's method on (a − shift)⁻¹ with a small residual in a.
void collect_guesses(const Sparse& a, double shift, std::vector<Guess>& guesses) {
  const SparseFactors<double> lu(minus_shift<Sparse>(a, shift));
  if (!lu.exist()) return;
  const Eigen::Index most = std::min(kSubspace, a.rows());
  Eigen::MatrixXd basis(a.rows(), most + 1);
  Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(most + 1, most);
  basis.col(0) = start_vector(a.rows());
  Eigen::Index size = 0;
  while (size < most) {
    Eigen::VectorXd next = lu.solve(basis.col(size));
    if (!next.allFinite()) break;
    const double before = next.norm();
    for (int pass = 0; pass < 2; ++pass) {  // twice is enough (Kahan)
      const Eigen::VectorXd along = basis.leftCols(size + 1).transpose() * next;
      projected.col(size).head(size + 1) += along;
      next -= basis.leftCols(size + 1) * along;
    }
    const double rest = next.norm();
    projected(size + 1, size) = rest;
    ++size;
    if (rest <= 1e-14 * before) break;  // the space is closed: its Ritz values are eigenvalues
    basis.col(size) = next / rest;
  }
  if (size == 0) return;
  const auto system = eigensystem_of(projected.topLeftCorner(size, size));
  if (!system) return;
  for (Eigen::Index k = 0; k < size; ++k) {
    const Complex value = system->values[k];
    if (value == 0.0 || value.imag() > 0) continue;  // of a pair: below the axis here is above it in a
    const Complex pole = shift + 1.0 / value;
    Eigen::VectorXcd vector = basis.leftCols(size) * system->vectors.col(k);
    vector.normalize();
    const double residual = (a * vector - pole * vector).norm();
    if (residual <= kPromising * std::abs(pole - shift)) guesses.push_back({pole, std::move(vector)});
  }
}

/// Inverse iteration with the guess as the shift, for the vectors of both sides; nothing where it does not
/// come to rest.
std::optional<Mode> refine(const Sparse& a, const Guess& guess, const std::vector<std::size_t>& group,
                           double norm) {
  Complex pole = guess.pole;
  Eigen::VectorXcd right = guess.vector;
  const ComplexSparse complex_a = a.cast<Complex>();
  const double epsilon = std::numeric_limits<double>::epsilon();
  constexpr int kMostShifts = 6;
  for (int k = 0; k < kMostShifts; ++k) {
    const double residual = (complex_a * right - pole * right).norm();
    if (residual <= 4 * epsilon * norm) break;
    // Beside the eigenvalue, so that the matrix is not singular to the last bit.
    const Complex shift = pole + epsilon * norm * Complex(1, 1);
    const SparseFactors<Complex> lu(minus_shift<ComplexSparse>(a, shift));
    if (!lu.exist()) break;
    const Eigen::VectorXcd next = lu.solve(right);
    if (!next.allFinite() || !(next.norm() > 0)) break;
    right = next.normalized();
    pole = right.dot(complex_a * right);
  }
  constexpr double kConverged = 1e-10;  // of the norm: far below any rate that is told
  if (!((complex_a * right - pole * right).norm() <= kConverged * norm)) return std::nullopt;
  Eigen::VectorXcd left = Eigen::VectorXcd::Ones(a.rows());
  const Complex beside = std::conj(pole) + 1e-12 * norm * Complex(1, 1);
  const SparseFactors<Complex> lu(minus_shift<ComplexSparse>(Sparse(a.transpose()), beside));
  if (lu.exist()) {
    left = start_vector(a.rows()).cast<Complex>();
    for (int k = 0; k < 3; ++k) left = lu.solve(left).normalized();
  }
  Mode mode;
  mode.pole = pole.imag() < 0 ? std::conj(pole) : pole;
  if (std::abs(mode.pole.imag()) <= 1e-12 * norm) mode.pole = mode.pole.real();
  const double overlap = std::abs(left.dot(right));
  const double condition = overlap > 0 ? left.norm() * right.norm() / overlap : kInfinity;
  mode.rounding = std::min(condition * epsilon, std::sqrt(epsilon)) * norm;
  Eigen::VectorXd shares = (left.array() * right.array()).abs();
  if (!shares.allFinite() || !(shares.sum() > 0)) shares.setOnes();
  shares /= shares.sum();
  for (Eigen::Index k = 0; k < shares.size(); ++k)
    mode.participants.push_back({group[static_cast<std::size_t>(k)], shares[k]});
  std::stable_sort(mode.participants.begin(), mode.participants.end(),
                   [](const Participation& x, const Participation& y) { return x.share > y.share; });
  return mode;
}

}  // namespace

double real_part_bound(const Sparse& a) {
  const Eigen::VectorXd diagonal = a.diagonal();
  if (diagonal.size() == 0 || !(diagonal.maxCoeff() < 0)) return kInfinity;
  constexpr int kMostPowers = 60;
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(a.rows()), sums(a.rows());
  for (int power = 0; power < kMostPowers; ++power) {
    sums.setZero();
    for (Eigen::Index c = 0; c < a.outerSize(); ++c) {
      for (Sparse::InnerIterator entry(a, c); entry; ++entry) {
        if (entry.row() != c) sums[entry.row()] += std::abs(entry.value()) * weights[c];
      }
    }
    const double bound = (diagonal.array() + sums.array() / weights.array()).maxCoeff();
    if (bound < 0) return bound;
    weights += (sums.array() / -diagonal.array()).matrix();
    weights /= weights.maxCoeff();
    weights = weights.cwiseMax(std::numeric_limits<double>::min());
  }
  return kInfinity;
}

bool is_proven_stable(const Sparse& a) {
  if (real_part_bound(a) < 0) return true;
  const Sparse turned = -(a + Sparse(a.transpose()));
  if (!(turned.diagonal().minCoeff() > 0)) return false;
  const Eigen::SimplicialLDLT<Sparse> cholesky(turned);
  // Well above the rounding of the factors.
  return cholesky.info() == Eigen::Success &&
         cholesky.vectorD().minCoeff() > 1e-12 * cholesky.vectorD().maxCoeff();
}

std::vector<Mode> rightmost_modes(const Sparse& a, const std::vector<std::size_t>& group) {
  std::vector<Mode> modes;
  const double norm = largest_row_sum(a);
  if (!(norm > 0) || !std::isfinite(norm)) return modes;
  std::vector<Guess> guesses;
  double shift = norm;
  for (int k = 0; k < kDecades; ++k, shift /= 10) collect_guesses(a, shift, guesses);
  // Integrators that no feedback reaches are found about every shift, each time with another rounding.
  guesses.erase(std::remove_if(guesses.begin(), guesses.end(),
                               [&](const Guess& guess) { return std::abs(guess.pole) <= kZeroGuess * norm; }),
                guesses.end());
  const auto refine_first = [&] {
    std::size_t tried = 0, found = 0;
    for (const Guess& guess : guesses) {
      if (found == kMostRefined || ++tried > kMostTried) return;
      const auto mode = refine(a, guess, group, norm);
      if (!mode || std::abs(mode->pole) <= kZeroPole * norm) continue;
      ++found;
      const bool known = std::any_of(modes.begin(), modes.end(), [&](const Mode& other) {
        return std::abs(other.pole - mode->pole) <= 1e-9 * norm;
      });
      if (!known) modes.push_back(*mode);
    }
  };
  // The same eigenvalue is found about several shifts.
  const auto unite = [&](const auto& worse) {
    std::stable_sort(guesses.begin(), guesses.end(), worse);
    guesses.erase(std::unique(guesses.begin(), guesses.end(),
                              [](const Guess& x, const Guess& y) {
                                return std::abs(x.pole - y.pole) <= 1e-3 * std::abs(x.pole);
                              }),
                  guesses.end());
  };
  unite([](const Guess& x, const Guess& y) { return x.pole.real() > y.pole.real(); });
  refine_first();
  unite([](const Guess& x, const Guess& y) {
    return -x.pole.real() / std::abs(x.pole) < -y.pole.real() / std::abs(y.pole);
  });
  refine_first();
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Mode& x, const Mode& y) { return x.pole.real() > y.pole.real(); });
  return modes;
}

}  // namespace oblique::solve
