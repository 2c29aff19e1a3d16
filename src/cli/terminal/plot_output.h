// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/draw/chart/chart.h>
#include <oblique/draw/picture/svg.h>

namespace oblique::cli {

/// What --plot asks for: "-" is the terminal, anything else a picture's file.
bool plots_in_terminal(const std::string& target);

/// Checks --plot and --theme, once and before the work is done; empty: not given. Throws ReadError.
void check_plot(const std::string& target, const std::string& theme);

/// The theme that --theme names; empty: not given. Throws ReadError.
draw::Theme plot_theme(const std::string& theme);

/// Prints the chart in Braille, as wide as the terminal, or writes it as a picture.
void plot(const draw::Chart& chart, const std::string& target, draw::Theme theme);

}  // namespace oblique::cli
