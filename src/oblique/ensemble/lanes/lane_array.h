// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>

// Not installed.
namespace oblique::ensemble {

/// Numbers of lanes, on a boundary that all instruction sets like.
class LaneArray {
 public:
  LaneArray() = default;
  explicit LaneArray(std::size_t size)
      : data_(static_cast<double*>(
            std::aligned_alloc(kAlign, (size * sizeof(double) + kAlign - 1) / kAlign * kAlign))) {
    for (std::size_t i = 0; i < size; ++i) data_.get()[i] = 0;
  }
  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  double& operator[](std::size_t i) { return data_.get()[i]; }

 private:
  static constexpr std::size_t kAlign = 128;
  struct Free {
    void operator()(double* data) const { std::free(data); }
  };
  std::unique_ptr<double, Free> data_;
};

}  // namespace oblique::ensemble
