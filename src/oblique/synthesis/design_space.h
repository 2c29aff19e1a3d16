// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/model/mechanism.h>
#include <oblique/synthesis/text_edit.h>

namespace oblique::synthesis {

/// A number of a mechanism file that may change.
struct Dimension {
  std::string name;  ///< "AB" (a length), "BCF.F.x" (of a mark), "D.y" (of the frame), "upper.sides.1"
  TextRange range;   ///< where it stands in the file
  double value = 0;  ///< as the file has it [length unit]
  double lower = 0;  ///< bounds [length unit]
  double upper = 0;
};

/// All mechanisms that differ from a file in its free dimensions only.
class DesignSpace {
 public:
  /// Each of `free` is the name of a link (its length), `body.sides` or `body.sides.1`, a mark `body.M` or
  /// one of its coordinates `body.M.x`, a frame point `D` or `D.x`; names of one number may be followed by
  /// bounds, `=130..150`. Without them a length lies between half and twice its value, a coordinate within
  /// half of the mechanism's largest length of it. Throws as `parse_mechanism`, and SynthesisError (kind
  /// `request`) with a finding for each name or bound that makes no sense.
  DesignSpace(std::string text, const std::string& file, std::span<const std::string> free);

  const mechanism::Mechanism& original() const { return original_; }
  const std::vector<Dimension>& dimensions() const { return dimensions_; }
  Eigen::VectorXd values() const;  ///< of the dimensions as the file has them
  Eigen::VectorXd lower() const;
  Eigen::VectorXd upper() const;

  /// The file with these values in place of the numbers that differ from them.
  std::string text(const Eigen::VectorXd& values) const;

  /// The mechanism of `text(values)`. Throws MechanismError where that is none (a length below zero, three
  /// sides that make no triangle).
  mechanism::Mechanism mechanism(const Eigen::VectorXd& values) const;

 private:
  std::string text_;
  mechanism::Mechanism original_;
  std::vector<Dimension> dimensions_;
};

}  // namespace oblique::synthesis
