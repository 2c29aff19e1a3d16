// SPDX-License-Identifier: MIT
#include <cstdlib>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "../support/compiled.h"

// Eigen allocates with malloc and operator new ends there too, so malloc itself is watched. It cannot be
// where a sanitizer has put its own in that place.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define OBLIQUE_WATCHES_MALLOC 1
#else
#define OBLIQUE_WATCHES_MALLOC 0
#endif

namespace {
thread_local bool watching = false;
thread_local long allocations = 0;

[[maybe_unused]] void note() {
  if (watching) ++allocations;
}
}  // namespace

#if OBLIQUE_WATCHES_MALLOC
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  note();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  note();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  note();
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
}
}
#endif

namespace oblique::network {
namespace {

using testing::Compiled;

/// How often `action` asks for memory.
template <class Action>
long allocations_in(Action action) {
  allocations = 0;
  watching = true;
  action();
  watching = false;
  return allocations;
}

class AllocationTest : public ::testing::TestWithParam<std::pair<const char*, std::string>> {
 protected:
  void SetUp() override {
    if (!OBLIQUE_WATCHES_MALLOC) GTEST_SKIP() << "malloc belongs to a sanitizer or to another C library";
  }
};

/// `n` summers, each of which reads itself and all others: a linear loop of n unknowns.
std::string full_loop(int n) {
  std::string text;
  for (int i = 0; i < n; ++i) {
    std::string terms = "\"x" + std::to_string(i) + "\"";
    for (int j = 0; j < n; ++j) terms += fmt::format(", \"{}*s{}\"", i == j ? -0.5 : 0.1 / (1 + i + j), j);
    text += fmt::format(
        "s{0} = {{ type = \"summer\", in = [{1}] }}\n"
        "x{0} = {{ type = \"integrator\", in = [\"s{0}\"], initial = 0.5 }}\n",
        i, terms);
  }
  return text;
}

TEST_P(AllocationTest, NothingAfterTheFirstCall) {
  const Compiled made(GetParam().second);
  const Program& program = made.program;
  Workspace workspace(program);
  std::vector<double> x = program.start();
  std::vector<double> derivatives(x.size()), values(program.jacobian_pattern().entries()),
      signals(program.n_signals());
  const auto evaluate_all = [&] {
    x[0] += 1e-3;  // so that the loops have something to do
    return program.derivatives(0, x.data(), derivatives.data(), workspace) &&
           program.jacobian(0, x.data(), values.data(), workspace) &&
           program.signals(0, x.data(), signals.data(), workspace);
  };
  ASSERT_TRUE(evaluate_all());
  bool solved = true;
  EXPECT_EQ(allocations_in([&] {
              for (int k = 0; k < 10; ++k) solved = solved && evaluate_all();
            }),
            0);
  EXPECT_TRUE(solved);
}

const std::pair<const char*, std::string> kDiagrams[]{
    {"LoopOfOne",
     "r = { type = \"square-root\", in = \"x\", gain = inf, bandwidth = inf }\n"
     "x = { type = \"integrator\", in = [\"-r\"], initial = 0.5 }\n"},
    {"LoopOfFour", full_loop(4)},
    {"LoopOfForty",
     full_loop(40)},  // more than the blocks of Eigen's LU (16) and products without scratch (20)
    {"NonLinearLoopOfThree", R"(aa = { type = "multiplier", in = ["a", "c"] }
bb = { type = "multiplier", in = ["b", "b"] }
a = { type = "servo-amplifier", in = ["aa", "0.1*b", "-x"], gain = inf, initial = 1 }
b = { type = "servo-amplifier", in = ["bb", "0.1*a", "-x"], gain = 1e4, bandwidth = inf, initial = 1 }
c = { type = "servo-amplifier", in = ["c", "-0.5*b", "-x"], gain = inf, initial = 1 }
x = { type = "integrator", in = ["a", "b"], initial = 1 }
)"},
    {"Dyad", R"(c = { type = "dyad-rrr", px = "x", py = "y", qx = "q", qy = "y", gain = inf, bandwidth = inf }
q = { type = "constant", value = 0.5 }
x = { type = "integrator", in = ["c.x"], initial = -0.5 }
y = { type = "integrator", in = ["c.y"] }
)"},
};

INSTANTIATE_TEST_SUITE_P(Diagrams, AllocationTest, ::testing::ValuesIn(kDiagrams),
                         [](const auto& tested) { return tested.param.first; });

/// The guard itself: it sees operator new, malloc, and Eigen.
TEST(AllocationGuard, SeesEveryWayToMemory) {
  if (!OBLIQUE_WATCHES_MALLOC) GTEST_SKIP() << "malloc belongs to a sanitizer or to another C library";
  EXPECT_EQ(allocations_in([] {}), 0);
  EXPECT_GE(allocations_in([] { std::vector<double>(10, 1.0).shrink_to_fit(); }), 1);
  EXPECT_GE(allocations_in([] { Eigen::MatrixXd::Identity(3, 3).eval(); }), 1);
}

}  // namespace
}  // namespace oblique::network
