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
    SymbolEntry{"summer", Form::triangle, "", "Σ", ""},
    SymbolEntry{"integrator", Form::integrator, "", "∫", ""},
    SymbolEntry{"inverter", Form::triangle, "", "1", ""},
    SymbolEntry{"open-amplifier", Form::open_amplifier, "∞", "∞", ""},
    SymbolEntry{"potentiometer", Form::circle, "", "", ""},
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
    SymbolEntry{"sign", Form::box, "", "", "sign"},
    SymbolEntry{"step", Form::box, "", "", "step"},
    SymbolEntry{"ramp", Form::box, "", "", "ramp"},
    SymbolEntry{"pulse-train", Form::box, "", "", "pulse-train"},
    SymbolEntry{"switch", Form::box, "", "", "contact"},
    SymbolEntry{"relay", Form::box, "", "", "contact"},
    SymbolEntry{"noise", Form::box, "", "", "noise"},
    SymbolEntry{"source", Form::box, "", "", "source"},
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
