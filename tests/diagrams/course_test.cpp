// SPDX-License-Identifier: MIT
// The pages of the course say what the files of its lessons say: the words of a lesson stand in its diagram,
// and its page repeats them with the commands. What the commands print is held by the test of the pages, what
// is seen by ShippedDiagram.
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/text/file.h>

namespace oblique::test {
namespace {

using ::testing::HasSubstr;

const std::string kCourseRoot = OBLIQUE_SOURCE_DIR;

/// The lessons, "1-open-amplifier": the diagrams of the course without the mechanisms that go with them.
std::vector<std::string> lessons() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kCourseRoot + "/diagrams/course")) {
    const std::string name = entry.path().stem().string();
    if (!name.ends_with("-mechanism")) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Its words with one blank between them, without the marks of emphasis and code; a command stands between
/// "$" and
/// "$ end".
std::string flowing(const std::string& page) {
  std::istringstream lines(page);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("$ ")) line += " $ end";
    std::erase_if(line, [](char c) { return c == '`' || c == '*'; });
    std::istringstream words(line);
    for (std::string word; words >> word;) text += word + ' ';
  }
  return text;
}

class CourseLesson : public ::testing::TestWithParam<std::string> {
 protected:
  const std::string file_ = "diagrams/course/" + GetParam() + ".toml";
  const diagram::Diagram diagram_ = diagram::read_diagram(kCourseRoot + "/" + file_);

  std::string page(const std::string& ending) const {
    return text::read_file(kCourseRoot + "/docs/course/" + GetParam() + ending);
  }
};
INSTANTIATE_TEST_SUITE_P(Course, CourseLesson, ::testing::ValuesIn(lessons()), [](const auto& tested) {
  std::string name = tested.param;
  std::erase(name, '-');
  return name;
});

TEST_P(CourseLesson, HasThreeThingsToChangeAndAQuestion) {
  ASSERT_TRUE(diagram_.lesson);
  const diagram::Lesson& lesson = *diagram_.lesson;
  EXPECT_FALSE(lesson.text.empty());
  ASSERT_GE(lesson.steps.size(), 4u);
  EXPECT_FALSE(lesson.steps[0].expectations.empty());  // first it is looked at as it is
  for (std::size_t k = 0; k < lesson.steps.size(); ++k) {
    EXPECT_EQ(lesson.steps[k].set.empty(), k == 0) << k + 1;
    EXPECT_THAT(lesson.steps[k].guess, HasSubstr("?")) << k + 1;
  }
  ASSERT_TRUE(lesson.question);
  EXPECT_EQ(lesson.question->answer, "answer.value");
  EXPECT_FALSE(lesson.question->hint.empty());
}

// In this order, and nothing that the page says to set is another than the file's.
TEST_P(CourseLesson, IsToldByItsPage) {
  const diagram::Lesson& lesson = diagram_.lesson.value();
  std::vector<std::string> told = {"# " + diagram_.title, lesson.text};
  for (const diagram::LessonStep& step : lesson.steps) {
    std::string command = "$ oblique run " + file_;
    for (const diagram::ParameterOverride& set : step.set) command += " --set " + set.path + "=" + set.value;
    told.insert(told.end(), {step.action, "Guess first: " + step.guess, command, step.see});
  }
  told.push_back(lesson.question->ask);
  const std::string text = flowing(page(".md"));
  std::size_t at = 0;
  for (const std::string& words : told) {
    const std::size_t found = text.find(flowing(words), at);
    EXPECT_NE(found, std::string::npos) << "the page does not say here: " << words;
    if (found != std::string::npos) at = found + words.size() / 2;
  }
  // A question is tried with --check, and the page does not give the answer away: what it tries is wrong.
  EXPECT_THAT(text.substr(at), HasSubstr("$ oblique run " + file_ + " --set answer.value="));
  EXPECT_THAT(text.substr(at), HasSubstr(" --check $ end … wrong question: …"));
}

TEST_P(CourseLesson, HasASheetForTheTeacherWithTheAnswer) {
  const std::string sheet = flowing(page("-teacher.md"));
  EXPECT_THAT(sheet, HasSubstr("](" + GetParam() + ".md)"));
  EXPECT_THAT(sheet, HasSubstr("$ oblique run " + file_ + " --set answer.value="));
  EXPECT_THAT(sheet, HasSubstr(" --check $ end … right question: …"));
  for (const char* const part : {"## The mathematics", "## The answer", "## What goes wrong"})
    EXPECT_THAT(sheet, HasSubstr(part));
}

TEST_P(CourseLesson, IsLinked) {
  const std::string contents = text::read_file(kCourseRoot + "/docs/course/README.md");
  EXPECT_THAT(contents, HasSubstr("](" + GetParam() + ".md)"));
  EXPECT_THAT(contents, HasSubstr("](" + GetParam() + "-teacher.md)"));
  EXPECT_THAT(page(".md"), HasSubstr("](" + GetParam() + "-teacher.md)"));
  EXPECT_THAT(page(".md"), HasSubstr("](../pictures/course-" + GetParam() + ".svg)"));
}

}  // namespace
}  // namespace oblique::test
