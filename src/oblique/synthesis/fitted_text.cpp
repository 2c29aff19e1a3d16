// SPDX-License-Identifier: MIT
#include <oblique/synthesis/fitted_text.h>

#include <algorithm>

#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>
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

/// The text with the points of its sketch where they stand in `start_configuration`.
std::string with_sketch(const std::string& text, const mechanism::Mechanism& mechanism,
                        const StartConfiguration& start_configuration) {
  const text::Document document = text::parse_document(text, mechanism.file);
  const text::Value* const sketch = document.root.find("sketch");
  if (sketch == nullptr) return text;
  std::vector<Replacement> replacements;
  for (const text::Entry& entry : sketch->entries) {
    const auto point = mechanism.find_point(entry.key);
    const auto stands = std::find_if(start_configuration.begin(), start_configuration.end(),
                                     [&](const mechanism::SketchPoint& p) { return p.point == point; });
    if (stands == start_configuration.end()) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      const double coordinate = stands->position[static_cast<Eigen::Index>(i)];
      replacements.push_back({range_of(text, entry.value.elements[i]), fmt::format("{:.6g}", coordinate)});
    }
  }
  return replace_ranges(text, std::move(replacements));
}

}  // namespace

FittedText fitted_text(const DesignSpace& space, const Eigen::VectorXd& values,
                       const StartConfiguration& start_configuration) {
  std::string text = space.text(values);
  if (picks(text, space, start_configuration)) return {std::move(text), false};
  text = with_sketch(text, space.original(), start_configuration);
  if (picks(text, space, start_configuration)) return {std::move(text), true};
  throw SynthesisError(
      SynthesisError::Kind::nowhere,
      text::Diagnostic{{space.original().file, {}},
                       "the points of [sketch] cannot tell the assembly modes of the fitted mechanism apart",
                       {},
                       "sketch further points of the mechanism, and fit again"});
}

}  // namespace oblique::synthesis
