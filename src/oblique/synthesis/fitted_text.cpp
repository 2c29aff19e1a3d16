// SPDX-License-Identifier: MIT
#include <oblique/synthesis/fitted_text.h>

#include <algorithm>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/synthesis/sketch_edit.h>
#include <oblique/synthesis/synthesis_error.h>

namespace oblique::synthesis {
namespace {

/// Two modes are farther apart than this part of the mechanism's size, or they are one.
constexpr double kSameWithin = 1e-7;

bool picks(const std::string& text, const DesignSpace& space, const StartConfiguration& start_configuration) {
  try {
    const auto picked = start_configuration_of(mechanism::parse_mechanism(text, space.original().file));
    const double within = kSameWithin * space.original().largest_length();
    return picked &&
           std::equal(picked->begin(), picked->end(), start_configuration.begin(), start_configuration.end(),
                      [&](const mechanism::SketchPoint& a, const mechanism::SketchPoint& b) {
                        return (a.position - b.position).norm() <= within;
                      });
  } catch (const mechanism::MechanismError&) {  // the sketch is as far from the one mode as from the other
    return false;
  }
}

}  // namespace

FittedText fitted_text(const DesignSpace& space, const Eigen::VectorXd& values,
                       const StartConfiguration& start_configuration) {
  std::string text = space.text(values);
  if (picks(text, space, start_configuration)) return {std::move(text), false};
  text = with_sketch(text, space.original(), start_configuration, NewPoints::leave_out);
  if (picks(text, space, start_configuration)) return {std::move(text), true};
  throw SynthesisError(
      SynthesisError::Kind::nowhere,
      text::Diagnostic{{space.original().file, {}},
                       "the points of [sketch] cannot tell the assembly modes of the fitted mechanism apart",
                       {},
                       "sketch further points of the mechanism, and fit again"});
}

}  // namespace oblique::synthesis
