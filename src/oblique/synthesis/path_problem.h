// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <oblique/synthesis/design_space.h>
#include <oblique/synthesis/path_curve.h>
#include <oblique/synthesis/target_path.h>

namespace oblique::synthesis {

/// Where all moving points stand at the start; as a sketch it picks the assembly mode nearest to it.
using StartConfiguration = std::vector<mechanism::SketchPoint>;

/// The start configuration of a mechanism as its sketch picks it, or nothing where it cannot be assembled
/// there.
std::optional<StartConfiguration> start_configuration_of(const mechanism::Mechanism& mechanism);

/// How far the members of a space are from a target path.
///
/// With timing, residual k is P(tₖ) − target k. Without, it is the difference from the target to the nearest
/// place of the path, whose derivative is that of the path at this place, as far as it is normal to the path:
/// the place itself moves along with no first-order effect on the distance.
///
/// A member belongs to the mode of the original: from member to member the dimensions go in steps, each of
/// which assembles in the mode nearest to the one before. A member has no residuals where it cannot be
/// assembled, where it has no path at a target's time, and where it does not turn fully although the original
/// does.
class PathProblem {
 public:
  /// Throws SynthesisError (kind `request`) where the original itself has no path at a target's time; throws
  /// as `solve_motion` where it cannot be assembled or has no drive.
  PathProblem(const DesignSpace& space, const TargetPath& target);

  /// Puts the search back to the original.
  void restart();

  std::optional<Eigen::VectorXd> residuals(const Eigen::VectorXd& values);

  /// By central differences, one-sided at the edge of the domain; of the member whose residuals were computed
  /// last or of one near it.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& values);

  /// Weight of a barrier that keeps the mechanism off its dead centres: adds to the sum the mean square of
  /// the links' accelerations α/ω₀² over the turn. It grows without bound there; that of the speeds would
  /// not, as a four-bar linkage passes its change point with a jump in them. Only of use where `must_turn`.
  void set_barrier(double weight) { barrier_ = weight; }

  /// α/ω₀² of all links over the turn of a member that begins near `start_configuration`, ω₀ the speed of
  /// the first drive.
  Eigen::VectorXd accelerations(const Eigen::VectorXd& values,
                                const StartConfiguration& start_configuration) const;

  const DesignSpace& space() const { return space_; }
  bool must_turn() const { return must_turn_; }
  double size() const { return size_; }  ///< largest length of the original
  std::size_t targets() const { return target_.positions.size(); }
  std::size_t members_tried() const { return members_tried_; }
  /// The start configuration of the member whose residuals were computed last.
  const StartConfiguration& start_configuration() const { return here_.start_configuration; }
  /// Places of the point over the turn of the original with one dimension changed a little, for each that can
  /// be: the largest distance from those of the original [length unit], or nothing where no change can be
  /// made.
  std::optional<double> effect_of(Eigen::Index dimension);

 private:
  struct Member {
    Eigen::VectorXd values;
    StartConfiguration start_configuration;
  };
  struct Solved {
    StartConfiguration start_configuration;
    std::vector<PathCurve::Foot> feet;  ///< one for each target
    Eigen::VectorXd accelerations;      ///< weighted; empty without a barrier
  };
  struct Perturbed {
    std::vector<Eigen::Vector2d> places;  ///< at the times of the feet
    Eigen::VectorXd accelerations;
  };

  std::optional<StartConfiguration> walk_to(const Eigen::VectorXd& values) const;
  std::optional<Solved> solve(const Eigen::VectorXd& values, const StartConfiguration& near);
  std::optional<Perturbed> perturb(const Eigen::VectorXd& values, const std::vector<PathCurve::Foot>& feet);
  std::optional<std::vector<PathCurve::Foot>> timed_feet(const mechanism::Mechanism& mechanism) const;
  mechanism::Motion turn_of(const mechanism::Mechanism& mechanism) const;
  Eigen::VectorXd accelerations_in(const mechanism::Motion& turn) const;
  double weight_of_an_acceleration() const;

  const DesignSpace& space_;
  const TargetPath& target_;
  double size_ = 0;
  bool must_turn_ = false;
  double barrier_ = 0;
  Member original_;
  Member here_;
  std::size_t members_tried_ = 0;
};

}  // namespace oblique::synthesis
