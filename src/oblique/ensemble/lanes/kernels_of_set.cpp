// SPDX-License-Identifier: MIT
// Compiled once for each instruction set: OBLIQUE_LANE_KERNELS is then the name of what it gives, and
// OBLIQUE_LANE_SET that of the set. So nothing here may be an inline function of a library: the linker could
// take it for all units. Each operation is rounded by itself (-ffp-contract=off), so that all sets give the
// same numbers.
#include <oblique/ensemble/lanes/kernels_of_set.h>

#include <cstddef>
#include <cstdint>

extern "C" double sin(double) noexcept;
extern "C" double cos(double) noexcept;

namespace oblique::ensemble {
namespace {

using Index = std::uint32_t;

#if defined(__AVX512F__)
constexpr std::uint32_t kBest = 8;
#elif defined(__AVX2__)
constexpr std::uint32_t kBest = 4;
#else
constexpr std::uint32_t kBest = 2;
#endif

template <std::uint32_t width>
struct Vectors {
  static constexpr Index kSize = width < kBest ? width : kBest;
  static constexpr Index kParts = width / kSize;
  // An attribute that depends on a parameter: only typedef takes it. NOLINTBEGIN(modernize-use-using)
  typedef double Vector __attribute__((vector_size(8 * kSize), aligned(8 * kSize), may_alias));
  typedef std::int64_t Whole __attribute__((vector_size(8 * kSize), aligned(8 * kSize), may_alias));
  // NOLINTEND(modernize-use-using)
};

// --- sine and cosine: the argument less the nearest odd or even multiple of π/2, which is known to 33 + 33 +
// 53 bits (Cody and Waite), then a polynomial for the sine within ±π/2, of least relative error. Three units
// in the last place up to kFarthest.

constexpr double kFarthest = 1e5;
constexpr double kRound = 6755399441055744.0;  // 1.5 · 2^52: what is added rounds to a whole number

/// The sine or cosine of a slot, and the largest magnitude so far.
template <std::uint32_t width>
void turn(const double* x, double* out, bool of_cosine, typename Vectors<width>::Vector* largest) {
  using Vs = Vectors<width>;
  using V = typename Vs::Vector;
  using W = typename Vs::Whole;
  const double half = of_cosine ? 0.5 : 0;
  const std::int64_t quarter = of_cosine ? 1 : 0;
  V sine[Vs::kParts];
  for (Index p = 0; p < Vs::kParts; ++p) {
    const V argument = ((const V*)x)[p];
    V& most = largest[p];
    const V size = argument < 0 ? -argument : argument;
    most = size <= most ? most : size;
    const V shifted = (argument * 3.18309886183790691216e-01 - half) + kRound;
    const V quarters = 2.0 * ((shifted - kRound) + half);
    const V high = argument - quarters * 1.57079632673412561417e+00;
    const V low = quarters * 6.07710050630396597660e-11;
    const V r = high - low;
    const V rest = ((high - r) - low) - quarters * 2.02226624879595063154e-21;
    const V z = r * r, z2 = z * z, z4 = z2 * z2;
    const V bend = ((-0.16666666666666666 + z * 0.008333333333333316) +
                    z2 * (-0.00019841269841254885 + z * 2.7557319219139174e-06)) +
                   z4 * ((-2.5052107613933993e-08 + z * 1.6058977114025027e-10) +
                         z2 * (-7.643963964341869e-13 + z * 2.7313658477694193e-15));
    sine[p] = r + ((rest - rest * (0.5 * z)) + r * (z * bend));
    const W odd = ((W)shifted + quarter) << 63;  // of π, as the sign bit
    sine[p] = (V)((W)sine[p] ^ odd);
  }
  for (Index p = 0; p < Vs::kParts; ++p) ((V*)out)[p] = sine[p];
}

template <std::uint32_t width>
struct Kernels {
  using Vs = Vectors<width>;
  using V = typename Vs::Vector;
  using W = typename Vs::Whole;
  static constexpr Index kParts = Vs::kParts;

  static const V* at(const double* array, Index i) {
    return (const V*)(array + static_cast<std::size_t>(i) * width);
  }
  static V* at(double* array, Index i) { return (V*)(array + static_cast<std::size_t>(i) * width); }
  static V magnitude(V x) { return x < 0 ? -x : x; }

  /// Those of a range; what is too far for the polynomial is left to the library.
  static void turn_all(const LaneStep* begin, const LaneStep* end, bool of_cosine, double* slots) {
    V largest[kParts] = {};
    for (const LaneStep* i = begin; i != end; ++i)
      turn<width>((const double*)at(slots, i->a), (double*)at(slots, i->result), of_cosine, largest);
    bool far = false;
    for (Index l = 0; l < width; ++l) far = far || !(((const double*)largest)[l] < kFarthest);
    if (!far) return;
    for (const LaneStep* i = begin; i != end; ++i) {  // once more, each before those that may read it
      const auto* const x = (const double*)at(slots, i->a);
      auto* const result = (double*)at(slots, i->result);
      turn<width>(x, result, of_cosine, largest);
      for (Index l = 0; l < width; ++l) {
        if (!(x[l] < kFarthest && x[l] > -kFarthest)) result[l] = of_cosine ? ::cos(x[l]) : ::sin(x[l]);
      }
    }
  }

  static void run(const LaneTapeCode& tape, double* slots) {
    for (Index g = 0; g < tape.n_ranges; ++g) {
      const LaneRange& range = tape.ranges[g];
      const LaneStep* const end = tape.steps + range.end;
      const LaneStep* i = tape.steps + range.begin;
      switch (range.op) {
#define OBLIQUE_LANE_OP(name, formula)                                                            \
  case LaneOp::name:                                                                              \
    for (; i != end; ++i) {                                                                       \
      const V *const a = at(slots, i->a), *const b = at(slots, i->b), *const c = at(slots, i->c); \
      (void)b;                                                                                    \
      (void)c;                                                                                    \
      V results[kParts];                                                                          \
      for (Index p = 0; p < kParts; ++p) results[p] = formula;                                    \
      V* const result = at(slots, i->result);                                                     \
      for (Index p = 0; p < kParts; ++p) result[p] = results[p];                                  \
    }                                                                                             \
    break;
        OBLIQUE_LANE_OP(add, a[p] + b[p])
        OBLIQUE_LANE_OP(subtract, a[p] - b[p])
        OBLIQUE_LANE_OP(multiply, a[p] * b[p])
        OBLIQUE_LANE_OP(divide, a[p] / b[p])
        OBLIQUE_LANE_OP(negate, -a[p])
        OBLIQUE_LANE_OP(multiply_add, a[p] * b[p] + c[p])
        OBLIQUE_LANE_OP(multiply_subtract, c[p] - a[p] * b[p])
#undef OBLIQUE_LANE_OP
        case LaneOp::sqrt:
          for (; i != end; ++i) {
            const auto* const a = (const double*)at(slots, i->a);
            auto* const result = (double*)at(slots, i->result);
            for (Index l = 0; l < width; ++l) result[l] = __builtin_sqrt(a[l]);
          }
          break;
        case LaneOp::sin:
        case LaneOp::cos:
          turn_all(i, end, range.op == LaneOp::cos, slots);
          break;
        case LaneOp::other:
          for (; i != end; ++i) {
            const auto *const a = (const double*)at(slots, i->a), *const b = (const double*)at(slots, i->b),
                              *const c = (const double*)at(slots, i->c);
            auto* const result = (double*)at(slots, i->result);
            for (Index l = 0; l < width; ++l) result[l] = lane_other(range.code, a[l], b[l], c[l]);
          }
          break;
      }
    }
  }

  static void matrix(const LaneMatrixCode& code, const double* slots, const double* scale, double* entries) {
    for (Index k = 0; k < code.n_entries; ++k) {
      for (Index p = 0; p < kParts; ++p) at(entries, k)[p] = V{};
    }
    for (Index k = 0; k < code.n_steps; ++k) {
      V* const entry = at(entries, code.steps[std::size_t{2} * k]);
      const V* const slot = at(slots, code.steps[std::size_t{2} * k + 1]);
      for (Index p = 0; p < kParts; ++p) entry[p] -= slot[p];
    }
    for (Index i = 0; i < code.n_states; ++i) {
      V* const entry = at(entries, code.diagonal[i]);
      for (Index p = 0; p < kParts; ++p) entry[p] += ((const V*)scale)[p];
    }
  }

  static void factor(const StraightLuCode& lu, double* entries, double* reciprocals, double* growth) {
    V largest[kParts] = {};
    const Index* code = lu.factor;
    for (Index k = 0; k < lu.n; ++k) {
      const V* const pivot = at(entries, *code++);
      const Index n_rows = *code++, n_columns = *code++;
      const Index* const columns = code;
      code += n_columns;
      V reciprocal[kParts];
      for (Index p = 0; p < kParts; ++p) at(reciprocals, k)[p] = reciprocal[p] = 1.0 / pivot[p];
      for (Index r = 0; r < n_rows; ++r) {
        V* const multiplier = at(entries, *code++);
        V m[kParts];
        for (Index p = 0; p < kParts; ++p) {
          multiplier[p] = m[p] = multiplier[p] * reciprocal[p];
          const V size = magnitude(m[p]);
          largest[p] = size <= largest[p] ? largest[p] : size;
        }
        for (Index c = 0; c < n_columns; ++c) {
          V* const entry = at(entries, *code++);
          const V* const above = at(entries, columns[c]);
          for (Index p = 0; p < kParts; ++p) entry[p] -= m[p] * above[p];
        }
      }
    }
    for (Index p = 0; p < kParts; ++p) ((V*)growth)[p] = largest[p];
  }

  static void solve(const StraightLuCode& lu, const double* entries, const double* reciprocals,
                    const double* b, double* work, double* x) {
    const Index* code = lu.forward;
    for (Index k = 0; k < lu.n; ++k) {
      V sum[kParts];
      const V* const right = at(b, *code++);
      for (Index p = 0; p < kParts; ++p) sum[p] = right[p];
      for (Index left = *code++; left > 0; --left) {
        const V* const entry = at(entries, *code++);
        const V* const known = at(work, *code++);
        for (Index p = 0; p < kParts; ++p) sum[p] -= entry[p] * known[p];
      }
      for (Index p = 0; p < kParts; ++p) at(work, k)[p] = sum[p];
    }
    code = lu.backward;
    for (Index k = lu.n; k-- > 0;) {
      V sum[kParts];
      for (Index p = 0; p < kParts; ++p) sum[p] = at(work, k)[p];
      V* const unknown = at(x, *code++);
      for (Index right = *code++; right > 0; --right) {
        const V* const entry = at(entries, *code++);
        const V* const known = at(work, *code++);
        for (Index p = 0; p < kParts; ++p) sum[p] -= entry[p] * known[p];
      }
      for (Index p = 0; p < kParts; ++p) at(work, k)[p] = unknown[p] = sum[p] * at(reciprocals, k)[p];
    }
  }

  static void combine(Index n, Index n_terms, const double* factors, const double* const* terms,
                      const double* base, double* out) {
    for (Index i = 0; i < n; ++i) {
      V sum[kParts];
      for (Index p = 0; p < kParts; ++p) sum[p] = base == nullptr ? V{} : at(base, i)[p];
      for (Index k = 0; k < n_terms; ++k) {
        const V* const term = at(terms[k], i);
        for (Index p = 0; p < kParts; ++p) sum[p] += factors[k] * term[p];
      }
      for (Index p = 0; p < kParts; ++p) at(out, i)[p] = sum[p];
    }
  }

  static void advance(Index n, Index n_terms, const double* factors, const double* const* terms,
                      const double* scale, const double* base, double* out) {
    for (Index i = 0; i < n; ++i) {
      V sum[kParts] = {};
      for (Index k = 0; k < n_terms; ++k) {
        if (factors[k] == 0) continue;
        const V* const term = at(terms[k], i);
        for (Index p = 0; p < kParts; ++p) sum[p] += factors[k] * term[p];
      }
      for (Index p = 0; p < kParts; ++p) {
        const V change = sum[p] * ((const V*)scale)[p];
        at(out, i)[p] = base == nullptr ? change : at(base, i)[p] + change;
      }
    }
  }

  static void weigh(Index n, Index n_terms, const double* weights, const double* const* terms,
                    const double* base, double* out) {
    for (Index i = 0; i < n; ++i) {
      V sum[kParts];
      for (Index p = 0; p < kParts; ++p) sum[p] = at(base, i)[p];
      for (Index k = 0; k < n_terms; ++k) {
        const V *const term = at(terms[k], i), *const weight = at(weights, k);
        for (Index p = 0; p < kParts; ++p) sum[p] += weight[p] * term[p];
      }
      for (Index p = 0; p < kParts; ++p) at(out, i)[p] = sum[p];
    }
  }

  static void right_side(Index n, Index n_states, Index n_terms, const double* factors,
                         const double* const* terms, const double* scale, const double* by_time,
                         const double* time_scale, const double* const* rates, double* out) {
    for (Index i = 0; i < n; ++i) {
      V sum[kParts] = {};
      if (i < n_states) {
        for (Index k = 0; k < n_terms; ++k) {
          const V* const term = at(terms[k], i);
          for (Index p = 0; p < kParts; ++p) sum[p] += factors[k] * term[p];
        }
        for (Index p = 0; p < kParts; ++p) sum[p] *= ((const V*)scale)[p];
      }
      const V* const rate = (const V*)rates[i];
      for (Index p = 0; p < kParts; ++p) sum[p] += rate[p];
      if (by_time != nullptr) {
        for (Index p = 0; p < kParts; ++p) sum[p] += at(by_time, i)[p] * ((const V*)time_scale)[p];
      }
      for (Index p = 0; p < kParts; ++p) at(out, i)[p] = sum[p];
    }
  }

  static void norm(Index n, const double* error, const double* before, const double* after,
                   const double* absolute, double relative, double* out) {
    V largest[kParts] = {}, nothing[kParts] = {};
    for (Index i = 0; i < n; ++i) {
      for (Index p = 0; p < kParts; ++p) {
        const V a = magnitude(at(before, i)[p]), b = magnitude(at(after, i)[p]);
        const V size = magnitude(at(error, i)[p]) / (absolute[i] + relative * (a > b ? a : b));
        largest[p] = size > largest[p] ? size : largest[p];
        nothing[p] += 0.0 * size + 0.0 * b;  // no number where one of them is none
      }
    }
    for (Index p = 0; p < kParts; ++p) ((V*)out)[p] = largest[p] + nothing[p];
  }

  static void take(Index n, const double* where, const double* from, double* to) {
    for (Index i = 0; i < n; ++i) {
      for (Index p = 0; p < kParts; ++p)
        at(to, i)[p] = ((const V*)where)[p] != 0 ? at(from, i)[p] : at(to, i)[p];
    }
  }

  static void between(Index n, const double* theta, const double* before, const double* after,
                      const double* c1, const double* c2, const double* c3, double* out, double* slope) {
    for (Index i = 0; i < n; ++i) {
      for (Index p = 0; p < kParts; ++p) {
        const V t = ((const V*)theta)[p], s = 1.0 - t;
        const V a = at(before, i)[p], b = at(after, i)[p], k1 = at(c1, i)[p], k2 = at(c2, i)[p],
                k3 = at(c3, i)[p];
        const V bend = k1 + t * (k2 + t * k3);
        at(out, i)[p] = s * a + t * (b + s * bend);
        at(slope, i)[p] = (b - a) + (s - t) * bend + t * s * (k2 + 2.0 * t * k3);
      }
    }
  }

  static constexpr LaneKernels all(const char* set) {
    return {set,     static_cast<int>(width),
            run,     matrix,
            factor,  solve,
            combine, advance,
            weigh,   right_side,
            norm,    take,
            between};
  }
};

}  // namespace

const LaneKernels OBLIQUE_LANE_KERNELS[kWidths] = {
    Kernels<4>::all(OBLIQUE_LANE_SET), Kernels<8>::all(OBLIQUE_LANE_SET), Kernels<16>::all(OBLIQUE_LANE_SET)};

}  // namespace oblique::ensemble
