// SPDX-License-Identifier: MIT
#include <oblique/report/block_page.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(BlockList, HasEveryBlockWithItsSummary) {
  const auto& library = diagram::BlockLibrary::shipped();
  const text::Vocabulary verbs{{}, [](const text::Action& a) { return a.name + "(" + a.subject + ")"; }};
  const std::string list = block_list(library, verbs);
  for (const std::string& name : library.names())
    EXPECT_THAT(list, HasSubstr("\n" + name + " ")) << library.find(name)->summary;
  EXPECT_THAT(list, HasSubstr(library.find("integrator")->summary));
  EXPECT_TRUE(list.ends_with("\n\nblocks(NAME) tells all about one.\n"));
}

TEST(BlockPage, HasPortsParametersAndTheDefinition) {
  const auto& library = diagram::BlockLibrary::shipped();
  for (const std::string& name : library.names()) {
    const diagram::BlockDefinition& block = *library.find(name);
    const std::string page = to_text(block);
    EXPECT_TRUE(page.starts_with(block.title + " (" + name + ")\n" + block.summary + "\n")) << name;
    for (const auto& port : block.inputs) EXPECT_THAT(page, HasSubstr("\n" + port.name + " ")) << name;
    for (const auto& port : block.outputs) EXPECT_THAT(page, HasSubstr("\n" + port.name + " ")) << name;
    for (const auto& parameter : block.parameters) EXPECT_THAT(page, HasSubstr(parameter.doc)) << name;
    EXPECT_THAT(page, Not(HasSubstr("\n[parameters"))) << name << ": stands in the table already";
  }
}

TEST(BlockPage, GivesTheRangeOfAParameterInWords) {
  const std::string page = to_text(*diagram::BlockLibrary::shipped().find("potentiometer"));
  EXPECT_THAT(page, HasSubstr("at least 0, at most 1"));
}

}  // namespace
}  // namespace oblique::report
