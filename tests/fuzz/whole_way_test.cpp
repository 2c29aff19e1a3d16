// SPDX-License-Identifier: MIT
// Random diagrams and mechanisms on the whole way from text to trajectory. OBLIQUE_FUZZ_RUNS sets how many
// are tried and OBLIQUE_FUZZ_SEED with which seed the first begins, for a longer run than the usual one, or
// for one alone.
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "whole_way.h"

namespace oblique::fuzz {
namespace {

std::uint64_t asked(const char* variable, std::uint64_t usual) {
  const char* const value = std::getenv(variable);
  return value != nullptr ? std::stoull(value) : usual;
}

std::string random_bytes(std::uint64_t seed) {
  constexpr std::size_t kBytes = 256;
  std::mt19937_64 random(seed);
  std::string bytes(kBytes, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random() & 0xFFU);
  return bytes;
}

/// At least `least` of the inputs must lead to runs that are compared: else nothing is tested.
void examine(Verdict (*examined)(std::string_view bytes), std::uint64_t usual, double least) {
  const std::uint64_t first = asked("OBLIQUE_FUZZ_SEED", 1), runs = asked("OBLIQUE_FUZZ_RUNS", usual);
  std::uint64_t compared = 0;
  for (std::uint64_t seed = first; seed < first + runs; ++seed) {
    const Verdict verdict = examined(random_bytes(seed));
    EXPECT_TRUE(verdict.fault.empty())
        << "OBLIQUE_FUZZ_SEED=" << seed << " OBLIQUE_FUZZ_RUNS=1: " << verdict.fault;
    compared += verdict.compared ? 1 : 0;
  }
  if (runs >= usual) {
    EXPECT_GE(static_cast<double>(compared), least * static_cast<double>(runs));
  }
}

TEST(WholeWay, OfDiagramsIsTheSameHoweverItIsGone) {
  examine(examine_diagram, 1000, 0.5);
}

TEST(WholeWay, OfMechanismsIsTheSameHoweverItIsGone) {
  examine(examine_mechanism, 300, 0.3);
}

}  // namespace
}  // namespace oblique::fuzz
