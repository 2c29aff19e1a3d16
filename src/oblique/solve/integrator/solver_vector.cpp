// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/solver_vector.h>

#include <algorithm>
#include <cmath>
#include <new>

#include <nvector/nvector_serial.h>

// No element of a result depends on another one, though a result may stand in place of what it is made of;
// g++ must be told.
#ifdef __clang__
#define OBLIQUE_ELEMENTS_APART
#else
#define OBLIQUE_ELEMENTS_APART _Pragma("GCC ivdep")
#endif

namespace oblique::solve {
namespace {

double* elements(N_Vector vector) {
  return NV_DATA_S(vector);
}

double largest_weighted(N_Vector x, N_Vector weights) {
  const double* const values = elements(x);
  const double* const scale = elements(weights);
  const sunindextype n = NV_LENGTH_S(x);
  double largest = 0;
  for (sunindextype i = 0; i < n; ++i) {
    const double value = std::abs(values[i] * scale[i]);
    if (std::isnan(value)) return value;  // a comparison would lose it
    largest = std::max(largest, value);
  }
  return largest;
}

/// z = a x + b y, where z may be x or y.
void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  const double* const xs = elements(x);
  const double* const ys = elements(y);
  double* const zs = elements(z);
  const sunindextype n = NV_LENGTH_S(x);
  OBLIQUE_ELEMENTS_APART
  for (sunindextype i = 0; i < n; ++i) zs[i] = a * xs[i] + b * ys[i];
}

/// z = c x, where z may be x.
void scale(double c, N_Vector x, N_Vector z) {
  const double* const xs = elements(x);
  double* const zs = elements(z);
  const sunindextype n = NV_LENGTH_S(x);
  OBLIQUE_ELEMENTS_APART
  for (sunindextype i = 0; i < n; ++i) zs[i] = c * xs[i];
}

/// Z[k] = a[k] x + Y[k], where Z[k] may be Y[k].
int scale_and_add(int count, double* a, N_Vector x, N_Vector* y, N_Vector* z) {
  for (int k = 0; k < count; ++k) linear_sum(a[k], x, 1, y[k], z[k]);
  return 0;
}

/// z = c[0] X[0] + c[1] X[1] + …, where z may be X[0].
int linear_combination(int count, double* c, N_Vector* x, N_Vector z) {
  if (count == 1) {
    scale(c[0], x[0], z);
    return 0;
  }
  linear_sum(c[0], x[0], c[1], x[1], z);
  for (int k = 2; k < count; ++k) linear_sum(c[k], x[k], 1, z, z);
  return 0;
}

/// SUNDIALS' N_VClone writes into what this gives without a look whether it gave anything. So the lack of
/// memory is thrown, through frames of C that have nothing to clean up: what they made hangs on the memory of
/// CVODES.
N_Vector clone_or_throw(N_Vector vector) {
  N_Vector clone = N_VClone_Serial(vector);
  if (clone == nullptr) throw std::bad_alloc();
  return clone;
}

}  // namespace

N_Vector make_solver_vector(sunindextype size, SUNContext context) {
  N_Vector vector = N_VNew_Serial(size, context);
  if (vector == nullptr) throw std::bad_alloc();
  vector->ops->nvwrmsnorm = largest_weighted;
  vector->ops->nvlinearsum = linear_sum;
  vector->ops->nvscale = scale;
  vector->ops->nvscaleaddmulti = scale_and_add;
  vector->ops->nvlinearcombination = linear_combination;
  vector->ops->nvclone = clone_or_throw;
  return vector;
}

}  // namespace oblique::solve
