// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/patch/linear_form.h>

namespace oblique::patch {

/// The weight of a residual at the inputs of its servo amplifier: that of the greater inputs of most
/// machines.
inline constexpr double kInputGain = 10;

/// A weighted sum as the input of a block.
using Terms = std::vector<diagram::WeightedSignal>;

/// The terms as the setting `in`, without those of weight 0 (but one, where there are no others).
text::Entry sum_of(const Terms& terms);

/// The product of two signals as the setting `in`.
text::Entry product_of(const std::string& a, const std::string& b);

/// Writes the blocks of a diagram under names that are free.
class CircuitWriter {
 public:
  /// Title, run and so on, and all blocks so far.
  diagram::Diagram& diagram() { return diagram_; }

  /// The reference: 1 machine unit. Before anything that has a constant.
  void add_reference();
  const std::string& one() const { return one_; }

  /// `wanted`, or the next free name that a block may have, which is then taken.
  std::string free_name(const std::string& wanted);

  /// Adds a block under a name that was taken before.
  void add_named(const std::string& name, std::string type, std::vector<text::Entry> settings,
                 std::string comment = {});

  /// Adds a block under `wanted`, or under the next free name that a block may have, and returns the name it
  /// has.
  std::string add_block(const std::string& wanted, std::string type, std::vector<text::Entry> settings,
                        std::string comment = {});

  /// The form as weighted signals, its constant on the reference.
  Terms terms_of(const LinearForm& form) const;

  /// A summer for a form.
  std::string add_summer(const std::string& wanted, const LinearForm& form, std::string comment = {});

  /// A multiplier for a · b.
  std::string add_product(const std::string& wanted, const std::string& a, const std::string& b);

  /// A form for an input that takes one signal: a summer stands before it where it has more terms.
  text::Entry wire(const std::string& block, const char* port, const LinearForm& form);

 private:
  diagram::Diagram diagram_;
  std::set<std::string> names_;
  std::string one_;
};

}  // namespace oblique::patch
