// SPDX-License-Identifier: MIT
#include <oblique/patch/circuit_writer.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace oblique::patch {

text::Entry sum_of(const Terms& terms) {
  Terms kept;
  for (const diagram::WeightedSignal& term : terms) {
    if (term.weight != 0) kept.push_back(term);
  }
  if (kept.empty()) kept.push_back(terms.front());
  return diagram::wire_setting("in", kept);
}

text::Entry product_of(const std::string& a, const std::string& b) {
  return diagram::wire_setting("in", {{1, a}, {1, b}});
}

void CircuitWriter::add_reference() {
  one_ = add_block("one", "constant", {diagram::number_setting("value", 1)}, "the reference: 1 machine unit");
}

std::string CircuitWriter::free_name(const std::string& wanted) {
  std::string name = wanted;
  for (int k = 2; diagram::is_reserved(name) || !names_.insert(name).second; ++k)
    name = fmt::format("{}_{}", wanted, k);
  return name;
}

void CircuitWriter::add_named(const std::string& name, std::string type, std::vector<text::Entry> settings,
                              std::string comment) {
  diagram::BlockInstance block;
  block.name = name;
  block.type = std::move(type);
  block.settings = std::move(settings);
  block.comment = std::move(comment);
  diagram_.blocks.push_back(std::move(block));
}

std::string CircuitWriter::add_block(const std::string& wanted, std::string type,
                                     std::vector<text::Entry> settings, std::string comment) {
  std::string name = free_name(wanted);
  add_named(name, std::move(type), std::move(settings), std::move(comment));
  return name;
}

Terms CircuitWriter::terms_of(const LinearForm& form) const {
  double largest = std::abs(form.constant);
  for (const auto& [signal, weight] : form.weights) largest = std::max(largest, std::abs(weight));
  // the rounding of a cosine of 90° is no potentiometer
  constexpr double kRounding = 1e-15;
  Terms terms;
  for (const auto& [signal, weight] : form.weights) {
    if (std::abs(weight) > kRounding * largest) terms.push_back({weight, signal});
  }
  if (std::abs(form.constant) > kRounding * largest || terms.empty()) terms.push_back({form.constant, one_});
  return terms;
}

std::string CircuitWriter::add_summer(const std::string& wanted, const LinearForm& form,
                                      std::string comment) {
  return add_block(wanted, "summer", {sum_of(terms_of(form))}, std::move(comment));
}

std::string CircuitWriter::add_product(const std::string& wanted, const std::string& a,
                                       const std::string& b) {
  return add_block(wanted, "multiplier", {product_of(a, b)});
}

text::Entry CircuitWriter::wire(const std::string& block, const char* port, const LinearForm& form) {
  const Terms terms = terms_of(form);
  if (terms.size() == 1) return diagram::wire_setting(port, terms);
  return diagram::wire_setting(port, {{1, add_summer(block + "_" + port, form)}});
}

}  // namespace oblique::patch
