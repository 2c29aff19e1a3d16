// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <utility>

namespace oblique::patch {

/// A weighted sum of signals and a constant [machine unit].
struct LinearForm {
  std::map<std::string, double> weights;
  double constant = 0;

  LinearForm& add(const LinearForm& other, double factor = 1) {
    for (const auto& [signal, weight] : other.weights) weights[signal] += factor * weight;
    constant += factor * other.constant;
    return *this;
  }
  bool operator==(const LinearForm&) const = default;
};

inline LinearForm weighted(const std::string& signal, double weight = 1) {
  LinearForm form;
  form.weights[signal] = weight;
  return form;
}

inline LinearForm constant(double value) {
  LinearForm form;
  form.constant = value;
  return form;
}

inline LinearForm combined(std::initializer_list<std::pair<double, const LinearForm*>> parts) {
  LinearForm sum;
  for (const auto& [factor, form] : parts) sum.add(*form, factor);
  return sum;
}

struct VectorForm {
  LinearForm x, y;
};

/// a + factor · b.
inline VectorForm sum(const VectorForm& a, double factor, const VectorForm& b) {
  return {combined({{1, &a.x}, {factor, &b.x}}), combined({{1, &a.y}, {factor, &b.y}})};
}

}  // namespace oblique::patch
