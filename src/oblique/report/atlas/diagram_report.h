// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include <oblique/draw/chart/chart.h>
#include <oblique/report/atlas/agreement.h>
#include <oblique/report/html_page.h>

namespace oblique::report {

/// All that is known of a diagram, on one page: where it comes from, the circuit and the equations read back
/// from it, curves as on the plotter, what was published against what is computed, the largest signal of each
/// element, settings, static test, stability, and the machines that it fits.
struct DiagramReport {
  const Programme& programme;
  const diagram::BlockLibrary& blocks;
  text::Vocabulary vocabulary = text::plain_vocabulary();
  std::function<void(double fraction)> progress = {};
  std::string index = {};   ///< address of the page that lists it; empty: none
  std::string studio = {};  ///< address that opens it in the studio; empty: none

  /// Throws as flattening and assembly do; what fails later is told on the page.
  HtmlPage page() const;
};

/// The comment at the head of a diagram's file: its paragraphs, lines joined; what is indented is kept as it
/// is.
std::vector<std::string> head_comment(const std::string& text);

/// The outputs of a run as the author's plotter drew them, or over the time.
draw::Chart plotter_chart(const Programme& programme, const diagram::BlockLibrary& blocks);

}  // namespace oblique::report
