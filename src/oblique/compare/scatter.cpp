// SPDX-License-Identifier: MIT
#include <oblique/compare/scatter.h>

namespace oblique::compare {
namespace {

/// Uniform in [−1, 1).
double uniform(const DrawKey& key, std::size_t block, std::size_t figure) {
  const auto low = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
  const auto high = [](std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32); };
  const auto bits =
      philox({low(key.run), high(key.run), low(block), low(figure)}, {low(key.seed), high(key.seed)});
  const std::uint64_t all = (static_cast<std::uint64_t>(bits[0]) << 32) | bits[1];
  return static_cast<double>(all >> 11) * 0x1p-52 - 1;
}

}  // namespace

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  constexpr std::uint64_t kFirstFactor = 0xD2511F53, kSecondFactor = 0xCD9E8D57;
  constexpr std::uint32_t kFirstStep = 0x9E3779B9, kSecondStep = 0xBB67AE85;
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t first = kFirstFactor * counter[0], second = kSecondFactor * counter[2];
    counter = {
        static_cast<std::uint32_t>(second >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(second),
        static_cast<std::uint32_t>(first >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(first)};
    key[0] += kFirstStep;
    key[1] += kSecondStep;
  }
  return counter;
}

std::vector<Draw> draw(const diagram::FlatDiagram& diagram, const std::vector<diagram::BlockFigure>& scatters,
                       DrawKey key) {
  std::vector<Draw> draws;
  for (std::size_t b = 0; b < diagram.blocks.size(); ++b) {
    const diagram::FlatBlock& block = diagram.blocks[b];
    for (std::size_t s = 0; s < scatters.size(); ++s) {
      const auto parameter = scatters[s].acts_on(*block.definition);
      if (!parameter) continue;
      const double nominal = block.parameters[*parameter];
      const double away = scatters[s].value * uniform(key, b, s);
      const bool allowed = block.definition->parameters[*parameter].allows(nominal + away);
      draws.push_back({b, *parameter, allowed ? nominal + away : nominal - away});
    }
  }
  return draws;
}

void apply_draws(const std::vector<Draw>& draws, diagram::FlatDiagram& diagram) {
  for (const Draw& drawn : draws) {
    diagram::FlatBlock& block = diagram.blocks[drawn.block];
    block.parameters[drawn.parameter] = drawn.value;
    block.choose_behaviour();
  }
}

std::vector<diagram::BlockFigure> scatters_of_tolerance(const diagram::BlockLibrary& library,
                                                        double tolerance) {
  std::vector<diagram::BlockFigure> scatters;
  for (const std::string& name : library.names()) {
    const diagram::BlockDefinition& definition = *library.find(name);
    if (definition.is_composite()) continue;
    for (const diagram::ParameterDefinition& parameter : definition.parameters) {
      const bool scattered = parameter.name == "tolerance" ||
                             (definition.role == diagram::Role::multiplier && parameter.name == "error");
      if (scattered) scatters.push_back({name, parameter.name, tolerance, "tolerance"});
    }
  }
  return scatters;
}

}  // namespace oblique::compare
