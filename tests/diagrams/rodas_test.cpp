// SPDX-License-Identifier: MIT
// Every shipped diagram and patched mechanism by Rodas5P against CVODES, with which it shares the equations
// and nothing of the integration.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/obstacle.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/patch/patch.h>
#include <oblique/patch/patch_error.h>
#include <oblique/patch/range.h>
#include <oblique/solve/run.h>
#include <oblique/solve/solve_error.h>

namespace oblique::test {
namespace {

std::vector<std::string> paths_in(const std::string& folder) {
  std::vector<std::string> names;
  const std::string path = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + folder;
  for (const auto& entry : std::filesystem::directory_iterator(path)) names.push_back(entry.path().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// A diagram and its runs.
class Compared {
 public:
  Compared(const diagram::Diagram& diagram, const diagram::BlockLibrary& library)
      : flat_(diagram::flatten(diagram, library)),
        program_(network::assemble(flat_)),
        options_(solve::options_of(diagram.run)) {}

  oblique::solve::Run run(diagram::IntegrationMethod method, double finer = 1) const {
    solve::RunOptions options = options_;
    options.method = method;
    options.tolerance /= finer;
    options.max_steps = 200'000;
    if (options.absolute_tolerance) *options.absolute_tolerance /= finer;
    try {
      return solve::run(program_, flat_, options);
    } catch (const solve::SolveError& error) {
      ADD_FAILURE() << diagram::method_name(method) << ", " << finer << " times finer: " << error.what();
      return {};
    }
  }

  diagram::IntegrationMethod asked() const { return options_.method; }
  double tolerance() const { return options_.tolerance; }

 private:
  diagram::FlatDiagram flat_;
  network::Program program_;
  solve::RunOptions options_;
};

/// The largest difference of a column until a row, and the largest value of it.
struct Difference {
  double largest = 0, size = 0;
};
Difference difference_of(const solve::Trajectory& a, const solve::Trajectory& b, std::size_t column) {
  Difference found;
  for (std::size_t row = 0; row < a.rows(); ++row) {
    found.largest = std::max(found.largest, std::abs(a.at(row, column) - b.at(row, column)));
    found.size = std::max(found.size, std::abs(b.at(row, column)));
  }
  return found;
}

/// Of smooth problems the worst was 60 tolerances off, with either. Where the equations let errors grow more,
/// CVODES' own are the measure: ten of those, against a run that is a hundred times finer, if rounding
/// allows.
void expect_alike(const Compared& compared) {
  constexpr double kTolerances = 200, kTimesCvodes = 10;
  constexpr double kFinest = 1e-11;  // beyond, BDF does not come through Andrews' squeezer
  const auto fine = compared.run(compared.asked(), std::min(100.0, compared.tolerance() / kFinest));
  const auto cvodes = compared.run(compared.asked());
  const auto rodas = compared.run(diagram::IntegrationMethod::rodas);
  if (fine.trajectory.rows() == 0) return;
  ASSERT_EQ(rodas.trajectory.rows(), fine.trajectory.rows());
  ASSERT_EQ(cvodes.trajectory.rows(), fine.trajectory.rows());
  EXPECT_EQ(rodas.warnings.size(), cvodes.warnings.size());
  bool is_known = true;
  for (std::size_t column = 1; column < fine.trajectory.columns().size(); ++column) {
    const Difference by_cvodes = difference_of(cvodes.trajectory, fine.trajectory, column);
    const Difference by_rodas = difference_of(rodas.trajectory, fine.trajectory, column);
    EXPECT_LE(by_rodas.largest,
              kTolerances * compared.tolerance() * by_cvodes.size + kTimesCvodes * by_cvodes.largest)
        << fine.trajectory.columns()[column].name;
    is_known = is_known && by_cvodes.largest < 1e-3 * by_cvodes.size;
  }
  if (is_known) {
    EXPECT_NEAR(static_cast<double>(rodas.event_count), static_cast<double>(cvodes.event_count),
                0.02 * static_cast<double>(cvodes.event_count));
  }
}

/// By triangles where that goes, else by gradient servos.
diagram::Diagram patched(const mechanism::Mechanism& mechanism) {
  try {
    return patch::patch(mechanism, {});
  } catch (const patch::PatchError&) {
    patch::PatchOptions options;
    options.method = patch::PatchMethod::gradient;
    return patch::patch(mechanism, options);
  }
}

TEST(ByRodas, ShippedDiagramsAreAsByCvodes) {
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  for (const char* folder : {"historical", "lessons"}) {
    for (const std::string& file : paths_in(folder)) {
      SCOPED_TRACE(file);
      expect_alike(Compared(diagram::read_diagram(file), library));
    }
  }
}

TEST(ByRodas, PatchedMechanismsAreAsByCvodes) {
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  int count = 0;
  for (const std::string& file : paths_in("mechanisms")) {
    SCOPED_TRACE(file);
    const mechanism::Mechanism mechanism = patch::within_range(mechanism::read_mechanism(file));
    if (mechanism::find_obstacle(mechanism, mechanism::decompose(mechanism))) continue;
    expect_alike(Compared(patched(mechanism), library));
    ++count;
  }
  EXPECT_GT(count, 20);
}

}  // namespace
}  // namespace oblique::test
