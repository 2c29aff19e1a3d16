// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/report/pole_chart.h>

#include <algorithm>
#include <array>

namespace oblique::report {
namespace {

constexpr double kPoleHeight = 220;  // [px]

}  // namespace

draw::Chart pole_chart(const diagram::FlatDiagram& diagram, const network::Program& program,
                       const std::vector<solve::Instant>& instants, const std::string& title) {
  std::array<draw::Curve, 2> kinds{draw::Curve{"", {}, 0, draw::Curve::Style::marks},
                                   draw::Curve{"", {}, 1, draw::Curve::Style::marks}};
  const auto groups = solve::coupled_groups(program);
  solve::IdealMachine ideal(diagram, program);
  network::Workspace workspace(program);
  for (const solve::Instant& instant : instants) {
    const auto linear = solve::Linearisation::at(program, workspace, instant);
    if (!linear) continue;
    ideal.look_at(instant, workspace);
    for (const auto& group : groups) {
      if (group.size() > solve::kMostStatesForModes) continue;
      const std::vector<solve::Mode> modes = solve::modes_of(linear->block(group), group);
      const auto of_the_problem = ideal.problem_modes(group, modes);
      for (std::size_t m = 0; m < modes.size(); ++m) {
        const solve::Mode& mode = modes[m];
        draw::Curve& curve = kinds[of_the_problem[m] ? 1 : 0];
        curve.points.emplace_back(mode.pole.real(), mode.pole.imag());
        if (mode.pole.imag() != 0) curve.points.emplace_back(mode.pole.real(), -mode.pole.imag());
      }
    }
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
