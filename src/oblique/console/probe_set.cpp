// SPDX-License-Identifier: MIT
#include <oblique/console/probe_set.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <oblique/console/console.h>

namespace oblique::console {
namespace {

/// The names that a probe records, that of its trigger last.
std::vector<std::string> probed_names(const ProbeSettings& settings) {
  std::vector<std::string> names = settings.names;
  if (settings.trigger) names.push_back(settings.trigger->name);
  return names;
}

}  // namespace

std::optional<Channel> find_channel(Pots& pots, std::string_view name) {
  for (const diagram::FlatOutput& output : pots.flat()->outputs) {
    if (output.name == name)
      return Channel{pots.program()->signal_index(output.signal), output.scale, output.offset, output.unit};
  }
  const std::vector<std::string>& names = pots.program()->signal_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return Channel{static_cast<std::size_t>(found - names.begin()), 1, 0, "machine unit"};
}

std::vector<std::string> output_names(const diagram::FlatDiagram& flat) {
  std::vector<std::string> names;
  for (const diagram::FlatOutput& output : flat.outputs) names.push_back(output.name);
  return names;
}

Channel ProbeSet::channel(std::string_view name) const {
  if (auto found = find_channel(pots_, name)) return *found;
  std::vector<std::string> candidates = output_names(*pots_.flat());
  for (const std::string& signal : pots_.program()->signal_names()) {
    if (std::find(candidates.begin(), candidates.end(), signal) == candidates.end())
      candidates.push_back(signal);
  }
  throw ConsoleError(text::Diagnostic{{pots_.diagram().file, {}},
                                      fmt::format("there is no signal '{}' for a probe", name),
                                      "the name of an output, a block or one of its outputs",
                                      text::suggest(name, candidates)});
}

void ProbeSet::refuse(const std::string& what, const std::string& expected) const {
  throw ConsoleError(
      text::Diagnostic{{pots_.diagram().file, {}}, "a probe cannot be set: " + what, expected, {}});
}

void ProbeSet::check(const ProbeSettings& settings) const {
  for (const std::string& name : settings.names) channel(name);
  if (settings.names.empty()) refuse("it has no names", "at least one");
  if (!(settings.interval >= 0)) refuse("its interval is no time", "0 or more seconds");
  if (!(settings.length > 0)) refuse("its traces have no length", "more than 0 seconds");
  if (const auto& trigger = settings.trigger) {
    channel(trigger->name);
    if (!std::isfinite(trigger->level)) refuse("its level is no number", "a finite number");
    if (!(trigger->hold_off >= 0)) refuse("its hold-off is no time", "0 or more seconds");
  }
}

std::size_t ProbeSet::set(ProbeSettings settings, const Piece& here) {
  Set made;
  for (const std::string& name : probed_names(settings)) made.channels.push_back(channel(name));
  made.probe = std::make_unique<Probe>(std::move(settings), here.begin);
  sets_.push_back(std::move(made));
  show(sets_.back(), here);
  return sets_.size() - 1;
}

void ProbeSet::remove(std::size_t number) {
  at(number);
  sets_[number].probe.reset();
}

const ProbeSet::Set& ProbeSet::at(std::size_t number) const {
  if (number < sets_.size() && sets_[number].probe) return sets_[number];
  throw ConsoleError(
      text::Diagnostic{{pots_.diagram().file, {}},
                       fmt::format("there is no probe number {}", number),
                       "a number that 'set_probe' has given, of a probe that is not taken away",
                       {}});
}

void ProbeSet::look(const Piece& piece) {
  for (const Set& set : sets_) {
    if (set.probe) show(set, piece);
  }
}

void ProbeSet::show(const Set& set, const Piece& piece) {
  set.probe->look(piece.begin, piece.end, piece.whole, [&](double t, std::vector<double>& values) {
    piece.signals(t, signals_);
    values.clear();
    for (const Channel& channel : set.channels) values.push_back(channel.value(signals_));
  });
}

void ProbeSet::jump(double now) {
  for (const Set& set : sets_) {
    if (set.probe) set.probe->jump(now);
  }
}

void ProbeSet::find_again() {
  for (Set& set : sets_) {
    if (!set.probe) continue;
    set.channels.clear();
    for (const std::string& name : probed_names(set.probe->settings())) {
      if (auto found = find_channel(pots_, name)) {
        set.channels.push_back(*found);
      } else {
        set.probe.reset();
        break;
      }
    }
  }
}

}  // namespace oblique::console
