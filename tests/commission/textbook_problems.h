// SPDX-License-Identifier: MIT
// Problems of textbooks, in their own units, with what SciPy gives for them.
#pragma once

#include <optional>
#include <vector>

namespace oblique::testing {

/// A value that an output has at a time, and the largest magnitude of the output.
struct Truth {
  const char* output;
  double time, value, size;
};

struct Problem {
  const char* name;
  double until;
  const char* blocks;
  std::vector<Truth> truths;  ///< SciPy's DOP853 or Radau at tolerances of 1e-11 and less
  /// How far a TR-10 may be off, of the size: about twice what it is. Its multipliers err by 0.8 % of the
  /// machine unit, which rates of change gather, and its potentiometers by 0.0125 %. Of a Model-1 no errors
  /// are published. Nothing: it is not put onto a TR-10.
  std::optional<double> on_tr10;
  double least_setting = 0.002;  ///< of a potentiometer: 8 of the 4000 steps of a TR-10
  double least_signal = 0.3;     ///< the peak of any amplifier [machine unit]
};

/// Where errors of the multipliers decide the phase of a relaxation, or are larger than the start, how far it
/// goes is all that is asked.
inline constexpr double kAnywhere = 2;

inline const std::vector<Problem> kTextbookProblems = {
    // a mass of 1200 kg on 48 kN/m and 1.2 kNs/m under 6 kN [mm]
    {"spring",
     6,
     R"toml(
one = { type = "constant" }
v   = { type = "integrator", in = ["6000/1200*1000*one", "-1200/1200*v", "-48000/1200*x"] }
x   = { type = "integrator", in = "v", initial = 20 }
)toml",
     {{"x", 1.8, 113.4185391965652, 207},
      {"v", 1.8, -254.14220881696917, 590},
      {"x", 6, 119.7625794739642, 207}},
     5e-4},
    // van der Pol's oscillator of 50 Hz, mu = 3, 10 V [V, V/s]
    {"van_der_pol",
     0.1,
     R"toml(
xx  = { type = "squarer", in = "x" }
xxv = { type = "multiplier", in = ["xx", "v"] }
v   = { type = "integrator", in = ["3*2*pi*50*v", "-3*2*pi*50/100*xxv", "-(2*pi*50)^2*x"] }
x   = { type = "integrator", in = "v", initial = 5 }
)toml",
     {{"x", 0.07, -8.552622845970875, 20.2}, {"x", 0.1, 2.846376019818333, 20.2}},
     kAnywhere},
    // Volterra's hares and lynxes [heads, years]
    {"volterra",
     30,
     R"toml(
hl = { type = "multiplier", in = ["h", "l"] }
h  = { type = "integrator", in = ["0.55*h", "-2.8e-5*hl"], initial = 30000 }
l  = { type = "integrator", in = ["-0.84*l", "2.6e-5*hl"], initial = 4000 }
)toml",
     {{"h", 9, 17393.86277658994, 77500},
      {"l", 9, 5457.9746864344925, 55900},
      {"h", 30, 20677.640817779273, 77500}},
     0.1},
    // J0 from 1 on, by z = x y', y' = z/x: a divider whose denominator grows to 20
    {"bessel",
     19,
     R"toml(
one = { type = "constant" }
x   = { type = "integrator", in = "one", initial = 1 }
q   = { type = "divider", numerator = "z", denominator = "x" }
xy  = { type = "multiplier", in = ["x", "y"] }
y   = { type = "integrator", in = "q", initial = 0.7651976865579666 }
z   = { type = "integrator", in = "-xy", initial = -0.44005058574493355 }
)toml",
     {{"y", 5.7, 0.28506473771059915, 0.765}, {"y", 19, 0.1670246643406815, 0.765}},
     0.02},
    // A to B to C, at 400 and 1.5 1/s [mol/m3]
    {"kinetics",
     5,
     R"toml(
a = { type = "integrator", in = "-400*a", initial = 2.5e5 }
b = { type = "integrator", in = ["400*a", "-1.5*b"] }
c = { type = "integrator", in = "1.5*b" }
)toml",
     {{"b", 1.5, 26448.98985240678, 2.45e5}, {"c", 3.5, 248683.18233395054, 2.5e5}},
     0.003},
    // two tanks that run out by Torricelli's law [m, s]
    {"tanks",
     3600,
     R"toml(
one = { type = "constant" }
r1  = { type = "square-root", in = "h1" }
r2  = { type = "square-root", in = "h2" }
h1  = { type = "integrator", in = ["2e-3*one", "-1.5e-3*r1"], initial = 3.2 }
h2  = { type = "integrator", in = ["1.5e-3*r1", "-1.8e-3*r2"], initial = 0.4 }
)toml",
     {{"h1", 1080, 2.610939329758902, 3.2}, {"h2", 3600, 1.462787467923222, 1.5}},
     0.01},
    // a shell of 800 m/s with quadratic drag [m]
    {"projectile",
     50,
     R"toml(
one = { type = "constant" }
vx2 = { type = "squarer", in = "vx" }
vy2 = { type = "squarer", in = "vy" }
v2  = { type = "summer", in = ["vx2", "vy2"] }
v   = { type = "square-root", in = "v2", initial = 800 }
ax  = { type = "multiplier", in = ["v", "vx"] }
ay  = { type = "multiplier", in = ["v", "vy"] }
vx  = { type = "integrator", in = "-5e-5*ax", initial = "800*cos(pi/4)" }
vy  = { type = "integrator", in = ["-9.81*one", "-5e-5*ay"], initial = "800*sin(pi/4)" }
x   = { type = "integrator", in = "vx" }
y   = { type = "integrator", in = "vy" }
)toml",
     {{"x", 15, 6706.416439087729, 16400},
      {"y", 35, 8043.762301028702, 8050},
      {"x", 50, 16378.88063478626, 16400}},
     0.003},
    // a rocket that burns 1.2 t of its 2 t at 50 kN [m, s]
    {"rocket",
     60,
     R"toml(
one    = { type = "constant" }
m      = { type = "integrator", in = "-20*one", initial = 2000 }
thrust = { type = "gain", in = "one", factor = 5e4 }
a      = { type = "divider", numerator = "thrust", denominator = "m", initial = 25 }
v      = { type = "integrator", in = ["a", "-9.81*one"] }
h      = { type = "integrator", in = "v" }
)toml",
     {{"v", 42, 949.7979386041683, 1700}, {"h", 60, 40712.926812573096, 40700}},
     0.02},
    // a satellite of 8.6 km/s at 7000 km [km, s]
    {"satellite",
     9000,
     R"toml(
one = { type = "constant" }
u   = { type = "divider", numerator = "one", denominator = "r" }
uu  = { type = "squarer", in = "u" }
uuu = { type = "multiplier", in = ["uu", "u"] }
v   = { type = "integrator", in = ["(7000*8.6)^2*uuu", "-398600.4418*uu"] }
r   = { type = "integrator", in = "v", initial = 7000 }
phi = { type = "integrator", in = "7000*8.6*uu" }
)toml",
     {{"r", 2700, 11178.01462338314, 13000},
      {"r", 9000, 7908.547330410978, 13000},
      {"phi", 9000, 5.236794719735244, 5.3}},
     0.025},
    // Michaelis and Menten, from 100 umol/l [mol/l, s]: an ideal amplifier divides by numbers of 1e-4, before
    // a
    // real summer of a TR-10 gives it one
    {"enzyme",
     200,
     R"toml(
one = { type = "constant" }
d   = { type = "summer", in = ["5e-5*one", "s"] }
q   = { type = "divider", numerator = "s", denominator = "d", gain = "inf", bandwidth = "inf" }
s   = { type = "integrator", in = "-1e-6*q", initial = 1e-4 }
p   = { type = "integrator", in = "1e-6*q" }
)toml",
     {{"s", 60, 6.30567519916192e-05, 1e-4}, {"p", 200, 8.91142447119112e-05, 9e-5}},
     std::nullopt},
    // Mathieu's equation at 1 kHz, from 2 um [m]
    {"mathieu",
     0.01,
     R"toml(
drive = { type = "sine-source", amplitude = 1, frequency = "1 kHz", phase = "90 deg" }
dy    = { type = "multiplier", in = ["drive", "y"] }
v     = { type = "integrator", in = ["-(pi*1000)^2*0.2*y", "(pi*1000)^2*2*0.35*dy"] }
y     = { type = "integrator", in = "v", initial = 2e-6 }
)toml",
     {{"y", 0.003, 5.887989689840181e-07, 3.3e-6}, {"y", 0.01, -1.0871761075135724e-06, 3.3e-6}},
     0.01},
    // a ball on a stiff floor, from 800 mm [mm]: a dead zone, of which a comparator makes the corner on a
    // Model-1
    {"ball",
     2,
     R"toml(
one = { type = "constant" }
s   = { type = "dead-zone", in = "y", low = 0, high = 1e7 }
v   = { type = "integrator", in = ["-9810*one", "-4e4*s"] }
y   = { type = "integrator", in = "v", initial = 800 }
)toml",
     {{"y", 0.6, 554.8925407580131, 800}, {"y", 2, 189.08236719263994, 800}},
     0.01,
     0.002,
     0.2},  // the floor gives by a fortieth of the height
    // a servo of 90 degrees by PID, whose drive has a limit [degrees]
    {"pid",
     8,
     R"toml(
one       = { type = "constant" }
e         = { type = "summer", in = ["90*one", "-a"] }
i         = { type = "integrator", in = "e" }
u         = { type = "summer", in = ["8*e", "2*i", "-3*w"] }
u_limited = { type = "limiter", in = "u", low = -200, high = 200 }
w         = { type = "integrator", in = ["u_limited", "-1.5*w"] }
a         = { type = "integrator", in = "w" }
)toml",
     {{"a", 2.4, 107.539562970445, 108}, {"a", 8, 93.11634371068662, 108}},
     0.002},
    // an epidemic in a town of 2.4 million [persons, days]: 100 of them are a start of 1.4e-4
    {"epidemic",
     100,
     R"toml(
si = { type = "multiplier", in = ["s", "i"] }
s  = { type = "integrator", in = "-0.35/2.4e6*si", initial = 2399900 }
i  = { type = "integrator", in = ["0.35/2.4e6*si", "-0.12*i"], initial = 100 }
)toml",
     {{"s", 70, 199589.44678020477, 2.4e6}, {"i", 30, 90520.49279633292, 7e5}},
     kAnywhere,
     1e-4},
    // a series circuit of 100 ohms, 10 mH and 1 uF on 5 V [A, V]
    {"resonant_circuit",
     2e-3,
     R"toml(
u  = { type = "constant", value = 5 }
i  = { type = "integrator", in = ["100*u", "-100*100*i", "-100*uc"] }
uc = { type = "integrator", in = "1e6*i" }
)toml",
     {{"i", 2e-4, 0.020963981483316566, 0.0273}, {"uc", 1e-3, 5.010850583696628, 5.8}},
     3e-4},
    // a quarter of a car on a kerb of 50 mm [m, N]
    {"suspension",
     3,
     R"toml(
road   = { type = "constant", value = 0.05 }
body   = { type = "integrator", in = "v" }
wheel  = { type = "integrator", in = "u" }
spring = { type = "summer", in = ["16182*wheel", "-16182*body", "1000*u", "-1000*v"] }
tyre   = { type = "summer", in = ["190000*road", "-190000*wheel"] }
v      = { type = "integrator", in = "1/290*spring" }
u      = { type = "integrator", in = ["1/59*tyre", "-1/59*spring"] }
)toml",
     {{"body", 0.3, 0.07346246125350287, 0.079},
      {"wheel", 1.2, 0.05068385455492962, 0.077},
      {"spring", 0.3, -676.0850871175932, 2700}},
     2e-3},
    // a motor at 100 rad/s by a regulator of two terms; its back e.m.f. asks for a setting of 0.0008 [rad/s,
    // A]
    {"motor",
     2,
     R"toml(
r = { type = "constant", value = 100 }
e = { type = "summer", in = ["r", "-w"] }
q = { type = "integrator", in = "e" }
u = { type = "summer", in = ["100*e", "200*q"] }
i = { type = "integrator", in = ["2*u", "-2*i", "-0.02*w"] }
w = { type = "integrator", in = ["i", "-10*w"] }
)toml",
     {{"w", 0.1, 62.89168776776292, 130}, {"i", 2, 1000.0372181575987, 1681}},
     1e-3,
     5e-4},
    // a pendulum upright on a cart by feedback of its states [m, rad, N]
    {"inverted_pendulum",
     6,
     R"toml(
x = { type = "integrator", in = "v", initial = 0.2 }
v = { type = "integrator", in = ["1.81818*F", "-0.181818*v", "2.67273*a"] }
a = { type = "integrator", in = "w", initial = "10*pi/180" }
w = { type = "integrator", in = ["4.54545*F", "-0.454545*v", "31.1818*a"] }
F = { type = "summer", in = ["x", "1.6567*v", "-18.6854*a", "-3.4594*w"] }
)toml",
     {{"x", 1.2, -0.17934882846018514, 0.2},
      {"a", 1.2, -0.036576530750868155, 0.1745},
      {"F", 1.2, 0.24946797738597895, 3.06}},
     2e-3},
    // a drug in three compartments [mg, hours; mg/l]
    {"compartments",
     48,
     R"toml(
a1 = { type = "integrator", in = ["-0.55*a1", "0.1*a2", "0.01*a3"], initial = 500 }
a2 = { type = "integrator", in = ["0.2*a1", "-0.1*a2"] }
a3 = { type = "integrator", in = ["0.05*a1", "-0.01*a3"] }
c  = { type = "gain", in = "a1", factor = "1/20" }
)toml",
     {{"c", 6, 2.0479329034705325, 25},
      {"a2", 48, 13.675270529116707, 131.2},
      {"a3", 48, 48.701642942912365, 53.5}},
     6e-4},
    // Duffing's spring in two wells, by a sine source [1]
    {"two_wells",
     40,
     R"toml(
x2 = { type = "squarer", in = "x" }
x3 = { type = "multiplier", in = ["x", "x2"] }
f  = { type = "sine-source", amplitude = 0.2, frequency = "1.2/(2*pi)", phase = "pi/2" }
v  = { type = "integrator", in = ["-0.3*v", "x", "-x3", "f"] }
x  = { type = "integrator", in = "v", initial = 1 }
)toml",
     {{"x", 8, 0.710872306809239, 1.36}, {"v", 40, -0.3804585754223383, 0.652}},
     0.2},
    // Monod's culture, washed through [g/l, hours]: in the end the divisor of the growth is a fifteenth of
    // what it
    // is at first, by which 0.8 % of the machine unit of a multiplier are an eighth
    {"chemostat",
     40,
     R"toml(
one   = { type = "constant" }
d     = { type = "summer", in = ["s", "0.12*one"] }
m     = { type = "divider", numerator = "s", denominator = "d" }
grown = { type = "multiplier", in = ["m", "x"] }
s     = { type = "integrator", in = ["0.3*4*one", "-0.3*s", "-0.53/0.4*grown"], initial = 4 }
x     = { type = "integrator", in = ["0.53*grown", "-0.3*x"], initial = 0.05 }
)toml",
     {{"s", 12, 2.413822831883327, 4},
      {"x", 40, 1.5373916433733312, 1.54},
      {"m", 40, 0.5660376110264589, 0.97}},
     0.45},
    // lynxes that hunt while hares are plenty [heads, years]: a TR-10 has one comparator
    {"hunting",
     40,
     R"toml(
one  = { type = "constant" }
both = { type = "multiplier", in = ["h", "l"] }
many = { type = "comparator", in = ["h", "-20000*one"], hysteresis = 4000, initial = 1 }
met  = { type = "electronic-switch", on = "both", control = "many" }
h    = { type = "integrator", in = ["0.55*h", "-2.8e-5*met"], initial = 30000 }
l    = { type = "integrator", in = ["-0.84*l", "2.6e-5*met"], initial = 4000 }
)toml",
     {{"h", 10, 37018.44309495, 77400}, {"l", 25, 21650.92826996, 55800}, {"h", 40, 46022.27179034, 77400}},
     0.2},
};

}  // namespace oblique::testing
