// SPDX-License-Identifier: MIT
#include "four_bar_by_hand.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include "figures.h"

namespace oblique::bench {
namespace {

// Crank cos φ and sin φ; length L and direction ψ of B → D; angle γ at B.
enum StateIndex { kCos, kSin, kSide, kCosPsi, kSinPsi, kCosGamma, kSinGamma, kStates };

// 1 machine unit of a coordinate is 4 m, and of the triangle 1.25 of these (`reach`).
constexpr double kMetres = 4;
constexpr double kReach = 1.25;
constexpr double kCrank = 1 / kMetres;
constexpr double kFrame = 4 / kMetres;
constexpr double kCoupler = 3.5 / kMetres;
constexpr double kRocker = 3 / kMetres;
constexpr double kAdjacent = kCoupler / kReach;
constexpr double kOpposite = kRocker / kReach;
constexpr double kCosineConstant = (kAdjacent * kAdjacent - kOpposite * kOpposite) / (2 * kAdjacent);
constexpr double kHold = 0.1;
constexpr double kInputGain = 10;
// M − B = (a + i b)(C − B)
constexpr double kMarkAlong = 1.75 / 3.5;
constexpr double kMarkLeft = 1 / 3.5;

struct Constants {
  double rate;  ///< 1/τ of the amplifiers [1/s]
  double gain;  ///< μ times the weight of the residuals
};

double side_x(double cosine) {
  return (kFrame - kCrank * cosine) / kReach;
}
double side_y(double sine) {
  return -kCrank * sine / kReach;
}

int derivatives(sunrealtype, N_Vector states, N_Vector slopes, void* user) {
  const auto& k = *static_cast<const Constants*>(user);
  const double* const x = N_VGetArrayPointer(states);
  double* const d = N_VGetArrayPointer(slopes);
  const double c = x[kCos], s = x[kSin], side = x[kSide];
  const double dx = side_x(c), dy = side_y(s);
  const double excess = kHold * (1 - c * c - s * s);
  d[kCos] = -s + excess * c;
  d[kSin] = c + excess * s;
  d[kSide] = k.rate * (-side - k.gain * (side * side - dx * dx - dy * dy));
  d[kCosPsi] = k.rate * (-x[kCosPsi] - k.gain * (side * x[kCosPsi] - dx));
  d[kSinPsi] = k.rate * (-x[kSinPsi] - k.gain * (side * x[kSinPsi] - dy));
  const double cosine_residual = side * x[kCosGamma] - side * side / (2 * kAdjacent) - kCosineConstant;
  d[kCosGamma] = k.rate * (-x[kCosGamma] - k.gain * cosine_residual);
  const double sine_residual = x[kSinGamma] * x[kSinGamma] + x[kCosGamma] * x[kCosGamma] - 1;
  d[kSinGamma] = k.rate * (-x[kSinGamma] - k.gain * sine_residual);
  return 0;
}

constexpr int kEntries = 17;

int jacobian(sunrealtype, N_Vector states, N_Vector, SUNMatrix matrix, void* user, N_Vector, N_Vector,
             N_Vector) {
  static constexpr std::array<sunindextype, kStates + 1> kColumns{0, 4, 8, 12, 13, 14, 16, 17};
  static constexpr std::array<sunindextype, kEntries> kRows{
      kCos,    kSin,    kSide,     kCosPsi,    // by cos φ
      kCos,    kSin,    kSide,     kSinPsi,    // by sin φ
      kSide,   kCosPsi, kSinPsi,   kCosGamma,  // by L
      kCosPsi, kSinPsi, kCosGamma, kSinGamma, kSinGamma};
  std::copy(kColumns.begin(), kColumns.end(), SUNSparseMatrix_IndexPointers(matrix));
  std::copy(kRows.begin(), kRows.end(), SUNSparseMatrix_IndexValues(matrix));
  double* const j = SUNSparseMatrix_Data(matrix);

  const auto& k = *static_cast<const Constants*>(user);
  const double* const x = N_VGetArrayPointer(states);
  const double c = x[kCos], s = x[kSin], side = x[kSide];
  const double dx = side_x(c), dy = side_y(s);
  const double loop = k.rate * k.gain;
  constexpr double kDx = -kCrank / kReach;  // d side_x/d cos φ = d side_y/d sin φ
  j[0] = kHold * (1 - 3 * c * c - s * s);
  j[1] = 1 - 2 * kHold * c * s;
  j[2] = loop * 2 * dx * kDx;
  j[3] = loop * kDx;
  j[4] = -1 - 2 * kHold * c * s;
  j[5] = kHold * (1 - c * c - 3 * s * s);
  j[6] = loop * 2 * dy * kDx;
  j[7] = loop * kDx;
  j[8] = -k.rate - loop * 2 * side;
  j[9] = -loop * x[kCosPsi];
  j[10] = -loop * x[kSinPsi];
  j[11] = -loop * (x[kCosGamma] - side / kAdjacent);
  j[12] = j[13] = j[14] = -k.rate - loop * side;
  j[15] = -loop * 2 * x[kCosGamma];
  j[16] = -k.rate - loop * 2 * x[kSinGamma];
  return 0;
}

/// The positive root of u² + u/g = v: a servo amplifier of gain g that takes a square root, at rest.
double root_at_rest(double v, double g) {
  return (std::sqrt(1 / (g * g) + 4 * v) - 1 / g) / 2;
}

void start_at_rest(double* x, double gain) {
  x[kCos] = 1;
  x[kSin] = 0;
  const double dx = side_x(1), dy = side_y(0);
  const double side = root_at_rest(dx * dx + dy * dy, gain);
  x[kSide] = side;
  x[kCosPsi] = dx / (side + 1 / gain);
  x[kSinPsi] = dy / (side + 1 / gain);
  x[kCosGamma] = (side * side / (2 * kAdjacent) + kCosineConstant) / (side + 1 / gain);
  x[kSinGamma] = root_at_rest(1 - x[kCosGamma] * x[kCosGamma], gain);
}

std::array<double, 7> row_at(double t, const double* x) {
  const double bx = kCrank * x[kCos], by = kCrank * x[kSin];
  const double cx = bx + kCoupler * (x[kCosPsi] * x[kCosGamma] - x[kSinPsi] * x[kSinGamma]);
  const double cy = by + kCoupler * (x[kSinPsi] * x[kCosGamma] + x[kCosPsi] * x[kSinGamma]);
  const double mx = bx + kMarkAlong * (cx - bx) - kMarkLeft * (cy - by);
  const double my = by + kMarkAlong * (cy - by) + kMarkLeft * (cx - bx);
  return {t, kMetres * bx, kMetres * by, kMetres * cx, kMetres * cy, kMetres * mx, kMetres * my};
}

void check(bool good) {
  if (!good) throw std::runtime_error("the hand-written four-bar failed");
}

}  // namespace

FourBarRun run_four_bar_by_hand(const FourBarSettings& settings) {
  FourBarRun result;
  const double begin = cpu_seconds();
  Constants constants{2 * std::numbers::pi * settings.bandwidth, settings.gain * kInputGain};
  SUNContext context = nullptr;
  check(SUNContext_Create(nullptr, &context) == 0);
  N_Vector states = N_VNew_Serial(kStates, context);
  N_Vector between = N_VNew_Serial(kStates, context);
  start_at_rest(N_VGetArrayPointer(states), constants.gain);
  SUNMatrix matrix = SUNSparseMatrix(kStates, kStates, kEntries, CSC_MAT, context);
  SUNLinearSolver solver = SUNLinSol_KLU(states, matrix, context);
  void* memory = CVodeCreate(CV_BDF, context);
  check(CVodeInit(memory, derivatives, 0, states) == CV_SUCCESS);
  check(CVodeSetUserData(memory, &constants) == CV_SUCCESS);
  check(CVodeSStolerances(memory, settings.tolerance, settings.absolute_tolerance) == CV_SUCCESS);
  check(CVodeSetLinearSolver(memory, solver, matrix) == CV_SUCCESS);
  check(CVodeSetJacFn(memory, jacobian) == CV_SUCCESS);
  check(CVodeSetStopTime(memory, settings.until) == CV_SUCCESS);

  result.rows.push_back(row_at(0, N_VGetArrayPointer(states)));
  for (double t = 0; t < settings.until;) {
    check(CVode(memory, 2 * settings.until, states, &t, CV_ONE_STEP) >= 0);
    while (static_cast<int>(result.rows.size()) < settings.samples) {
      const int k = static_cast<int>(result.rows.size());
      const double time =
          k + 1 == settings.samples ? settings.until : settings.until * k / (settings.samples - 1);
      if (time > t) break;
      check(CVodeGetDky(memory, time, 0, between) == CV_SUCCESS);
      result.rows.push_back(row_at(time, N_VGetArrayPointer(between)));
    }
  }
  CVodeGetNumSteps(memory, &result.steps);
  CVodeFree(&memory);
  SUNLinSolFree(solver);
  SUNMatDestroy(matrix);
  N_VDestroy(between);
  N_VDestroy(states);
  SUNContext_Free(&context);
  result.seconds = cpu_seconds() - begin;
  return result;
}

}  // namespace oblique::bench
