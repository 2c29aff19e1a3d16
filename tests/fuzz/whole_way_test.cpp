// SPDX-License-Identifier: MIT
// Random diagrams and mechanisms on the whole way from text to trajectory. OBLIQUE_FUZZ_RUNS sets how many
// are tried and OBLIQUE_FUZZ_SEED with which seed the first begins, for a longer run than the usual one, or
// for one alone.
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>

#include <sys/resource.h>

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

/// Of the whole process so far, as its most [bytes].
double memory_used() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

#ifdef __SANITIZE_ADDRESS__
constexpr double kSanitized = 5;  // times as long and as large
#else
constexpr double kSanitized = 1;
#endif
/// What one input may take: each of its runs has a budget of steps, which takes a tenth of a second at most.
constexpr double kMostSeconds = 5 * kSanitized;  // of the processor, so that a busy machine makes no faults
constexpr double kMostMemory = 1e9 * kSanitized;

/// At least `least` of the inputs must lead to runs that are compared: else nothing is tested.
void examine(Verdict (*examined)(std::string_view bytes), std::uint64_t usual, double least) {
  const std::uint64_t first = asked("OBLIQUE_FUZZ_SEED", 1), runs = asked("OBLIQUE_FUZZ_RUNS", usual);
  std::uint64_t compared = 0;
  for (std::uint64_t seed = first; seed < first + runs; ++seed) {
    const double before = memory_used();
    const std::clock_t begin = std::clock();
    const Verdict verdict = examined(random_bytes(seed));
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    EXPECT_LT(seconds, kMostSeconds) << "OBLIQUE_FUZZ_SEED=" << seed << " OBLIQUE_FUZZ_RUNS=1";
    if (before <= kMostMemory) {  // the first that needs more is told
      EXPECT_LT(memory_used(), kMostMemory) << "OBLIQUE_FUZZ_SEED=" << seed << " OBLIQUE_FUZZ_RUNS=1";
    }
    EXPECT_TRUE(verdict.fault.empty())
        << "OBLIQUE_FUZZ_SEED=" << seed << " OBLIQUE_FUZZ_RUNS=1: " << verdict.fault;
    compared += verdict.compared ? 1 : 0;
  }
  if (runs >= usual) {
    EXPECT_GE(static_cast<double>(compared), least * static_cast<double>(runs));
  }
}

// A minute of the processor together: 60 diagrams and 250 mechanisms a second.
TEST(WholeWay, OfDiagramsIsTheSameHoweverItIsGone) {
  examine(examine_diagram, 2000, 0.5);
}

TEST(WholeWay, OfMechanismsIsTheSameHoweverItIsGone) {
  examine(examine_mechanism, 6000, 0.3);
}

}  // namespace
}  // namespace oblique::fuzz
