// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/panel_stack.h>

#include <algorithm>

namespace oblique::draw {

Picture stack_panels(const std::string& title, std::size_t n_panels, const PaintPanel& paint,
                     const std::string& note, double width) {
  constexpr double kTitleSize = 15, kNoteSize = 11, kAfterTitle = 16, kBetween = 24;  // [px]
  Picture picture{width, 0, title, {}};
  double y = kPanelMargin;
  if (!title.empty()) {
    picture.marks.push_back(label_mark({kPanelMargin, y + kTitleSize}, title, Anchor::start, kTitleSize));
    std::get<Label>(picture.marks.back().shape).bold = true;
    y += kTitleSize + kAfterTitle;
  }
  for (std::size_t p = 0; p < n_panels; ++p) y = paint(p, y, picture.marks) + kBetween;
  if (!note.empty()) {
    picture.marks.push_back(label_mark({kPanelMargin, y}, note, Anchor::start, kNoteSize));
    y += kBetween;
  }
  double end = 0;
  for (const Mark& mark : picture.marks) end = std::max(end, extent_of(mark).max().x());
  picture.width = std::max(width, end + kPanelMargin);
  picture.height = y - kBetween + kPanelMargin;
  return picture;
}

}  // namespace oblique::draw
