// SPDX-License-Identifier: MIT
#include <oblique/machine/sign_assignment.h>

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace oblique::machine {
namespace {

/// A network of summers (with inverted sums) and multipliers, as one would draw it.
struct Network {
  struct Element {
    bool multiplies = false;
    std::vector<std::pair<std::size_t, bool>> inputs;  ///< signal, and whether it comes in negative
  };
  std::vector<Element> elements;
};

Network random_network(std::mt19937& random, std::size_t size) {
  Network network;
  for (std::size_t e = 0; e < size; ++e) {
    Network::Element element;
    element.multiplies = random() % 3 == 0;
    const std::size_t inputs = element.multiplies ? 2 : 1 + random() % 3;
    for (std::size_t k = 0; k < inputs; ++k) element.inputs.emplace_back(random() % size, random() % 2 == 0);
    network.elements.push_back(std::move(element));
  }
  return network;
}

/// The problem as the machine stage states it: a summer inverts, and its sign flips all its inputs.
SignProblem problem_of(const Network& network) {
  SignProblem problem;
  for (const Network::Element& element : network.elements) {
    const std::size_t first = problem.variables;
    problem.variables += element.multiplies ? 2 : 1;
    problem.signals.push_back({{first, element.multiplies ? std::optional(first + 1) : std::nullopt}});
    for (std::size_t k = 0; k < element.inputs.size(); ++k) {
      const auto [signal, negative] = element.inputs[k];
      problem.uses.push_back(
          {signal, element.multiplies ? negative : !negative, element.multiplies ? first + k : first});
    }
  }
  return problem;
}

/// The fewest inverters by trying every sign of every output, and for each multiplier both pairs of input
/// signs that give it. Works on the network itself: voltages ±1, no variables.
std::size_t fewest_inverters(const Network& network) {
  const std::size_t size = network.elements.size();
  std::size_t fewest = size;
  std::vector<std::size_t> multipliers;
  for (std::size_t e = 0; e < size; ++e) {
    if (network.elements[e].multiplies) multipliers.push_back(e);
  }
  for (std::size_t outputs = 0; outputs < std::size_t{1} << size; ++outputs) {
    const auto sign = [&](std::size_t e) { return (outputs >> e & 1) != 0 ? -1 : 1; };
    for (std::size_t flipped = 0; flipped < std::size_t{1} << multipliers.size(); ++flipped) {
      std::vector<bool> wanted_otherwise(size, false);
      const auto want = [&](const std::pair<std::size_t, bool>& input, int polarity) {
        const int wanted = input.second ? -polarity : polarity;
        if (wanted != sign(input.first)) wanted_otherwise[input.first] = true;
      };
      std::size_t m = 0;
      for (std::size_t e = 0; e < size; ++e) {
        const Network::Element& element = network.elements[e];
        if (!element.multiplies) {
          for (const auto& input : element.inputs) want(input, -sign(e));
          continue;
        }
        const int first = (flipped >> m++ & 1) != 0 ? -1 : 1;
        want(element.inputs[0], first);
        want(element.inputs[1], first * sign(e));
      }
      fewest = std::min(fewest, static_cast<std::size_t>(
                                    std::count(wanted_otherwise.begin(), wanted_otherwise.end(), true)));
    }
  }
  return fewest;
}

TEST(SignAssignment, TakesAsFewInvertersAsAnyChoiceOfSigns) {
  std::mt19937 random(20261121);
  std::size_t total = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Network network = random_network(random, 2 + static_cast<std::size_t>(trial) % 8);
    const std::size_t fewest = fewest_inverters(network);
    EXPECT_EQ(choose_signs(problem_of(network)).inverters, fewest) << "trial " << trial;
    total += fewest;
  }
  EXPECT_GT(total, 0U);  // some of these networks cannot do without
}

// x″ = −x: two integrators, each inverting, and one more inversion round the loop.
TEST(SignAssignment, GivesTheCircleItsOneInverter) {
  SignProblem problem;
  problem.variables = 2;
  problem.signals = {{{0, std::nullopt}}, {{1, std::nullopt}}};
  problem.uses = {{1, true, 0}, {0, false, 1}};  // ẋ = v, v̇ = −x, the first integrator inverting v
  const SignChoice choice = choose_signs(problem);
  EXPECT_EQ(choice.inverters, 1U);
  EXPECT_EQ(choice.negative, (std::vector<bool>{false, false}));  // the reader is spared minus signs
}

TEST(SignAssignment, LeavesFixedSignalsAsTheyAre) {
  SignProblem problem;
  problem.signals = {{}, {}};
  problem.uses = {{0, true, std::nullopt}, {1, false, std::nullopt}};
  const SignChoice choice = choose_signs(problem);
  EXPECT_EQ(choice.inverted, (std::vector<bool>{true, false}));
  EXPECT_EQ(choice.inverters, 1U);
}

}  // namespace
}  // namespace oblique::machine
