// SPDX-License-Identifier: MIT
// Every diagram that is shipped says where it comes from, runs and gives what its [expect] says; every
// mechanism can be patched and agrees.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>

#include <oblique/compare/compare.h>
#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/obstacle.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/atlas/published_check.h>
#include <oblique/report/expectation_check.h>
#include <oblique/text/file.h>

#include "../support/rate_errors.h"

namespace oblique::test {
namespace {

/// The diagrams and mechanisms of a folder; none where it is not there.
std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> names;
  const std::filesystem::path path = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + folder;
  if (!std::filesystem::exists(path)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    names.push_back(folder + "/" + entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string test_name(const ::testing::TestParamInfo<std::string>& tested) {
  std::string name;
  for (const char c : tested.param) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  }
  return name;
}

std::string path_of(const std::string& name) {
  return std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + name;
}

/// Whether a line of the text begins so.
bool has_line(std::string_view text, std::string_view begin) {
  return text.starts_with(begin) || text.find('\n' + std::string(begin)) != std::string_view::npos;
}

/// The diagrams that have a line which begins so. Every test asks, in a process of its own: that nothing is
/// parsed saves a quarter of the time of them all.
std::vector<std::string> diagrams_with(std::string_view begin_of_line) {
  std::vector<std::string> names;
  for (const char* const folder : {"historical", "lessons", "atlas", "course"}) {
    for (const std::string& name : files_in(folder)) {
      const std::string text = text::read_file(path_of(name));
      if (!has_line(text, R"(format = "oblique-mechanism/1")") && has_line(text, begin_of_line))
        names.push_back(name);
    }
  }
  return names;
}

class ShippedDiagram : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Diagrams, ShippedDiagram, ::testing::ValuesIn(diagrams_with("")), test_name);

TEST_P(ShippedDiagram, BeginsWithAParagraphOfItsOrigin) {
  std::istringstream text(text::read_file(path_of(GetParam())));
  std::size_t words = 0;
  std::string line, word;
  while (std::getline(text, line) && line.starts_with('#')) {
    std::istringstream comment(line);
    while (comment >> word) ++words;
  }
  EXPECT_GE(words, 30u);  // fewer do not say where a problem comes from and what the machine shows
  EXPECT_FALSE(diagram::read_diagram(path_of(GetParam())).title.empty());
}

TEST_P(ShippedDiagram, GivesWhatItExpects) {
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::Diagram diagram = diagram::read_diagram(path_of(GetParam()));
  ASSERT_FALSE(diagram.expectations.empty());
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  solve::RunOptions options = solve::options_of(diagram.run);
  report::ask_for_expectations(diagram, options);
  const oblique::solve::Run result = solve::run(network::Program(network::assemble(flat)), flat, options);
  for (const report::ExpectationResult& expectation : report::check_expectations(diagram, result)) {
    EXPECT_TRUE(expectation.met) << expectation.expectation.text << " = " << expectation.actual;
  }
}

class PublishedDiagram : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Diagrams, PublishedDiagram,
                         ::testing::ValuesIn(diagrams_with("[[published.value]]")), test_name);

TEST_P(PublishedDiagram, AgreesWithWhatWasPublishedOrSaysWhyNot) {
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::Diagram diagram = diagram::read_diagram(path_of(GetParam()));
  ASSERT_TRUE(diagram.published && !diagram.published->values.empty());
  const oblique::solve::Run run =
      report::run_with(diagram, library, {}, report::published_expectations(diagram));
  for (const report::PublishedResult& result : report::check_published(diagram, library, {}, run))
    EXPECT_TRUE(result.is_known()) << report::to_text({result});
}

class Lesson : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Diagrams, Lesson, ::testing::ValuesIn(diagrams_with("[lesson]")), test_name);

// Each step gives what it says is seen; the question is open as the file is shipped. What a step without
// numbers shows (that the run ends with an error, say) its page holds.
TEST_P(Lesson, TeachesWhatIsSeen) {
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::Diagram diagram = diagram::read_diagram(path_of(GetParam()));
  ASSERT_TRUE(diagram.lesson);
  for (const diagram::LessonStep& step : diagram.lesson->steps) {
    if (step.expectations.empty()) continue;
    const oblique::solve::Run run = report::run_with(diagram, library, step.set, step.expectations);
    for (const report::ExpectationResult& seen : report::check_expectations(step.expectations, run))
      EXPECT_TRUE(seen.met) << step.action << ": " << seen.expectation.text << " = " << seen.actual;
  }
  if (!diagram.lesson->question) return;
  const std::vector<diagram::Expectation>& expected = diagram.lesson->question->expectations;
  const auto held = report::check_expectations(expected, report::run_with(diagram, library, {}, expected));
  EXPECT_FALSE(std::all_of(held.begin(), held.end(), [](const auto& r) { return r.met; }));
}

/// A mechanism and how it is patched.
struct Patched {
  std::string file;
  patch::PatchMethod method;
};

/// A triad whose legs are all links.
bool is_on_links(const mechanism::Group& group) {
  const auto& conditions = group.equations.conditions;
  return std::all_of(conditions.begin(), conditions.end(), [](const mechanism::Condition& c) {
    return c.kind == mechanism::Condition::Kind::distance;
  });
}

/// Whether a mechanism is patched so: all that meet no dead centre, or are swung over their range, by
/// gradient servos; those without groups of class IV and higher, without slides in the legs of triads, and
/// without drives inside groups of several bodies, by triangles too.
bool is_patchable(const Patched& patched) {
  const mechanism::Mechanism mechanism =
      patch::within_range(mechanism::read_mechanism(path_of(patched.file)));
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  if (mechanism::find_obstacle(mechanism, structure)) return false;
  return patched.method == patch::PatchMethod::gradient ||
         std::all_of(structure.groups.begin(), structure.groups.end(), [](const mechanism::Group& group) {
           if (group.form.kind == mechanism::GroupKind::triad) return is_on_links(group);
           return group.form.kind != mechanism::GroupKind::general || group.bodies.size() == 1;
         });
}

/// Every mechanism by both methods: which of them can be patched takes too long to be asked by every test.
std::vector<Patched> all_patched() {
  std::vector<Patched> all;
  for (const std::string& name : files_in("mechanisms")) {
    all.push_back({name, patch::PatchMethod::gradient});
    all.push_back({name, patch::PatchMethod::triangles});
  }
  return all;
}

class PatchedMechanism : public ::testing::TestWithParam<Patched> {
 protected:
  void SetUp() override {
    if (!is_patchable(GetParam())) GTEST_SKIP() << "there is no such patch";
  }
};
INSTANTIATE_TEST_SUITE_P(Diagrams, PatchedMechanism, ::testing::ValuesIn(all_patched()),
                         [](const auto& tested) {
                           const ::testing::TestParamInfo<std::string> file(tested.param.file, tested.index);
                           return test_name(file) + std::string(patch::method_name(tested.param.method));
                         });

TEST_P(PatchedMechanism, AgreesWithItsExactMotion) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(path_of(GetParam().file));
  compare::CompareOptions options;
  options.methods = {GetParam().method};
  options.gains = {1e3, 1e4};
  const compare::Comparison comparison =
      compare::compare(mechanism, diagram::BlockLibrary::shipped(), options);
  for (const compare::ComparedRun& run : comparison.runs) {
    EXPECT_LT(run.max_error, 10 / run.gain * comparison.size)
        << run.gain;  // 1/gain, magnified at most ten times
    EXPECT_TRUE(run.stable);
  }
  const compare::GainSeries& series = comparison.series.front();
  if (!series.order) {  // the tolerance hides it: a trammel on its prismatic joint errs by 1e-8 at gain 1e4
    EXPECT_LT(comparison.runs.back().max_error, 10 * series.floor.value());
    return;
  }
  EXPECT_NEAR(*series.order, -1, 0.05);
}

// The rates' matrix is that of the positions; its inverse enters once more with each derivative.
TEST_P(PatchedMechanism, HasTheRatesOfItsExactMotion) {
  const mechanism::Mechanism mechanism =
      patch::within_range(mechanism::read_mechanism(path_of(GetParam().file)));
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  patch::PatchOptions options;
  options.method = GetParam().method;
  options.derivatives = true;
  const auto errors_at = [&](double gain) {
    options.gain = gain;
    const diagram::Diagram diagram = patch::patch(mechanism, options);
    const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
    return rate_errors(
        mechanism, solve::run(network::Program(network::assemble(flat)), flat, solve::options_of(diagram.run))
                       .trajectory);
  };
  const RateErrors low = errors_at(1e4), high = errors_at(1e5);
  EXPECT_NEAR(std::log10(high.velocity / low.velocity), -1, 0.05);
  EXPECT_NEAR(std::log10(high.acceleration / low.acceleration), -1, 0.05);
  EXPECT_LT(high.velocity, 20 / 1e5);  // of the largest; the leg of Theo Jansen has 10/gain and 17/gain
  EXPECT_LT(high.acceleration, 40 / 1e5);
}

TEST(PatchedMechanism, IsMostOfTheCatalogue) {
  std::vector<Patched> all = all_patched();
  std::erase_if(all, [](const Patched& patched) { return !is_patchable(patched); });
  const auto triangles = std::count_if(
      all.begin(), all.end(), [](const Patched& p) { return p.method == patch::PatchMethod::triangles; });
  EXPECT_GE(triangles, 30);
  EXPECT_GE(static_cast<long>(all.size()) - triangles, 33);
}

}  // namespace
}  // namespace oblique::test
