// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/phase_clock.h>
#include <oblique/solve/run_warnings.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace oblique::solve {
namespace {

/// Ends that differ by rounding are one: "300 ms" is not quite 0.3 s.
constexpr double kRounding = 1e-12;

/// The points that the expression takes at the time of the run; nothing where it holds no such table.
const text::PointTable* points_over_time(const diagram::FlatBlock& block,
                                         const text::Expression& expression) {
  const bool table = expression.kind == text::Expression::Kind::call &&
                     expression.function == text::Function::table && expression.operands.size() == 2 &&
                     expression.operands[0].name == "time";
  if (table && !block.points.empty()) {
    if (const auto parameter = block.definition->find_parameter(expression.operands[1].name))
      return &block.points[*parameter];
  }
  for (const text::Expression& operand : expression.operands) {
    if (const text::PointTable* const found = points_over_time(block, operand)) return found;
  }
  return nullptr;
}

/// A line that does not change says what holds beyond the points; of another nobody knows whether it goes on.
void warn_of_points(const diagram::FlatBlock& block, const text::PointTable& points, double begin, double end,
                    std::vector<text::Diagnostic>& warnings) {
  const std::vector<double>&x = points.x, &y = points.y;
  const std::size_t last = x.size() - 1;
  const auto warn = [&](std::string_view what, double point, double run, std::string_view which) {
    warnings.push_back({block.place,
                        fmt::format("the points of '{}' {} at t = {:.10g} s, the run at {:.10g} s: between "
                                    "them the line through the "
                                    "{} two points goes on",
                                    block.path, what, point, run, which),
                        "points over the whole run",
                        "beyond = \"hold\" in the table of the points makes the outermost values hold; "
                        "another point, or a pause "
                        "at the end, says what else should"});
  };
  if (begin < x.front() - kRounding * std::abs(x.front()) && y[0] != y[1])
    warn("begin", x.front(), begin, "first");
  if (end > x[last] + kRounding * std::abs(x[last]) && y[last] != y[last - 1])
    warn("end", x[last], end, "last");
}

/// Of an oscillation that is damped a little the formulas make one that grows.
void warn_of_coarse_adams(const std::string& file, const RunOptions& options, const Run& run,
                          std::vector<text::Diagnostic>& warnings) {
  constexpr double kCoarse = 1e-3;
  if (run.method.method != diagram::IntegrationMethod::adams || options.tolerance <= kCoarse) return;
  warnings.push_back({{file, {}},
                      fmt::format("at a tolerance of {} Adams lets oscillations grow", options.tolerance),
                      "1e-3 or less",
                      {}});
}

void warn_of_timeline(const diagram::FlatTimeline& timeline, const std::string& file, const RunState& state,
                      std::vector<text::Diagnostic>& warnings) {
  const bool by_condition =
      std::any_of(timeline.phases.begin(), timeline.phases.end(),
                  [](const diagram::FlatPhase& phase) { return std::isinf(phase.duration); });
  const PhaseClock::Position& at = state.position;
  const bool in_last = at.phase + 1 == timeline.phases.size() && at.cycle + 1 >= timeline.cycles;
  // Phases of known length were cut off on purpose, and who repeats without end knows that the run ends.
  if (!by_condition || in_last || std::isinf(timeline.cycles)) return;
  text::Remedy remedy{"the length of such phases is not known in advance: give a later 'until' in [run], or ",
                      text::Setting{"until"}};
  if (at.cycle > 0) {
    remedy +=
        fmt::format("; at the pace so far all cycles take {:.3g} s", state.time * timeline.cycles / at.cycle);
  }
  warnings.push_back(
      {{file, {}},
       fmt::format("the run ends at t = {:.10g} s in phase {} of cycle {} of its timeline", state.time,
                   at.phase + 1, at.cycle + 1),
       fmt::format("phase {} of cycle {}, the last one", timeline.phases.size(), timeline.cycles),
       std::move(remedy)});
}

/// Whether a signal may vary in a phase: that of a constant does not, nor that of an integrator that is not
/// let operate.
bool varies_in(const diagram::FlatDiagram& diagram, const diagram::FlatPhase& phase,
               const diagram::FlatTerm& term) {
  const diagram::FlatBlock& source = diagram.blocks[term.signal.block];
  if (source.definition->role == diagram::Role::integrator)
    return phase.modes[source.group] == diagram::OperatingMode::operate;
  return source.definition->role != diagram::Role::reference;
}

/// An integrator in initial condition follows a changing `start` with a lag of its own, unless it is given
/// one.
void warn_of_follower(const diagram::FlatDiagram& diagram, const diagram::FlatBlock& block,
                      std::vector<text::Diagnostic>& warnings) {
  constexpr double kShort = 1e-4;  // [s]: a hundred of its lags
  const auto start = block.definition->find_input("start");
  const auto charging = block.definition->find_parameter("charging");
  if (block.definition->role != diagram::Role::integrator || !start || !charging ||
      block.parameters[*charging] > 0)
    return;
  const std::vector<diagram::FlatTerm>& terms = block.inputs[*start].terms;
  for (const diagram::FlatPhase& phase : diagram.timeline.phases) {
    const bool follows = std::any_of(terms.begin(), terms.end(), [&](const diagram::FlatTerm& term) {
      return varies_in(diagram, phase, term);
    });
    if (!follows || phase.modes[block.group] != diagram::OperatingMode::initial || phase.duration >= kShort)
      continue;
    warnings.push_back({block.place,
                        fmt::format("'{}' follows its 'start' with a time constant of 1 µs, in a phase of "
                                    "{:.3g} s",
                                    block.path, phase.duration),
                        "a phase that is far longer",
                        {"give it a time constant of its own, a thousandth of that: ",
                         text::Setting{block.path + ".charging"}}});
    return;
  }
}

}  // namespace

std::vector<text::Diagnostic> warnings_at_end(const diagram::FlatDiagram& diagram, const RunOptions& options,
                                              const Run& run) {
  std::vector<text::Diagnostic> warnings;
  const double begin = options.from ? options.from->time : 0;
  for (const diagram::FlatBlock& block : diagram.blocks) {
    warn_of_follower(diagram, block, warnings);
    for (const diagram::Equation& equation : block.behaviour->equations) {
      const text::PointTable* const points = points_over_time(block, equation.expression);
      if (points != nullptr) warn_of_points(block, *points, begin, run.state.time, warnings);
    }
  }
  const bool came_to_its_end = !run.halted && run.state.time >= options.until;
  warn_of_coarse_adams(diagram.file, options, run, warnings);
  if (came_to_its_end) warn_of_timeline(diagram.timeline, diagram.file, run.state, warnings);
  return warnings;
}

}  // namespace oblique::solve
