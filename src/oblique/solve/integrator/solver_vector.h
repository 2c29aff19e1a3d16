// SPDX-License-Identifier: MIT
#pragma once

#include <sundials/sundials_nvector.h>

namespace oblique::solve {

/// A vector for CVODES, one after the other in memory as SUNDIALS' serial one, whose clones are such vectors
/// too. Its error norm is the largest weighted element, in place of the weighted root mean square, in which
/// the error of an oscillator beside 10 000 idle integrators counts a hundredth; of one element both are the
/// same. Sums are single loops, where SUNDIALS distinguishes a dozen cases: a third of the time of a small
/// run. Throws std::bad_alloc. Not installed.
N_Vector make_solver_vector(sunindextype size, SUNContext context);

}  // namespace oblique::solve
