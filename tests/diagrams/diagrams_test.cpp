// SPDX-License-Identifier: MIT
// Every diagram that is shipped says where it comes from, runs and gives what its [expect] says; every
// mechanism can be patched and agrees.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>

#include <oblique/compare/compare.h>
#include <oblique/mechanism/obstacle.h>
#include <oblique/mechanism/read_mechanism.h>
#include <oblique/solve/expectation_check.h>
#include <oblique/text/document.h>

#include "../support/rate_errors.h"

namespace oblique {
namespace {

std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + folder)) {
    names.push_back(folder + "/" + entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string test_name(const testing::TestParamInfo<std::string>& tested) {
  std::string name;
  for (const char c : tested.param) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  }
  return name;
}

std::string path_of(const std::string& name) {
  return std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + name;
}

std::vector<std::string> diagrams() {
  std::vector<std::string> names = files_in("historical");
  const std::vector<std::string> lessons = files_in("lessons");
  names.insert(names.end(), lessons.begin(), lessons.end());
  return names;
}

class ShippedDiagram : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Diagrams, ShippedDiagram, testing::ValuesIn(diagrams()), test_name);

TEST_P(ShippedDiagram, BeginsWithAParagraphOfItsOrigin) {
  std::istringstream text(read_file(path_of(GetParam())));
  std::size_t words = 0;
  std::string line, word;
  while (std::getline(text, line) && line.starts_with('#')) {
    std::istringstream comment(line);
    while (comment >> word) ++words;
  }
  EXPECT_GE(words, 30u);  // fewer do not say where a problem comes from and what the machine shows
  EXPECT_FALSE(read_diagram(path_of(GetParam())).title.empty());
}

TEST_P(ShippedDiagram, GivesWhatItExpects) {
  const BlockLibrary library = BlockLibrary::shipped();
  const Diagram diagram = read_diagram(path_of(GetParam()));
  ASSERT_FALSE(diagram.expectations.empty());
  const FlatDiagram flat = flatten(diagram, library);
  RunOptions options = options_of(diagram.run);
  ask_for_expectations(diagram, options);
  const oblique::Run result = run(Program(assemble(flat)), flat, options);
  for (const ExpectationResult& expectation : check_expectations(diagram, result)) {
    EXPECT_TRUE(expectation.met) << expectation.expectation.text << " = " << expectation.actual;
  }
}

/// A mechanism and how it is patched.
struct Patched {
  std::string file;
  PatchMethod method;
};

/// A triad whose leads are all links.
bool is_on_links(const Group& group) {
  const auto& conditions = group.equations.conditions;
  return std::all_of(conditions.begin(), conditions.end(),
                     [](const Condition& c) { return c.kind == Condition::Kind::distance; });
}

/// All that meet no dead centre, or are swung over their range, by gradient servos; those without groups of
/// class IV and higher, without slides in the leads of triads, and without drives inside groups of several
/// bodies, by triangles too.
std::vector<Patched> patchable() {
  std::vector<Patched> all;
  for (const std::string& name : files_in("mechanisms")) {
    const Mechanism mechanism = within_range(read_mechanism(path_of(name)));
    const Structure structure = decompose(mechanism);
    if (find_obstacle(mechanism, structure)) continue;
    all.push_back({name, PatchMethod::gradient});
    const bool dyads = std::all_of(structure.groups.begin(), structure.groups.end(), [](const Group& group) {
      if (group.kind == GroupKind::triad) return is_on_links(group);
      return group.kind != GroupKind::general || group.bodies.size() == 1;
    });
    if (dyads) all.push_back({name, PatchMethod::triangles});
  }
  return all;
}

class PatchedMechanism : public testing::TestWithParam<Patched> {};
INSTANTIATE_TEST_SUITE_P(Diagrams, PatchedMechanism, testing::ValuesIn(patchable()), [](const auto& tested) {
  const testing::TestParamInfo<std::string> file(tested.param.file, tested.index);
  return test_name(file) + std::string(method_name(tested.param.method));
});

TEST_P(PatchedMechanism, AgreesWithItsExactMotion) {
  const Mechanism mechanism = read_mechanism(path_of(GetParam().file));
  CompareOptions options;
  options.methods = {GetParam().method};
  options.gains = {1e3, 1e4};
  const Comparison comparison = compare(mechanism, BlockLibrary::shipped(), options);
  for (const ComparedRun& run : comparison.runs) {
    EXPECT_LT(run.max_error, 10 / run.gain * comparison.size)
        << run.gain;  // 1/gain, magnified at most ten times
    EXPECT_TRUE(run.stable);
  }
  const GainSeries& series = comparison.series.front();
  if (!series.order) {  // the tolerance hides it: a trammel on its slide errs by 1e-8 at gain 1e4
    EXPECT_LT(comparison.runs.back().max_error, 10 * series.floor.value());
    return;
  }
  EXPECT_NEAR(*series.order, -1, 0.05);
}

// The rates' matrix is that of the positions; its inverse enters once more with each derivative.
TEST_P(PatchedMechanism, HasTheRatesOfItsExactMotion) {
  const Mechanism mechanism = within_range(read_mechanism(path_of(GetParam().file)));
  const BlockLibrary library = BlockLibrary::shipped();
  PatchOptions options;
  options.method = GetParam().method;
  options.derivatives = true;
  const auto errors_at = [&](double gain) {
    options.gain = gain;
    const Diagram diagram = patch(mechanism, options);
    const FlatDiagram flat = flatten(diagram, library);
    return rate_errors(mechanism, run(Program(assemble(flat)), flat, options_of(diagram.run)).trajectory);
  };
  const RateErrors low = errors_at(1e4), high = errors_at(1e5);
  EXPECT_NEAR(std::log10(high.velocity / low.velocity), -1, 0.05);
  EXPECT_NEAR(std::log10(high.acceleration / low.acceleration), -1, 0.05);
  EXPECT_LT(high.velocity, 20 / 1e5);  // of the largest; the leg of Theo Jansen has 10/gain and 17/gain
  EXPECT_LT(high.acceleration, 40 / 1e5);
}

TEST(PatchedMechanism, IsMostOfTheCatalogue) {
  const std::vector<Patched> all = patchable();
  const auto triangles = std::count_if(all.begin(), all.end(),
                                       [](const Patched& p) { return p.method == PatchMethod::triangles; });
  EXPECT_GE(triangles, 30);
  EXPECT_GE(static_cast<long>(all.size()) - triangles, 33);
}

}  // namespace
}  // namespace oblique
