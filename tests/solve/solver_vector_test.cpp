// SPDX-License-Identifier: MIT
// The vectors of the solver: each operation of theirs against the formula, in place too.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <nvector/nvector_serial.h>

#include <oblique/solve/integrator/solver_vector.h>

namespace oblique::solve {
namespace {

class SolverVector : public ::testing::Test {
 protected:
  SolverVector() {
    SUNContext_Create(nullptr, &context_);
    first_ = make_solver_vector(kSize, context_);
  }
  ~SolverVector() override {
    for (const N_Vector vector : made_) N_VDestroy(vector);
    N_VDestroy(first_);
    SUNContext_Free(&context_);
  }

  N_Vector of(std::vector<double> values) {
    made_.push_back(N_VClone(first_));
    std::copy(values.begin(), values.end(), N_VGetArrayPointer(made_.back()));
    return made_.back();
  }
  static std::vector<double> values(N_Vector vector) {
    return {N_VGetArrayPointer(vector), N_VGetArrayPointer(vector) + kSize};
  }

  static constexpr sunindextype kSize = 3;
  SUNContext context_ = nullptr;
  N_Vector first_;
  std::vector<N_Vector> made_;
};

using Values = std::vector<double>;

TEST_F(SolverVector, Sums) {
  const N_Vector x = of({1, 2, 3}), y = of({10, 20, 30}), z = of({0, 0, 0});
  N_VLinearSum(2, x, -0.5, y, z);
  EXPECT_EQ(values(z), (Values{-3, -6, -9}));
  N_VLinearSum(1, x, 1, y, y);
  EXPECT_EQ(values(y), (Values{11, 22, 33}));
  N_VLinearSum(3, x, 1, x, x);
  EXPECT_EQ(values(x), (Values{4, 8, 12}));
  N_VScale(0.25, x, x);
  EXPECT_EQ(values(x), (Values{1, 2, 3}));
}

TEST_F(SolverVector, SumsOfSeveral) {
  const N_Vector x = of({1, 2, 3}), y = of({10, 20, 30}), z = of({100, 200, 300});
  double factors[] = {2, 3, 4};
  N_Vector all[] = {x, y, z};
  const N_Vector sum = of({0, 0, 0});
  EXPECT_EQ(N_VLinearCombination(3, factors, all, sum), 0);
  EXPECT_EQ(values(sum), (Values{432, 864, 1296}));
  EXPECT_EQ(N_VLinearCombination(1, factors, all, sum), 0);
  EXPECT_EQ(values(sum), (Values{2, 4, 6}));
  EXPECT_EQ(N_VLinearCombination(3, factors, all, x), 0);  // in place of the first
  EXPECT_EQ(values(x), (Values{432, 864, 1296}));

  const N_Vector added = of({1, 0, 0});
  N_Vector ys[] = {y, z}, out[] = {y, sum};
  EXPECT_EQ(N_VScaleAddMulti(2, factors, added, ys, out), 0);
  EXPECT_EQ(values(y), (Values{12, 20, 30}));
  EXPECT_EQ(values(sum), (Values{103, 200, 300}));
}

TEST_F(SolverVector, ErrorsAreTheLargest) {
  EXPECT_EQ(N_VWrmsNorm(of({1, -2, 3}), of({1, 4, 2})), 8);
  EXPECT_TRUE(std::isnan(N_VWrmsNorm(of({1, NAN, 3}), of({1, 4, 2}))));
  EXPECT_TRUE(std::isnan(N_VWrmsNorm(of({NAN, 1, 3}), of({1, 4, 2}))));
}

}  // namespace
}  // namespace oblique::solve
