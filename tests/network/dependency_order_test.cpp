// SPDX-License-Identifier: MIT
#include <oblique/network/graph/dependency_order.h>

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace oblique::network {
namespace {

using Rows = std::vector<std::vector<std::uint32_t>>;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::size_t kNever = static_cast<std::size_t>(-1);

std::vector<OrderStep> order_of(const Rows& rows, std::vector<bool> implicit = {}) {
  Dependencies dependencies;
  for (const auto& row : rows) dependencies.add_row(row);
  implicit.resize(rows.size(), false);
  return dependency_order(dependencies, implicit);
}

/// Whether every quantity can be reached from every other: Warshall's closure, nothing of Tarjan's in it.
std::vector<std::vector<bool>> reachable(const Rows& rows) {
  std::vector<std::vector<bool>> reach(rows.size(), std::vector<bool>(rows.size(), false));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const std::uint32_t j : rows[i]) reach[i][j] = true;
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < rows.size(); ++j) reach[i][j] = reach[i][j] || (reach[i][k] && reach[k][j]);
    }
  }
  return reach;
}

/// "" where the order can be computed from first to last, else what is wrong with it.
std::string fault_of(const std::vector<OrderStep>& order, const Rows& rows) {
  std::vector<std::size_t> step_of(rows.size(), kNever);
  std::vector<bool> known(rows.size(), false);
  for (std::size_t s = 0; s < order.size(); ++s) {
    for (const auto* part : {&order[s].tears, &order[s].inner}) {
      for (const std::uint32_t q : *part) {
        if (step_of[q] != kNever) return "twice: " + std::to_string(q);
        step_of[q] = s;
      }
    }
    if (order[s].tears.empty() && order[s].inner.size() != 1) return "a step of many without a tear";
    for (const std::uint32_t q : order[s].tears) known[q] = true;
    for (const std::uint32_t q : order[s].inner) {
      for (const std::uint32_t needed : rows[q]) {
        if (!known[needed]) return std::to_string(q) + " before " + std::to_string(needed);
      }
      known[q] = true;
    }
    for (const std::uint32_t q : order[s].tears) {
      for (const std::uint32_t needed : rows[q]) {
        if (!known[needed])
          return "the equation of " + std::to_string(q) + " before " + std::to_string(needed);
      }
    }
  }
  if (std::count(step_of.begin(), step_of.end(), kNever) > 0) return "not all of them";
  return {};
}

RC_GTEST_PROP(DependencyOrder, PutsEveryQuantityAfterWhatItNeeds, ()) {
  const auto n = *rc::gen::inRange<std::uint32_t>(1, 14);
  Rows rows(n);
  for (auto& row : rows)
    row = *rc::gen::container<std::vector<std::uint32_t>>(rc::gen::inRange<std::uint32_t>(0, n));
  for (auto& row : rows) row.resize(std::min<std::size_t>(row.size(), 3));
  const auto implicit = *rc::gen::container<std::vector<bool>>(n, rc::gen::arbitrary<bool>());
  const auto order = order_of(rows, implicit);
  RC_ASSERT(fault_of(order, rows) == "");

  std::vector<std::size_t> step_of(n);
  for (std::size_t s = 0; s < order.size(); ++s) {
    for (const std::uint32_t q : order[s].tears) step_of[q] = s;
    for (const std::uint32_t q : order[s].inner) {
      step_of[q] = s;
      RC_ASSERT(!implicit[q]);
    }
  }
  const auto reach = reachable(rows);
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      if (i != j) RC_ASSERT((step_of[i] == step_of[j]) == (reach[i][j] && reach[j][i]));
    }
    // Outside of loops nothing is torn.
    if (!reach[i][i] && !implicit[i]) RC_ASSERT(order[step_of[i]].tears.empty());
  }
}

TEST(DependencyOrder, OfNothingIsEmpty) {
  EXPECT_THAT(order_of({}), IsEmpty());
}

TEST(DependencyOrder, TearsACycleOnce) {
  // 0 → 1 → 2 → 0, and 3 reads 1.
  const auto order = order_of({{1}, {2}, {0}, {1}});
  ASSERT_EQ(order.size(), 2U);
  EXPECT_EQ(order[0].tears.size(), 1U);
  EXPECT_EQ(order[0].inner.size(), 2U);
  EXPECT_THAT(order[1].inner, ElementsAre(3));
}

TEST(DependencyOrder, TearsTheQuantityThatMostWiresMeetIn) {
  // 0 ⇄ 1, 0 ⇄ 2, 0 ⇄ 3: without 0 nothing is left of the cycles.
  const auto order = order_of({{1, 2, 3}, {0}, {0}, {0}});
  ASSERT_EQ(order.size(), 1U);
  EXPECT_THAT(order[0].tears, ElementsAre(0));
}

TEST(DependencyOrder, TearsWhatNeedsItself) {
  const auto order = order_of({{0}, {0}});
  ASSERT_EQ(order.size(), 2U);
  EXPECT_THAT(order[0].tears, ElementsAre(0));
  EXPECT_THAT(order[0].inner, IsEmpty());
  EXPECT_THAT(order[1].tears, IsEmpty());
}

TEST(DependencyOrder, ImplicitQuantitiesAreTearsAndEnough) {
  // The cycle 0 → 1 → 2 → 0 is broken by 1, which an equation defines.
  const auto order = order_of({{1}, {2}, {0}}, {false, true, false});
  ASSERT_EQ(order.size(), 1U);
  EXPECT_THAT(order[0].tears, ElementsAre(1));
  EXPECT_THAT(order[0].inner, ElementsAre(0, 2)) << "0 needs the torn 1, 2 needs 0";
}

TEST(DependencyOrder, AnImplicitQuantityOutsideOfCyclesIsStillSolvedFor) {
  const auto order = order_of({{1}, {}}, {true, false});
  ASSERT_EQ(order.size(), 2U);
  EXPECT_THAT(order[0].inner, ElementsAre(1));
  EXPECT_THAT(order[1].tears, ElementsAre(0));
}

// A recursive search would need a frame a quantity.

TEST(DependencyOrder, WalksALongChainWithoutTheStack) {
  constexpr std::uint32_t kLength = 100'000;
  Rows forward(kLength), backward(kLength), ring(kLength);
  for (std::uint32_t i = 0; i < kLength; ++i) {
    if (i + 1 < kLength) forward[i] = {i + 1};
    if (i > 0) backward[i] = {i - 1};
    ring[i] = {(i + 1) % kLength};
  }
  EXPECT_EQ(fault_of(order_of(forward), forward), "");
  EXPECT_EQ(fault_of(order_of(backward), backward), "");
  const auto torn = order_of(ring);
  EXPECT_EQ(fault_of(torn, ring), "");
  ASSERT_EQ(torn.size(), 1U);
  EXPECT_EQ(torn[0].tears.size(), 1U);
}

}  // namespace
}  // namespace oblique::network
