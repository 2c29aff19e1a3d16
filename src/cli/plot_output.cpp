// SPDX-License-Identifier: MIT
#include "plot_output.h"

#include <oblique/draw/braille.h>

#include "picture_output.h"
#include "terminal.h"

namespace oblique::cli {

bool plots_in_terminal(const std::string& target) {
  return target == "-";
}

void check_plot(const std::string& target) {
  if (!target.empty() && !plots_in_terminal(target)) check_picture_output(target);
}

void plot(const Chart& chart, const std::string& target) {
  constexpr std::size_t kWidthElsewhere = 80;
  if (plots_in_terminal(target)) {
    print(to_braille(chart, terminal_width(kWidthElsewhere), stdout_has_colours()));
  } else {
    save_picture(draw_chart(chart), target);
  }
}

}  // namespace oblique::cli
