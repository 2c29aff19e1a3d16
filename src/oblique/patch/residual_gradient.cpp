// SPDX-License-Identifier: MIT
// The gradient of squared residuals as blocks: gradient servos and rate circuits run down it.
#include <oblique/patch/patch_builder.h>

namespace oblique::patch {
namespace {

double slope(const LinearForm& form, const std::string& unknown) {
  const auto found = form.weights.find(unknown);
  return found == form.weights.end() ? 0 : found->second;
}

}  // namespace

void PatchBuilder::add_gradients(const Residual& residual, const std::vector<std::string>& forms,
                                 const std::string& gap, Gradients& gradients) {
  std::map<std::size_t, std::string> pulls;  // gap · form
  for (auto& [unknown, gradient] : gradients) {
    std::map<std::size_t, double> weights;
    for (const Residual::Product& product : residual.products) {
      weights[product.a] += product.weight * slope(residual.forms[product.b].second, unknown);
      weights[product.b] += product.weight * slope(residual.forms[product.a].second, unknown);
    }
    for (const auto& [form, weight] : weights) {
      if (weight == 0) continue;
      if (!pulls.contains(form)) {
        pulls[form] = add_block(gap + "_pull_" + std::to_string(form + 1), "multiplier",
                                {diagram::wire_setting("in", {{1, gap}, {1, forms[form]}})});
      }
      gradient.push_back({weight, pulls[form]});
    }
    if (const double direct = slope(residual.rest, unknown); direct != 0) gradient.push_back({direct, gap});
  }
}

}  // namespace oblique::patch
