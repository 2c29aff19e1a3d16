// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/program/program.h>
#include <oblique/network/program/tangent_network.h>
#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/sensitivity/sensitivity_parameters.h>

namespace oblique::solve {

/// The sensitivities s = dx/dp of a run by some of its parameters, and of all that follows from them.
///
/// Between events they obey s′ = ∂f/∂x s + ∂f/∂p, exactly: the equations are differentiated symbolically,
/// algebraic loops with them. At an event, which comes dt*/dp later where p is larger, they jump: with the
/// event function g(t, x, p), dt*/dp = −(∂g/∂x s + ∂g/∂p)/(dg/dt), and
///
///     s⁺ = s⁻ + (f⁻ − f⁺) dt*/dp                                  of a state that goes on,
///     s⁺ = ∂R/∂x (s⁻ + f⁻ dt*/dp) + ∂R/∂t dt*/dp + ∂R/∂p − f⁺ dt*/dp   of one that is set to R(t, x, p)
///
/// (Rozenvasser 1967; Galán, Feehery and Barton 1999). States that start at rest start where ∂f/∂x s + ∂f/∂p
/// of them is zero. What is not known in this way is refused, by a SolveError. Not installed.
class Sensitivities {
 public:
  /// Of a run of `program`, which `diagram` was compiled to, over `span` seconds. `diagram` must outlive it.
  /// Throws SolveError where a parameter next to its value makes another circuit.
  Sensitivities(const network::Program& program, const diagram::FlatDiagram& diagram,
                std::vector<SensitivityParameter> parameters, double span);

  std::size_t count() const { return parameters_.size(); }
  /// The size of each parameter, 1 at least: of its sensitivities, tolerances are those of the states over
  /// it.
  std::vector<double> scales() const;

  /// dx/dp of each parameter where the run starts, or where the last event has left it.
  const std::vector<std::vector<double>>& states() const { return states_; }

  /// The run starts there, settled, after the events `served`. A run that goes on from a saved state has none
  /// yet.
  void start(double t, std::span<const double> x, const network::Workspace& run,
             const std::vector<std::size_t>& served, bool from_state);
  /// d(dx/dt)/dp of parameter k where dx/dp = s; false where there is no value.
  bool rates(double t, const double* x, std::size_t k, const double* s, double* rates);
  /// d output/dp, of each output by each parameter, in the units of the outputs and the parameters.
  void outputs(double t, std::span<const double> x, const std::vector<std::vector<double>>& s,
               std::span<double> values);

  /// d output/dx of one output, by each state; with the unknowns of algebraic loops as they follow.
  void output_by_states(double t, std::span<const double> x, std::size_t output, std::span<double> values);

  /// The run goes on from `from` to `to` without an event. Refuses what jumps there all the same.
  void pass(double from, double to, const Interpolant& within);
  /// An event is about to be settled; then it is, and the events `served` have come.
  void before_event(double t, std::span<const double> x, std::vector<std::vector<double>> s);
  void after_event(double t, std::span<const double> x, const network::Workspace& run,
                   const std::vector<std::size_t>& served);
  /// What is not followed. Throw SolveError.
  [[noreturn]] void refuse_slide(double t) const;
  [[noreturn]] void refuse_jump(double t) const;
  /// Throws where the sensitivities s of a run that has failed at t are beyond what numbers hold.
  void refuse_growth(double t, const std::vector<std::vector<double>>& s) const;

 private:
  struct Direction {
    double time = 0;
    std::span<const double> states;             ///< none: they stand still
    std::optional<std::size_t> parameter = {};  ///< and the discrete states as they move with it
  };
  void hold(const Direction& along);
  bool evaluate(double t, const double* x, const Direction& along);
  void evaluate_or_refuse(double t, std::span<const double> x, const Direction& along);
  bool differentiate_rates(double t, const double* x);
  void load(const network::Workspace& run);
  void refuse_jump_of_angle(std::size_t angle, double from, double to, const Interpolant& within);
  void start_states(double t, std::span<const double> x);
  void start_memories(double t, std::span<const double> x, const network::Workspace& run,
                      const std::vector<std::size_t>& served);
  bool any_action_moves(const std::vector<std::size_t>& served) const;
  void refuse_turns_at_start(double t, std::span<const double> x);
  void refuse_rests(double t, std::span<const double> x, const std::vector<double>& rates);
  void refuse_moved(const std::vector<std::size_t>& at_zero, double t, std::span<const double> x,
                    const std::vector<std::vector<double>>& states, std::string_view where);
  /// Of each discrete state: whether a switch or the timeline sets it, and no event.
  std::vector<bool> are_positions() const;
  [[noreturn]] void refuse(double t, const std::string& why) const;

  /// What is known just before an event.
  struct Moment {
    std::vector<double> x, rates, event_values, event_rates;
    std::vector<std::vector<double>> s;
  };
  std::vector<double> delays(double t, const std::vector<double>& discrete_states, bool acts);
  bool is_set(const std::vector<std::size_t>& served, bool on_state, std::size_t index) const;
  std::optional<std::size_t> matching_action(double t, const std::vector<std::size_t>& served, bool on_state,
                                             std::size_t index, double value);

  const diagram::FlatDiagram& diagram_;
  std::vector<SensitivityParameter> parameters_;
  double span_;
  std::vector<network::State> run_states_;
  std::vector<network::Switch> run_switches_;
  std::vector<network::Event> run_events_;
  std::vector<std::uint32_t> mode_states_;
  std::size_t n_unknowns_, n_discrete_states_;
  std::size_t first_angle_ = 0, n_angles_ = 0;  ///< signals: y and x of each atan2(y, x)
  network::TangentNetwork layout_;              ///< without its network
  std::unique_ptr<network::Program> program_;
  std::unique_ptr<network::Workspace> workspace_;
  std::vector<double> discrete_states_;        ///< of the run
  std::vector<std::vector<double>> memories_;  ///< d discrete states/dp of each parameter
  std::vector<std::vector<double>> states_;
  std::vector<double> held_, values_;

  // The rates at one place: ∂f/∂x, and ∂f/∂p of all parameters; of one with which discrete states move, by a
  // program of its own.
  std::unique_ptr<network::Program> columns_program_, rates_program_;
  std::unique_ptr<network::Workspace> columns_workspace_, rates_workspace_;
  std::vector<network::ParameterDerivatives::Entry> entries_;
  std::vector<double> entry_values_;
  std::optional<double> known_time_;
  std::vector<double> known_states_, jacobian_;
  std::vector<std::vector<double>> by_parameter_;
  Moment before_;
  std::vector<bool> memories_move_;   ///< of each parameter
  std::vector<double> phase_delays_;  ///< by which the present phase of the timeline began later, over dp
};

}  // namespace oblique::solve
