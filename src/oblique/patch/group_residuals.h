// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/point_forms.h>

namespace oblique::patch {

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

/// What a drive gives, as forms of its signals.
struct DriveForms {
  VectorForm axis;  ///< the direction of the body that it turns
  LinearForm way;   ///< of the slide that it moves [machine unit]
};

/// The conditions of one group of any class: bodies keep their lengths, are hinged to each other, slides stay
/// on their lines, drives are where they say.
class GroupResiduals {
 public:
  /// Gives a point whose place is unknown its form.
  using Unknown = std::function<VectorForm(std::size_t point)>;

  /// Needs the forms of all points that the groups before place, and adds those of this group; `drives` as in
  /// the mechanism. All arguments have to outlive it.
  GroupResiduals(PointForms& places, const Scaling& scaling, const std::vector<DriveForms>& drives,
                 Unknown unknown);

  /// The residuals of a group; calls `unknown` for each of its points that is no form of others.
  std::vector<Residual> of(const mechanism::Group& group);

 private:
  std::size_t known_count(std::size_t body) const;
  long uses(const mechanism::Group& group, std::size_t point) const;
  void add_body(const mechanism::Group& group, std::size_t index);
  double reach_of(const mechanism::Slide& slide) const;
  Residual offset_of(const mechanism::Slide& slide, const std::string& name, bool along);
  void add_slide(const mechanism::Slide& slide);
  double largest_of(std::size_t body) const;
  void add_drive(std::size_t d);

  PointForms& places_;
  const mechanism::Mechanism& mechanism_;
  const Scaling& scaling_;
  const std::vector<DriveForms>& drives_;
  Unknown unknown_;
  std::vector<Residual> residuals_;  ///< of the present group
};

}  // namespace oblique::patch
