// SPDX-License-Identifier: MIT
// Mechanism → diagram by the gradient servo.
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/solver/kinematics.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/patch_builder.h>

namespace oblique::patch {
namespace {

class GradientPatch : private PatchBuilder {
 public:
  GradientPatch(const mechanism::Mechanism& mechanism, const PatchOptions& options)
      : PatchBuilder(mechanism, options) {
    if (!std::isfinite(options.gain * bandwidth_)) {
      throw PatchError(text::Diagnostic{{mechanism.file, {}},
                                        "a gradient servo of infinite gain has no time scale",
                                        "a finite gain and bandwidth",
                                        {}},
                       PatchError::Kind::request);
    }
    rate_ = options.gain * 2 * std::numbers::pi * bandwidth_;
  }

  diagram::Diagram make() {
    describe(
        "patched as gradient servos",
        fmt::format(
            "Each unknown coordinate is an integrator that runs down the gradient of the squared\n"
            "conditions of its group, at K = {:.6g} 1/s (gain {} times the bandwidth of {} Hz). Run over {}.",
            rate_, options_.gain, bandwidth_, span_text()));
    add_reference();
    start_ = mechanism::start_configuration(mechanism_, structure_);
    for (const mechanism::Group& group : structure_.groups) {
      if (group.form.placing == mechanism::Placing::rotation) {
        add_crank(group);
        for (const std::size_t point : group.points) set_known(point);
      } else {
        add_group(group);
      }
    }
    if (options_.derivatives) add_rates();
    add_outputs();
    return std::move(diagram_);
  }

 private:
  void add_group(const mechanism::Group& group) {
    const std::size_t first = diagram_.blocks.size();
    for (const std::size_t d : group.drives) add_drive(group, d);
    unknowns_.clear();
    GroupResiduals residuals(*this, scaling_, drives_, [this](std::size_t point) {
      add_unknown(point);
      return VectorForm{weighted(signals_[point].x), weighted(signals_[point].y)};
    });
    const std::vector<Residual> conditions = residuals.of(group);
    write(conditions);
    if (first < diagram_.blocks.size()) {
      diagram_.blocks[first].comment =
          fmt::format("group {} ({}): {} conditions for {} coordinates{}{}", group.name,
                      mechanism::kind_name(group.form.kind), conditions.size(), unknowns_.size(),
                      diagram_.blocks[first].comment.empty() ? "" : "\n", diagram_.blocks[first].comment);
    }
    for (const std::size_t point : group.points) {
      if (signals_[point].x.empty()) {
        add_summed_point(point, terms_of(points_[point]->x), terms_of(points_[point]->y), {});
      }
      set_known(point);
    }
  }

  void add_unknown(std::size_t point) {
    signals_[point] = {free_name(name_of(point) + "_x"), free_name(name_of(point) + "_y")};
    unknowns_.emplace_back(signals_[point].x,
                           scaled(start_.points[point].position.x() - scaling_.origin.x()));
    unknowns_.emplace_back(signals_[point].y,
                           scaled(start_.points[point].position.y() - scaling_.origin.y()));
  }

  void add_drive(const mechanism::Group& group, std::size_t d) {
    const mechanism::Drive& drive = mechanism_.drives[d];
    if (drive.slide) {
      add_way(d);
    } else {
      add_generator(d, fmt::format("drive {} turns {} inside the group {}", drive.name,
                                   mechanism_.bodies[drive.body].name, group.name));
    }
  }

  /// The blocks of the residuals, then the integrators that they drive.
  void write(const std::vector<Residual>& residuals) {
    Gradients gradients;
    for (const auto& [name, initial] : unknowns_) gradients[name];
    for (const Residual& residual : residuals) write(residual, gradients);
    for (const auto& [name, initial] : unknowns_) {
      Terms& descent = gradients[name];
      for (diagram::WeightedSignal& term : descent) term.weight = -term.weight;
      diagram::BlockInstance block;
      block.name = name;
      block.type = "integrator";
      block.settings = {diagram::wire_setting("in", descent), diagram::number_setting("rate", rate_),
                        diagram::number_setting("initial", initial)};
      diagram_.blocks.push_back(std::move(block));
    }
  }

  void write(const Residual& residual, Gradients& gradients) {
    std::vector<std::string> forms;
    for (const auto& [name, form] : residual.forms) {
      forms.push_back(add_block(name, "summer", {sum_of(terms_of(form))},
                                forms.empty() ? residual.comment : std::string()));
      form_blocks_.emplace_back(form, forms.back());
    }
    Terms sum = terms_of(residual.rest);
    if (sum.size() == 1 && sum.front().weight == 0) sum.clear();
    for (const Residual::Product& product : residual.products) {
      const std::string block = add_block(
          product.a == product.b ? forms[product.a] + "2" : forms[product.a] + "_" + forms[product.b],
          "multiplier", {diagram::wire_setting("in", {{1, forms[product.a]}, {1, forms[product.b]}})});
      sum.push_back({product.weight, block});
    }
    const std::string gap = add_block(residual.name + "_gap", "summer", {diagram::wire_setting("in", sum)},
                                      forms.empty() ? residual.comment : std::string());
    add_gradients(residual, forms, gap, gradients);
  }

  double rate_ = 0;  ///< K [1/s]
  mechanism::Configuration start_;
  std::vector<std::pair<std::string, double>>
      unknowns_;  ///< signals of the present group and where they start
};

}  // namespace

diagram::Diagram patch_gradient(const mechanism::Mechanism& mechanism, const PatchOptions& options) {
  return GradientPatch(mechanism, options).make();
}

}  // namespace oblique::patch
