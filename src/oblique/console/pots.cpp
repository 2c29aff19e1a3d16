// SPDX-License-Identifier: MIT
#include <oblique/console/pots.h>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/machine_profile.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/assembly/parameter_difference.h>
#include <oblique/text/expression.h>
#include <oblique/text/quantity.h>

namespace oblique::console {
namespace {

const diagram::Behaviour* behaviour_of(const diagram::FlatBlock& block) {
  return block.definition->choose_behaviour(block.parameters, block.polarity);
}

}  // namespace

Pots::Pots(diagram::Diagram diagram, const diagram::BlockLibrary& library,
           std::vector<diagram::ParameterOverride> overrides)
    : diagram_(std::move(diagram)), library_(&library), overrides_(std::move(overrides)) {
  compile(flattened(overrides_));
}

const std::shared_ptr<const network::Program>& Pots::program() {
  if (turned_) program_ = std::make_shared<const network::Program>(*compiled_, *setting_);
  turned_ = false;
  return program_;
}

Turned Pots::turn(const std::string& pot, const std::string& value) {
  if (turn_known(pot, value)) return Turned::at_once;
  std::vector<diagram::ParameterOverride> overrides = overrides_;
  const auto same = std::find_if(overrides.begin(), overrides.end(),
                                 [&](const diagram::ParameterOverride& other) { return other.path == pot; });
  const auto index = static_cast<std::size_t>(same - overrides.begin());
  if (same == overrides.end()) overrides.push_back({pot, {}});
  overrides[index].value = value;
  auto flat = flattened(overrides);
  const auto others = changed(*flat);
  const bool at_once = others && setting_->set(*others);
  if (at_once) {
    flat_ = std::move(flat);
    turned_ = true;
  } else {
    compile(std::move(flat));
  }
  overrides_ = std::move(overrides);
  const auto found = network::find_parameter(*flat_, *numbers_, pot);
  if (found && found->parameter && flat_->blocks[found->block].formulas.empty()) {
    known_.insert_or_assign(pot, Known{found->block, *found->parameter, found->number,
                                       diagram::unit_on(diagram_.machine.profile, found->unit), index});
  }
  return at_once ? Turned::at_once : Turned::compiled_anew;
}

/// Turns a pot that was turned before and leaves the equations as they are; false where nothing was done.
bool Pots::turn_known(const std::string& name, const std::string& value) {
  const auto found = known_.find(name);
  if (found == known_.end()) return false;
  const auto& [place, parameter, number, unit, index] = found->second;
  diagram::FlatBlock& block = flat_->blocks[place];
  double now = 0;
  try {
    now = text::parse_quantity(value, unit);
  } catch (const text::ExpressionError&) {
    return false;  // whoever reads the whole diagram tells of it
  }
  if (!block.definition->parameters[parameter].allows(now)) return false;
  const double before = std::exchange(block.parameters[parameter], now);
  const Parameter changed{number, now};
  if (behaviour_of(block) != block.behaviour || !setting_->set({&changed, 1})) {
    block.parameters[parameter] = before;
    return false;
  }
  overrides_[index].value = value;
  turned_ = true;
  return true;
}

void Pots::set_timeline(diagram::Timeline timeline) {
  diagram_.timeline = std::move(timeline);
  compile(flattened(overrides_));
}

std::vector<std::string> Pots::names() const {
  std::vector<std::string> names;
  for (const diagram::FlatBlock& block : flat_->blocks) {
    for (const auto& parameter : block.definition->parameters) {
      if (!parameter.points && !parameter.formula)
        names.push_back(fmt::format("{}.{}", block.path, parameter.name));
    }
  }
  return names;
}

std::optional<Pots::Setting> Pots::setting_of(std::string_view name) const {
  const auto found = network::find_parameter(*flat_, *numbers_, name);
  return found ? std::optional(Setting{found->value, found->unit}) : std::nullopt;
}

std::shared_ptr<diagram::FlatDiagram> Pots::flattened(
    const std::vector<diagram::ParameterOverride>& overrides) const {
  return std::make_shared<diagram::FlatDiagram>(diagram::flatten(diagram_, *library_, overrides));
}

void Pots::compile(std::shared_ptr<diagram::FlatDiagram> flat) {
  compiled_ = std::make_shared<const network::Program>(network::assemble(*flat));
  flat_ = std::move(flat);
  program_ = compiled_;
  numbers_.emplace(*flat_);
  setting_.emplace(*compiled_);
  turned_ = false;
}

/// The parameters that are others in `now`; nothing where more than parameters is.
std::optional<std::vector<Pots::Parameter>> Pots::changed(const diagram::FlatDiagram& now) const {
  const auto numbers = network::parameter_difference(*flat_, *numbers_, now);
  if (!numbers) return std::nullopt;
  for (std::size_t b = 0; b < now.blocks.size(); ++b) {
    if (behaviour_of(flat_->blocks[b]) != behaviour_of(now.blocks[b])) return std::nullopt;
  }
  const std::vector<double> values = network::parameter_values(now);
  std::vector<Parameter> changed;
  for (const std::uint32_t number : *numbers) changed.push_back({number, values[number]});
  return changed;
}

}  // namespace oblique::console
