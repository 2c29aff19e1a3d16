// SPDX-License-Identifier: MIT
#include "random_diagram.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <fmt/format.h>

namespace oblique::fuzz {
namespace {

const BlockKind& random_kind(Dice& dice) {
  const auto kinds = block_kinds();
  const int all = std::accumulate(kinds.begin(), kinds.end(), 0,
                                  [](int sum, const BlockKind& kind) { return sum + kind.weight; });
  int left = static_cast<int>(dice.below(static_cast<std::size_t>(all)));
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&](const BlockKind& kind) { return (left -= kind.weight) < 0; });
  return *found;
}

double random_weight(Dice& dice) {
  constexpr double kWeights[] = {1, -1, 0.5, -0.5, -2, 2, 0.3, -1.7};
  return kWeights[dice.below(std::size(kWeights))];
}

/// Mostly a block before this one or one with a state, so that algebraic loops are there but not everywhere.
Wire random_wire(const DiagramPlan& plan, std::size_t to, Dice& dice) {
  constexpr int kTries = 4;
  const bool any = dice.one_in(8);
  std::size_t from = dice.below(plan.blocks.size());
  for (int k = 0; k < kTries && !any && from >= to && !plan.blocks[from].kind->has_state; ++k)
    from = dice.below(plan.blocks.size());
  return {random_weight(dice), from, dice.below(plan.blocks[from].kind->outputs.size())};
}

void wire(DiagramPlan& plan, std::size_t index, Dice& dice) {
  PlannedBlock& block = plan.blocks[index];
  for (const PortKind& port : block.kind->inputs) {
    if (!port.required && !dice.one_in(3)) continue;
    std::vector<Wire> wires{random_wire(plan, index, dice)};
    if (port.is_sum) {
      while (wires.size() < 3 && dice.one_in(2)) wires.push_back(random_wire(plan, index, dice));
      // Most integrators are damped, and most amplifiers fed back: what grows without end soon leaves every
      // machine.
      if (block.kind->type == "integrator" && !dice.one_in(3)) wires.push_back({-0.5, index, 0});
      if (block.kind->type == "servo-amplifier" && !dice.one_in(4)) wires.push_back({1, index, 0});
    }
    block.inputs.emplace_back(&port, std::move(wires));
  }
}

double factor_of(Dimension dimension, const Writing& writing) {
  return std::pow(writing.value, dimension.value) * std::pow(writing.time, dimension.time);
}

class Writer {
 public:
  Writer(const DiagramPlan& plan, const Writing& writing)
      : plan_(plan), writing_(writing), signs_(writing.signs) {}

  std::string text() {
    std::string out = "format = \"oblique-diagram/1\"\n";
    if (plan_.profile != "ideal" || plan_.inverting)
      out += fmt::format("[machine]\nprofile = \"{}\"\ninverting = {}\n", plan_.profile, plan_.inverting);
    out += fmt::format("[run]\nuntil = {}\ntolerance = {}\nmethod = \"{}\"\nsettle = {}\nsamples = {}\n",
                       plan_.until * writing_.time, plan_.tolerance, plan_.method, plan_.settle,
                       writing_.samples);
    if (plan_.max_step) out += fmt::format("max_step = {}\n", *plan_.max_step * writing_.time);
    if (plan_.absolute_tolerance)
      out += fmt::format("absolute_tolerance = {}\n", *plan_.absolute_tolerance * writing_.value);
    if (!plan_.phases.empty()) {
      constexpr const char* kModes[] = {"operate", "hold", "initial"};
      out += "[timeline]\nphases = [";
      for (const PlannedPhase& phase : plan_.phases) {
        out +=
            fmt::format("{{ mode = \"{}\", for = {} }}, ", kModes[phase.mode], phase.length * writing_.time);
      }
      out += fmt::format("]\ncycles = {}\n", plan_.cycles);
    }
    out += "[blocks]\n";
    std::vector<std::string> lines;
    for (std::size_t k = 0; k < plan_.blocks.size(); ++k) lines.push_back(line_of(k));
    for (std::size_t k = 0; k < lines.size(); ++k)
      out += lines[writing_.order.empty() ? k : writing_.order[k]];
    out += offsets_;
    out += "[outputs]\n";
    for (std::size_t k = 0; k < plan_.blocks.size(); ++k) {
      out += fmt::format("y{} = {{ signal = \"{}\", scale = {} }}\n", k, signal({1, k, 0}),
                         1 / factor_of(plan_.blocks[k].kind->outputs[0].dimension, writing_));
    }
    return out;
  }

 private:
  std::string name(std::size_t block) const {
    if (writing_.names == Writing::Names::rising) return fmt::format("b{}", block);
    return fmt::format("x{}", 900 - block);
  }

  std::string signal(const Wire& wire) const {
    const BlockKind& kind = *plan_.blocks[wire.block].kind;
    if (kind.outputs.size() == 1) return name(wire.block);
    return name(wire.block) + "." + std::string(kind.outputs[wire.output].name);
  }

  double disturbed(double number) {
    if (writing_.disturbance == 0) return number;
    return number * (1 + ((signs_() & 1U) != 0 ? writing_.disturbance : -writing_.disturbance));
  }

  /// Blocks that do something else beside a level of what they read.
  static bool compares(const BlockKind& kind) {
    constexpr std::string_view kTypes[] = {"comparator", "sign", "relay", "electronic-switch", "multiplexer"};
    const bool jumps = std::any_of(kind.parameters.begin(), kind.parameters.end(),
                                   [](const ParameterKind& p) { return p.form == Form::jumping_curve; });
    return jumps || std::find(std::begin(kTypes), std::end(kTypes), kind.type) != std::end(kTypes);
  }

  /// The signal of a wire with an offset, as that of a summer of its own.
  std::string offset_signal(const Wire& wire) {
    if (offsets_.empty()) offsets_ = "unity = { type = \"constant\", value = 1 }\n";
    const std::string name = fmt::format("offset{}", ++n_offsets_);
    const char* const sign = plan_.inverting ? "-1" : "1";
    const double off = (signs_() & 1U) != 0 ? writing_.offset : -writing_.offset;
    offsets_ += fmt::format("{} = {{ type = \"summer\", in = [\"{}*{}\", \"{}*unity\"] }}\n", name, sign,
                            signal(wire), off);
    return name;
  }

  std::string term(const Wire& wire, const PortKind& port, bool with_offset) {
    const Dimension from = plan_.blocks[wire.block].kind->outputs[wire.output].dimension;
    const double scale = factor_of(port.dimension, writing_) / factor_of(from, writing_);
    const double weight = disturbed(wire.weight) * scale;
    return fmt::format("\"{}*{}\"", weight, with_offset ? offset_signal(wire) : signal(wire));
  }

  std::string line_of(std::size_t index) {
    const PlannedBlock& block = plan_.blocks[index];
    const bool with_offset = writing_.offset != 0 && plan_.profile == "ideal" && compares(*block.kind);
    std::string line = fmt::format("{} = {{ type = \"{}\"", name(index), block.kind->type);
    for (const auto& [port, wires] : block.inputs) {
      line += fmt::format(", {} = ", port->name);
      if (!port->is_sum) {
        line += term(wires.front(), *port, with_offset);
        continue;
      }
      line += "[";
      for (std::size_t k = 0; k < wires.size(); ++k)
        line += (k == 0 ? "" : ", ") + term(wires[k], *port, with_offset);
      line += "]";
    }
    for (const auto& [parameter, planned] : block.parameters) {
      // Parts of one, such as a setting, may only become less.
      const bool is_part = parameter->dimension.value == 0 && parameter->dimension.time == 0;
      const double number = is_part ? planned * (1 - writing_.disturbance) : disturbed(planned);
      const double value = number * factor_of(parameter->dimension, writing_);
      line += fmt::format(", {} = {}", parameter->name, setting(parameter->form, value));
    }
    return line + " }\n";
  }

  static std::string setting(Form form, double value) {
    switch (form) {
      case Form::whole:
        return fmt::format("{}", std::round(value));
      case Form::curve:
        return fmt::format("[[-1, {0}], [0, 0], [0.5, 1], [1, {1}]]", value, -value);
      case Form::jumping_curve:
        return fmt::format("[[-1, 0.5], [0, 0], [0, {0}], [1, {0}]]", value);
      case Form::sine:
        return fmt::format("\"sin({}*time)\"", value);
      default:
        return fmt::format("{}", value);
    }
  }

  const DiagramPlan& plan_;
  const Writing& writing_;
  std::mt19937 signs_;
  std::string offsets_;  ///< lines of blocks that only `offset` needs
  int n_offsets_ = 0;
};

}  // namespace

DiagramPlan plan_diagram(Dice& dice) {
  constexpr double kTolerances[] = {1e-8, 1e-6, 1e-7, 1e-9};
  constexpr const char* kMethods[] = {"auto", "auto", "bdf", "adams", "rodas"};
  constexpr const char* kProfiles[] = {"tr-10", "rat-700", "mn-7", "the-analog-thing"};
  DiagramPlan plan;
  plan.until = dice.number(0.5, 8.5);
  plan.tolerance = kTolerances[dice.below(std::size(kTolerances))];
  plan.method = kMethods[dice.below(std::size(kMethods))];
  plan.settle = !dice.one_in(8);
  plan.inverting = dice.one_in(8);
  if (dice.one_in(16)) {
    plan.profile = kProfiles[dice.below(std::size(kProfiles))];
    plan.inverting = true;
  }
  if (dice.one_in(8)) plan.max_step = dice.number(0.015625, 0.265625);
  if (dice.one_in(8)) plan.absolute_tolerance = plan.tolerance * dice.number(0.001, 0.1);
  if (dice.one_in(8)) {
    for (std::size_t phases = 1 + dice.below(4); phases > 0; --phases)
      plan.phases.push_back({dice.below(3), dice.number(0.125, 2.125)});
    plan.cycles = 1 + dice.below(3);
  }
  const std::size_t n = 2 + dice.below(9);
  for (std::size_t k = 0; k < n; ++k) plan.blocks.push_back({&random_kind(dice), {}, {}});
  for (std::size_t k = 0; k < n; ++k) {
    wire(plan, k, dice);
    for (const ParameterKind& parameter : plan.blocks[k].kind->parameters) {
      if (parameter.required || dice.one_in(2))
        plan.blocks[k].parameters.emplace_back(&parameter, dice.number(parameter.low, parameter.high));
    }
  }
  return plan;
}

bool can_be_scaled(const DiagramPlan& plan) {
  const auto changes = [&](const Wire& wire) {
    const Dimension dimension = plan.blocks[wire.block].kind->outputs[wire.output].dimension;
    return dimension.value == 0 || dimension.time != 0;
  };
  return plan.profile == "ideal" &&
         std::none_of(plan.blocks.begin(), plan.blocks.end(), [&](const PlannedBlock& block) {
           if (!block.kind->weighs) return false;
           const auto& wires = block.inputs.front().second;
           return std::any_of(wires.begin(), wires.end(), changes);
         });
}

std::string text_of(const DiagramPlan& plan, const Writing& writing) {
  return Writer(plan, writing).text();
}

}  // namespace oblique::fuzz
