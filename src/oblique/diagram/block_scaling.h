// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Dense>

#include <oblique/diagram/flat_diagram.h>

namespace oblique::diagram {

/// Factors on the signals and parameters of one block under which its equations still hold.
struct BlockScaling {
  std::vector<double> inputs, outputs, parameters;  ///< in the order of the definition
};

/// Which amplitude scalings the equations of a block allow, found from the equations alone as one checks the
/// dimensions of a formula: terms of a sum have one factor, a product has the product of the factors, what a
/// sine or a table is fed with must not be scaled, a parameter in machine units may be. With the logarithms
/// of all factors as unknowns these are linear equations; the rules are their solutions.
///
/// An integrator, a summer, a servo amplifier or a limiter may be scaled as a whole; a multiplier gives the
/// product of the factors of its inputs; a cosine keeps its signals.
class BlockScalingRules {
 public:
  explicit BlockScalingRules(const FlatBlock& block);

  /// Whether one factor for all signals and parameters in machine units is allowed, as in every linear block.
  bool scales_as_a_whole() const;

  /// That factor for all.
  BlockScaling whole(double factor) const;

  /// The factors of the outputs that follow from those of the inputs; a factor for an input that the rules do
  /// not leave free is replaced by the one they ask for. Parameters in machine units that do not follow from
  /// the inputs have `free`.
  BlockScaling from_inputs(std::span<const double> inputs, double free = 1) const;

 private:
  friend class RuleReader;
  BlockScaling scaling_of(const Eigen::VectorXd& logarithms) const;

  const FlatBlock* block_;
  std::vector<Eigen::Index> outputs_, parameters_,
      inputs_;  ///< column of each; −1: a parameter that is a number
  Eigen::Index columns_ = 0;
  Eigen::MatrixXd equations_;  ///< reduced to echelon form; a row times the logarithms of the factors is 0
  Eigen::VectorXd whole_;      ///< a factor for all: 1 for what is scaled with the signals, 0 for numbers
};

}  // namespace oblique::diagram
