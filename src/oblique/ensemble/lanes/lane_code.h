// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

// What the kernels run: plain data, so that units compiled for other instruction sets share no code with the
// rest. Not installed.
namespace oblique::ensemble {

/// What a run of operations computes. All others are `other`: a call for each lane.
enum class LaneOp : std::uint32_t {
  add,
  subtract,
  multiply,
  divide,
  negate,
  sqrt,
  sin,
  cos,
  multiply_add,       ///< a·b + c
  multiply_subtract,  ///< c − a·b
  other
};

/// One operation on slots; a slot holds a number for each lane.
struct LaneStep {
  std::uint32_t a, b, c, result;
};

/// Operations of one kind in a row: `steps[begin]` to `steps[end − 1]`.
struct LaneRange {
  LaneOp op;
  std::uint32_t code;  ///< of `other`: network::Instruction::Code
  std::uint32_t begin, end;
};

/// A tape in ranges of one kind each.
struct LaneTapeCode {
  const LaneRange* ranges;
  std::uint32_t n_ranges;
  const LaneStep* steps;
};

/// An LU factorisation in a straight line, its order and fill fixed: places in an array of entries.
struct StraightLuCode {
  std::uint32_t n;
  /// Of each pivot: its place; how many rows, how many columns; the places of the columns; for each row its
  /// place in the pivot's column, then the places of that row in the columns.
  const std::uint32_t* factor;
  /// Of each row in pivot order: the right side's index; how many entries left of the pivot; of each its
  /// place and the pivot.
  const std::uint32_t* forward;
  /// From the last pivot to the first: index of the unknown; how many entries right of the pivot; of each its
  /// place and the pivot.
  const std::uint32_t* backward;
};

/// Where ∂F/∂u goes in the matrix M/(hγ) − ∂F/∂u.
struct LaneMatrixCode {
  std::uint32_t n_entries;        ///< with those that fill in
  std::uint32_t n_steps;          ///< subtractions of a slot from an entry
  const std::uint32_t* steps;     ///< entry, slot
  std::uint32_t n_states;         ///< the first rows, which have a mass
  const std::uint32_t* diagonal;  ///< entries of these rows on the diagonal
};

/// The kernels for one instruction set and number of lanes. All arrays hold `width` numbers for each index.
/// The same numbers come out of each lane whatever the set and the width: every operation is rounded by
/// itself (no fused ones), and lanes do not meet.
struct LaneKernels {
  const char* set;
  int width;

  void (*run)(const LaneTapeCode& tape, double* slots);
  /// M·scale − ∂F/∂u; `scale` [width].
  void (*matrix)(const LaneMatrixCode& code, const double* slots, const double* scale, double* entries);
  /// Factors in place. `reciprocals`: of the pivots; `growth` [width]: the largest multiplier.
  void (*factor)(const StraightLuCode& lu, double* entries, double* reciprocals, double* growth);
  /// x = A⁻¹ b; `work` [n].
  void (*solve)(const StraightLuCode& lu, const double* entries, const double* reciprocals, const double* b,
                double* work, double* x);
  /// out = base + Σ factors[k] · terms[k].
  void (*combine)(std::uint32_t n, std::uint32_t n_terms, const double* factors, const double* const* terms,
                  const double* base, double* out);
  /// out = base + scale · Σ factors[k] · terms[k]; `scale` [width]; `base` may be null, and is then 0.
  void (*advance)(std::uint32_t n, std::uint32_t n_terms, const double* factors, const double* const* terms,
                  const double* scale, const double* base, double* out);
  /// out = base + Σ weights[k] · terms[k]; `weights` [n_terms, width].
  void (*weigh)(std::uint32_t n, std::uint32_t n_terms, const double* weights, const double* const* terms,
                const double* base, double* out);
  /// out = F + M · (Σ factors[k] · terms[k]) · scale + by_time · time_scale; `scale`, `time_scale` [width];
  /// `by_time` may be null.
  void (*right_side)(std::uint32_t n, std::uint32_t n_states, std::uint32_t n_terms, const double* factors,
                     const double* const* terms, const double* scale, const double* by_time,
                     const double* time_scale, const double* const* rates, double* out);
  /// The largest |error| / (absolute + relative · max(|before|, |after|)) of each lane; no number where any
  /// is none. `absolute` [n, one for all lanes].
  void (*norm)(std::uint32_t n, const double* error, const double* before, const double* after,
               const double* absolute, double relative, double* out);
  /// to = from in the lanes where `where` is not 0.
  void (*take)(std::uint32_t n, const double* where, const double* from, double* to);
  /// The polynomial of a step between its ends at `theta` [width], and its derivative by `theta`.
  void (*between)(std::uint32_t n, const double* theta, const double* before, const double* after,
                  const double* c1, const double* c2, const double* c3, double* out, double* slope);
};

/// What a lane does that the kernels do not: one operation on numbers.
double lane_other(std::uint32_t code, double a, double b, double c);

}  // namespace oblique::ensemble
