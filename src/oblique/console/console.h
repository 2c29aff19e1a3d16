// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <oblique/console/probe.h>
#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/flatten.h>
#include <oblique/solve/run_records.h>
#include <oblique/solve/run_state.h>
#include <oblique/text/diagnostic.h>

namespace oblique::console {

/// Thrown for what a console cannot do: a name that there is not, a time that is over.
class ConsoleError : public text::Error {
 public:
  using text::Error::Error;
};

/// How a pot was turned.
enum class Turned {
  at_once,        ///< the equations stayed, with other numbers
  compiled_anew,  ///< they are others now: another case of a block, a factor that became 0 or 1
};

/// A machine that is held: it runs as far as it is asked to, is read like with a voltmeter, and its pots are
/// turned while it runs. Between two turns the steps are those of `solve::run`: how often and where it is
/// asked in between changes none. What `run` only finds afterwards, and then begins anew for, is warned of
/// here: a machine that was watched cannot be run again.
class Console {
 public:
  /// The machine of a diagram, which begins at t = 0 as a run does: settled, and computing unless its
  /// timeline says otherwise. `library` must outlive the console. Throws DiagramError, NetworkError and
  /// SolveError.
  Console(diagram::Diagram diagram, const diagram::BlockLibrary& library);
  Console(Console&&) noexcept;
  Console& operator=(Console&&) noexcept;
  ~Console();

  double time() const;  ///< [s]
  /// Runs until that time [s]. Throws ConsoleError for one that is over, and SolveError; the console then
  /// stands where the machine failed.
  void advance(double until);

  /// What the voltmeter shows.
  struct Reading {
    double value = 0;
    std::string unit;
  };
  /// An output of the diagram, in its unit; else a signal by the name that a diagram calls it by ("c",
  /// "b.cos") in machine units, or a pot ("c.gain") in the unit of the parameter. Throws ConsoleError.
  Reading read(std::string_view name) const;
  /// Its number alone.
  double value(std::string_view name) const { return read(name).value; }
  /// A signal in machine units, where an output has its name, too. Throws ConsoleError.
  double signal(std::string_view name) const;
  /// The values of all signals, in the order of `signal_names` [machine unit].
  std::vector<double> signals() const;
  /// The names of all outputs, signals and pots that there are.
  std::vector<std::string> output_names() const;
  std::vector<std::string> signal_names() const;
  std::vector<std::string> pot_names() const;

  /// The lamps: what signals are beyond ±1 machine unit at `time`, in their order.
  struct Overload {
    std::string signal;
    double value = 0;  ///< [machine unit]
  };
  std::vector<Overload> overloads() const;

  /// Records from now on, and gives the number of the probe. Throws ConsoleError for a name that there is
  /// not, and for an interval, a length or a hold-off that is none.
  std::size_t set_probe(ProbeSettings settings);
  /// What a probe has recorded until `time`. Throws ConsoleError for a number that no probe has.
  const std::vector<Trace>& traces(std::size_t probe) const;
  /// Those of them that have ended; the probe forgets them. Throws ConsoleError likewise.
  std::vector<Trace> take_traces(std::size_t probe);
  /// Takes a probe away.
  void remove_probe(std::size_t probe);

  /// Turns a pot ("c.gain"), or the weight of a wire ("c.in[2]"), to a quantity ("1e4", "20 ms"), and says
  /// how. The machine goes on as it stands when it next runs or is read: states, elements of loops and
  /// discrete states are carried over by name. Throws DiagramError and NetworkError, and is then as it was;
  /// what it then cannot solve, those that run and read tell, until the pot is turned again.
  Turned turn(const std::string& pot, const std::string& value);

  /// Puts another diagram in place of this one while the machine is held: it goes on at `time`, and what has
  /// the same name, or one of `renamed` (the name before, the new one), goes on from where it stands; what is
  /// new begins where it starts. Pots stay as they are turned where the file still says of them what it said,
  /// and are given with their values; probes that show what there is no more are taken away. `library` must
  /// outlive the console. Throws DiagramError, NetworkError, SolveError, and ConsoleError where the timeline
  /// is another; the console is then as it was.
  std::vector<diagram::ParameterOverride> exchange(
      diagram::Diagram diagram, const diagram::BlockLibrary& library,
      const std::vector<std::pair<std::string, std::string>>& renamed = {});

  /// Puts all integrators into a mode of operation. Throws ConsoleError where the diagram's timeline says in
  /// which they are, and SolveError.
  void set_mode(diagram::OperatingMode mode);

  /// Repetitive operation from now on: in initial condition for so long, then in operation, and from the
  /// beginning again [s], until a mode is set. Throws ConsoleError as above, and for times that are none.
  void repeat(double initial, double operate);

  /// The state at `time`, with which `solve::run` and any console of the same diagram can go on.
  solve::RunState save() const;
  /// Goes on from such a state; pots stay as they are turned. Throws ReadError where it is another diagram's,
  /// and SolveError, and is then as it was.
  void restore(const solve::RunState& state);

  /// What has happened until `time`.
  std::vector<solve::EventRecord> events() const;
  /// What could not be seen so far.
  std::vector<text::Diagnostic> warnings() const;

 private:
  class Held;
  std::unique_ptr<Held> held_;
};

}  // namespace oblique::console
