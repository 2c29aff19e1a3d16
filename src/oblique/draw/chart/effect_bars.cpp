// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/effect_bars.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/draw/chart/axes.h>
#include <oblique/draw/chart/panel_stack.h>
#include <oblique/draw/picture/text_width.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

constexpr double kBarText = 12, kBarLabel = 11;    // [px]
constexpr double kBar = 18, kStep = 28, kGap = 6;  // [px]

double widest(const EffectBars& panel, std::string EffectBars::Bar::*text, double size) {
  double width = 0;
  for (const EffectBars::Bar& bar : panel.bars) width = std::max(width, text_width(bar.*text, size));
  return width;
}

/// Gives where the panel ends.
double paint(const EffectBars& panel, std::size_t index, double top, double width, std::vector<Mark>& marks) {
  std::vector<double> values{panel.middle};
  for (const EffectBars::Bar& bar : panel.bars) values.insert(values.end(), {bar.low, bar.high});
  const Scale x(panel.axis, values, true);
  Scale rows({""}, {0, 1}, false);
  const double left = kPanelMargin + widest(panel, &EffectBars::Bar::name, kBarText) + 2 * kGap +
                      widest(panel, &EffectBars::Bar::low_label, kBarLabel);
  const double right = width - kPanelMargin - kGap - widest(panel, &EffectBars::Bar::high_label, kBarLabel);
  const double height = kStep * static_cast<double>(panel.bars.size()) + kStep - kBar;
  const Axes axes(Extent(Vector2d(left, top), Vector2d(std::max(right, left + 120), top + height)), x, rows,
                  Axes::Shape::stretched);
  for (Mark& mark : axes.marks()) {
    // no grid and no numbers of rows
    const Label* const label = std::get_if<Label>(&mark.shape);
    if (label != nullptr && label->anchor == Anchor::end) continue;
    const Extent extent = extent_of(mark);
    const bool across = label == nullptr && extent.sizes().x() > 3 && extent.sizes().y() < 3;
    if (!across) marks.push_back(std::move(mark));
  }
  const double middle = axes.at({panel.middle, 0}).x();
  for (std::size_t b = 0; b < panel.bars.size(); ++b) {
    const EffectBars::Bar& bar = panel.bars[b];
    const double y = top + (kStep - kBar) + kStep * static_cast<double>(b);
    const double begin = axes.at({std::min(bar.low, bar.high), 0}).x();
    const double end = axes.at({std::max(bar.low, bar.high), 0}).x();
    marks.push_back(box_mark({begin, y}, {std::max(end - begin, 1.0), kBar}, Ink::blue, {Ink::none, 0}));
    marks.back().opacity = 0.75;
    marks.back().id = fmt::format("bar-{}-{}", index, b);
    marks.back().tooltip = fmt::format("{}: {:.6g} … {:.6g}", bar.name, bar.low, bar.high);
    const double base = y + kBar / 2 + 4;
    marks.push_back(label_mark({kPanelMargin, base}, bar.name, Anchor::start, kBarText));
    marks.push_back(label_mark({begin - kGap, base}, bar.low_label, Anchor::end, kBarLabel));
    marks.push_back(label_mark({end + kGap, base}, bar.high_label, Anchor::start, kBarLabel));
  }
  marks.push_back(line_mark({middle, top}, {middle, top + height}, {Ink::line, 1.25}));
  return top + height + Axes::kFoot + 6;
}

}  // namespace

Picture draw_effect_bars(const std::string& title, const std::vector<EffectBars>& panels,
                         const std::string& note, double width) {
  const auto panel = [&](std::size_t index, double top, std::vector<Mark>& marks) {
    return paint(panels[index], index, top, width, marks);
  };
  return stack_panels(title, panels.size(), panel, note, width);
}

}  // namespace oblique::draw
