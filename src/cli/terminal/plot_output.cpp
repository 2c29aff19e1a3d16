// SPDX-License-Identifier: MIT
#include "terminal/plot_output.h"

#include <oblique/draw/chart/braille.h>
#include <oblique/text/diagnostic.h>

#include "terminal/picture_output.h"
#include "terminal/terminal.h"

namespace oblique::cli {

bool plots_in_terminal(const std::string& target) {
  return target == "-";
}

void check_plot(const std::string& target, const std::string& theme) {
  if (!theme.empty() && (target.empty() || plots_in_terminal(target))) {
    throw text::ReadError(text::Diagnostic{
        {},
        target.empty() ? "--theme chooses the colours of a drawing, and none is asked for"
                       : "--theme chooses the colours of a picture; the terminal has its own",
        "--plot FILE.svg beside it",
        {}});
  }
  if (!target.empty() && !plots_in_terminal(target)) check_picture_output(target);
  plot_theme(theme);
}

draw::Theme plot_theme(const std::string& theme) {
  return theme.empty() ? draw::Theme::automatic : theme_option(theme);
}

void plot(const draw::Chart& chart, const std::string& target, draw::Theme theme) {
  constexpr std::size_t kWidthElsewhere = 80;
  if (plots_in_terminal(target)) {
    print_coloured(draw::to_braille(chart, terminal_width(kWidthElsewhere), stdout_has_colours()));
  } else {
    save_picture(draw::draw_chart(chart), target, theme);
  }
}

}  // namespace oblique::cli
