// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/console/pots.h>
#include <oblique/console/probe.h>
#include <oblique/diagram/flat_diagram.h>

namespace oblique::console {

/// An output or a signal as it is read.
struct Channel {
  std::size_t signal = 0;
  double scale = 1, offset = 0;
  std::string unit;

  double value(const std::vector<double>& signals) const { return scale * signals[signal] + offset; }
};

/// That of an output, else of a signal; nothing where no one has the name.
std::optional<Channel> find_channel(Pots& pots, std::string_view name);
std::vector<std::string> output_names(const diagram::FlatDiagram& flat);

/// The probes of a console, by the numbers in which they were set. Not installed.
class ProbeSet {
 public:
  /// What the machine has can be read by its names. It must outlive this.
  explicit ProbeSet(Pots& pots) : pots_(pots) {}

  /// A smooth piece of the machine's way, or a part of one that begins with it.
  struct Piece {
    double begin = 0, end = 0;  ///< [s]
    bool whole = false;         ///< a step or an event ends there
    /// All signals at a time of it.
    std::function<void(double t, std::vector<double>& values)> signals;
  };

  /// Throws ConsoleError for what is no probe.
  void check(const ProbeSettings& settings) const;
  /// Adds one that was checked, shows it where the machine stands, and gives its number.
  std::size_t set(ProbeSettings settings, const Piece& here);
  void remove(std::size_t number);
  const std::vector<Trace>& traces(std::size_t number) const { return at(number).probe->traces(); }
  std::vector<Trace> take_traces(std::size_t number) { return at(number).probe->take_ended(); }

  void look(const Piece& piece);
  /// The machine stands at another time now.
  void jump(double now);
  /// Of a machine in which signals stand elsewhere; probes of what there is no more are taken away.
  void find_again();

 private:
  struct Set {
    std::vector<Channel> channels;  ///< of its names and, at the end, of its trigger
    std::unique_ptr<Probe> probe;   ///< none once it is taken away
  };

  void show(const Set& set, const Piece& piece);
  Channel channel(std::string_view name) const;
  const Set& at(std::size_t number) const;
  [[noreturn]] void refuse(const std::string& what, const std::string& expected) const;

  Pots& pots_;
  std::vector<Set> sets_;
  std::vector<double> signals_;
};

}  // namespace oblique::console
