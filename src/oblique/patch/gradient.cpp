// SPDX-License-Identifier: MIT
// Mechanism → diagram by the gradient servo.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include <oblique/patch/patch_builder.h>

namespace oblique {
namespace {

/// A condition g = Σ weight · a · b + rest = 0 [machine unit], whose forms a, b stay within ±1.
struct Residual {
  struct Product {
    double weight;
    std::size_t a, b;  ///< indices in `forms`
  };
  std::string name;
  std::string comment;
  std::vector<std::pair<std::string, LinearForm>> forms;  ///< with the names of their blocks
  std::vector<Product> products;
  LinearForm rest;
};

class GradientPatch : private PatchBuilder {
 public:
  GradientPatch(const Mechanism& mechanism, const PatchOptions& options) : PatchBuilder(mechanism, options) {
    if (!std::isfinite(options.gain * bandwidth_)) {
      throw PatchError(Diagnostic{{mechanism.file, {}},
                                  "a gradient servo of infinite gain has no time scale",
                                  "a finite --gain and --bandwidth",
                                  {}});
    }
    rate_ = options.gain * 2 * std::numbers::pi * bandwidth_;
  }

  Diagram make() {
    describe(
        "patched as gradient servos",
        fmt::format(
            "Each unknown coordinate is an integrator that runs down the gradient of the squared\n"
            "conditions of its group, at K = {:.6g} 1/s (gain {} times the bandwidth of {} Hz). Run over "
            "one turn of '{}'.",
            rate_, options_.gain, bandwidth_, mechanism_.drives.front().name));
    add_reference();
    start_ = start_configuration(mechanism_, structure_);
    for (const Group& group : structure_.groups) {
      if (group.kind == GroupKind::crank) {
        add_crank(group);
        for (const std::size_t point : group.points) set_known(point);
      } else {
        add_group(group);
      }
    }
    add_outputs();
    return std::move(diagram_);
  }

 private:
  void add_group(const Group& group) {
    residuals_.clear();
    unknowns_.clear();
    std::vector<std::size_t> left = group.bodies;
    for (const std::size_t slide : group.slides) {  // a point that slides by itself
      const std::size_t point = mechanism_.slides[slide].point;
      if (group.bodies.empty() && !points_[point]) add_unknown(point);
    }
    while (!left.empty()) {  // the body first of which most is known
      const auto next = std::max_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
        return known_count(a) < known_count(b);
      });
      add_body(group, *next);
      left.erase(next);
    }
    for (const std::size_t s : group.slides) add_slide(mechanism_.slides[s]);
    for (const std::size_t d : group.drives) add_drive(group, d);
    const std::size_t first = diagram_.blocks.size();
    write();
    if (first < diagram_.blocks.size()) {
      diagram_.blocks[first].comment =
          fmt::format("group {} ({}): {} conditions for {} coordinates{}{}", group.name,
                      kind_name(group.kind), residuals_.size(), unknowns_.size(),
                      diagram_.blocks[first].comment.empty() ? "" : "\n", diagram_.blocks[first].comment);
    }
    for (const std::size_t point : group.points) {
      if (signals_[point].x.empty()) {
        add_summed_point(point, terms_of(points_[point]->x), terms_of(points_[point]->y), {});
      }
      set_known(point);
    }
  }

  std::size_t known_count(std::size_t body) const {
    const auto& points = mechanism_.bodies[body].points;
    return static_cast<std::size_t>(std::count_if(
        points.begin(), points.end(), [&](const BodyPoint& p) { return points_[p.point].has_value(); }));
  }

  void add_unknown(std::size_t point) {
    signals_[point] = {free_name(name_of(point) + "_x"), free_name(name_of(point) + "_y")};
    unknowns_.push_back({signals_[point].x, scaled(start_.points[point].position.x() - scaling_.origin.x())});
    unknowns_.push_back({signals_[point].y, scaled(start_.points[point].position.y() - scaling_.origin.y())});
    VectorForm form;
    form.x.weights[signals_[point].x] = 1;
    form.y.weights[signals_[point].y] = 1;
    points_[point] = form;
  }

  /// How much a point matters to others: the bodies of the group and the slides that use it.
  long uses(const Group& group, std::size_t point) const {
    return std::count_if(group.bodies.begin(), group.bodies.end(),
                         [&](std::size_t body) { return mechanism_.bodies[body].find(point) != nullptr; }) +
           std::count_if(group.slides.begin(), group.slides.end(),
                         [&](std::size_t s) { return mechanism_.slides[s].point == point; });
  }

  /// Two points stand for a body, at their distance; the others follow from them.
  void add_body(const Group& group, std::size_t index) {
    const Body& body = mechanism_.bodies[index];
    std::vector<BodyPoint> order = body.points;
    std::stable_sort(order.begin(), order.end(), [&](const BodyPoint& a, const BodyPoint& b) {
      const bool known_a = points_[a.point].has_value(), known_b = points_[b.point].has_value();
      return known_a != known_b ? known_a : uses(group, a.point) > uses(group, b.point);
    });
    const BodyPoint p = order[0], c = order[1];
    for (const BodyPoint& base : {p, c}) {
      if (!points_[base.point]) add_unknown(base.point);
    }
    const double r = scaled((c.local - p.local).norm());
    const VectorForm& at_p = *points_[p.point];
    const VectorForm& at_c = *points_[c.point];
    Residual distance;
    distance.name = body.name;
    distance.comment = fmt::format("|{}{}| = {:.6g} {}", name_of(p.point), name_of(c.point),
                                   r * scaling_.length, mechanism_.length_unit);
    distance.forms = {{body.name + "_dx", combined({{1 / r, &at_c.x}, {-1 / r, &at_p.x}})},
                      {body.name + "_dy", combined({{1 / r, &at_c.y}, {-1 / r, &at_p.y}})}};
    distance.products = {{r / 2, 0, 0}, {r / 2, 1, 1}};
    distance.rest.constant = -r / 2;
    residuals_.push_back(std::move(distance));
    bases_[index] = {p, c};
    for (std::size_t i = 2; i < order.size(); ++i) {
      const VectorForm follows = point_of(index, order[i].local);
      std::optional<VectorForm>& there = points_[order[i].point];
      if (!there) {
        there = follows;
        continue;
      }
      for (const bool is_x : {true, false}) {
        Residual hinge;
        hinge.name = fmt::format("{}_{}{}", body.name, name_of(order[i].point), is_x ? "x" : "y");
        hinge.comment = fmt::format("{} carries {}", body.name, name_of(order[i].point));
        hinge.rest = is_x ? combined({{1, &follows.x}, {-1, &there->x}})
                          : combined({{1, &follows.y}, {-1, &there->y}});
        residuals_.push_back(std::move(hinge));
      }
    }
  }

  /// The largest distance of a slide's point from where its line begins, over the motion: it scales the
  /// products.
  double reach_of(const Slide& slide) const {
    const std::size_t s = static_cast<std::size_t>(&slide - mechanism_.slides.data());
    return round_up(scaled(std::max(scaling_.slides[s] + std::abs(slide.offset), scaling_.length / 1000)));
  }

  /// g = n·(P − A), or along the line u·(P − A).
  Residual offset_of(const Slide& slide, const std::string& name, bool along) {
    const LineForm line = line_form(slide.carrier, line_of(mechanism_, slide));
    const VectorForm& point = *points_[slide.point];
    const double reach = reach_of(slide);
    const LinearForm dx = combined({{1 / reach, &point.x}, {-1 / reach, &line.at.x}});
    const LinearForm dy = combined({{1 / reach, &point.y}, {-1 / reach, &line.at.y}});
    Residual residual;
    residual.name = name;
    if (!slide.carrier) {  // a line of the frame: the condition is linear
      const double ux = line.direction.x.constant, uy = line.direction.y.constant;
      residual.rest = along ? combined({{reach * ux, &dx}, {reach * uy, &dy}})
                            : combined({{reach * ux, &dy}, {-reach * uy, &dx}});
      return residual;
    }
    residual.forms = {{name + "_ux", line.direction.x},
                      {name + "_uy", line.direction.y},
                      {name + "_dx", dx},
                      {name + "_dy", dy}};
    if (along) {
      residual.products = {{reach, 0, 2}, {reach, 1, 3}};
    } else {
      residual.products = {{reach, 0, 3}, {-reach, 1, 2}};
    }
    return residual;
  }

  void add_slide(const Slide& slide) {
    Residual on_line = offset_of(slide, slide.name, false);
    on_line.comment = fmt::format("{} stays on the line of {}", name_of(slide.point), slide.name);
    residuals_.push_back(std::move(on_line));
    if (!slide.of) return;
    const VectorForm guided =
        direction_of(*slide.of, Eigen::Vector2d(std::cos(slide.angle), -std::sin(slide.angle)));
    const LineForm line = line_form(slide.carrier, line_of(mechanism_, slide));
    const double size = scaled(largest_of(*slide.of));
    Residual angle;
    angle.name = slide.name + "_angle";
    angle.comment = fmt::format("{} keeps its angle", mechanism_.bodies[*slide.of].name);
    if (!slide.carrier) {
      angle.rest = combined(
          {{size * line.direction.x.constant, &guided.y}, {-size * line.direction.y.constant, &guided.x}});
    } else {
      angle.forms = {{angle.name + "_ux", line.direction.x},
                     {angle.name + "_uy", line.direction.y},
                     {angle.name + "_vx", guided.x},
                     {angle.name + "_vy", guided.y}};
      angle.products = {{size, 0, 3}, {-size, 1, 2}};
    }
    residuals_.push_back(std::move(angle));
  }

  double largest_of(std::size_t body) const {
    double largest = 0;
    for (const BodyPoint& p : mechanism_.bodies[body].points) largest = std::max(largest, p.local.norm());
    return largest;
  }

  void add_drive(const Group& group, std::size_t d) {
    const Drive& drive = mechanism_.drives[d];
    if (drive.slide) {
      const Slide& slide = mechanism_.slides[*drive.slide];
      const std::string way = add_block(
          drive.name, "integrator",
          {wire_setting("in", {{scaled(drive.speed), one_}}), number_setting("initial", scaled(drive.start))},
          fmt::format("drive {}: {:.6g} {}/s along {}", drive.name, drive.speed, mechanism_.length_unit,
                      slide.name));
      Residual along = offset_of(slide, drive.name + "_along", true);
      along.comment = fmt::format("{} stands where {} says", name_of(slide.point), drive.name);
      along.rest.weights[way] -= 1;
      residuals_.push_back(std::move(along));
      return;
    }
    const std::string generator =
        add_block(drive.name, "crank-generator",
                  {wire_setting("speed", {{1, one_}}), number_setting("rate", drive.speed),
                   number_setting("start", drive.start)},
                  fmt::format("drive {} turns {} inside the group {}", drive.name,
                              mechanism_.bodies[drive.body].name, group.name));
    const VectorForm axis = direction_of(drive.body, Eigen::Vector2d::UnitX());
    const double size = scaled(largest_of(drive.body));
    for (const bool is_x : {true, false}) {
      Residual turned;
      turned.name = fmt::format("{}_{}", drive.name, is_x ? "x" : "y");
      turned.comment =
          fmt::format("{} has the direction of {}", mechanism_.bodies[drive.body].name, drive.name);
      turned.rest = combined({{size, is_x ? &axis.x : &axis.y}});
      turned.rest.weights[generator + (is_x ? ".cos" : ".sin")] -= size;
      residuals_.push_back(std::move(turned));
    }
  }

  static double slope(const LinearForm& form, const std::string& unknown) {
    const auto found = form.weights.find(unknown);
    return found == form.weights.end() ? 0 : found->second;
  }

  /// The blocks of the residuals, then the integrators that they drive.
  void write() {
    std::map<std::string, Terms> descents;  // of each unknown
    for (const Residual& residual : residuals_) write(residual, descents);
    for (const auto& [name, initial] : unknowns_) {
      BlockInstance block;
      block.name = name;
      block.type = "integrator";
      block.settings = {wire_setting("in", descents[name]), number_setting("rate", rate_),
                        number_setting("initial", initial)};
      diagram_.blocks.push_back(std::move(block));
    }
  }

  void write(const Residual& residual, std::map<std::string, Terms>& descents) {
    std::vector<std::string> forms;
    for (const auto& [name, form] : residual.forms)
      forms.push_back(add_block(name, "summer", {sum_of(terms_of(form))},
                                forms.empty() ? residual.comment : std::string()));
    Terms sum = terms_of(residual.rest);
    if (sum.size() == 1 && sum.front().weight == 0) sum.clear();
    for (const Residual::Product& product : residual.products) {
      const std::string block = add_block(
          product.a == product.b ? forms[product.a] + "2" : forms[product.a] + "_" + forms[product.b],
          "multiplier", {wire_setting("in", {{1, forms[product.a]}, {1, forms[product.b]}})});
      sum.push_back({product.weight, block});
    }
    const std::string gap = add_block(residual.name + "_gap", "summer", {wire_setting("in", sum)},
                                      forms.empty() ? residual.comment : std::string());
    std::map<std::size_t, std::string> pulls;  // gap · form
    for (const auto& [unknown, initial] : unknowns_) {
      std::map<std::size_t, double> weights;
      for (const Residual::Product& product : residual.products) {
        weights[product.a] += product.weight * slope(residual.forms[product.b].second, unknown);
        weights[product.b] += product.weight * slope(residual.forms[product.a].second, unknown);
      }
      for (const auto& [form, weight] : weights) {
        if (weight == 0) continue;
        if (!pulls.contains(form)) {
          pulls[form] = add_block(residual.name + "_pull_" + std::to_string(form + 1), "multiplier",
                                  {wire_setting("in", {{1, gap}, {1, forms[form]}})});
        }
        descents[unknown].push_back({-weight, pulls[form]});
      }
      if (const double direct = slope(residual.rest, unknown); direct != 0)
        descents[unknown].push_back({-direct, gap});
    }
  }

  double rate_ = 0;  ///< K [1/s]
  Configuration start_;
  std::vector<Residual> residuals_;                       ///< of the present group
  std::vector<std::pair<std::string, double>> unknowns_;  ///< its signals and where they start
};

}  // namespace

Diagram patch_gradient(const Mechanism& mechanism, const PatchOptions& options) {
  return GradientPatch(mechanism, options).make();
}

}  // namespace oblique
