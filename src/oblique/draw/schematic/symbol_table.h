// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <oblique/draw/schematic/schematic.h>

/// What is drawn for which symbol. Not installed.
namespace oblique::draw::schematic {

/// The line around a symbol.
enum class Form { triangle, integrator, open_amplifier, circle, box, ports, terminal };

/// What a symbol is made of: its classic outline, the texts in it, and its curve.
struct SymbolEntry {
  const char* symbol;
  Form classic;
  const char* classic_text;
  const char* din_text;
  const char* icon;
  bool inputs_alike = false;  ///< which signal comes where makes no difference
};
/// The entry of a block's `symbol`; none where boxes with port names do.
const SymbolEntry* find_symbol(const std::string& symbol);

/// How a port of a block with this symbol is written inside its box.
struct PortSign {
  std::string text;
  bool edge = false;      ///< it acts when its signal rises: a wedge
  bool inverted = false;  ///< a small circle at an output
};
PortSign port_sign(const Block& block, const std::string& port);

/// The lines of a small curve within −1 … 1 in both directions, y upwards.
std::vector<std::vector<Eigen::Vector2d>> icon_lines(const std::string& icon);

}  // namespace oblique::draw::schematic
