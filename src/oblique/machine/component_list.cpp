// SPDX-License-Identifier: MIT
#include <oblique/machine/component_list.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/machine/carried_signals.h>
#include <oblique/machine/input_weight.h>
#include <oblique/machine/role.h>

namespace oblique::machine {
namespace {

std::string counted(double n, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

class Counter {
 public:
  Counter(const diagram::FlatDiagram& diagram, const diagram::MachineProfile& machine)
      : diagram_(diagram), machine_(machine), signed_(has_signed_weights(machine)) {
    for (const diagram::FlatBlock& block : diagram.blocks) count(block);
    inverters_ += static_cast<double>(inverted_.size());
    potentiometers_ += static_cast<double>(weighted_.size());
  }

  ComponentList components() {
    list_.machine = machine_.title;
    if (machine_.find(diagram::ElementKind::amplifier) != nullptr) {
      add_uncommitted();
    } else {
      add_committed();
    }
    for (const auto& [rate, needed] : rates_) {
      const std::string element = fmt::format("integrators with k0 = {:.4g} 1/s", rate);
      if (!machine_.rates_known && rate != 1)
        list_.rows.push_back({element, needed, true, {}, {}, false, {}});
      const bool lacks =
          std::find(machine_.rates.begin(), machine_.rates.end(), rate) == machine_.rates.end();
      if (machine_.rates.empty() || !lacks) continue;
      list_.rows.push_back({element,
                            needed,
                            true,
                            0.0,
                            fmt::format("k0 on this machine: {:g} 1/s", fmt::join(machine_.rates, ", ")),
                            false,
                            {}});
    }
    add_potentiometers();
    add_named(diagram::ElementKind::multiplier, "multipliers", multipliers_);
    add_named(diagram::ElementKind::comparator, "comparators", comparators_);
    add_named(diagram::ElementKind::function_generator, "function generators", generators_);
    for (const auto& [kind, needed] : needs_) {
      if (is_always_told(kind)) continue;  // added above
      const diagram::ElementCount* const has = machine_.find(kind);
      list_.rows.push_back({diagram::elements_name(kind),
                            needed.count,
                            true,
                            has != nullptr ? has->count : std::optional<double>(),
                            {},
                            false,
                            needed.blocks});
    }
    for (const auto& [block, paths] : others_) {
      list_.rows.push_back({block, static_cast<double>(paths.size()), false, {}, {}, false, paths, true});
    }
    return std::move(list_);
  }

 private:
  void count(const diagram::FlatBlock& block) {
    const Role role = block.definition->role;
    if (role == Role::reference) {
      const double value = std::abs(parameter_of(block, "value"));
      if (value != 1 && value != 0) ++potentiometers_;
    } else if (role == Role::gain) {
      count_gain(parameter_of(block, "factor"));
    } else if (role == Role::potentiometer) {
      ++potentiometers_;
    } else if (role == Role::inverter) {
      ++inverters_;
    } else if (role == Role::summer) {
      ++summers_;
    } else if (role == Role::integrator) {
      ++integrators_;
      ++rates_[std::abs(parameter_of(block, "rate"))];
      const double initial = std::abs(parameter_of(block, "initial"));
      if (!signed_ && initial != 0 && initial != 1) ++potentiometers_;
    } else if (role == Role::open_amplifier) {
      ++open_;
    } else if (is_product(role)) {
      multipliers_.push_back(block.path);
    } else if (role == Role::comparator) {
      comparators_.push_back(block.path);
    } else if (role == Role::function_generator) {
      generators_.push_back(block.path);
    } else if (!block.definition->needs.empty()) {
      count_needs(block);
    } else {
      others_[block.definition->name].push_back(block.path);
    }
    for (std::size_t port = 0; port < block.inputs.size(); ++port)
      count_weights(block.inputs[port], block.definition->inputs[port].sum);
  }

  /// A block that says itself what it is made of.
  void count_needs(const diagram::FlatBlock& block) {
    for (const diagram::ElementNeed& need : block.definition->needs) {
      const double count =
          std::ceil(text::evaluate(need.count, [&](std::string_view name) -> std::optional<double> {
            if (name == "polarity") return block.polarity;
            return parameter_of(block, name);
          }));
      if (count > 0) count_need(need.kind, count, block.path);
    }
  }

  void count_need(diagram::ElementKind kind, double count, const std::string& path) {
    switch (kind) {
      case diagram::ElementKind::amplifier:  // without a network that would make it another
        open_ += count;
        return;
      case diagram::ElementKind::integrator:
        integrators_ += count;
        return;
      case diagram::ElementKind::summer:
        summers_ += count;
        return;
      case diagram::ElementKind::inverter:
        inverters_ += count;
        return;
      case diagram::ElementKind::potentiometer:
        potentiometers_ += count;
        return;
      case diagram::ElementKind::multiplier:
      case diagram::ElementKind::comparator:
      case diagram::ElementKind::function_generator:
      case diagram::ElementKind::store:
      case diagram::ElementKind::electronic_switch:
      case diagram::ElementKind::counter:
      case diagram::ElementKind::flip_flop:
      case diagram::ElementKind::monostable:
      case diagram::ElementKind::noise_generator:
      case diagram::ElementKind::diode:
        break;
    }
    Needed& needed = needs_[kind];
    needed.count += count;
    needed.blocks.push_back(path);
  }

  void count_gain(double factor) {
    if (std::abs(factor) != 1) ++potentiometers_;
    if (std::abs(factor) > 1) ++summers_;
    if (factor < 0 && !signed_) ++inverters_;
  }

  void count_weights(const diagram::FlatInput& input, bool sum) {
    const std::vector<double> unit{1};
    for (const diagram::FlatTerm& term : input.terms) {
      if (term.weight == 0) continue;
      const diagram::FlatBlock& from = diagram_.blocks[term.signal.block];
      const Role role = from.definition->role;
      const auto key = std::pair(term.signal.block, term.signal.output);
      if (term.weight < 0 && !signed_ && role != Role::reference) inverted_.insert(key);
      if (sum && std::abs(term.weight) != 1) weights_inputs_ = true;
      const InputWeight split =
          split_weight(std::abs(term.weight), sum || signed_ ? machine_.input_gains : unit);
      if (split.setting != 1)
        weighted_.emplace(key.first, key.second, term.weight < 0, fmt::format("{:.12g}", split.setting));
    }
  }

  void add(diagram::ElementKind kind, std::string element, double needed, std::string note = {}) {
    if (needed == 0) return;
    const diagram::ElementCount* const has = machine_.find(kind);
    list_.rows.push_back({std::move(element),
                          needed,
                          has != nullptr,
                          has != nullptr ? has->count : std::optional<double>(),
                          std::move(note),
                          false,
                          {}});
  }

  void add_named(diagram::ElementKind kind, std::string element, std::vector<std::string> blocks) {
    auto needed = static_cast<double>(blocks.size());
    if (const auto others = needs_.find(kind); others != needs_.end()) {
      needed += others->second.count;
      blocks.insert(blocks.end(), others->second.blocks.begin(), others->second.blocks.end());
    }
    if (blocks.empty()) return;
    add(kind, std::move(element), needed);
    list_.rows.back().blocks = std::move(blocks);
  }

  void add_potentiometers() {
    const bool at_least = weights_inputs_ && !machine_.input_gains_known;
    if (potentiometers_ == 0 && !at_least) return;
    const diagram::ElementCount* const has = machine_.find(diagram::ElementKind::potentiometer);
    list_.rows.push_back({"potentiometers",
                          potentiometers_,
                          has != nullptr || potentiometers_ == 0,
                          has != nullptr ? has->count : std::optional<double>(),
                          at_least ? "the gains of inputs are not published" : "",
                          at_least,
                          {}});
  }

  void add_uncommitted() {
    std::vector<std::string> parts;
    const auto part = [&](double n, std::string_view one, std::string_view many) {
      if (n > 0) parts.push_back(counted(n, one, many));
    };
    part(summers_, "summer", "summers");
    part(inverters_, "inverter", "inverters");
    part(integrators_, "integrator", "integrators");
    part(open_, "open amplifier", "open amplifiers");
    add(diagram::ElementKind::amplifier, "amplifiers", summers_ + inverters_ + integrators_ + open_,
        fmt::format("{}", fmt::join(parts, ", ")));
    if (machine_.find(diagram::ElementKind::integrator) != nullptr)
      add(diagram::ElementKind::integrator, "integrator networks", integrators_);
  }

  void add_committed() {
    add(diagram::ElementKind::integrator, "integrators", integrators_);
    double inverters = inverters_, summers = summers_ + open_;
    const diagram::ElementCount* const has = machine_.find(diagram::ElementKind::inverter);
    const double free = has == nullptr ? 0 : has->count.value_or(inverters);
    const double beyond = std::max(0.0, inverters - free);
    summers += beyond;
    inverters -= beyond;
    std::vector<std::string> parts;
    if (open_ > 0) parts.push_back(counted(open_, "open amplifier", "open amplifiers"));
    if (beyond > 0) parts.push_back(counted(beyond, "inverter", "inverters"));
    add(diagram::ElementKind::summer, "summers", summers,
        parts.empty() ? "" : fmt::format("{} of these", fmt::join(parts, ", ")));
    add(diagram::ElementKind::inverter, "inverters", inverters);
  }

  const diagram::FlatDiagram& diagram_;
  const diagram::MachineProfile& machine_;
  bool signed_;
  bool weights_inputs_ = false;  ///< some sum has a weight other than ±1
  ComponentList list_;
  double summers_ = 0, inverters_ = 0, integrators_ = 0, open_ = 0, potentiometers_ = 0;
  std::vector<std::string> multipliers_, comparators_, generators_;  ///< paths
  std::map<double, double> rates_;  ///< how many integrators have which [1/s]
  struct Needed {
    double count = 0;
    std::vector<std::string> blocks;  ///< paths
  };
  std::map<diagram::ElementKind, Needed> needs_;            ///< of blocks that say what they require
  std::map<std::string, std::vector<std::string>> others_;  ///< without a role, by the names of their blocks
  std::set<std::pair<std::size_t, std::size_t>> inverted_;  ///< signals that negative weights ask for
  /// Potentiometers that weights ask for: signal, its sign, setting.
  std::set<std::tuple<std::size_t, std::size_t, bool, std::string>> weighted_;
};

}  // namespace

double ComponentListRow::missing() const {
  if (!exists) return needed;
  return available ? std::max(0.0, needed - *available) : 0;
}

ComponentList::Verdict ComponentList::verdict() const {
  const auto missing = [](const ComponentListRow& row) { return row.missing() > 0; };
  const auto unknown = [](const ComponentListRow& row) {
    return row.at_least || (row.exists && !row.available);
  };
  if (std::any_of(rows.begin(), rows.end(), missing)) return Verdict::does_not_fit;
  return std::any_of(rows.begin(), rows.end(), unknown) ? Verdict::cannot_tell : Verdict::fits;
}

std::vector<std::string> ComponentList::absent() const {
  std::vector<std::string> kinds;
  for (const ComponentListRow& row : rows) {
    if (!row.exists) kinds.push_back(row.element);
  }
  return kinds;
}

ComponentList component_list_of(const diagram::FlatDiagram& diagram, const diagram::MachineProfile& machine) {
  return Counter(diagram, machine).components();
}

}  // namespace oblique::machine
