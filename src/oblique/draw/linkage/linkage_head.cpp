// SPDX-License-Identifier: MIT
#include <oblique/draw/linkage/linkage_head.h>

#include <algorithm>

#include <oblique/draw/animation/analog_overlay.h>
#include <oblique/draw/linkage/linkage_parts.h>
#include <oblique/draw/picture/text_width.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

constexpr double kHeadMargin = 16, kTextSize = 12;  // [px]

const std::vector<std::vector<double>>& dashes() {
  static const std::vector<std::vector<double>> all{{}, {9, 4}, {2, 4}, {12, 3, 2, 3}};
  return all;
}

/// Texts from left to right, line by line.
class Legend {
 public:
  Legend(Picture& picture, double y) : picture_(picture), y_(y) {}

  void text(const std::string& text, const std::string& id) {
    room_for(text_width(text, kTextSize));
    label(text);
    picture_.marks.back().id = id;
  }

  void line(const Pen& pen, const std::string& text) { swatch(text, line_mark({0, 0}, {kSwatch, 0}, pen)); }

  /// A little bar, as links are drawn.
  void link(const std::string& text) {
    constexpr double kHeight = 8;
    Mark bar = box_mark({0, -kHeight / 2}, {kSwatch, kHeight}, Ink::faint, {Ink::line, 1.3});
    std::get<Box>(bar.shape).rounding = kHeight / 2;
    swatch(text, bar);
  }

  bool any() const { return any_; }
  double bottom() const { return y_ + 4; }

 private:
  static constexpr double kLine = 20, kSwatch = 26, kGap = 22, kAfterSwatch = 6;

  void swatch(const std::string& text, const Mark& mark) {
    room_for(kSwatch + kAfterSwatch + text_width(text, kTextSize));
    picture_.marks.push_back(placed(mark, {x_, y_ - 4}, 0));
    x_ += kSwatch + kAfterSwatch;
    label(text);
  }

  void room_for(double width) {
    if (any_ && x_ + width > picture_.width - kHeadMargin) {
      x_ = kHeadMargin;
      y_ += kLine;
    }
    any_ = true;
  }

  void label(const std::string& text) {
    picture_.marks.push_back(label_mark({x_, y_}, text, Anchor::start, kTextSize));
    x_ += text_width(text, kTextSize) + kGap;
  }

  Picture& picture_;
  double x_ = kHeadMargin, y_;
  bool any_ = false;
};

}  // namespace

Pen trace_pen(const LinkageScene& scene, std::size_t k) {
  std::vector<Ink> inks(std::begin(kAccents), std::end(kAccents));
  if (scene.analog) std::erase(inks, kAnalogInk);
  return {inks[k % inks.size()], 2, dashes()[k % dashes().size()]};
}

Pen analog_trace_pen(std::size_t k) {
  return {kAnalogInk, 1.2, dashes()[k % dashes().size()]};
}

double add_linkage_head(Picture& picture, const mechanism::Mechanism& mechanism, const LinkageScene& scene) {
  constexpr double kTitleSize = 17, kTitleBase = 30, kToText = 16, kTop = 12;
  double bottom = kTop;
  if (!picture.title.empty()) {
    Label title{{kHeadMargin, kTitleBase}, picture.title, Anchor::start, kTitleSize, true};
    const double room = picture.width - 2 * kHeadMargin;
    title.size = std::min(kTitleSize, kTitleSize * room / text_width(title.text, kTitleSize, true));
    picture.marks.push_back({title, {Ink::none, 0}, Ink::line});
    bottom = kTitleBase + 6;
  }
  Legend legend(picture, bottom + kToText);
  if (!scene.caption.empty()) legend.text(scene.caption, "caption");
  if (scene.analog) {
    legend.link("exact");
    legend.line({kAnalogInk, 2}, scene.analog->legend);
  }
  for (std::size_t k = 0; k < scene.traces.size(); ++k)
    legend.line(trace_pen(scene, k), "path of " + mechanism.points[scene.traces[k]].name);
  if (scene.analog && !scene.analog->caption.empty()) legend.text(scene.analog->caption, "error");
  return legend.any() ? legend.bottom() : bottom;
}

}  // namespace oblique::draw
