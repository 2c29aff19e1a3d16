// SPDX-License-Identifier: MIT
// Runs that are saved and gone on with.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SavedRun : public ::testing::Test {
 protected:
  SavedRun() : folder_(make_scratch_folder()) {
    std::filesystem::create_directories(folder_);
    std::filesystem::copy_file(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/historical/van-der-pol.toml",
                               folder_ / "pol.toml", std::filesystem::copy_options::overwrite_existing);
    std::filesystem::copy_file(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/lessons/circle.toml",
                               folder_ / "circle.toml", std::filesystem::copy_options::overwrite_existing);
  }
  ~SavedRun() override { std::filesystem::remove_all(folder_); }

  Outcome oblique(const std::string& arguments) const {
    return run_command("oblique " + arguments, folder_.string());
  }

  std::string content(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }
  static std::string last_line(const std::string& csv) {
    return csv.substr(csv.rfind('\n', csv.size() - 2) + 1);
  }
  static double number(const std::string& line, int column) {
    std::istringstream cells(line);
    std::string cell;
    for (int c = 0; c <= column; ++c) std::getline(cells, cell, ',');
    return std::stod(cell);
  }

  std::filesystem::path folder_;
};

TEST_F(SavedRun, GoesOnAsIfItHadNotBeenInterrupted) {
  EXPECT_EQ(oblique("run pol.toml --until 20 -o whole.csv").status, 0);
  EXPECT_EQ(oblique("run pol.toml --until 7 --save half.toml").status, 0);
  EXPECT_EQ(oblique("run pol.toml --until 20 --from half.toml -o rest.csv").status, 0);
  const std::string whole = last_line(content("whole.csv")), rest = last_line(content("rest.csv"));
  EXPECT_EQ(number(whole, 0), number(rest, 0));
  EXPECT_NEAR(number(whole, 1), number(rest, 1),
              1e-5);  // tolerance 1e-8 on a stable cycle, outputs of some units
}

TEST_F(SavedRun, GoesOnWithAChangedParameter) {
  EXPECT_EQ(oblique("run circle.toml --until 1 --save half.toml").status, 0);
  const Outcome outcome = oblique("run circle.toml --until 2 --from half.toml --set x.rate=2");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST_F(SavedRun, RefusesTheStateOfAnotherDiagram) {
  EXPECT_EQ(oblique("run pol.toml --until 1 --save pol-state.toml").status, 0);
  const Outcome outcome =
      oblique("run circle.toml --until 2 --from pol-state.toml --save new.toml -o new.csv");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err, HasSubstr("this is the state of another diagram"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new.toml"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new.csv"));
}

TEST_F(SavedRun, RefusesWhatIsNoState) {
  const Outcome diagram = oblique("run circle.toml --from circle.toml");
  EXPECT_EQ(diagram.status, 2);
  EXPECT_THAT(diagram.err,
              HasSubstr("the format is 'oblique-diagram/1'; expected 'oblique-state/1', the state of a run"));
  EXPECT_EQ(oblique("run circle.toml --from none.toml").status, 2);
}

TEST_F(SavedRun, RefusesExpectationsOfThePast) {
  EXPECT_EQ(oblique("run circle.toml --until 100 --save hundred.toml").status, 0);
  const Outcome outcome = oblique("run circle.toml --from hundred.toml --check");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("and the run goes on from t = 100 s"));
}

TEST_F(SavedRun, OfATimelineIsNotRescaled) {
  std::ofstream(folder_ / "phases.toml")
      << "format = \"oblique-diagram/1\"\n[timeline]\nphases = [{ mode = \"operate\", for = 1 }]\n[blocks]\n"
         "one = { type = \"constant\" }\nx = { type = \"integrator\", in = [\"5*one\"] }\n";
  const Outcome outcome = oblique("check phases.toml --rescale -o new.toml");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("a diagram with [groups] or a [timeline] cannot be rescaled"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new.toml"));
}

TEST_F(SavedRun, RefusesAnEndThatIsPast) {
  EXPECT_EQ(oblique("run circle.toml --until 5 --save five.toml").status, 0);
  const Outcome outcome = oblique("run circle.toml --until 4 --from five.toml");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("the state is that of t = 5 s, and the run ends at 4 s"));
  EXPECT_THAT(outcome.err, HasSubstr("give a later --until"));
}

}  // namespace
}  // namespace oblique::test
