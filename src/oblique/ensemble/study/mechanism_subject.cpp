// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/mechanism_subject.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <oblique/commission/judge.h>
#include <oblique/diagram/flatten.h>
#include <oblique/ensemble/study/diagram_subject.h>
#include <oblique/ensemble/study/study.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/patch/patch.h>
#include <oblique/synthesis/design_space.h>
#include <oblique/synthesis/synthesis_error.h>
#include <oblique/text/diagnostic.h>

namespace oblique::ensemble {
namespace {

constexpr const char *kGain = "gain", *kBandwidth = "bandwidth";

[[noreturn]] void refuse(std::string what, std::string expected = {}, text::Remedy remedy = {}) {
  throw StudyError(text::Diagnostic{{}, std::move(what), std::move(expected), std::move(remedy)});
}

/// "B.x" and "B.y" of a moving point among the outputs.
struct PointOutput {
  std::size_t point = 0, x = 0, y = 0;
};

class MechanismSubject : public Subject {
 public:
  MechanismSubject(const Plan& plan, const std::string& text, const diagram::BlockLibrary& library)
      : library_(library), text_(text), file_(plan.subject) {
    mechanism_ = mechanism::parse_mechanism(text_, file_);
    if (plan.gain) options_.gain = *plan.gain;
    if (plan.method) {
      const auto method = patch::parse_patch_method(*plan.method);
      if (!method)
        refuse(fmt::format("there is no method '{}'", *plan.method), "triangles, gradient or paper");
      options_.method = *method;
    }
    if (plan.samples) options_.samples = *plan.samples;
    commission::JudgedPatch judged =
        commission::judged_patch(patch::within_range(mechanism_), library_, options_);
    options_ = judged.options;  // with the split of a triad that settles
    diagram_ = std::move(judged.diagram);
    diagram_.title = mechanism_.title;
    for (const diagram::OutputSpec& output : diagram_.outputs) all_outputs_.push_back(output.name);
    bandwidth_ = patch::bandwidth_of(patch::within_range(mechanism_), options_);
  }

  solve::RunOptions run_options() const override { return solve::options_of(diagram_.run); }
  const diagram::Diagram& diagram() const override { return diagram_; }
  std::vector<Measure> usual_measures() const override { return {{"error()", "error()", {}}}; }

  text::Unit unit_of(const std::string& name) override {
    if (name == kGain) return {};
    if (name == kBandwidth) return text::parse_unit("Hz").value();
    dimension(name);
    return text::parse_unit(mechanism_.length_unit).value();
  }

  double vary(const std::string& name, double lowest, double highest) override {
    if (name == kGain || name == kBandwidth) {
      if (!(lowest > 0)) refuse(fmt::format("'{}' would be {}", name, lowest), "a number above 0");
      names_.push_back({name, {}});
      return name == kGain ? options_.gain : bandwidth_;
    }
    synthesis::Dimension found = dimension(name);
    if (!std::isfinite(lowest) || !std::isfinite(highest))
      refuse(fmt::format("'{}' would be infinite", name), "finite dimensions");
    for (const Varied& other : names_) {
      if (other.dimension == found.name)
        refuse(fmt::format("'{}' and '{}' are the same number", other.name, name), "each once");
    }
    names_.push_back({name, found.name});
    const double value = found.value;
    std::vector<std::string> free;
    for (const Varied& varied : names_) {
      if (!varied.dimension.empty()) free.push_back(varied.dimension);
    }
    space_.emplace(text_, file_, free);
    return value;
  }

  std::size_t add_output(const std::string& name) override {
    for (std::size_t k = 0; k < asked_.size(); ++k) {
      if (asked_[k].name == name) return k;
    }
    asked_.push_back(output_called(diagram_, library_, name, all_outputs_));
    return asked_.size() - 1;
  }

  void add_error_outputs() override {
    for (std::size_t p = 0; p < mechanism_.points.size(); ++p) {
      const mechanism::Point& point = mechanism_.points[p];
      if (!point.fixed) points_.push_back({p, add_output(point.name + ".x"), add_output(point.name + ".y")});
    }
  }

  void check_exact(const std::string& column) const override {
    std::vector<std::string> names;
    for (const auto& known : mechanism::motion_column_names(mechanism_)) names.push_back(known.name);
    if (std::find(names.begin(), names.end(), column) != names.end()) return;
    throw text::ExpressionError{
        0, fmt::format("the exact motion has no column '{}'", column), {}, text::suggest(column, names)};
  }

  Machine machine(std::span<const double> values) const override {
    patch::PatchOptions options = options_;
    Eigen::VectorXd dimensions(space_ ? std::ssize(space_->dimensions()) : 0);
    Eigen::Index next = 0;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (!names_[k].dimension.empty()) {
        dimensions[next++] = values[k];
      } else {
        (names_[k].name == kGain ? options.gain : options.bandwidth.emplace()) = values[k];
      }
    }
    auto made = std::make_shared<mechanism::Mechanism>(
        patch::within_range(space_ ? space_->mechanism(dimensions) : mechanism_));
    diagram::Diagram diagram = patch::patch(*made, options);
    diagram.file = file_;
    std::vector<diagram::OutputSpec> outputs;
    for (const diagram::OutputSpec& asked : asked_) {
      const auto own = std::find_if(diagram.outputs.begin(), diagram.outputs.end(),
                                    [&](const diagram::OutputSpec& one) { return one.name == asked.name; });
      outputs.push_back(own == diagram.outputs.end() ? asked : *own);
    }
    diagram.outputs = std::move(outputs);
    Machine machine;
    machine.flat = diagram::flatten(diagram, library_);
    machine.until = diagram.run.until;
    auto motion = std::make_shared<std::optional<mechanism::Motion>>();  // made where it is asked for
    const auto exact = [made, motion](std::size_t rows) -> const mechanism::Motion& {
      if (!*motion) motion->emplace(mechanism::solve_motion(*made, static_cast<int>(rows)));
      return **motion;
    };
    machine.exact = [made, exact](const std::string& column, std::size_t rows) {
      for (mechanism::MotionColumn& one : mechanism::motion_columns(*made, exact(rows))) {
        if (one.name == column) return std::move(one.values);
      }
      return std::vector<double>(rows, std::nan(""));
    };
    machine.errors = [points = points_, exact](std::span<const std::vector<double>> table) {
      return errors_of(points, exact(table[0].size()), table);
    };
    return machine;
  }

 private:
  struct Varied {
    std::string name,
        dimension;  ///< the dimension as the design space knows it; empty: a figure of the patch
  };

  /// The one number of the mechanism that a name means; "AB.length" is AB.
  synthesis::Dimension dimension(const std::string& name) const {
    constexpr std::string_view kLength = ".length";
    std::string known = name;
    if (name.ends_with(kLength)) known.resize(name.size() - kLength.size());
    try {
      const synthesis::DesignSpace space(text_, file_, std::vector<std::string>{known});
      if (space.dimensions().size() == 1) return space.dimensions().front();
      std::string names;
      for (const synthesis::Dimension& one : space.dimensions())
        names += (names.empty() ? "" : ", ") + one.name;
      refuse(fmt::format("'{}' is {} numbers", name, space.dimensions().size()), "one of " + names);
    } catch (const synthesis::SynthesisError& error) {
      constexpr std::string_view kOfAFit = "free dimensions: ";
      text::Diagnostic finding = error.diagnostics().front();
      if (finding.what.starts_with(kOfAFit)) finding.what.erase(0, kOfAFit.size());
      if (finding.remedy.empty()) finding.remedy = "besides dimensions there are 'gain' and 'bandwidth'";
      throw StudyError(std::move(finding));
    }
  }

  static MotionErrors errors_of(const std::vector<PointOutput>& points, const mechanism::Motion& exact,
                                std::span<const std::vector<double>> outputs) {
    MotionErrors errors;
    double sum = 0;
    std::size_t count = 0;
    for (const PointOutput& point : points) {
      for (std::size_t row = 0; row < outputs[0].size(); ++row, ++count) {
        const Eigen::Vector2d place(outputs[1 + point.x][row], outputs[1 + point.y][row]);
        const double error = (place - exact.configurations[row].points[point.point].position).norm();
        sum += error * error;
        if (!(error <= errors.largest)) errors.largest = error;  // "not a number" stays
      }
    }
    errors.rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(count, 1)));
    return errors;
  }

  const diagram::BlockLibrary& library_;
  std::string text_, file_;
  mechanism::Mechanism mechanism_;
  patch::PatchOptions options_;
  double bandwidth_ = 0;  ///< of the file's own patch [Hz]
  diagram::Diagram diagram_;
  std::vector<std::string> all_outputs_;
  std::vector<diagram::OutputSpec> asked_;
  std::vector<PointOutput> points_;
  std::vector<Varied> names_;
  std::optional<synthesis::DesignSpace> space_;  ///< of the dimensions among them
};

}  // namespace

std::unique_ptr<Subject> mechanism_subject(const Plan& plan, const std::string& text,
                                           const diagram::BlockLibrary& library) {
  return std::make_unique<MechanismSubject>(plan, text, library);
}

}  // namespace oblique::ensemble
