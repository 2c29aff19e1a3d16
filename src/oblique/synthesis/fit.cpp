// SPDX-License-Identifier: MIT
#include <oblique/synthesis/fit.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include <oblique/synthesis/design_space.h>
#include <oblique/synthesis/fitted_text.h>
#include <oblique/synthesis/least_squares.h>
#include <oblique/synthesis/path_problem.h>
#include <oblique/synthesis/synthesis_error.h>
#include <oblique/text/even_point.h>
#include <oblique/text/nearest_decimal.h>

namespace oblique::synthesis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Distances below this part of the mechanism's size are as good as none.
constexpr double kNothing = 1e-12;
/// A path that moves by less than this part of the mechanism's size does not depend on a dimension.
constexpr double kNoEffect = 1e-12;
/// A mechanism farther from the file's is taken instead only if it is better by this factor.
constexpr double kWorthwhile = 0.99;
/// Points that are tried for each start before it is given up.
constexpr int kTriesForAStart = 20;

PathError error_of(const VectorXd& residuals) {
  PathError error;
  const Index targets = residuals.size() / 2;
  for (Index k = 0; k < targets; ++k)
    error.largest = std::max(error.largest, residuals.segment<2>(2 * k).norm());
  error.rms = std::sqrt(residuals.squaredNorm() / static_cast<double>(targets));
  return error;
}

[[noreturn]] void fail(SynthesisError::Kind kind, const std::string& file, std::string what,
                       std::string expected, std::string remedy) {
  throw SynthesisError(kind,
                       text::Diagnostic{{file, {}}, std::move(what), std::move(expected), std::move(remedy)});
}

class Fitter {
 public:
  Fitter(const DesignSpace& space, const TargetPath& target, const FitOptions& options)
      : space_(space), target_(target), options_(options), problem_(space, target) {
    least_squares_.residuals = [this](const VectorXd& x) { return problem_.residuals(x); };
    least_squares_.jacobian = [this](const VectorXd& x) { return problem_.jacobian(x); };
    least_squares_.lower = space.lower();
    least_squares_.upper = space.upper();
    const double nothing = kNothing * problem_.size();
    least_squares_.floor = nothing * nothing * static_cast<double>(problem_.targets());
  }

  Fit run() {
    check_request();
    Fit fit;
    fit.before = error_of(problem_.residuals(space_.values()).value());
    fit.turns_fully = problem_.must_turn();
    search();
    finish(fit);
    fit.mechanisms_tried = problem_.members_tried();
    return fit;
  }

 private:
  void check_request() {
    const std::string& point = space_.original().points[target_.point].name;
    for (std::size_t i = 0; i < space_.dimensions().size(); ++i) {
      const auto effect = problem_.effect_of(static_cast<Index>(i));
      if (!effect || *effect > kNoEffect * problem_.size()) continue;
      fail(SynthesisError::Kind::request, space_.original().file,
           fmt::format("free dimensions: '{}' has no effect on the path of '{}'", space_.dimensions()[i].name,
                       point),
           "dimensions that the path depends on", "leave it out");
    }
    const std::size_t numbers = space_.dimensions().size();
    // without timing a target only says how far the path is beside it, with timing where the point is
    const std::size_t asked = target_.times.empty() ? problem_.targets() : 2 * problem_.targets();
    if (asked >= numbers) return;
    fail(SynthesisError::Kind::request, target_.file,
         fmt::format("{} target{} for {} free numbers", problem_.targets(),
                     problem_.targets() == 1 ? "" : "s", numbers),
         fmt::format("{} or more", target_.times.empty() ? numbers : (numbers + 1) / 2),
         "give more points of the path, or free fewer dimensions");
  }

  void search() {
    int tried = 0;
    for (int k = 0; k < options_.starts && !is_nothing(); ++k) {
      if (options_.progress) options_.progress(static_cast<double>(k) / options_.starts);
      if (k == 0) {
        const VectorXd values = space_.values();
        search_from(values.cwiseMax(space_.lower()).cwiseMin(space_.upper()));
        continue;
      }
      for (int trial = 0; trial < kTriesForAStart; ++trial) {
        const std::vector<double> even =
            text::even_point(++tried, static_cast<std::size_t>(space_.values().size()));
        const VectorXd point = VectorXd::Map(even.data(), space_.values().size());
        if (search_from(space_.lower() + point.cwiseProduct(space_.upper() - space_.lower()))) break;
      }
    }
    if (best_) return;
    fail(SynthesisError::Kind::nowhere, space_.original().file,
         fmt::format("no mechanism was found within the bounds that {}",
                     problem_.must_turn() ? "turns fully, as the given one does" : "can be assembled"),
         {}, "widen the bounds, free other dimensions, or search from more starts");
  }

  bool is_nothing() const { return best_ && best_->sum <= least_squares_.floor; }

  /// One search; false where there is no mechanism at `start`.
  bool search_from(const VectorXd& start) {
    problem_.restart();
    auto minimum = minimise(least_squares_, start);
    if (!minimum) return false;
    const bool at_edge = minimum->blocked && problem_.must_turn();
    if (!at_edge || !behind_barriers(start, minimum->sum)) consider(*minimum);
    return true;
  }

  /// Searches anew where a search ran against the edge of what turns fully, which leads to `sum`: behind a
  /// barrier, which is then lowered, it follows the edge instead (the interior-point method). What is found
  /// keeps a small distance from the edge unless it lies within by itself. False where nothing is found.
  bool behind_barriers(const VectorXd& start, double sum) {
    constexpr double kFirstPart = 0.1;  // of the barrier in the sum
    constexpr double kLowering = 0.1;
    constexpr int kStages = 6;
    if (sum <= least_squares_.floor) return false;
    problem_.restart();
    const VectorXd accelerations = problem_.accelerations(space_.values(), problem_.start_configuration());
    double weight =
        kFirstPart * sum * static_cast<double>(accelerations.size()) / accelerations.squaredNorm();
    Minimum minimum{start, sum, true};
    for (int stage = 0; stage < kStages; ++stage, weight *= kLowering) {
      problem_.set_barrier(weight);
      const auto next = minimise(least_squares_, minimum.x);
      problem_.set_barrier(0);
      if (!next) return false;
      minimum = *next;
    }
    const auto residuals = problem_.residuals(minimum.x);
    if (residuals) consider({minimum.x, residuals->squaredNorm(), minimum.blocked});
    const auto last = minimise(least_squares_, minimum.x);
    if (last && !last->blocked) consider(*last);
    return residuals.has_value();
  }

  void consider(const Minimum& minimum) {
    // of the stages of one search the best counts, of several searches the first unless a later one is
    // clearly better
    if (best_ && std::sqrt(minimum.sum) >= kWorthwhile * std::sqrt(best_->sum)) {
      const bool same_place = (minimum.x - best_->x).norm() <= 0.01 * problem_.size();
      if (!same_place || minimum.sum >= best_->sum) return;
    }
    // the numbers that will stand in the file, which is what is measured
    const VectorXd rounded = rounded_values(minimum.x);
    if (const auto residuals = problem_.residuals(rounded)) {
      best_ = Best{rounded, residuals->squaredNorm(), error_of(*residuals), problem_.start_configuration()};
    } else if (const auto exact = problem_.residuals(minimum.x)) {
      best_ = Best{minimum.x, exact->squaredNorm(), error_of(*exact), problem_.start_configuration()};
    }
  }

  /// To ten digits; a change that does not show in them is none.
  VectorXd rounded_values(const VectorXd& values) const {
    VectorXd rounded = values;
    for (Index i = 0; i < values.size(); ++i) {
      const Dimension& dimension = space_.dimensions()[static_cast<std::size_t>(i)];
      const double decimal = text::nearest_decimal(values[i], 10);
      rounded[i] = std::clamp(decimal, dimension.lower, dimension.upper);
      if (decimal == text::nearest_decimal(dimension.value, 10)) rounded[i] = dimension.value;
    }
    return rounded;
  }

  void finish(Fit& fit) {
    const double gain = fit.before.rms - best_->error.rms;
    fit.improved = gain > kNothing * problem_.size();
    const VectorXd values = fit.improved ? best_->x : space_.values();
    fit.after = fit.improved ? best_->error : fit.before;
    for (std::size_t i = 0; i < space_.dimensions().size(); ++i) {
      const Dimension& d = space_.dimensions()[i];
      fit.dimensions.push_back({d.name, d.value, values[static_cast<Index>(i)], d.lower, d.upper});
    }
    fit.text = space_.text(values);
    if (!fit.improved) return;
    if (fit.turns_fully) {
      const auto largest = [&](const VectorXd& member, const StartConfiguration& start_configuration) {
        return problem_.accelerations(member, start_configuration).lpNorm<Eigen::Infinity>();
      };
      fit.acceleration_after = largest(values, best_->start_configuration);
      problem_.restart();
      fit.acceleration_before = largest(space_.values(), problem_.start_configuration());
    }
    FittedText fitted = fitted_text(space_, values, best_->start_configuration);
    fit.sketch_moved = fitted.sketch_moved;
    fit.text = with_comment(fitted.text, comment(fit));
  }

  std::string comment(const Fit& fit) const {
    const auto file_name = [](const std::string& path) {
      return std::filesystem::path(path).filename().string();
    };
    std::string changed;
    for (const FittedDimension& d : fit.dimensions) {
      if (d.changed()) changed += fmt::format("{}{}", changed.empty() ? "" : ", ", d.name);
    }
    return fmt::format(
        "Fitted from {}: {} changed so that {} follows the {} points of {}, rms {:.4g} {} (before {:.4g}).",
        file_name(space_.original().file), changed, space_.original().points[target_.point].name,
        problem_.targets(), file_name(target_.file), fit.after.rms, space_.original().length_unit,
        fit.before.rms);
  }

  struct Best {
    VectorXd x;
    double sum;
    PathError error;
    StartConfiguration start_configuration;
  };

  const DesignSpace& space_;
  const TargetPath& target_;
  const FitOptions& options_;
  PathProblem problem_;
  LeastSquares least_squares_;
  std::optional<Best> best_;
};

}  // namespace

Fit fit_path(const std::string& text, const std::string& file, std::span<const std::string> free,
             const TargetPath& target, const FitOptions& options) {
  const DesignSpace space(text, file, free);
  return Fitter(space, target, options).run();
}

}  // namespace oblique::synthesis
