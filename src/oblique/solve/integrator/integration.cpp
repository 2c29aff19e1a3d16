// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/integration.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/method.h>
#include <oblique/solve/integrator/rosenbrock_solver.h>
#include <oblique/solve/interruption.h>

namespace oblique::solve {
namespace {

std::vector<double> absolute_tolerances(const SolverSettings& settings, std::size_t n_states) {
  return settings.own_tolerances.empty() ? std::vector<double>(n_states, settings.absolute_tolerance)
                                         : settings.own_tolerances;
}

}  // namespace

Integration::Integration(const Parts& parts, MethodChoice method, const Refinement& refinement, double t)
    : parts_(parts),
      method_(std::move(method)),
      refinement_(refinement),
      settings_(solver_settings(parts.program.states(), parts.options, method_.method, refinement)),
      solver_(make_solver(t)),
      growth_(parts.system, settings_, parts.options.until - t),
      small_(
          parts.system, settings_, parts.options.tolerance, parts.options.until - t,
          [this](double at, const double* x, double* values) { return read(at, x, values); },
          parts.diagram.outputs.size() + parts.program.switches().size(), parts.diagram.outputs.size()),
      lost_(parts.diagram, parts.system, settings_, parts.options.until - t,
            [this](double at, const double* x, double* values) { return read_outputs(at, x, values); }),
      short_steps_(HiddenMotion(parts.system, settings_.relative_tolerance,
                                absolute_tolerances(settings_, parts.states.size())),
                   *solver_, parts.options.until - t),
      turning_(parts.program, parts.workspace, parts.switching),
      begin_(t) {
  if (parts_.sensitivities) cvodes_->follow(*parts_.sensitivities);
  growth_.restart(t, parts.states);
  small_.advance(t, parts.states);
}

std::unique_ptr<Solver> Integration::make_solver(double t) {
  const Segments& segments = parts_.segments;
  const bool rodas = settings_.method == diagram::IntegrationMethod::rodas;
  parts_.switching.leave_slides_where_they_are(rodas);
  if (rodas) {
    return std::make_unique<RosenbrockSolver>(parts_.system, t, parts_.states, segments.end(),
                                              segments.length(), settings_);
  }
  auto cvodes = std::make_unique<CvodesSolver>(parts_.system, t, parts_.states, segments.end(),
                                               segments.length(), settings_);
  cvodes_ = cvodes.get();
  return cvodes;
}

/// Keeps the step from t short beside the turns of algebraic loops, and for `watch_places`.
void Integration::limit_step(double t) {
  if (turning_.any() && !turn_limit_)
    turn_limit_ = turning_.longest_step(t, parts_.states, parts_.segments.end());
  const double limit =
      std::min({short_steps_.limit(), turn_limit_.value_or(kNone), places_limit_, growth_limit_});
  if (limit < kNone || limits_) solver_->limit_step(limit);
  limits_ = limit < kNone;
}

/// Behind an event all that is ahead is looked at anew: of steps that pass over many places to look at, and
/// in which events come, the work would grow with the square of the length of the run.
void Integration::watch_places() {
  constexpr double kMany = 64, kLonger = 4;
  if (any_event_ && static_cast<double>(places_) > kMany)
    places_limit_ = length_ * kMany / static_cast<double>(places_);
  else
    places_limit_ *= kLonger;
  if (places_limit_ > parts_.options.until - begin_) places_limit_ = kNone;
  any_event_ = false;
}

void Integration::go_on(double t) {
  any_event_ = true;
  lost_.begin_segment(t, parts_.states);
}

/// Whether loops turn so quickly where the step has led that it may have passed over a turn: it is then to be
/// taken anew, and shorter.
bool Integration::turns_too_far(double from, double t) {
  constexpr double kFaster = 4;  // than where the step began: two radians
  if (!turning_.any()) return false;
  turn_limit_ = turning_.longest_step(t, solver_->states(), from);
  if (t - from <= kFaster * *turn_limit_) return false;
  turn_limit_ = (t - from) / kFaster;
  solver_->restart(from, parts_.states, parts_.segments.end(), parts_.segments.end() - from);
  return true;
}

/// Whether an implicit step has passed over growth: it is then to be taken anew, and no longer than that
/// takes.
bool Integration::outruns_growth(double from, double t) {
  constexpr double kPart = 0.25;  // of the time in which it grows by e
  constexpr int kStepsBetween = 4;
  constexpr double kLess = kPart / 2;
  const double rate = growth_.outrun(t, solver_->states(), t - from);
  if (rate == 0) {
    // (The Jacobian that the solver has seen last may be older than what stands now.)
    if (growth_limit_ < kNone && ++limited_steps_ % kStepsBetween == 0 &&
        !growth_.grows(t, solver_->states(), growth_limit_, kLess))
      growth_limit_ = kNone;
    return false;
  }
  growth_limit_ = kPart / rate;
  solver_->restart(from, parts_.states, parts_.segments.end(), parts_.segments.end() - from);
  return true;
}

bool Integration::take_step(double& t) {
  constexpr int kMostEnds = 100;  // of branches, one at the other
  const double from = t;
  limit_step(t);
  try {
    t = solver_->step();
  } catch (const SolverFailure& failure) {
    if (failure.kind == SolverFailure::Kind::interrupted) throw Interrupted();
    if (failure.kind == SolverFailure::Kind::step_budget) throw;
    const std::vector<double> last = parts_.states;
    switch (parts_.branches.look_ahead(t, parts_.segments.end(), parts_.states, *solver_)) {
      case BranchWatch::Ahead::end:
        if (++ends_ > kMostEnds) throw;
        parts_.segments.end_branch(from, last, t);
        if (parts_.overloads) parts_.overloads->restart(t, parts_.states);
        restart(t);
        return false;
      case BranchWatch::Ahead::not_yet:
        turn_limit_.reset();
        solver_->restart(t, parts_.states, parts_.segments.end(), parts_.segments.end() - t);
        return false;
      case BranchWatch::Ahead::nothing:
        throw;
    }
  }
  ends_ = 0;
  if (turns_too_far(from, t) || outruns_growth(from, t)) {
    t = from;
    return false;
  }
  const bool damps = settings_.method != diagram::IntegrationMethod::adams;
  parts_.switching.take_step(solver_->statistics().last_step, damps);
  const std::vector<double>& sample_times =
      parts_.sources.sample_times(from, t, *solver_, parts_.switching.slides());
  // The states are still those of `from`.
  if (short_steps_.take_back(from, parts_.states, sample_times, parts_.segments.end())) {
    turn_limit_.reset();
    t = from;
    return false;
  }
  places_ = sample_times.size();
  length_ = t - from;
  parts_.segments.take_step(from, t, sample_times, *solver_);
  return true;
}

/// Looks whether the run has become stiff, and leaves it to BDF then. A decay that is much faster than what
/// else moves holds Adams' formulas at the first two orders, whose steps alone do not multiply it; those of
/// the second turn it over at each step, and leave what follows it quickly off by an error.
void Integration::look_for_stiffness(double t) {
  constexpr int kHeldOrder = 2;
  if (settings_.method != diagram::IntegrationMethod::adams || parts_.sensitivities ||
      parts_.options.method != diagram::IntegrationMethod::automatic)
    return;
  low_steps_ = cvodes_->last_order() <= kHeldOrder ? low_steps_ + 1 : 0;
  if (low_steps_ < next_look_) return;
  next_look_ *= 2;
  auto stiff =
      stiff_method(parts_.program, parts_.workspace, t, parts_.states, parts_.options.until - begin_);
  if (!stiff) return;
  method_ = *std::move(stiff);
  settings_ = solver_settings(parts_.program.states(), parts_.options, method_.method, refinement_);
  cvodes_->change_settings(settings_);
}

void Integration::restart(double t) {
  low_steps_ = 0;
  turn_limit_.reset();
  parts_.switching.take_step(0);
  parts_.segments.begin(t);
  solver_->restart(t, parts_.states, parts_.segments.end(), parts_.segments.length());
  if (parts_.sensitivities) cvodes_->set_sensitivities(parts_.sensitivities->states());
}

void Integration::end_step(Segments::Passed passed, double t) {
  any_event_ = any_event_ || passed == Segments::Passed::segment;
  watch_places();
  if (passed == Segments::Passed::segment) {
    restart(t);
    growth_.restart(t, parts_.states);
    short_steps_.restart();
    lost_.begin_segment(t, parts_.states);
  } else {
    std::copy(solver_->states().begin(), solver_->states().end(), parts_.states.begin());
    parts_.switching.stand_at(t, parts_.states);
    growth_.advance(t, parts_.states);
    short_steps_.advance(t, parts_.states, parts_.segments.end());
    if (cvodes_ != nullptr) look_for_stiffness(t);
  }
  small_.advance(t, parts_.states);
  lost_.advance(t, parts_.states);
}

void Integration::end(double t) {
  growth_.end();
  small_.end(t, parts_.states);
  lost_.end(t, parts_.states);
}

Unseen Integration::unseen() const {
  Unseen unseen;
  unseen.growth = growth_.found();
  unseen.small = small_.found();
  std::erase_if(unseen.small, [this](const SmallState& small) {  // it was asked for
    return parts_.program.states()[small.state].tolerance > 0;
  });
  if (parts_.options.absolute_tolerance) return unseen;
  for (const std::size_t i : lost_.decayed()) {
    if (!(parts_.program.states()[i].tolerance > 0)) unseen.lost.push_back(i);
  }
  return unseen;
}

std::vector<std::size_t> Integration::lost(std::span<const double> x) const {
  constexpr double kErrors = 100;  // of the absolute tolerance: what the steps together leave
  const std::vector<double> tolerances = absolute_tolerances(settings_, x.size());
  std::vector<std::size_t> lost;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool asked_for = parts_.program.states()[i].tolerance > 0;
    if (!asked_for && x[i] != 0 && std::abs(x[i]) <= kErrors * tolerances[i]) lost.push_back(i);
  }
  return lost;
}

std::vector<text::Diagnostic> Integration::warnings() const {
  // but of those that show a state that is too small, which is told of apart
  std::vector<bool> told(parts_.diagram.outputs.size(), false);
  for (const SmallState& small : unseen().small) {
    if (small.reading < told.size()) told[small.reading] = true;
  }
  return lost_.warnings(told);
}

bool Integration::read_outputs(double t, const double* x, double* values) {
  std::vector<double> signals(parts_.program.n_signals());
  if (!parts_.switching.signals(t, x, signals.data())) return false;
  for (const diagram::FlatOutput& output : parts_.diagram.outputs)
    *values++ = output.scale * signals[parts_.program.signal_index(output.signal)];
  return true;
}

/// What shows that a state is not known: the outputs, then the event functions of the switches.
bool Integration::read(double t, const double* x, double* values) {
  if (!read_outputs(t, x, values)) return false;
  double* const of_switches = values + parts_.diagram.outputs.size();
  if (!parts_.program.event_functions(t, x, of_switches, parts_.workspace)) return false;
  if (!parts_.switching.slides()) return true;
  const std::vector<bool> sliding = parts_.switching.sliding();  // what is held at zero is known
  for (std::size_t s = 0; s < sliding.size(); ++s) {
    if (sliding[s]) of_switches[s] = 0;
  }
  return true;
}

}  // namespace oblique::solve
