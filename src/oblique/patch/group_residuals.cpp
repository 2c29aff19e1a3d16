// SPDX-License-Identifier: MIT
#include <oblique/patch/group_residuals.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/patch/unit_vector.h>

namespace oblique::patch {
namespace {

class GroupResiduals {
 public:
  GroupResiduals(const mechanism::Group& group, PointBook& places, const Scaling& scaling,
                 const std::vector<DriveForms>& drives, const GiveSignals& give_signals)
      : group_(group),
        places_(places),
        mechanism_(places.mechanism()),
        scaling_(scaling),
        drives_(drives),
        give_signals_(give_signals) {}

  std::vector<Residual> run() {
    std::vector<std::size_t> left = group_.bodies;
    for (const std::size_t slide : group_.slides) {  // a point that slides by itself
      const std::size_t point = mechanism_.slides[slide].point;
      if (group_.bodies.empty() && !places_.has(point)) give_signals_(point);
    }
    while (!left.empty()) {  // the link first of which most is known
      const auto next = std::max_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
        return known_count(a) < known_count(b);
      });
      add_body(*next);
      left.erase(next);
    }
    for (const std::size_t s : group_.slides) add_slide(mechanism_.slides[s]);
    for (const std::size_t d : group_.drives) add_drive(d);
    return std::move(residuals_);
  }

 private:
  std::size_t known_count(std::size_t body) const {
    const auto& points = mechanism_.bodies[body].points;
    return static_cast<std::size_t>(std::count_if(
        points.begin(), points.end(), [&](const mechanism::BodyPoint& p) { return places_.has(p.point); }));
  }

  /// How much a point matters to others: the links of the group and the prismatic joints that use it.
  long uses(std::size_t point) const {
    return std::count_if(group_.bodies.begin(), group_.bodies.end(),
                         [&](std::size_t body) { return mechanism_.bodies[body].find(point) != nullptr; }) +
           std::count_if(group_.slides.begin(), group_.slides.end(),
                         [&](std::size_t s) { return mechanism_.slides[s].point == point; });
  }

  /// Two points stand for a link, at their distance; the others follow from them.
  void add_body(std::size_t index) {
    const mechanism::Body& body = mechanism_.bodies[index];
    std::vector<mechanism::BodyPoint> order = body.points;
    std::stable_sort(order.begin(), order.end(),
                     [&](const mechanism::BodyPoint& a, const mechanism::BodyPoint& b) {
                       const bool known_a = places_.has(a.point), known_b = places_.has(b.point);
                       return known_a != known_b ? known_a : uses(a.point) > uses(b.point);
                     });
    const mechanism::BodyPoint p = order[0], c = order[1];
    for (const mechanism::BodyPoint& base : {p, c}) {
      if (!places_.has(base.point)) give_signals_(base.point);
    }
    const double r = places_.scaled((c.local - p.local).norm());
    const VectorForm& at_p = places_.at(p.point);
    const VectorForm& at_c = places_.at(c.point);
    Residual distance;
    distance.name = body.name;
    distance.comment = fmt::format("|{}{}| = {:.6g} {}", places_.name_of(p.point), places_.name_of(c.point),
                                   r * scaling_.length, mechanism_.length_unit);
    distance.forms = {{body.name + "_dx", combined({{1 / r, &at_c.x}, {-1 / r, &at_p.x}})},
                      {body.name + "_dy", combined({{1 / r, &at_c.y}, {-1 / r, &at_p.y}})}};
    distance.products = {{r / 2, 0, 0}, {r / 2, 1, 1}};
    distance.rest.constant = -r / 2;
    residuals_.push_back(std::move(distance));
    places_.set_base(index, p.point, c.point);
    for (std::size_t i = 2; i < order.size(); ++i) {
      const VectorForm follows = places_.point_of(index, order[i].local);
      if (!places_.has(order[i].point)) {
        places_.set(order[i].point, follows);
        continue;
      }
      const VectorForm& there = places_.at(order[i].point);
      for (const bool is_x : {true, false}) {
        Residual joint;
        joint.name = fmt::format("{}_{}{}", body.name, places_.name_of(order[i].point), is_x ? "x" : "y");
        joint.comment = fmt::format("{} carries {}", body.name, places_.name_of(order[i].point));
        joint.rest =
            is_x ? combined({{1, &follows.x}, {-1, &there.x}}) : combined({{1, &follows.y}, {-1, &there.y}});
        residuals_.push_back(std::move(joint));
      }
    }
  }

  /// The largest distance of a prismatic joint's point from where its line begins, over the motion: it scales
  /// the products.
  double reach_of(const mechanism::Slide& slide) const {
    const auto s = static_cast<std::size_t>(&slide - mechanism_.slides.data());
    return round_up(
        places_.scaled(std::max(scaling_.slides[s] + std::abs(slide.offset), scaling_.length / 1000)));
  }

  /// g = n·(P − A), or along the line u·(P − A).
  Residual offset_of(const mechanism::Slide& slide, const std::string& name, bool along) {
    const PointBook::LineForm line = places_.line_form(slide.carrier, mechanism::line_of(mechanism_, slide));
    const VectorForm& point = places_.at(slide.point);
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

  void add_slide(const mechanism::Slide& slide) {
    Residual on_line = offset_of(slide, slide.name, false);
    on_line.comment = fmt::format("{} stays on the line of {}", places_.name_of(slide.point), slide.name);
    residuals_.push_back(std::move(on_line));
    if (!slide.of) return;
    const VectorForm guided = places_.direction_of(*slide.of, unit_vector(-slide.angle));
    const PointBook::LineForm line = places_.line_form(slide.carrier, mechanism::line_of(mechanism_, slide));
    const double size = places_.scaled(largest_of(*slide.of));
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
    for (const mechanism::BodyPoint& p : mechanism_.bodies[body].points)
      largest = std::max(largest, p.local.norm());
    return largest;
  }

  void add_drive(std::size_t d) {
    const mechanism::Drive& drive = mechanism_.drives[d];
    if (drive.slide) {
      const mechanism::Slide& slide = mechanism_.slides[*drive.slide];
      Residual along = offset_of(slide, drive.name + "_along", true);
      along.comment = fmt::format("{} stands where {} says", places_.name_of(slide.point), drive.name);
      along.rest.add(drives_[d].way, -1);
      residuals_.push_back(std::move(along));
      return;
    }
    const VectorForm axis = places_.direction_of(drive.body, Eigen::Vector2d::UnitX());
    const double size = places_.scaled(largest_of(drive.body));
    for (const bool is_x : {true, false}) {
      Residual turned;
      turned.name = fmt::format("{}_{}", drive.name, is_x ? "x" : "y");
      turned.comment =
          fmt::format("{} has the direction of {}", mechanism_.bodies[drive.body].name, drive.name);
      turned.rest = combined(
          {{size, is_x ? &axis.x : &axis.y}, {-size, is_x ? &drives_[d].axis.x : &drives_[d].axis.y}});
      residuals_.push_back(std::move(turned));
    }
  }

  const mechanism::Group& group_;
  PointBook& places_;
  const mechanism::Mechanism& mechanism_;
  const Scaling& scaling_;
  const std::vector<DriveForms>& drives_;
  const GiveSignals& give_signals_;
  std::vector<Residual> residuals_;
};

}  // namespace

std::vector<Residual> residuals_of(const mechanism::Group& group, PointBook& places, const Scaling& scaling,
                                   const std::vector<DriveForms>& drives, const GiveSignals& give_signals) {
  return GroupResiduals(group, places, scaling, drives, give_signals).run();
}

}  // namespace oblique::patch
