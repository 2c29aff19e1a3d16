// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <oblique/draw/symbols.h>

namespace oblique::schematic {
namespace {

using Eigen::Vector2d;
using Lines = std::vector<std::vector<Vector2d>>;

// clang-format off
constexpr std::array kSymbols{
    SymbolEntry{"summer", Outline::triangle, "", "Σ", ""},
    SymbolEntry{"integrator", Outline::integrator, "", "∫", ""},
    SymbolEntry{"inverter", Outline::triangle, "", "1", ""},
    SymbolEntry{"open-amplifier", Outline::open_amplifier, "∞", "∞", ""},
    SymbolEntry{"potentiometer", Outline::circle, "", "", ""},
    SymbolEntry{"gain", Outline::box, "", "", ""},
    SymbolEntry{"constant", Outline::circle, "", "", ""},
    SymbolEntry{"multiplier", Outline::box, "×", "×", "", true},
    SymbolEntry{"servo-multiplier", Outline::box, "S ×", "S ×", "", true},
    SymbolEntry{"divider", Outline::box, "÷", "÷", ""},
    SymbolEntry{"squarer", Outline::box, "x²", "x²", ""},
    SymbolEntry{"square-root", Outline::box, "√x", "√x", ""},
    SymbolEntry{"maximum", Outline::box, "max", "max", "", true},
    SymbolEntry{"minimum", Outline::box, "min", "min", "", true},
    SymbolEntry{"transfer-lag", Outline::box, "1/(1+Ts)", "1/(1+Ts)", ""},
    SymbolEntry{"function", Outline::box, "", "", ""},
    SymbolEntry{"function-generator", Outline::box, "", "", "function-generator"},
    SymbolEntry{"comparator", Outline::box, "", "", "comparator"},
    SymbolEntry{"absolute-value", Outline::box, "", "", "absolute-value"},
    SymbolEntry{"backlash", Outline::box, "", "", "backlash"},
    SymbolEntry{"dead-zone", Outline::box, "", "", "dead-zone"},
    SymbolEntry{"limiter", Outline::box, "", "", "limiter"},
    SymbolEntry{"sign", Outline::box, "", "", "sign"},
    SymbolEntry{"step", Outline::box, "", "", "step"},
    SymbolEntry{"ramp", Outline::box, "", "", "ramp"},
    SymbolEntry{"pulse-train", Outline::box, "", "", "pulse-train"},
    SymbolEntry{"switch", Outline::box, "", "", "contact"},
    SymbolEntry{"relay", Outline::box, "", "", "contact"},
    SymbolEntry{"noise", Outline::box, "", "", "noise"},
    SymbolEntry{"source", Outline::box, "", "", "source"},
};
// clang-format on

struct IconEntry {
  const char* name;
  Lines lines;
};

Lines wave() {
  std::vector<Vector2d> line;
  constexpr int kPoints = 24;
  for (int k = 0; k <= kPoints; ++k) {
    const double x = -1 + 2.0 * k / kPoints;
    line.push_back({x, 0.8 * std::sin(std::numbers::pi * (x + 1))});
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
  };
  return entries;
}

}  // namespace

const SymbolEntry* find_symbol(const std::string& symbol) {
  const auto found = std::find_if(kSymbols.begin(), kSymbols.end(),
                                  [&](const SymbolEntry& e) { return symbol == e.symbol; });
  return found == kSymbols.end() ? nullptr : &*found;
}

Lines icon_lines(const std::string& icon) {
  for (const IconEntry& entry : icons()) {
    if (icon == entry.name) return entry.lines;
  }
  return {};
}

Ink loop_ink(std::size_t loop) {
  return kAccents[loop % std::size(kAccents)];
}

}  // namespace oblique::schematic
