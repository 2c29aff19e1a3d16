// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/point_book.h>

namespace oblique::patch {

/// A condition g = Σ weight · a · b + rest = 0 [machine unit], whose forms a, b stay within ±1.
struct Residual {
  struct Product {
    double weight;
    std::size_t a, b;  ///< indices in `forms`
  };
  std::string name;
  std::string comment;
  std::vector<std::pair<std::string, LinearForm>> forms;  ///< with the names of their blocks
  std::vector<Product> products;
  LinearForm rest;
};

/// What a drive gives, as forms of its signals.
struct DriveForms {
  VectorForm axis;  ///< the direction of the link that it turns
  LinearForm way;   ///< of the prismatic joint that it moves [machine unit]
};

/// Gives a point whose place is unknown its signals, in the book.
using GiveSignals = std::function<void(std::size_t point)>;

/// The conditions of one group of any class: links keep their lengths, are pinned to each other, sliding
/// points stay on their lines, drives are where they say. The book has all points that the groups before
/// place, and gets those of this group: signals for the points that are unknowns, forms of those for the
/// others.
std::vector<Residual> residuals_of(const mechanism::Group& group, PointBook& places, const Scaling& scaling,
                                   const std::vector<DriveForms>& drives, const GiveSignals& give_signals);

}  // namespace oblique::patch
