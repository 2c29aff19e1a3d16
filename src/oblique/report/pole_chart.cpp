// SPDX-License-Identifier: MIT
#include <oblique/report/pole_chart.h>

#include <algorithm>
#include <array>

#include <oblique/solve/stability/poles_along.h>

namespace oblique::report {
namespace {

constexpr double kPoleHeight = 220;  // [px]

}  // namespace

draw::Chart pole_chart(const diagram::FlatDiagram& diagram, const network::Program& program,
                       const std::vector<solve::Instant>& instants, const std::string& title) {
  std::array<draw::Curve, 2> kinds{draw::Curve{"", {}, 0, draw::Curve::Style::marks},
                                   draw::Curve{"", {}, 1, draw::Curve::Style::marks}};
  for (const solve::PoleAt& pole : solve::poles_along(diagram, program, instants)) {
    draw::Curve& curve = kinds[pole.of_problem ? 1 : 0];
    curve.points.emplace_back(pole.value.real(), pole.value.imag());
    if (pole.value.imag() != 0) curve.points.emplace_back(pole.value.real(), -pole.value.imag());
  }
  draw::Chart chart;
  chart.title = title;
  constexpr std::array<const char*, 2> kNames{"real part, servo loops", "real part, the problem itself"};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    if (kinds[kind].points.empty()) continue;
    double highest = 0;
    for (const Eigen::Vector2d& point : kinds[kind].points) highest = std::max(highest, point.y());
    draw::Curve limit{
        "limit of stability", {{0, -highest}, {0, highest}}, draw::Curve::kPlain, draw::Curve::Style::guide};
    if (highest == 0) limit.points = {{0, -1}, {0, 1}};
    chart.panels.push_back(
        {{kNames[kind], "1/s"}, {"imaginary part", "1/s"}, {limit, kinds[kind]}, kPoleHeight});
  }
  if (chart.panels.empty())
    chart.note = "There is nothing to draw: no state acts back on itself, so that all eigenvalues are 0.";
  return chart;
}

}  // namespace oblique::report
