// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/mobility_report.h>

#include <algorithm>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {
namespace {

std::string quoted_bodies(const Mechanism& mechanism, const std::vector<std::size_t>& bodies) {
  std::vector<std::string> names;
  names.reserve(bodies.size());
  for (const std::size_t body : bodies) names.push_back("'" + mechanism.bodies[body].name + "'");
  return fmt::format("{} {}", names.size() == 1 ? "body" : "bodies", fmt::join(names, ", "));
}

/// Points that only one link names and frame points that none names: where a revolute joint may have been
/// meant.
std::string loose_ends(const Mechanism& mechanism) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < mechanism.points.size(); ++i) {
    const std::size_t needed = mechanism.points[i].fixed ? 1 : 2;
    const bool slides = std::any_of(mechanism.slides.begin(), mechanism.slides.end(), [&](const Slide& s) {
      return s.point == i || s.first == i || s.second == i;
    });
    if (mechanism.bodies_at(i).size() < needed && !slides) names.push_back(mechanism.points[i].name);
  }
  if (names.empty()) return {};
  return fmt::format("; no joint at {}: is a name misspelt?", fmt::join(names, ", "));
}

/// "3·3 bodies − 2·3 revolute joints − 1 slide".
std::string mobility_formula(const Mechanism& mechanism) {
  int slides = 0;
  for (const Slide& slide : mechanism.slides) slides += slide.of ? 2 : 1;
  const int bodies = static_cast<int>(mechanism.bodies.size());
  const int revolutes = (3 * bodies - slides - mobility(mechanism)) / 2;
  std::string text = fmt::format("3·{} bodies − 2·{} revolute joints", bodies, revolutes);
  if (slides > 0) text += fmt::format(" − {} for slides", slides);
  return text;
}

std::vector<std::size_t> bodies_among(const ConstraintGraph& graph,
                                      const std::vector<std::size_t>& vertices) {
  std::vector<std::size_t> bodies;
  for (const std::size_t v : vertices) {
    if (graph.is_body(v)) bodies.push_back(v);
  }
  return bodies;
}

}  // namespace

void check_mobility(const Mechanism& mechanism) {
  const int freedom = mobility(mechanism);
  const int drives = static_cast<int>(mechanism.drives.size());
  if (freedom == drives) return;
  text::Diagnostic finding;
  finding.place = drives > 0 ? mechanism.drives.back().place : mechanism.bodies.front().place;
  finding.what = fmt::format("the mechanism has mobility {} ({}) but {} {}", freedom,
                             mobility_formula(mechanism), drives, drives == 1 ? "drive" : "drives");
  finding.expected = "one drive for each degree of freedom";
  if (freedom > drives) {
    finding.remedy = fmt::format("under-driven: add {} or join bodies by revolute joints",
                                 freedom - drives == 1 ? "a drive" : "drives") +
                     loose_ends(mechanism);
  } else {
    finding.remedy = freedom < 0 ? "over-constrained: leave out bodies or joints"
                                 : "over-driven: leave out drives or superfluous joints";
  }
  throw MechanismError(MechanismError::Kind::mobility, std::move(finding));
}

void check_parts(const Mechanism& mechanism, const ConstraintGraph& graph) {
  std::vector<text::Diagnostic> findings;
  std::vector<std::tuple<ConstraintGraph::Edge::Kind, std::size_t, std::size_t>> told;
  for (const std::size_t index : graph.redundant()) {
    const ConstraintGraph::Edge& edge = graph.edges()[index];
    const std::tuple pair(edge.kind, edge.index, edge.point);
    if (std::find(told.begin(), told.end(), pair) != told.end()) continue;
    told.push_back(pair);
    auto others = bodies_among(graph, graph.competitors(index));
    text::Diagnostic finding;
    const auto follows = [&](const std::string& what) {
      return fmt::format("{} superfluous: {} fix it already", what, quoted_bodies(mechanism, others));
    };
    switch (edge.kind) {
      case ConstraintGraph::Edge::Kind::revolute:
        std::erase(others, edge.index);
        finding.place = mechanism.bodies[edge.index].place;
        finding.what = fmt::format(
            "body '{}' is over-constrained: its revolute joint at '{}' is superfluous, since {} fix it "
            "already",
            mechanism.bodies[edge.index].name, mechanism.points[edge.point].name,
            others.empty() ? "its other points" : quoted_bodies(mechanism, others));
        finding.remedy = "leave the body out, or remove another joint or drive of these bodies";
        break;
      case ConstraintGraph::Edge::Kind::on_line:
      case ConstraintGraph::Edge::Kind::angle:
        finding.place = mechanism.slides[edge.index].place;
        finding.what = follows(fmt::format("slide '{}' is", mechanism.slides[edge.index].name));
        finding.remedy = "leave the slide out, or remove another joint or drive of these bodies";
        break;
      case ConstraintGraph::Edge::Kind::turn:
      case ConstraintGraph::Edge::Kind::along:
        finding.place = mechanism.drives[edge.index].place;
        finding.what = follows(fmt::format("drive '{}' is", mechanism.drives[edge.index].name));
        finding.remedy = "drive another body";
        break;
    }
    findings.push_back(std::move(finding));
  }
  if (graph.freedom() > 0) {
    const auto bodies = bodies_among(graph, graph.movable());
    text::Diagnostic finding;
    finding.place = mechanism.bodies[bodies.empty() ? 0 : bodies.front()].place;
    finding.what = fmt::format("{} can move freely (mobility {} after the drives)",
                               quoted_bodies(mechanism, bodies), graph.freedom());
    finding.expected = "every body held by drives and pairs";
    finding.remedy = "join to the rest, or drive" + loose_ends(mechanism);
    findings.push_back(std::move(finding));
  }
  if (!findings.empty()) throw MechanismError(MechanismError::Kind::mobility, std::move(findings));
}

}  // namespace oblique::mechanism
