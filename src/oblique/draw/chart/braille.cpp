// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/braille.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <oblique/draw/chart/chart_layout.h>
#include <oblique/text/encoding.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

constexpr double kPixelsPerRow = 16;
constexpr std::size_t kMostOfName = 18;  ///< characters of a curve's name

/// Characters on a terminal, near enough: code points.
std::size_t length_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

/// The first `most` characters.
std::string cut(const std::string& text, std::size_t most) {
  std::size_t end = 0;
  for (std::size_t n = 0; end < text.size(); ++end) {
    if ((static_cast<unsigned char>(text[end]) & 0xC0U) != 0x80U && ++n > most) break;
  }
  return text.substr(0, end);
}

std::string right_aligned(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, length_of(text)), ' ') + text;
}

/// In the colour of curve `number`: that of kAccents as near as the eight of a terminal come.
std::string coloured(const std::string& text, std::optional<std::size_t> number) {
  constexpr std::array<const char*, 6> kColours{"34", "31", "32", "33", "36", "35"};
  static_assert(kColours.size() == std::size(kAccents));
  if (!number || *number == Curve::kPlain) return text;
  return std::string("\033[") + kColours[*number % kColours.size()] + "m" + text + "\033[0m";
}

/// Dots in cells of two by four.
class Dots {
 public:
  Dots(std::size_t columns, std::size_t rows)
      : columns_(columns), cells_(columns * rows), numbers_(columns * rows) {}

  std::size_t width() const { return 2 * columns_; }
  std::size_t height() const { return 4 * (cells_.size() / columns_); }

  void set(std::size_t x, std::size_t y, std::size_t number) {
    // the order of the dots in Unicode: down the left column, down the right one, then the lowest two
    constexpr unsigned char kBits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    const std::size_t cell = y / 4 * columns_ + x / 2;
    cells_[cell] = static_cast<unsigned char>(cells_[cell] | kBits[y % 4][x % 2]);
    numbers_[cell] = number;
  }

  std::string row(std::size_t r, bool colours) const {
    std::string text;
    for (std::size_t c = r * columns_; c < (r + 1) * columns_; ++c) {
      if (cells_[c] == 0) {
        text += ' ';
        continue;
      }
      // U+2800 + cell in UTF-8
      const std::string dots{'\xE2', static_cast<char>(0xA0 | (cells_[c] >> 6U)),
                             static_cast<char>(0x80 | (cells_[c] & 0x3FU))};
      text += coloured(dots, colours ? std::optional(numbers_[c]) : std::nullopt);
    }
    return text;
  }

 private:
  std::size_t columns_;
  std::vector<unsigned char> cells_;
  std::vector<std::size_t> numbers_;  ///< of the curve last drawn through each cell
};

class PanelText {
 public:
  PanelText(const Panel& panel, const PanelScales& scales, std::size_t label_width, std::size_t columns)
      : panel_(panel),
        x_(scales.x),
        y_(scales.y),
        label_width_(label_width),
        plot_columns_(columns - label_width - 2 - name_width()),
        plot_rows_(static_cast<std::size_t>(std::max(6.0, panel.height / kPixelsPerRow))),
        dots_(plot_columns_, plot_rows_) {
    if (panel.equal) equalise();
    for (const Curve& curve : panel.curves) {
      if (!is_drawn(curve)) continue;
      const auto style = curve.style == Curve::Style::band ? Curve::Style::guide : curve.style;
      draw(curve.points, style, curve.number);
      draw(curve.other_edge, style, curve.number);
    }
  }

  std::string text(bool shows_x, bool colours) const {
    std::string text = y_.title() + "\n";
    std::vector<std::string> labels(plot_rows_);
    for (const Tick& tick : y_.ticks(std::floor(static_cast<double>(plot_rows_) / 3))) {
      if (!tick.label.empty()) labels[row_of(tick.value)] = tick.label;
    }
    const std::vector<const Curve*> names = names_by_row();
    for (std::size_t r = 0; r < plot_rows_; ++r) {
      std::string line = right_aligned(labels[r], label_width_) + (labels[r].empty() ? " │" : " ┤");
      line += dots_.row(r, colours);
      if (names[r] != nullptr) {
        line += " " + coloured(cut(names[r]->name, kMostOfName),
                               colours ? std::optional(names[r]->number) : std::nullopt);
      }
      line.erase(line.find_last_not_of(' ') + 1);
      text += line + "\n";
    }
    return text + (shows_x ? x_axis() : std::string());
  }

 private:
  std::size_t name_width() const {
    std::size_t width = 0;
    for (const Curve& curve : panel_.curves)
      width = std::max(width, std::min(kMostOfName, length_of(curve.name)));
    return width == 0 ? 0 : width + 1;
  }

  void equalise() {
    const double unit = std::max((x_.high() - x_.low()) / static_cast<double>(dots_.width()),
                                 (y_.high() - y_.low()) / static_cast<double>(dots_.height()));
    x_.widen(unit * static_cast<double>(dots_.width()));
    y_.widen(unit * static_cast<double>(dots_.height()));
  }

  Vector2d dot_of(const Vector2d& point) const {
    return {x_.fraction(point.x()) * static_cast<double>(dots_.width() - 1),
            (1 - y_.fraction(point.y())) * static_cast<double>(dots_.height() - 1)};
  }
  std::size_t row_of(double y) const {
    return static_cast<std::size_t>(std::lround(dot_of({x_.low(), y}).y())) / 4;
  }

  /// There is no room for bands within bands: the first is drawn, by its edges.
  bool is_drawn(const Curve& curve) const {
    return curve.style != Curve::Style::band ||
           &curve == &*std::find_if(panel_.curves.begin(), panel_.curves.end(),
                                    [](const Curve& c) { return c.style == Curve::Style::band; });
  }

  void draw(const std::vector<Vector2d>& points, Curve::Style style, std::size_t number) {
    std::optional<Vector2d> last;
    std::size_t drawn = 0;
    for (const Vector2d& point : points) {
      if (!x_.shows(point.x()) || !y_.shows(point.y())) {
        last.reset();
        continue;
      }
      const Vector2d here = dot_of(point);
      if (!last || style == Curve::Style::marks) last = here;
      const Vector2d way = here - *last;
      const int steps = std::max(1, static_cast<int>(std::ceil(way.cwiseAbs().maxCoeff())));
      for (int k = 1; k <= steps; ++k) {
        const Vector2d dot = *last + way * (static_cast<double>(k) / steps);
        const bool left_out = style == Curve::Style::guide && drawn++ % 4 >= 2;
        if (left_out) continue;
        dots_.set(static_cast<std::size_t>(std::lround(dot.x())),
                  static_cast<std::size_t>(std::lround(dot.y())), number);
      }
      last = here;
    }
  }

  /// Each curve's name in the row of its last point, or as near to it as there is room.
  std::vector<const Curve*> names_by_row() const {
    std::vector<const Curve*> names(plot_rows_, nullptr);
    for (const Curve& curve : panel_.curves) {
      const auto last = std::find_if(curve.points.rbegin(), curve.points.rend(),
                                     [&](const Vector2d& p) { return x_.shows(p.x()) && y_.shows(p.y()); });
      if (curve.name.empty() || !is_drawn(curve) || last == curve.points.rend()) continue;
      const std::size_t wanted = row_of(last->y());
      for (std::size_t off = 0; off < plot_rows_; ++off) {
        if (wanted + off < plot_rows_ && names[wanted + off] == nullptr) {
          names[wanted + off] = &curve;
          break;
        }
        if (off <= wanted && names[wanted - off] == nullptr) {
          names[wanted - off] = &curve;
          break;
        }
      }
    }
    return names;
  }

  /// The line with its ticks, their numbers, the title.
  std::string x_axis() const {
    std::vector<std::string> line(plot_columns_, "─");
    std::string numbers(label_width_ + 1, ' ');
    std::size_t used = numbers.size();
    for (const Tick& tick : x_.ticks(std::floor(static_cast<double>(plot_columns_) / 10))) {
      if (tick.label.empty()) continue;
      const auto column = static_cast<std::size_t>(std::lround(dot_of({tick.value, y_.low()}).x())) / 2;
      line[column] = "┬";
      const std::size_t length = length_of(tick.label), centre = label_width_ + 2 + column;
      const std::size_t end = label_width_ + 2 + plot_columns_ + name_width();
      std::size_t start = centre - std::min(centre, length / 2);
      start = std::min(start, end - length);
      if (start < used) continue;
      numbers += std::string(start - used, ' ') + tick.label;
      used = start + length + 1;
      numbers += ' ';
    }
    numbers.erase(numbers.find_last_not_of(' ') + 1);
    std::string text = std::string(label_width_ + 1, ' ') + "└";
    for (const std::string& part : line) text += part;
    const std::string title = x_.title();
    const std::size_t middle = label_width_ + 2 + plot_columns_ / 2;
    const std::size_t before = middle - std::min(middle, length_of(title) / 2);
    return text + "\n" + numbers + "\n" + std::string(before, ' ') + title + "\n";
  }

  const Panel& panel_;
  Scale x_, y_;
  std::size_t label_width_, plot_columns_, plot_rows_;
  Dots dots_;
};

/// The colours are the only escapes.
Chart with_visible_texts(Chart chart) {
  chart.title = text::visible(chart.title);
  chart.note = text::visible(chart.note);
  for (Panel& panel : chart.panels) {
    for (Axis* axis : {&panel.x, &panel.y}) {
      axis->name = text::visible(axis->name);
      axis->unit = text::visible(axis->unit);
    }
    for (Curve& curve : panel.curves) curve.name = text::visible(curve.name);
  }
  return chart;
}

}  // namespace

std::string to_braille(const Chart& chart, std::size_t columns, bool colours) {
  const Chart shown = with_visible_texts(chart);
  columns = std::max(columns, kFewestColumns);
  const std::vector<PanelScales> scales = scales_of(shown);
  std::size_t label_width = 0;
  for (const PanelScales& both : scales) {
    for (const Tick& tick : both.y.ticks(8)) label_width = std::max(label_width, length_of(tick.label));
  }
  const auto in_lines = [&](const std::string& words) {
    std::string lines;
    for (const std::string& line :
         wrapped(words, [&](const auto& part) { return length_of(part) <= columns; }))
      lines += cut(line, columns) + "\n";
    return lines;
  };
  std::string text = in_lines(shown.title);
  for (std::size_t p = 0; p < shown.panels.size(); ++p) {
    if (!text.empty()) text += "\n";
    text +=
        PanelText(shown.panels[p], scales[p], label_width, columns).text(shows_x_numbers(shown, p), colours);
  }
  if (!shown.note.empty()) text += "\n" + in_lines(shown.note);
  return text;
}

}  // namespace oblique::draw
