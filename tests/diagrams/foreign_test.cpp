// SPDX-License-Identifier: MIT
// Diagrams that others have composed, with truths that share no code with Oblique: those of `findings` were
// once answered wrongly, those of `literature` are problems from books, solved by another program.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/expectation_check.h>

namespace oblique::test {
namespace {

std::vector<std::string> foreign_diagrams() {
  std::vector<std::string> paths;
  for (const char* const folder : {"findings", "literature"}) {
    const std::filesystem::path path = std::filesystem::path(OBLIQUE_SOURCE_DIR) / "tests/diagrams" / folder;
    if (!std::filesystem::exists(path)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string foreign_name(const ::testing::TestParamInfo<std::string>& tested) {
  std::string name;
  for (const char c : std::filesystem::path(tested.param).stem().string()) {
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : 'x';
  }
  return name;
}

/// The shipped blocks, and those that the diagrams bring with them.
const diagram::BlockLibrary& foreign_blocks() {
  static const diagram::BlockLibrary library = [] {
    diagram::BlockLibrary all = diagram::BlockLibrary::shipped();
    all.add_directory(std::filesystem::path(OBLIQUE_SOURCE_DIR) / "tests/diagrams/blocks");
    return all;
  }();
  return library;
}

class ForeignDiagram : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Diagrams, ForeignDiagram, ::testing::ValuesIn(foreign_diagrams()), foreign_name);

TEST_P(ForeignDiagram, GivesTheTruth) {
  const diagram::BlockLibrary& library = foreign_blocks();
  const diagram::Diagram diagram = diagram::read_diagram(GetParam());
  ASSERT_FALSE(diagram.expectations.empty());
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  solve::RunOptions options = solve::options_of(diagram.run);
  report::ask_for_expectations(diagram, options);
  const oblique::solve::Run result = solve::run(network::Program(network::assemble(flat)), flat, options);
  for (const report::ExpectationResult& expectation : report::check_expectations(diagram, result)) {
    EXPECT_TRUE(expectation.met) << expectation.expectation.text << " = " << expectation.actual;
  }
}

/// Diagrams that were answered wrongly, or refused, where a relay slid beside them: what is small, what
/// follows quickly, what flips, and what rests where its own slide ends.
std::vector<std::string> diagrams_beside_a_slide() {
  std::vector<std::string> paths;
  for (const char* const name :
       {"half_wave_rectifier", "slope_by_a_fast_lag", "prandtl_ishlinskii", "oscillator_of_nanoamperes",
        "traces_beside_a_unit", "eccles_jordan", "schmitt_by_feedback", "limiter_astable",
        "fold_by_a_limiter", "limiter_with_positive_feedback", "time_optimal_by_switch",
        "time_optimal_unequal", "saturating_time_optimal"}) {
    for (const std::string& path : foreign_diagrams()) {
      if (std::filesystem::path(path).stem() == name) paths.push_back(path);
    }
  }
  return paths;
}

class BesideASlide : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Diagrams, BesideASlide, ::testing::ValuesIn(diagrams_beside_a_slide()),
                         foreign_name);

// A relay that holds an integrator at zero from a third of the run on, wired to nothing else, changes
// nothing.
TEST_P(BesideASlide, GivesTheTruthAllTheSame) {
  diagram::Diagram diagram = diagram::read_diagram(GetParam());
  const diagram::Diagram beside = diagram::parse_diagram(
      "format = \"oblique-diagram/1\"\n[blocks]\nidle_relay = { type = \"sign\", in = \"idle_state\" }\n"
      "idle_state = { type = \"integrator\", in = \"-idle_relay\", initial = 0.3, rate = " +
          std::to_string(1 / diagram.run.until) + " }\n",
      "beside.toml");
  ASSERT_FALSE(diagram.outputs.empty());
  diagram.blocks.insert(diagram.blocks.begin(), beside.blocks.begin(), beside.blocks.end());
  const diagram::FlatDiagram flat = diagram::flatten(diagram, foreign_blocks());
  solve::RunOptions options = solve::options_of(diagram.run);
  report::ask_for_expectations(diagram, options);
  const oblique::solve::Run result = solve::run(network::Program(network::assemble(flat)), flat, options);
  for (const report::ExpectationResult& expectation : report::check_expectations(diagram, result))
    EXPECT_TRUE(expectation.met) << expectation.expectation.text << " = " << expectation.actual;
}

}  // namespace
}  // namespace oblique::test
