// SPDX-License-Identifier: MIT
#include <oblique/solve/sensitivity/gradient.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>

#include <cvodes/cvodes.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/solver_vector.h>
#include <oblique/solve/sensitivity/sensitivities.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

struct Free {
  void operator()(N_Vector v) const { N_VDestroy(v); }
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
  void operator()(SUNContext c) const { SUNContext_Free(&c); }
  void operator()(void* memory) const { CVodeFree(&memory); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Free>;

void ignore_message(int, const char*, const char*, char*, void*) {}

/// The run forward with the positions of its start, and the adjoint equations backward along it.
class Adjoint {
 public:
  Adjoint(const network::Program& program, const diagram::FlatDiagram& diagram, Sensitivities& derivatives,
          const RunOptions& options, std::size_t output, bool integral)
      : program_(program),
        diagram_(diagram),
        derivatives_(derivatives),
        options_(options),
        output_(output),
        integral_(integral),
        workspace_(program),
        values_(program.jacobian_pattern().entries()) {
    SUNContext context = nullptr;
    if (SUNContext_Create(nullptr, &context) != 0) throw std::bad_alloc();
    context_.reset(context);
    find_transpose();
  }

  /// Of the output, after `gradient`.
  double integral_value() const { return integral_value_; }

  /// Throws SolveError.
  std::vector<double> gradient(double begin, double end, const std::vector<double>& x0,
                               const std::vector<double>& discrete_states) {
    workspace_.load_discrete_states(discrete_states);
    begin_ = begin;
    const auto n = static_cast<sunindextype>(x0.size());
    const auto count = static_cast<sunindextype>(derivatives_.count());
    const Owned<N_Vector> x(make_solver_vector(n, context_.get()));
    std::copy(x0.begin(), x0.end(), N_VGetArrayPointer(x.get()));
    memory_.reset(CVodeCreate(CV_BDF, context_.get()));
    void* const cvodes = memory_.get();
    if (cvodes == nullptr) throw std::bad_alloc();
    const double tight = options_.tolerance / kTighter;
    check(CVodeSetErrHandlerFn(cvodes, ignore_message, nullptr));
    check(CVodeInit(cvodes, forward, 0, x.get()));
    check(CVodeSetUserData(cvodes, this));
    check(CVodeSStolerances(cvodes, tight, kAbsoluteTolerance * tight));
    check(CVodeSetMaxNumSteps(cvodes, options_.max_steps));
    const Owned<SUNMatrix> matrix(made(SUNSparseMatrix(n, n, entries(), CSC_MAT, context_.get())));
    const Owned<SUNLinearSolver> solver(made(SUNLinSol_KLU(x.get(), matrix.get(), context_.get())));
    check(CVodeSetLinearSolver(cvodes, solver.get(), matrix.get()));
    check(CVodeSetJacFn(cvodes, forward_jacobian));
    const Owned<N_Vector> integral(make_solver_vector(1, context_.get()));
    N_VConst(0, integral.get());
    if (integral_) {
      check(CVodeQuadInit(cvodes, output_rate, integral.get()));
      check(CVodeQuadSStolerances(cvodes, tight, kAbsoluteTolerance * tight));
      check(CVodeSetQuadErrCon(cvodes, SUNTRUE));
    }
    constexpr long kStepsAPoint = 200;  // kept in memory between two checkpoints
    check(CVodeAdjInit(cvodes, kStepsAPoint, CV_HERMITE));
    sunrealtype reached = 0;
    int checkpoints = 0;
    const double length = end - begin;
    check(CVodeSetStopTime(cvodes, length));
    check(CVodeF(cvodes, length, x.get(), &reached, CV_NORMAL, &checkpoints));
    if (integral_) check(CVodeGetQuad(cvodes, &reached, integral.get()));
    integral_value_ = N_VGetArrayPointer(integral.get())[0];

    const Owned<N_Vector> lambda(N_VClone(x.get()));
    double* const adjoint = N_VGetArrayPointer(lambda.get());
    std::fill(adjoint, adjoint + n, 0.0);
    const std::vector<double> at_end(N_VGetArrayPointer(x.get()), N_VGetArrayPointer(x.get()) + n);
    std::vector<double> result =
        integral_ ? std::vector<double>(derivatives_.count()) : by_parameters(end, at_end);
    double largest = 1;
    if (!integral_) {
      by_states(end, at_end.data(), adjoint);
      for (sunindextype i = 0; i < n; ++i) largest = std::max(largest, std::abs(adjoint[i]));
    }
    int which = 0;
    check(CVodeCreateB(cvodes, CV_BDF, &which));
    check(CVodeInitB(cvodes, which, backward, length, lambda.get()));
    check(CVodeSetUserDataB(cvodes, which, this));
    check(CVodeSStolerancesB(cvodes, which, tight, kAbsoluteTolerance * tight * largest));
    check(CVodeSetMaxNumStepsB(cvodes, which, options_.max_steps));
    const Owned<SUNMatrix> matrix_b(made(SUNSparseMatrix(n, n, entries(), CSC_MAT, context_.get())));
    const Owned<SUNLinearSolver> solver_b(made(SUNLinSol_KLU(lambda.get(), matrix_b.get(), context_.get())));
    check(CVodeSetLinearSolverB(cvodes, which, solver_b.get(), matrix_b.get()));
    check(CVodeSetJacFnB(cvodes, which, backward_jacobian));
    const Owned<N_Vector> sums(make_solver_vector(count, context_.get()));
    N_VConst(0, sums.get());
    check(CVodeQuadInitB(cvodes, which, integrands, sums.get()));
    check(CVodeQuadSStolerancesB(cvodes, which, tight, kAbsoluteTolerance * tight * largest));
    check(CVodeSetQuadErrConB(cvodes, which, SUNTRUE));
    check(CVodeB(cvodes, 0, CV_NORMAL));
    check(CVodeGetB(cvodes, which, &reached, lambda.get()));
    check(CVodeGetQuadB(cvodes, which, &reached, sums.get()));
    for (std::size_t k = 0; k < result.size(); ++k) {
      result[k] += N_VGetArrayPointer(sums.get())[k];
      for (std::size_t i = 0; i < x0.size(); ++i) result[k] += adjoint[i] * derivatives_.states()[k][i];
    }
    return result;
  }

 private:
  static constexpr double kTighter = 10;  ///< than the run's: the adjoint sees the run's errors, too

  template <class Handle>
  static Handle made(Handle handle) {
    if (handle == nullptr) throw std::bad_alloc();
    return handle;
  }

  void check(int code) const {
    if (code >= 0) return;
    if (code == CV_MEM_FAIL || code == CVLS_MEM_FAIL) throw std::bad_alloc();
    throw SolveError(SolveError::Kind::other, begin_,
                     {{diagram_.file, {}},
                      fmt::format("the adjoint equations cannot be integrated (CVODES gives {})", code),
                      {},
                      "sensitivities along the run may still be known"});
  }

  sunindextype entries() const { return static_cast<sunindextype>(values_.size()); }

  /// Where the entries of the Jacobian stand in its transpose.
  void find_transpose() {
    const network::SparsePattern& pattern = program_.jacobian_pattern();
    transpose_.column_starts.assign(pattern.size() + 1, 0);
    for (const std::int64_t row : pattern.rows) ++transpose_.column_starts[static_cast<std::size_t>(row) + 1];
    for (std::size_t c = 0; c < pattern.size(); ++c)
      transpose_.column_starts[c + 1] += transpose_.column_starts[c];
    std::vector<std::int64_t> next = transpose_.column_starts;
    transpose_.rows.resize(pattern.rows.size());
    place_.resize(pattern.rows.size());
    for (std::size_t column = 0; column < pattern.size(); ++column) {
      for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
        const auto row = static_cast<std::size_t>(pattern.rows[static_cast<std::size_t>(k)]);
        const auto at = static_cast<std::size_t>(next[row]++);
        transpose_.rows[at] = static_cast<std::int64_t>(column);
        place_[static_cast<std::size_t>(k)] = at;
      }
    }
  }

  /// d output/dp of each parameter where the states stand still.
  std::vector<double> by_parameters(double t, const std::vector<double>& x) {
    const std::vector<std::vector<double>> still(derivatives_.count(), std::vector<double>(x.size()));
    std::vector<double> all(diagram_.outputs.size() * derivatives_.count()), own;
    derivatives_.outputs(t, x, still, all);
    for (std::size_t k = 0; k < derivatives_.count(); ++k)
      own.push_back(all[output_ * derivatives_.count() + k]);
    return own;
  }

  void by_states(double t, const double* x, double* gradient) {
    derivatives_.output_by_states(t, {x, program_.n_states()}, output_, {gradient, program_.n_states()});
  }

  bool jacobian(double t, N_Vector x) {
    return program_.jacobian(begin_ + t, N_VGetArrayPointer(x), values_.data(), workspace_);
  }

  static int forward(sunrealtype t, N_Vector x, N_Vector rates, void* user) {
    auto& self = *static_cast<Adjoint*>(user);
    return self.program_.derivatives(self.begin_ + t, N_VGetArrayPointer(x), N_VGetArrayPointer(rates),
                                     self.workspace_)
               ? 0
               : 1;
  }

  static int output_rate(sunrealtype t, N_Vector x, N_Vector rate, void* user) {
    auto& self = *static_cast<Adjoint*>(user);
    std::vector<double> signals(self.program_.n_signals());
    if (!self.program_.signals(self.begin_ + t, N_VGetArrayPointer(x), signals.data(), self.workspace_))
      return 1;
    const diagram::FlatOutput& output = self.diagram_.outputs[self.output_];
    N_VGetArrayPointer(rate)[0] =
        output.scale * signals[self.program_.signal_index(output.signal)] + output.offset;
    return 0;
  }

  static void fill(const network::SparsePattern& pattern, SUNMatrix matrix) {
    std::copy(pattern.column_starts.begin(), pattern.column_starts.end(),
              SUNSparseMatrix_IndexPointers(matrix));
    std::copy(pattern.rows.begin(), pattern.rows.end(), SUNSparseMatrix_IndexValues(matrix));
  }

  static int forward_jacobian(sunrealtype t, N_Vector x, N_Vector, SUNMatrix matrix, void* user, N_Vector,
                              N_Vector, N_Vector) {
    auto& self = *static_cast<Adjoint*>(user);
    fill(self.program_.jacobian_pattern(), matrix);
    if (!self.jacobian(t, x)) return 1;
    std::copy(self.values_.begin(), self.values_.end(), SUNSparseMatrix_Data(matrix));
    return 0;
  }

  /// λ′ = −(∂f/∂x)ᵀ λ, and of an integral − ∂(output)/∂x.
  static int backward(sunrealtype t, N_Vector x, N_Vector lambda, N_Vector rates, void* user) {
    auto& self = *static_cast<Adjoint*>(user);
    if (!self.jacobian(t, x)) return 1;
    double* const result = N_VGetArrayPointer(rates);
    const double* const adjoint = N_VGetArrayPointer(lambda);
    const network::SparsePattern& pattern = self.program_.jacobian_pattern();
    if (self.integral_) {
      try {
        self.by_states(self.begin_ + t, N_VGetArrayPointer(x), result);
      } catch (const SolveError&) {
        return 1;
      }
    } else {
      std::fill(result, result + pattern.size(), 0.0);
    }
    for (std::size_t column = 0; column < pattern.size(); ++column) {
      for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(k);
        result[column] += self.values_[entry] * adjoint[pattern.rows[entry]];
      }
      result[column] = -result[column];
    }
    return 0;
  }

  static int backward_jacobian(sunrealtype t, N_Vector x, N_Vector, N_Vector, SUNMatrix matrix, void* user,
                               N_Vector, N_Vector, N_Vector) {
    auto& self = *static_cast<Adjoint*>(user);
    fill(self.transpose_, matrix);
    if (!self.jacobian(t, x)) return 1;
    for (std::size_t k = 0; k < self.values_.size(); ++k)
      SUNSparseMatrix_Data(matrix)[self.place_[k]] = -self.values_[k];
    return 0;
  }

  /// The time runs backward: of what is integrated from the end to the begin the negative.
  static int integrands(sunrealtype t, N_Vector x, N_Vector lambda, N_Vector rates, void* user) {
    auto& self = *static_cast<Adjoint*>(user);
    const std::size_t n = self.program_.n_states();
    const std::vector<double> still(n);
    std::vector<double> by_parameter(n), of_output;
    const double* const states = N_VGetArrayPointer(x);
    try {
      if (self.integral_) of_output = self.by_parameters(self.begin_ + t, {states, states + n});
    } catch (const SolveError&) {
      return 1;
    }
    for (std::size_t k = 0; k < self.derivatives_.count(); ++k) {
      if (!self.derivatives_.rates(self.begin_ + t, states, k, still.data(), by_parameter.data())) return 1;
      double sum = self.integral_ ? of_output[k] : 0;
      for (std::size_t i = 0; i < n; ++i) sum += N_VGetArrayPointer(lambda)[i] * by_parameter[i];
      N_VGetArrayPointer(rates)[k] = -sum;
    }
    return 0;
  }

  const network::Program& program_;
  const diagram::FlatDiagram& diagram_;
  Sensitivities& derivatives_;
  const RunOptions& options_;
  std::size_t output_;
  bool integral_;
  network::Workspace workspace_;
  std::vector<double> values_;
  network::SparsePattern transpose_;
  std::vector<std::size_t> place_;  ///< of each entry of the Jacobian that of the transpose
  double begin_ = 0;                ///< [s]
  double integral_value_ = 0;
  Owned<SUNContext> context_;
  std::unique_ptr<void, Free> memory_;
};

/// The events that have come where the run starts, by where it starts: tables that may have been moved along,
/// and those of which the condition holds.
std::vector<std::size_t> served_at_start(const network::Program& program, double t, std::span<const double> x,
                                         network::Workspace& workspace) {
  std::vector<std::size_t> served;
  std::vector<double> signals(program.n_signals());
  const auto here = program.signals(t, x.data(), signals.data(), workspace);
  for (std::size_t e = 0; e < program.events().size(); ++e) {
    const network::Event& event = program.events()[e];
    if (event.repeats || (event.at_start && here && here->condition(e))) served.push_back(e);
  }
  return served;
}

}  // namespace

Gradient gradient(const network::Program& program, const diagram::FlatDiagram& diagram,
                  const RunOptions& options, const RunNumber& number, const std::vector<std::string>& names) {
  const auto output = std::find_if(diagram.outputs.begin(), diagram.outputs.end(),
                                   [&](const diagram::FlatOutput& o) { return o.name == number.output; });
  if (output == diagram.outputs.end()) {
    std::vector<std::string> known;
    for (const diagram::FlatOutput& o : diagram.outputs) known.push_back(o.name);
    throw text::ReadError(text::Diagnostic{{diagram.file, {}},
                                           fmt::format("there is no output '{}'", number.output),
                                           "the name of an output of the diagram",
                                           text::suggest(number.output, known)});
  }
  const bool integral = number.kind == RunNumber::Kind::integral;
  RunOptions how = options;
  if (!integral) how.until = number.time;
  how.sensitivity.clear();
  how.extra_times.clear();
  const double begin = how.from ? how.from->time : 0;
  std::vector<double> start, positions, positions_at_end;
  how.on_sample = [&](double, std::span<const double> states, std::span<const double> discrete_states) {
    if (start.empty() && positions.empty()) {
      start.assign(states.begin(), states.end());
      positions.assign(discrete_states.begin(), discrete_states.end());
    }
    positions_at_end.assign(discrete_states.begin(), discrete_states.end());
  };
  how.on_restart = [&] {
    start.clear();
    positions.clear();
  };
  const Run run = solve::run(program, diagram, how);
  const bool turns = std::any_of(run.events.begin(), run.events.end(),
                                 [&](const EventRecord& event) { return event.time > begin; });
  if (turns || positions != positions_at_end) {
    throw SolveError(SolveError::Kind::other, begin,
                     {{diagram.file, {}},
                      "the adjoint of a run in which something turns over is not known",
                      "a smooth run",
                      "sensitivities along the run follow its events"});
  }
  Gradient result;
  const auto index = static_cast<std::size_t>(output - diagram.outputs.begin());
  const Trajectory& rows = run.trajectory;
  result.value = rows.at(rows.rows() - 1, 1 + index);
  Sensitivities derivatives(program, diagram, sensitivity_parameters(diagram, names), how.until - begin);
  network::Workspace at_start(program);
  at_start.load_discrete_states(positions);
  const std::vector<std::size_t> served = served_at_start(program, begin, start, at_start);
  derivatives.start(begin, start, at_start, served, how.from.has_value());
  if (start.empty()) {  // nothing is integrated: the number follows from the parameters at once
    throw SolveError(SolveError::Kind::other, begin,
                     {{diagram.file, {}},
                      "a diagram without states has no adjoint equations",
                      "a diagram with an integrator",
                      "sensitivities along the run are known"});
  }
  Adjoint adjoint(program, diagram, derivatives, how, index, integral);
  result.by_parameter = adjoint.gradient(begin, how.until, start, positions);
  if (integral) result.value = adjoint.integral_value();
  return result;
}

Gradient gradient(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                  const RunNumber& number, const std::vector<std::string>& names) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  return gradient(network::Program(network::assemble(flat)), flat, options_of(diagram.run), number, names);
}

}  // namespace oblique::solve
