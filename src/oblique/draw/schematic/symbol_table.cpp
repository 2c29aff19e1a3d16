// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/symbol_table.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace oblique::draw::schematic {
namespace {

using Eigen::Vector2d;
using Lines = std::vector<std::vector<Vector2d>>;

// clang-format off
constexpr std::array kSymbols{
    SymbolEntry{"summer", Form::triangle, "", "Σ", ""},
    SymbolEntry{"integrator", Form::integrator, "", "∫", ""},
    SymbolEntry{"inverter", Form::triangle, "", "1", ""},
    SymbolEntry{"open-amplifier", Form::open_amplifier, "∞", "∞", ""},
    SymbolEntry{"potentiometer", Form::circle, "", "", "potentiometer"},
    SymbolEntry{"gain", Form::box, "", "", ""},
    SymbolEntry{"constant", Form::circle, "", "", ""},
    SymbolEntry{"multiplier", Form::box, "×", "×", "", true},
    SymbolEntry{"servo-multiplier", Form::box, "S ×", "S ×", "", true},
    SymbolEntry{"divider", Form::box, "÷", "÷", ""},
    SymbolEntry{"squarer", Form::box, "x²", "x²", ""},
    SymbolEntry{"square-root", Form::box, "√x", "√x", ""},
    SymbolEntry{"maximum", Form::box, "max", "max", "", true},
    SymbolEntry{"minimum", Form::box, "min", "min", "", true},
    SymbolEntry{"transfer-lag", Form::box, "1/(1+Ts)", "1/(1+Ts)", ""},
    SymbolEntry{"function", Form::box, "", "", ""},
    SymbolEntry{"function-generator", Form::box, "", "", "function-generator"},
    SymbolEntry{"comparator", Form::box, "", "", "comparator"},
    SymbolEntry{"absolute-value", Form::box, "", "", "absolute-value"},
    SymbolEntry{"backlash", Form::box, "", "", "backlash"},
    SymbolEntry{"dead-zone", Form::box, "", "", "dead-zone"},
    SymbolEntry{"limiter", Form::box, "", "", "limiter"},
    SymbolEntry{"diode", Form::box, "", "", "diode"},
    SymbolEntry{"diode-segment", Form::box, "", "", "ramp"},
    SymbolEntry{"diode-amplifier", Form::box, "", "", "bounded"},
    SymbolEntry{"logarithmic-amplifier", Form::triangle, "−ln", "−ln", ""},
    SymbolEntry{"delay", Form::box, "t−T", "t−T", ""},
    SymbolEntry{"sign", Form::box, "", "", "sign"},
    SymbolEntry{"step", Form::box, "", "", "step"},
    SymbolEntry{"ramp", Form::box, "", "", "ramp"},
    SymbolEntry{"pulse-train", Form::box, "", "", "pulse-train"},
    SymbolEntry{"switch", Form::box, "", "", "contact"},
    SymbolEntry{"relay", Form::box, "", "", "contact"},
    SymbolEntry{"noise", Form::box, "", "", "noise"},
    SymbolEntry{"source", Form::box, "", "", "source"},
    SymbolEntry{"monostable", Form::box, "", "", "monostable"},
    SymbolEntry{"track-and-store", Form::box, "", "", "track-and-store"},
    SymbolEntry{"flip-flop", Form::ports, "", "", ""},
    SymbolEntry{"jk-flip-flop", Form::ports, "", "", ""},
    SymbolEntry{"counter", Form::ports, "", "", "counter"},
    SymbolEntry{"preset-counter", Form::ports, "", "", "counter"},
    SymbolEntry{"multiplexer", Form::ports, "", "", "contact"},
    SymbolEntry{"resolver", Form::ports, "", "", "resolver"},
    SymbolEntry{"sine-cosine-generator", Form::ports, "", "", "source"},
    SymbolEntry{"crank", Form::ports, "", "", "crank"},
    SymbolEntry{"dyad", Form::ports, "", "", "dyad"},
    SymbolEntry{"triangle", Form::ports, "", "", "triangle"},
};
// clang-format on

struct IconEntry {
  const char* name;
  Lines lines;
};

/// A circle, or the arc of one, between two angles.
std::vector<Vector2d> arc(const Vector2d& centre, double radius, double from, double to) {
  std::vector<Vector2d> line;
  constexpr int kPoints = 24;
  for (int k = 0; k <= kPoints; ++k) {
    const double angle = from + (to - from) * k / kPoints;
    line.emplace_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return line;
}

Lines dyad() {
  const double turn = 2 * std::numbers::pi;
  return {{{-0.75, -0.65}, {-0.15, 0.6}},
          {{0.02, 0.55}, {0.75, -0.65}},
          arc({-0.06, 0.75}, 0.18, 0, turn),
          arc({-0.82, -0.8}, 0.18, 0, turn),
          arc({0.82, -0.8}, 0.18, 0, turn)};
}

Lines crank() {
  return {arc({0, 0}, 0.95, 0, 2 * std::numbers::pi), {{0, 0}, {0.67, 0.67}}, {{-0.3, 0}, {0.3, 0}}};
}

/// A tap that goes round.
Lines potentiometer() {
  return {arc({0, 0}, 0.7, 0, 2 * std::numbers::pi),
          {{-0.95, -0.95}, {0.95, 0.95}},
          {{0.5, 0.9}, {0.95, 0.95}, {0.9, 0.5}}};
}

/// A vector over an axis, with its angle.
Lines resolver() {
  return {{{-0.9, -0.7}, {1, -0.7}},
          {{-0.9, -0.7}, {0.8, 0.8}},
          {{0.35, 0.68}, {0.8, 0.8}, {0.72, 0.34}},
          arc({-0.9, -0.7}, 1.1, 0, 0.72)};
}

Lines wave() {
  std::vector<Vector2d> line;
  constexpr int kPoints = 24;
  for (int k = 0; k <= kPoints; ++k) {
    const double x = -1 + 2.0 * k / kPoints;
    line.emplace_back(x, 0.8 * std::sin(std::numbers::pi * (x + 1)));
  }
  return {line};
}

const std::vector<IconEntry>& icons() {
  static const std::vector<IconEntry> entries{
      {"function-generator", {{{-1, -0.8}, {-0.4, -0.6}, {0.1, 0.2}, {0.5, 0.3}, {1, 0.9}}}},
      {"comparator", {{{-1, -0.7}, {0, -0.7}, {0, 0.7}, {1, 0.7}}, {{-1, 0}, {1, 0}}}},
      {"absolute-value", {{{-1, 0.8}, {0, -0.6}, {1, 0.8}}}},
      {"backlash", {{{-1, -0.8}, {0.2, -0.8}, {1, 0.8}, {-0.2, 0.8}, {-1, -0.8}}}},
      {"dead-zone", {{{-1, -0.8}, {-0.35, 0}, {0.35, 0}, {1, 0.8}}}},
      {"limiter", {{{-1, -0.7}, {-0.45, -0.7}, {0.45, 0.7}, {1, 0.7}}}},
      {"bounded", {{{-1, 0.7}, {-0.45, 0.7}, {0.45, -0.7}, {1, -0.7}}}},
      {"diode",
       {{{-1, 0}, {1, 0}}, {{-0.5, 0.6}, {0.4, 0}, {-0.5, -0.6}, {-0.5, 0.6}}, {{0.4, 0.6}, {0.4, -0.6}}}},
      {"sign", {{{-1, -0.7}, {0, -0.7}, {0, 0.7}, {1, 0.7}}}},
      {"step", {{{-1, -0.7}, {-0.3, -0.7}, {-0.3, 0.7}, {1, 0.7}}}},
      {"ramp", {{{-1, -0.7}, {-0.4, -0.7}, {1, 0.8}}}},
      {"pulse-train",
       {{{-1, -0.6},
         {-0.7, -0.6},
         {-0.7, 0.7},
         {-0.3, 0.7},
         {-0.3, -0.6},
         {0.3, -0.6},
         {0.3, 0.7},
         {0.7, 0.7},
         {0.7, -0.6},
         {1, -0.6}}}},
      {"noise",
       {{{-1, 0},
         {-0.8, 0.5},
         {-0.65, -0.4},
         {-0.4, 0.8},
         {-0.2, -0.7},
         {0, 0.3},
         {0.2, -0.3},
         {0.35, 0.6},
         {0.55, -0.8},
         {0.75, 0.4},
         {1, -0.1}}}},
      {"contact", {{{-1, 0.7}, {-0.4, 0.7}}, {{-1, -0.7}, {-0.4, -0.7}}, {{1, 0}, {0.5, 0}, {-0.5, 0.6}}}},
      {"source", wave()},
      {"monostable", {{{-1, -0.7}, {-0.4, -0.7}, {-0.4, 0.7}, {0.4, 0.7}, {0.4, -0.7}, {1, -0.7}}}},
      {"track-and-store",
       {{{-1, -0.7}, {-0.7, -0.3}, {-0.45, 0.3}, {-0.2, 0.55}, {0.3, 0.55}},
        {{0.3, 0.55}, {0.3, -0.1}, {0.6, -0.3}, {1, -0.3}}}},
      {"counter",
       {{{-1, -0.8}, {-0.5, -0.8}, {-0.5, -0.3}, {0, -0.3}, {0, 0.2}, {0.5, 0.2}, {0.5, 0.7}, {1, 0.7}}}},
      {"resolver", resolver()},
      {"crank", crank()},
      {"potentiometer", potentiometer()},
      {"dyad", dyad()},
      {"triangle", {{{-0.95, -0.6}, {0.35, 0.75}, {0.95, -0.6}, {-0.95, -0.6}}}},
  };
  return entries;
}

}  // namespace

const SymbolEntry* find_symbol(const std::string& symbol) {
  const auto found = std::find_if(kSymbols.begin(), kSymbols.end(),
                                  [&](const SymbolEntry& e) { return symbol == e.symbol; });
  return found == kSymbols.end() ? nullptr : &*found;
}

PortSign port_sign(const Block& block, const std::string& port) {
  struct Entry {
    const char* symbol;
    const char* port;
    PortSign sign;
  };
  static const std::vector<Entry> entries{
      {"flip-flop", "set", {"S"}},
      {"flip-flop", "reset", {"R"}},
      {"flip-flop", "out", {"Q"}},
      {"flip-flop", "inverse", {"Q", false, true}},
      {"jk-flip-flop", "clock", {"C", true}},
      {"jk-flip-flop", "j", {"J"}},
      {"jk-flip-flop", "k", {"K"}},
      {"jk-flip-flop", "reset", {"R"}},
      {"jk-flip-flop", "out", {"Q"}},
      {"jk-flip-flop", "inverse", {"Q", false, true}},
      {"counter", "clock", {"C", true}},
      {"counter", "reset", {"R"}},
      {"preset-counter", "clock", {"C", true}},
      {"preset-counter", "load", {"L"}},
      {"preset-counter", "enable", {"E"}},
  };
  for (const Entry& entry : entries) {
    if (block.definition != nullptr && block.definition->symbol == entry.symbol && port == entry.port)
      return entry.sign;
  }
  return {port};
}

Lines icon_lines(const std::string& icon) {
  for (const IconEntry& entry : icons()) {
    if (icon == entry.name) return entry.lines;
  }
  return {};
}

}  // namespace oblique::draw::schematic
