// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/draw/picture/picture.h>

#include "../../support/process.h"
#include "../../support/scratch_folder.h"

// What the tests of --plot and report share.
namespace oblique::test {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

/// A picture as it was written. (std::regex would recurse as deep as a path is long.)
class Svg {
 public:
  explicit Svg(std::string text) : text_(std::move(text)) {}

  AlignedBox2d plot(int panel) const {
    const std::string element = with_id("plot-" + std::to_string(panel));
    const Vector2d corner(number(element, "x"), number(element, "y"));
    return {corner, Vector2d(corner + Vector2d(number(element, "width"), number(element, "height")))};
  }

  std::vector<Vector2d> curve(int panel, int index) const {
    std::string path =
        attribute(with_id("curve-" + std::to_string(panel) + "-" + std::to_string(index)), "d");
    for (char& c : path) {
      if (c == 'M' || c == 'L') c = ' ';
    }
    std::istringstream numbers(path);
    std::vector<Vector2d> points;
    for (double x = 0, y = 0; numbers >> x >> y;) points.emplace_back(x, y);
    return points;
  }

  std::vector<draw::Label> labels() const {
    std::vector<draw::Label> labels;
    for (const std::string& element : elements("<text ")) {
      const std::size_t end = element.find('>');
      draw::Label label{{number(element, "x"), number(element, "y")},
                        unescaped(element.substr(end + 1, element.find('<', end) - end - 1)),
                        draw::Anchor::start,
                        number(element, "font-size")};
      if (element.find("\"middle\"") != std::string::npos) label.anchor = draw::Anchor::middle;
      if (element.find("\"end\"") != std::string::npos) label.anchor = draw::Anchor::end;
      label.bold = element.find("\"bold\"") != std::string::npos;
      labels.push_back(label);
    }
    return labels;
  }

  std::vector<Vector2d> discs() const {
    std::vector<Vector2d> centres;
    for (const std::string& element : elements("<circle "))
      centres.emplace_back(number(element, "cx"), number(element, "cy"));
    return centres;
  }

  int panels() const {
    int count = 0;
    while (text_.find("id=\"plot-" + std::to_string(count) + "\"") != std::string::npos) ++count;
    return count;
  }

  /// The class of the stroke's colour.
  std::string ink_of(int panel, int number) const {
    const std::string classes =
        attribute(with_id("curve-" + std::to_string(panel) + "-" + std::to_string(number)), "class");
    return classes.substr(classes.find(" s-"));
  }

  Vector2d size() const { return {number(text_, "width"), number(text_, "height")}; }

 private:
  static std::string unescaped(std::string text) {
    const std::pair<const char*, const char*> kEntities[] = {
        {"&#39;", "'"}, {"&quot;", "\""}, {"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}};
    for (const auto& [entity, letter] : kEntities) {
      for (std::size_t at; (at = text.find(entity)) != std::string::npos;)
        text.replace(at, std::string(entity).size(), letter);
    }
    return text;
  }

  /// The lines that begin so: the writer puts an element on each.
  std::vector<std::string> elements(const std::string& head) const {
    std::vector<std::string> found;
    std::istringstream stream(text_);
    for (std::string line; std::getline(stream, line);) {
      if (line.starts_with(head)) found.push_back(line);
    }
    return found;
  }
  std::string with_id(const std::string& id) const {
    for (const char* head : {"<path ", "<rect "}) {
      for (const std::string& element : elements(head)) {
        if (element.find(" id=\"" + id + "\"") != std::string::npos) return element;
      }
    }
    throw std::runtime_error("there is no " + id);
  }
  static std::string attribute(const std::string& element, const std::string& name) {
    const std::size_t begin = element.find(" " + name + "=\"") + name.size() + 3;
    return element.substr(begin, element.find('"', begin) - begin);
  }
  static double number(const std::string& element, const std::string& name) {
    return std::stod(attribute(element, name));
  }

  std::string text_;
};

/// A folder of its own, and the program.
class PlotTest : public ::testing::Test {
 protected:
  PlotTest() : folder_(make_scratch_folder()) { std::filesystem::create_directories(folder_); }
  ~PlotTest() override { std::filesystem::remove_all(folder_); }

  static Outcome oblique(const std::string& arguments) {
    return run_command("oblique " + arguments, OBLIQUE_SOURCE_DIR);
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  std::string bytes_of(const std::string& name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  Svg drawn(const std::string& arguments) const {
    const Outcome outcome = oblique(arguments + " --plot " + file("plot.svg"));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Svg(bytes_of("plot.svg"));
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace oblique::test
