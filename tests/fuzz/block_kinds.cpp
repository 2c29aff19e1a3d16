// SPDX-License-Identifier: MIT
#include "block_kinds.h"

#include <limits>

namespace oblique::fuzz {
namespace {

constexpr PortKind kSumOfValues[] = {{"in", kValue, true}};
constexpr PortKind kOneValue[] = {{"in", kValue}};
constexpr PortKind kOnePlain[] = {{"in", kPlain}};
constexpr PortKind kTwoValues[] = {{"x", kValue}, {"y", kValue}};
constexpr PortKind kFactors[] = {{"x", kValue}, {"y", kPlain}};
constexpr OutputKind kValueOut[] = {{"out", kValue}};
constexpr OutputKind kPlainOut[] = {{"out", kPlain}};

constexpr PortKind kIntegratorIn[] = {
    {"in", kValue, true}, {"start", kValue, false, false}, {"set", kPlain, false, false}};
constexpr ParameterKind kIntegrator[] = {
    {"initial", -1, 1, kValue}, {"rate", 0.25, 4, kRate, true}, {"limit", 0.25, 2.25, kValue}};
constexpr ParameterKind kPlainIntegrator[] = {{"initial", -1, 1, kValue}, {"rate", 0.25, 2.25, kRate, true}};
constexpr ParameterKind kRealIntegrator[] = {{"initial", -1, 1, kValue},  {"rate", 0.25, 2.25, kRate, true},
                                             {"gain", 100, 1700, kPlain}, {"offset", -0.01, 0.01, kValue},
                                             {"leakage", 0, 0.25, kRate}, {"drift", -0.125, 0.125, kSlope}};
constexpr ParameterKind kFactor[] = {{"factor", -2, 2, kPlain, true}};
constexpr ParameterKind kSetting[] = {{"setting", 0, 1, kPlain, true}};
constexpr ParameterKind kLag[] = {
    {"time_constant", 0.03125, 1.03125, kTime, true}, {"gain", -2, 2, kPlain}, {"initial", -1, 1, kValue}};
constexpr ParameterKind kComparator[] = {
    {"hysteresis", 0, 0.5, kValue}, {"low", -1, 0, kPlain}, {"high", 0.25, 1.25, kPlain}};
constexpr PortKind kRelayIn[] = {
    {"coil", kValue}, {"make", kValue, false, false}, {"break", kValue, false, false}};
constexpr ParameterKind kRelay[] = {
    {"pull_in", 0.25, 1.25, kValue, true}, {"drop_out", -0.5, 0.25, kValue, true}, {"delay", 0, 0.5, kTime}};
constexpr ParameterKind kLimits[] = {{"low", -1, -0.0625, kValue, true},
                                     {"high", 0.0625, 1.0625, kValue, true}};
constexpr ParameterKind kBacklash[] = {
    {"play", 0, 0.5, kValue, true}, {"rate", 64, 1024, kRate, true}, {"initial", -0.5, 0.5, kValue}};
constexpr ParameterKind kConstant[] = {{"value", -1, 1, kValue, true}};
constexpr ParameterKind kSineSource[] = {
    {"amplitude", -1, 1, kValue, true}, {"frequency", 0, 4, kRate, true}, {"phase", -3, 3, kPlain}};
constexpr ParameterKind kPulses[] = {{"period", 0.5, 2.5, kTime, true},
                                     {"width", 0.015625, 0.484375, kTime, true},
                                     {"delay", 0, 1, kTime},
                                     {"low", -1, 1, kValue},
                                     {"high", -1, 1, kValue, true}};
constexpr ParameterKind kRamp[] = {{"slope", -2, 2, kSlope, true},
                                   {"start", 0, 1, kTime},
                                   {"stop", 1, 3, kTime},
                                   {"initial", -1, 1, kValue}};
constexpr ParameterKind kStep[] = {
    {"at", 0, 2, kTime, true}, {"from", -1, 1, kValue}, {"to", -1, 1, kValue, true}};
constexpr ParameterKind kServo[] = {
    {"gain", 100, 16100, kPlain, true}, {"bandwidth", 1, 17, kRate, true}, {"initial", -1, 1, kValue}};
constexpr PortKind kDividerIn[] = {{"numerator", kValue}, {"denominator", kPlain}};
constexpr ParameterKind kDivider[] = {{"gain", 1000, 17000, kPlain, true}, {"bandwidth", 1, 17, kRate, true}};
constexpr ParameterKind kRoot[] = {{"gain", 1000, 17000, kPlain, true}, {"bandwidth", 1, 17, kRate, true}};
constexpr PortKind kSumOfPlain[] = {{"in", kPlain, true}};
constexpr OutputKind kCosineAndSine[] = {{"cos", kPlain}, {"sin", kPlain}};
constexpr ParameterKind kGenerator[] = {
    {"rate", -4, 4, kRate, true}, {"start", -3, 3, kPlain}, {"hold", 0, 0.5, kRate, true}};
constexpr PortKind kCrankIn[] = {{"speed", kPlain, false, false}};
constexpr ParameterKind kCrank[] = {{"rate", -4, 4, kRate, true}, {"start", -3, 3, kPlain}};
constexpr PortKind kSwitchIn[] = {
    {"on", kValue, false, false}, {"off", kValue, false, false}, {"control", kValue}};
constexpr ParameterKind kSwitch[] = {{"threshold", -0.5, 0.5, kValue, true}};
constexpr PortKind kStoreIn[] = {{"in", kValue}, {"track", kPlain}};
constexpr ParameterKind kStore[] = {{"acquisition_time", 0, 0.5, kTime}, {"initial", -1, 1, kValue}};
constexpr PortKind kFlipFlopIn[] = {{"set", kPlain, false, false}, {"reset", kPlain}};
constexpr OutputKind kOutAndInverse[] = {{"out", kPlain}, {"inverse", kPlain}};
constexpr PortKind kCounterIn[] = {{"clock", kPlain}, {"reset", kPlain, false, false}};
constexpr OutputKind kCounterOut[] = {{"out", kPlain}, {"carry", kPlain}};
constexpr ParameterKind kCounter[] = {{"step", 0.0625, 0.3125, kPlain, true}};
constexpr PortKind kTrigger[] = {{"trigger", kPlain}};
constexpr ParameterKind kMonostable[] = {
    {"length", 0.0625, 1.0625, kTime, true}, {"retriggerable", 0, 1, kPlain}, {"high", -1, 1, kValue, true}};
constexpr PortKind kServoMultiplierIn[] = {{"x", kPlain}, {"y1", kValue}};
constexpr OutputKind kServoMultiplierOut[] = {{"out1", kValue}, {"position", kPlain}};
constexpr ParameterKind kServoMultiplier[] = {{"loop_gain", 10, 100, kRate, true},
                                              {"time_constant", 0, 0.0625, kTime},
                                              {"velocity_limit", 0.5, 8.5, kRate},
                                              {"dead_zone", 0, 0.0625, kPlain}};
constexpr PortKind kDirectionIn[] = {{"x", kPlain}, {"y", kPlain}};
constexpr OutputKind kDirectionOut[] = {{"length", kPlain}, {"cos", kPlain}, {"sin", kPlain}};
constexpr ParameterKind kDirection[] = {{"gain", 1000, 17000, kPlain, true},
                                        {"bandwidth", 1, 17, kRate, true}};
constexpr ParameterKind kNoise[] = {{"rms", 0, 0.25, kValue, true},
                                    {"bandwidth", 0.5, 2.5, kRate, true},
                                    {"seed", 0, 16, kPlain, false, Form::whole}};
constexpr ParameterKind kCurve[] = {{"points", -1, 1, kPlain, true, Form::curve}};
constexpr ParameterKind kJumpingCurve[] = {{"points", -1, 1, kPlain, true, Form::jumping_curve}};
constexpr ParameterKind kFormula[] = {{"formula", 0.25, 4.25, kRate, true, Form::sine}};
constexpr ParameterKind kDiode[] = {{"drop", 0, 0.5, kValue, true},
                                    {"breakdown", 0.25, 1.25, kValue},
                                    {"resistance", 0.25, 1.25, kPlain, true}};
constexpr ParameterKind kJunction[] = {{"saturation", 0.0625, 0.3125, kValue, true},
                                       {"thermal", 0.25, 1.25, kValue, true},
                                       {"resistance", 0.25, 2.25, kPlain, true}};
constexpr ParameterKind kSegment[] = {
    {"at", -1, 1, kValue, true}, {"slope", -2, 2, kPlain, true}, {"side", -1, 1, kPlain}};
constexpr ParameterKind kBounds[] = {{"low", -1, -0.0625, kValue, true},
                                     {"high", 0.0625, 1.0625, kValue, true},
                                     {"resistance", 0, 0.5, kPlain},
                                     {"feedback", 0.5, 1.5, kPlain},
                                     {"gain", 100, 1700, kPlain}};
constexpr ParameterKind kLogarithm[] = {{"saturation", 0.0625, 0.3125, kValue, true},
                                        {"thermal", 0.25, 1.25, kValue, true},
                                        {"pair", 1, 1, kPlain, true}};
constexpr ParameterKind kPade[] = {{"delay", 0.25, 1.25, kTime, true}, {"initial", -1, 1, kValue}};
constexpr ParameterKind kLine[] = {{"delay", 0.25, 1.25, kTime, true},
                                   {"stages", 1, 9, kPlain, true, Form::whole},
                                   {"straight", 0, 1, kPlain, false, Form::whole},
                                   {"initial", -1, 1, kValue}};
constexpr PortKind kMultiplexerIn[] = {
    {"in0", kValue}, {"in1", kValue, false, false}, {"in2", kValue, false, false}, {"address", kPlain}};
constexpr ParameterKind kAddress[] = {{"step", 0.25, 1.25, kPlain, true}};
constexpr PortKind kDemultiplexerIn[] = {{"in", kValue}, {"address", kPlain}};
constexpr OutputKind kDemultiplexerOut[] = {{"out0", kValue}, {"out1", kValue}, {"out7", kValue}};
constexpr PortKind kPresetIn[] = {{"clock", kPlain}, {"load", kPlain, false, false}};
constexpr OutputKind kPresetOut[] = {{"out", kPlain}, {"zero", kPlain}};
constexpr ParameterKind kPreset[] = {{"preset", 1, 9, kPlain, true, Form::whole},
                                     {"step", 0.0625, 0.3125, kPlain, true},
                                     {"reload", 0, 1, kPlain, false, Form::whole}};
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr ParameterKind kFastServo[] = {{"gain", 100, 16100, kPlain, true},
                                        {"bandwidth", kInfinity, kInfinity, kRate, true},
                                        {"initial", -1, 1, kValue}};
constexpr ParameterKind kIdealServo[] = {{"gain", kInfinity, kInfinity, kPlain, true},
                                         {"bandwidth", kInfinity, kInfinity, kRate, true},
                                         {"initial", -1, 1, kValue}};
constexpr ParameterKind kIdealDivider[] = {{"gain", kInfinity, kInfinity, kPlain, true},
                                           {"bandwidth", kInfinity, kInfinity, kRate, true}};
constexpr OutputKind kBallOut[] = {{"height", kValue}, {"speed", kSlope}};
constexpr ParameterKind kBall[] = {{"drop", 0.25, 2.25, kValue, true},
                                   {"g", 2, 10, {1, -2}, true},
                                   {"restitution", 0.25, 0.9, kPlain, true}};
constexpr ParameterKind kSpiker[] = {{"rate", 0.5, 4.5, kRate, true},
                                     {"threshold", 0.25, 1.25, kValue, true}};

constexpr BlockKind kKinds[] = {
    {"integrator", 8, kSumOfValues, kValueOut, kPlainIntegrator, true},
    {"integrator", 2, kIntegratorIn, kValueOut, kIntegrator, true},
    {"integrator", 1, kSumOfValues, kValueOut, kRealIntegrator, true, true},
    {"summer", 6, kSumOfValues, kValueOut, {}},
    {"inverter", 1, kOneValue, kValueOut, {}},
    {"gain", 2, kOneValue, kValueOut, kFactor},
    {"potentiometer", 2, kOneValue, kValueOut, kSetting},
    {"multiplier", 4, kFactors, kValueOut, {}},
    {"squarer", 1, kOnePlain, kPlainOut, {}},
    {"absolute-value", 1, kOneValue, kValueOut, {}},
    {"maximum", 1, kTwoValues, kValueOut, {}},
    {"minimum", 1, kTwoValues, kValueOut, {}},
    {"sign", 1, kOneValue, kPlainOut, {}},
    {"sine", 1, kOnePlain, kPlainOut, {}},
    {"cosine", 1, kOnePlain, kPlainOut, {}},
    {"arc-tangent", 1, kOnePlain, kPlainOut, {}},
    {"function-generator", 1, kOnePlain, kPlainOut, kCurve},
    {"function-generator", 1, kOnePlain, kPlainOut, kJumpingCurve},
    {"limiter", 2, kOneValue, kValueOut, kLimits},
    {"dead-zone", 2, kOneValue, kValueOut, kLimits},
    {"diode", 1, kOneValue, kValueOut, kDiode},
    {"junction-diode", 1, kOneValue, kValueOut, kJunction},
    {"diode-segment", 1, kOneValue, kValueOut, kSegment},
    {"diode-amplifier", 1, kSumOfValues, kValueOut, kBounds},
    {"logarithmic-amplifier", 1, kSumOfValues, kValueOut, kLogarithm},
    {"pade-delay-2", 1, kOneValue, kValueOut, kPade},
    {"pade-delay-3", 1, kOneValue, kValueOut, kPade},
    {"delay-line", 1, kOneValue, kValueOut, kLine},
    {"multiplexer", 1, kMultiplexerIn, kValueOut, kAddress},
    {"demultiplexer", 1, kDemultiplexerIn, kDemultiplexerOut, kAddress},
    {"preset-counter", 1, kPresetIn, kPresetOut, kPreset},
    {"backlash", 1, kOneValue, kValueOut, kBacklash, true},
    {"comparator", 3, kSumOfValues, kPlainOut, kComparator},
    {"relay", 2, kRelayIn, kValueOut, kRelay},
    {"electronic-switch", 1, kSwitchIn, kValueOut, kSwitch},
    {"track-and-store", 1, kStoreIn, kValueOut, kStore},
    {"flip-flop", 1, kFlipFlopIn, kOutAndInverse, {}},
    {"counter", 1, kCounterIn, kCounterOut, kCounter},
    {"monostable", 1, kTrigger, kValueOut, kMonostable},
    {"transfer-lag", 4, kOneValue, kValueOut, kLag, true},
    {"servo-amplifier", 2, kSumOfValues, kValueOut, kServo, true},
    {"servo-amplifier", 1, kSumOfValues, kValueOut, kFastServo},
    {"servo-amplifier", 1, kSumOfValues, kValueOut, kIdealServo},
    {"servo-multiplier", 1, kServoMultiplierIn, kServoMultiplierOut, kServoMultiplier, true},
    {"divider", 1, kDividerIn, kValueOut, kDivider, true},
    {"divider", 1, kDividerIn, kValueOut, kIdealDivider},
    {"square-root", 1, kOnePlain, kPlainOut, kRoot, true},
    {"sine-cosine-generator", 1, kSumOfPlain, kCosineAndSine, kGenerator, true},
    {"crank-generator", 1, kCrankIn, kCosineAndSine, kCrank, true},
    {"vector-direction", 1, kDirectionIn, kDirectionOut, kDirection, true},
    {"constant", 2, {}, kValueOut, kConstant, true},
    {"sine-source", 3, {}, kValueOut, kSineSource, true},
    {"pulse-train", 2, {}, kValueOut, kPulses, true},
    {"ramp", 1, {}, kValueOut, kRamp, true},
    {"step", 1, {}, kValueOut, kStep, true},
    {"time-function", 1, {}, kPlainOut, kFormula, true},
    {"noise-source", 1, {}, kValueOut, kNoise, true},
    {"ball", 1, {}, kBallOut, kBall, true},
    {"spiker", 1, kOneValue, kValueOut, kSpiker, true},
    {"swap", 1, kOnePlain, kPlainOut, {}},
};

}  // namespace

std::span<const BlockKind> block_kinds() {
  return kKinds;
}

}  // namespace oblique::fuzz
