// SPDX-License-Identifier: MIT
#include <oblique/patch/descent.h>

namespace oblique::patch {
namespace {

double derivative(const LinearForm& form, const std::string& unknown) {
  const auto found = form.weights.find(unknown);
  return found == form.weights.end() ? 0 : found->second;
}

}  // namespace

void add_gradients(CircuitWriter& writer, const Residual& residual, const std::vector<std::string>& forms,
                   const std::string& gap, Gradients& gradients) {
  std::map<std::size_t, std::string> pulls;  // gap · form
  for (auto& [unknown, gradient] : gradients) {
    std::map<std::size_t, double> weights;
    for (const Residual::Product& product : residual.products) {
      weights[product.a] += product.weight * derivative(residual.forms[product.b].second, unknown);
      weights[product.b] += product.weight * derivative(residual.forms[product.a].second, unknown);
    }
    for (const auto& [form, weight] : weights) {
      if (weight == 0) continue;
      if (!pulls.contains(form)) {
        pulls[form] = writer.add_product(gap + "_pull_" + std::to_string(form + 1), gap, forms[form]);
      }
      gradient.push_back({weight, pulls[form]});
    }
    if (const double direct = derivative(residual.rest, unknown); direct != 0)
      gradient.push_back({direct, gap});
  }
}

}  // namespace oblique::patch
