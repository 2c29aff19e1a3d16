// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <Eigen/Core>

#include <oblique/synthesis/design_space.h>
#include <oblique/synthesis/path_problem.h>

namespace oblique::synthesis {

struct FittedText {
  std::string text;
  bool sketch_moved = false;
};

/// The file of a space with other values. Its sketch stays as it is where it still picks the mode of
/// `start_configuration`; otherwise its points are put where they stand in it. Throws SynthesisError where
/// not even that picks the mode.
FittedText fitted_text(const DesignSpace& space, const Eigen::VectorXd& values,
                       const StartConfiguration& start_configuration);

}  // namespace oblique::synthesis
