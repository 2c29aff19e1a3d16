// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace oblique::fuzz {

/// What came of one random input.
struct Verdict {
  std::string fault;      ///< with the texts that show it; empty: none
  bool compared = false;  ///< outputs of several runs, all without warnings, were held beside each other
};

/// What is wrong with the way of one random diagram from its text to its trajectory. The bytes make the
/// diagram and choose what it is held against:
///
/// * the same with its blocks renamed, or written and read back: not a bit may differ;
/// * with its blocks in another order; with all values, or all times, scaled by two; gone through in two
/// runs,
///   the second from the saved state of the first; by another method; to a finer tolerance: the outputs of
///   two runs without warnings differ by no more than those of the same diagram do when its numbers are
///   disturbed by a thousand tolerances.
///
/// Other names, another order and another scale must also end in the same way, with the same warnings; but
/// for other names not where disturbed numbers make the diagram end otherwise too. A run that takes too many
/// steps tells nothing; a refusal of a stage is no fault, but nothing else may be thrown, and no output may
/// be without a number. (Scaled values may leave the machine where others do not.)
Verdict examine_diagram(std::string_view bytes);

/// The same of one random mechanism: a four-bar, a slider-crank, a six-bar or a triad, from its file by its
/// exact motion and its patch to the run of that. Held against it are
///
/// * the same with its points and bodies renamed: not a bit of the exact motion may differ;
/// * with its bodies in another order, or with all lengths doubled: the exact motions agree;
/// * its patch, written and read back: it is equal, and so is each bit of its run;
/// * the run of its patch by either method, where it turns and stays well away from dead centres: the points
/// are
///   where they exactly are, but for what the gain of the amplifiers leaves.
Verdict examine_mechanism(std::string_view bytes);

}  // namespace oblique::fuzz
