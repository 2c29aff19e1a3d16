// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <new>

// Not installed.
namespace oblique::ensemble {

/// Numbers of lanes, on a boundary that all instruction sets like; 0 at first.
class LaneArray {
 public:
  LaneArray() = default;
  explicit LaneArray(std::size_t size) : data_(new (kAlign) double[size]()) {}
  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  double& operator[](std::size_t i) { return data_.get()[i]; }
  double operator[](std::size_t i) const { return data_.get()[i]; }

 private:
  static constexpr std::align_val_t kAlign{128};
  struct Free {
    void operator()(double* data) const { ::operator delete[](data, kAlign); }
  };
  std::unique_ptr<double[], Free> data_;
};

}  // namespace oblique::ensemble
