// SPDX-License-Identifier: MIT
#include "linkage_by_hand.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include "figures.h"

namespace oblique::bench {
namespace {

using Index = sunindextype;

constexpr double kHold = 0.1;  // of the crank's circle
constexpr std::size_t kMostPoints = 32;

void check(bool good) {
  if (!good) throw std::runtime_error("the hand-written linkage failed");
}

std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

/// A dyad with what is constant in it, and where its entries of the Jacobian stand.
struct Dyad {
  std::size_t c, p, q;
  double r1, side, per_reach, adjacent, half_per_adjacent, opposite_squared;
  Index first;  ///< of its five states
  /// By a state that its base P → Q depends on: its places in the gradients of P and Q (−1: none), and in the
  /// rows of L, cos ψ and sin ψ.
  struct BaseEntry {
    int of_p, of_q;
    Index length, cosine, sine;
  };
  std::vector<BaseEntry> base;
  Index by_length[4], own[4], sine_by_cosine, by_variable;
};

/// Two points that another is made of: P + (a + i b)(Q − P).
struct Carried {
  std::size_t point, p, q;
  double a, b;
  std::vector<std::array<int, 2>> sources;  ///< of each place in its gradient, those of P and Q
};

class Linkage {
 public:
  Linkage(const HandLinkage& made, const HandSettings& settings)
      : made_(made),
        rate_(2 * std::numbers::pi * settings.bandwidth),
        gain_(rate_ * settings.gain * settings.input_gain),
        speed_(settings.crank_speed) {
    depends_[0] = {0, 1};
    if (made.mirror) depends_[*made.mirror] = {0, 1};
    for (const HandLinkage::Fixed& fixed : made.fixed) {
      x_[fixed.point] = fixed.x;
      y_[fixed.point] = fixed.y;
    }
    Index next = 2;
    for (const HandLinkage::Step& step : made.steps) {
      if (step.carried) {
        add(*step.carried);
        is_dyad_.push_back(false);
      } else {
        add(*step.dyad, next);
        is_dyad_.push_back(true);
        next += 5;
      }
    }
    if (made.loop) variable_ = next++;
    size_ = next;
    lay_out();
  }

  Index size() const { return size_; }
  std::size_t columns() const { return 1 + 2 * made_.shown.size(); }
  Index entries() const { return static_cast<Index>(rows_.size()); }

  void derivatives(const double* x, double* d) {
    const double excess = kHold * std::abs(speed_) * (1 - x[0] * x[0] - x[1] * x[1]);
    d[0] = -speed_ * x[1] + excess * x[0];
    d[1] = speed_ * x[0] + excess * x[1];
    place(x, [&](const Dyad& dyad, double dx, double dy) {
      const double* const s = x + dyad.first;
      double* const out = d + dyad.first;
      const double opposite_squared =
          dyad.opposite_squared >= 0 ? dyad.opposite_squared : x[variable_] * x[variable_];
      out[0] = -rate_ * s[0] - gain_ * (s[0] * s[0] - dx * dx - dy * dy);
      out[1] = -rate_ * s[1] - gain_ * (s[0] * s[1] - dx);
      out[2] = -rate_ * s[2] - gain_ * (s[0] * s[2] - dy);
      const double cosine =
          s[0] * s[3] - dyad.half_per_adjacent * (s[0] * s[0] - opposite_squared) - dyad.adjacent / 2;
      out[3] = -rate_ * s[3] - gain_ * cosine;
      out[4] = -rate_ * s[4] - gain_ * (s[4] * s[4] + s[3] * s[3] - 1);
    });
    if (made_.loop) {
      const double ex = (x_[made_.loop->point] - made_.loop->x) / made_.loop->length;
      const double ey = (y_[made_.loop->point] - made_.loop->y) / made_.loop->length;
      d[variable_] = (-rate_ * x[variable_] - gain_ * (ex * ex + ey * ey - 1)) / made_.loop->slower;
    }
  }

  void jacobian(const double* x, SUNMatrix matrix) {
    if (SUNMatGetID(matrix) == SUNMATRIX_SPARSE) {
      std::copy(columns_.begin(), columns_.end(), SUNSparseMatrix_IndexPointers(matrix));
      std::copy(rows_.begin(), rows_.end(), SUNSparseMatrix_IndexValues(matrix));
      jacobian(x, SUNSparseMatrix_Data(matrix));
      return;
    }
    entries_.resize(rows_.size());
    jacobian(x, entries_.data());
    for (Index column = 0; column < size_; ++column) {
      double* const to = SUNDenseMatrix_Column(matrix, column);
      for (Index k = columns_[at(column)]; k < columns_[at(column) + 1]; ++k)
        to[rows_[at(k)]] = entries_[at(k)];
    }
  }

  void jacobian(const double* x, double* j) {
    const double hold = kHold * std::abs(speed_), c = x[0], s = x[1];
    j[crank_[0]] = hold * (1 - 3 * c * c - s * s);
    j[crank_[1]] = speed_ - 2 * hold * c * s;
    j[crank_[2]] = -speed_ - 2 * hold * c * s;
    j[crank_[3]] = hold * (1 - c * c - 3 * s * s);
    gx_[0] = {made_.crank, 0};
    gy_[0] = {0, made_.crank};
    if (made_.mirror) {
      gx_[*made_.mirror] = {-made_.crank, 0};
      gy_[*made_.mirror] = {0, -made_.crank};
    }
    std::size_t next_carried = 0;
    place(
        x,
        [&](const Dyad& dyad, double dx, double dy) {
          const double* const v = x + dyad.first;
          for (const Dyad::BaseEntry& entry : dyad.base) {
            const double bx =
                dyad.per_reach * (part(gx_[dyad.q], entry.of_q) - part(gx_[dyad.p], entry.of_p));
            const double by =
                dyad.per_reach * (part(gy_[dyad.q], entry.of_q) - part(gy_[dyad.p], entry.of_p));
            j[entry.length] = gain_ * 2 * (dx * bx + dy * by);
            j[entry.cosine] = gain_ * bx;
            j[entry.sine] = gain_ * by;
          }
          j[dyad.by_length[0]] = -rate_ - gain_ * 2 * v[0];
          j[dyad.by_length[1]] = -gain_ * v[1];
          j[dyad.by_length[2]] = -gain_ * v[2];
          j[dyad.by_length[3]] = -gain_ * (v[3] - 2 * dyad.half_per_adjacent * v[0]);
          for (int k = 0; k < 3; ++k) j[dyad.own[k]] = -rate_ - gain_ * v[0];
          j[dyad.own[3]] = -rate_ - gain_ * 2 * v[4];
          j[dyad.sine_by_cosine] = -gain_ * 2 * v[3];
          if (dyad.opposite_squared < 0)
            j[dyad.by_variable] = -gain_ * 2 * dyad.half_per_adjacent * x[variable_];
          std::vector<double>&gx = gx_[dyad.c], &gy = gy_[dyad.c];
          std::copy(gx_[dyad.p].begin(), gx_[dyad.p].end(), gx.begin());
          std::copy(gy_[dyad.p].begin(), gy_[dyad.p].end(), gy.begin());
          const std::size_t n = gx_[dyad.p].size();
          const double turned = dyad.side * dyad.r1;
          gx[n] = dyad.r1 * v[3], gy[n] = turned * v[4];           // by cos ψ
          gx[n + 1] = -turned * v[4], gy[n + 1] = dyad.r1 * v[3];  // by sin ψ
          gx[n + 2] = dyad.r1 * v[1], gy[n + 2] = dyad.r1 * v[2];  // by cos γ
          gx[n + 3] = -turned * v[2], gy[n + 3] = turned * v[1];   // by sin γ
        },
        [&] {
          const Carried& point = carried_[next_carried++];
          for (std::size_t k = 0; k < point.sources.size(); ++k) {
            const double px = part(gx_[point.p], point.sources[k][0]),
                         py = part(gy_[point.p], point.sources[k][0]);
            const double bx = part(gx_[point.q], point.sources[k][1]) - px;
            const double by = part(gy_[point.q], point.sources[k][1]) - py;
            gx_[point.point][k] = px + point.a * bx - point.b * by;
            gy_[point.point][k] = py + point.a * by + point.b * bx;
          }
        });
    if (made_.loop) {
      const std::size_t point = made_.loop->point;
      const double per = 1 / (made_.loop->length * made_.loop->length);
      const double ex = per * (x_[point] - made_.loop->x), ey = per * (y_[point] - made_.loop->y);
      for (std::size_t k = 0; k < loop_entries_.size(); ++k)
        j[loop_entries_[k]] = -2 * gain_ / made_.loop->slower * (ex * gx_[point][k] + ey * gy_[point][k]);
      j[loop_own_] = -rate_ / made_.loop->slower;
    }
  }

  /// The columns at these states.
  void show(double t, const double* x, double scale, std::vector<double>& values) {
    place(x, [](const Dyad&, double, double) {});
    values.push_back(t);
    for (const std::size_t point : made_.shown) {
      values.push_back(scale * x_[point]);
      values.push_back(scale * y_[point]);
    }
  }

 private:
  static double part(const std::vector<double>& gradient, int place) {
    return place < 0 ? 0 : gradient[static_cast<std::size_t>(place)];
  }

  static int place_in(const std::vector<Index>& states, Index state) {
    const auto found = std::find(states.begin(), states.end(), state);
    return found == states.end() ? -1 : static_cast<int>(found - states.begin());
  }

  /// Finds all points, in order; `at_dyad` gets each dyad's base in units of its reach.
  template <class AtDyad>
  void place(const double* x, const AtDyad& at_dyad) {
    place(x, at_dyad, [] {});
  }
  template <class AtDyad, class AtCarried>
  void place(const double* x, const AtDyad& at_dyad, const AtCarried& at_carried) {
    x_[0] = made_.crank * x[0];
    y_[0] = made_.crank * x[1];
    if (made_.mirror) {
      x_[*made_.mirror] = -x_[0];
      y_[*made_.mirror] = -y_[0];
    }
    std::size_t d = 0, k = 0;
    for (const bool is_dyad : is_dyad_) {
      if (is_dyad) {
        const Dyad& dyad = dyads_[d++];
        const double* const s = x + dyad.first;
        at_dyad(dyad, dyad.per_reach * (x_[dyad.q] - x_[dyad.p]), dyad.per_reach * (y_[dyad.q] - y_[dyad.p]));
        x_[dyad.c] = x_[dyad.p] + dyad.r1 * (s[1] * s[3] - dyad.side * s[2] * s[4]);
        y_[dyad.c] = y_[dyad.p] + dyad.r1 * (s[2] * s[3] + dyad.side * s[1] * s[4]);
      } else {
        const Carried& point = carried_[k++];
        const double bx = x_[point.q] - x_[point.p], by = y_[point.q] - y_[point.p];
        x_[point.point] = x_[point.p] + point.a * bx - point.b * by;
        y_[point.point] = y_[point.p] + point.a * by + point.b * bx;
        at_carried();
      }
    }
  }

  void add(const HandLinkage::Dyad& made, Index first) {
    Dyad dyad{};
    dyad.c = made.c, dyad.p = made.p, dyad.q = made.q;
    dyad.r1 = made.r1;
    dyad.side = made.side;
    dyad.per_reach = 1 / made.reach;
    dyad.adjacent = made.r1 / made.reach;
    dyad.half_per_adjacent = 1 / (2 * dyad.adjacent);
    dyad.opposite_squared = made.variable ? -1 : made.r2 * made.r2 / (made.reach * made.reach);
    dyad.first = first;
    dyads_.push_back(dyad);
    depends_[made.c] = depends_[made.p];
    for (Index k = 1; k <= 4; ++k) depends_[made.c].push_back(first + k);
  }

  void add(const HandLinkage::Carried& made) {
    Carried point{made.point, made.p, made.q, made.a, made.b, {}};
    depends_[made.point] = base_of(made.p, made.q);
    for (const Index state : depends_[made.point])
      point.sources.push_back({place_in(depends_[made.p], state), place_in(depends_[made.q], state)});
    carried_.push_back(point);
  }

  std::vector<Index> base_of(std::size_t p, std::size_t q) const {
    std::vector<Index> states = depends_[p];
    for (const Index state : depends_[q]) {
      if (place_in(states, state) < 0) states.push_back(state);
    }
    return states;
  }

  /// The pattern of the Jacobian by columns, and the place of each entry in it.
  void lay_out() {
    std::vector<std::vector<Index>> rows(at(size_));
    const auto mark = [&](Index row, Index column) { rows[at(column)].push_back(row); };
    for (const Index row : {0, 1}) mark(row, 0), mark(row, 1);
    for (const Dyad& dyad : dyads_) {
      const Index f = dyad.first;
      for (const Index state : base_of(dyad.p, dyad.q))
        mark(f, state), mark(f + 1, state), mark(f + 2, state);
      for (Index k = 0; k < 4; ++k) mark(f + k, f);
      for (Index k = 1; k <= 4; ++k) mark(f + k, f + k);
      mark(f + 4, f + 3);
      if (dyad.opposite_squared < 0) mark(f + 3, variable_);
    }
    if (made_.loop) {
      for (const Index state : depends_[made_.loop->point]) mark(variable_, state);
      mark(variable_, variable_);
    }
    columns_.push_back(0);
    for (std::vector<Index>& column : rows) {
      std::sort(column.begin(), column.end());
      rows_.insert(rows_.end(), column.begin(), column.end());
      columns_.push_back(static_cast<Index>(rows_.size()));
    }
    const auto entry = [&](Index row, Index column) {
      const auto begin = rows_.begin() + columns_[at(column)], end = rows_.begin() + columns_[at(column) + 1];
      return static_cast<Index>(std::find(begin, end, row) - rows_.begin());
    };
    crank_ = {entry(0, 0), entry(1, 0), entry(0, 1), entry(1, 1)};
    for (Dyad& dyad : dyads_) {
      const Index f = dyad.first;
      for (const Index state : base_of(dyad.p, dyad.q))
        dyad.base.push_back({place_in(depends_[dyad.p], state), place_in(depends_[dyad.q], state),
                             entry(f, state), entry(f + 1, state), entry(f + 2, state)});
      for (Index k = 0; k < 4; ++k) {
        dyad.by_length[k] = entry(f + k, f);
        dyad.own[k] = entry(f + k + 1, f + k + 1);
      }
      dyad.sine_by_cosine = entry(f + 4, f + 3);
      if (dyad.opposite_squared < 0) dyad.by_variable = entry(f + 3, variable_);
    }
    if (made_.loop) {
      for (const Index state : depends_[made_.loop->point]) loop_entries_.push_back(entry(variable_, state));
      loop_own_ = entry(variable_, variable_);
    }
    for (std::size_t point = 0; point < kMostPoints; ++point) {
      gx_[point].resize(depends_[point].size());
      gy_[point].resize(depends_[point].size());
    }
  }

  HandLinkage made_;
  double rate_, gain_;  ///< 1/τ of the amplifiers [1/s], and times μ and the weight of the residuals
  double speed_;
  Index size_ = 0, variable_ = 0;
  std::vector<Dyad> dyads_;
  std::vector<Carried> carried_;
  std::vector<bool> is_dyad_;
  std::array<std::vector<Index>, kMostPoints> depends_;
  std::array<std::vector<double>, kMostPoints> gx_, gy_;
  std::array<double, kMostPoints> x_{}, y_{};
  std::vector<Index> columns_, rows_, loop_entries_;
  std::vector<double> entries_;
  std::array<Index, 4> crank_{};
  Index loop_own_ = 0;
};

int derivatives(sunrealtype, N_Vector states, N_Vector slopes, void* user) {
  static_cast<Linkage*>(user)->derivatives(N_VGetArrayPointer(states), N_VGetArrayPointer(slopes));
  return 0;
}

int jacobian(sunrealtype, N_Vector states, N_Vector, SUNMatrix matrix, void* user, N_Vector, N_Vector,
             N_Vector) {
  static_cast<Linkage*>(user)->jacobian(N_VGetArrayPointer(states), matrix);
  return 0;
}

}  // namespace

struct HandSolver::Parts {
  HandSettings settings;
  Algebra algebra;
  std::optional<Linkage> linkage;
  SUNContext context = nullptr;
  N_Vector states = nullptr, between = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver solver = nullptr;
  void* memory = nullptr;
};

HandSolver::HandSolver(const HandLinkage& linkage, const HandSettings& settings, Algebra algebra)
    : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.settings = settings;
  p.algebra = algebra;
  p.linkage.emplace(linkage, settings);
  const Index n = p.linkage->size();
  check(SUNContext_Create(nullptr, &p.context) == 0);
  p.states = N_VNew_Serial(n, p.context);
  p.between = N_VNew_Serial(n, p.context);
  if (algebra == Algebra::dense) {
    p.matrix = SUNDenseMatrix(n, n, p.context);
    p.solver = SUNLinSol_Dense(p.states, p.matrix, p.context);
  } else {
    p.matrix = SUNSparseMatrix(n, n, p.linkage->entries(), CSC_MAT, p.context);
    p.solver = SUNLinSol_KLU(p.states, p.matrix, p.context);
  }
  N_VConst(0, p.states);
  p.memory = CVodeCreate(CV_BDF, p.context);
  check(CVodeInit(p.memory, derivatives, 0, p.states) == CV_SUCCESS);
  check(CVodeSetUserData(p.memory, &*p.linkage) == CV_SUCCESS);
  check(CVodeSStolerances(p.memory, settings.tolerance, settings.absolute_tolerance) == CV_SUCCESS);
  check(CVodeSetLinearSolver(p.memory, p.solver, p.matrix) == CV_SUCCESS);
  check(CVodeSetJacFn(p.memory, jacobian) == CV_SUCCESS);
  check(CVodeSetMaxNumSteps(p.memory, 1'000'000) == CV_SUCCESS);
}

HandSolver::~HandSolver() {
  CVodeFree(&parts_->memory);
  SUNLinSolFree(parts_->solver);
  SUNMatDestroy(parts_->matrix);
  N_VDestroy(parts_->between);
  N_VDestroy(parts_->states);
  SUNContext_Free(&parts_->context);
}

void HandSolver::use(const HandLinkage& linkage) {
  parts_->linkage.emplace(linkage, parts_->settings);
}

HandRun HandSolver::run(std::span<const double> start) {
  Parts& p = *parts_;
  const HandSettings& settings = p.settings;
  check(start.size() == at(p.linkage->size()));
  HandRun result;
  result.columns = p.linkage->columns();
  const double begin = cpu_seconds();
  std::copy(start.begin(), start.end(), N_VGetArrayPointer(p.states));
  check(CVodeReInit(p.memory, 0, p.states) == CV_SUCCESS);
  check(CVodeSetStopTime(p.memory, settings.until) == CV_SUCCESS);
  p.linkage->show(0, start.data(), settings.scale, result.values);
  int rows = 1;
  for (double t = 0; t < settings.until;) {
    check(CVode(p.memory, 2 * settings.until, p.states, &t, CV_ONE_STEP) >= 0);
    for (; rows < settings.samples; ++rows) {
      const double time =
          rows + 1 == settings.samples ? settings.until : settings.until * rows / (settings.samples - 1);
      if (time > t) break;
      check(CVodeGetDky(p.memory, time, 0, p.between) == CV_SUCCESS);
      p.linkage->show(time, N_VGetArrayPointer(p.between), settings.scale, result.values);
    }
  }
  CVodeGetNumSteps(p.memory, &result.steps);
  result.seconds = cpu_seconds() - begin;
  return result;
}

HandRun run_by_hand(const HandLinkage& made, const HandSettings& settings, std::span<const double> start) {
  const double begin = cpu_seconds();
  HandSolver solver(made, settings);
  HandRun result = solver.run(start);
  result.seconds = cpu_seconds() - begin;
  return result;
}

}  // namespace oblique::bench
