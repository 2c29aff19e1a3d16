// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/atlas_site.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/report/atlas/studio_link.h>

#include "../../support/compiled.h"

namespace oblique::report {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string decaying(const std::string& author, const std::string& rest) {
  return "format = \"oblique-diagram/1\"\ntitle = \"Decay & more\"\n[run]\nuntil = 1\n[blocks]\n"
         "x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n[published]\ntitle = \"T\"\nauthor = "
         "\"" +
         author + "\"\n" + rest;
}

TEST(AtlasSite, ListsAndShowsAllProgrammes) {
  const diagram::BlockLibrary& blocks = testing::shipped_blocks();
  const std::string first = decaying("A. \\\"One\\\"",
                                     "year = 1961\nsubject = \"decay\"\nerrata = [\"1 < "
                                     "2\"]\n[[published.value]]\nname = \"x\"\nvalue = 0.37\n"
                                     "within = 0.01\n");
  const std::vector<Programme> programmes{
      run_programme("one.toml", first, blocks),
      run_programme("two.toml", decaying("B. Two", "picture = \"a bow\"\n"), blocks)};
  AtlasSite site{programmes, blocks};
  site.studio = "../../web/studio.html";
  const std::vector<SitePage> pages = site.pages();
  ASSERT_EQ(pages.size(), 3U);
  EXPECT_EQ(pages[0].name, "index.html");
  EXPECT_EQ(pages[1].name, "one.html");
  EXPECT_EQ(pages[2].name, "two.html");
  const std::string& index = pages[0].text;
  EXPECT_THAT(
      index,
      HasSubstr("<a class=\"card\" href=\"one.html\" data-year=\"1961\" data-author=\"A. &quot;One&quot;\" "
                "data-machine=\"Ideal machine\" data-subject=\"decay\" data-elements=\"Integrator\" "
                "data-circuit=\"as patched\">"));
  EXPECT_THAT(index, HasSubstr("<a class=\"card\" href=\"two.html\" data-year=\"unknown\""));
  EXPECT_THAT(index, AllOf(HasSubstr("<option>1961</option><option>unknown</option>"),
                           HasSubstr("<option>Integrator</option></select>"), HasSubstr("<li>1 &lt; 2</li>"),
                           HasSubstr("2 programmes, 1 published value: 1 within"),
                           HasSubstr("<td><a href=\"one.html\">one</a></td>"),
                           HasSubstr("<p><a href=\"one.html\">Decay &amp; more</a></p>"),
                           HasSubstr("Decay &amp; more")));
  EXPECT_THAT(pages[1].text,
              HasSubstr("href=\"../../web/studio.html" + studio_fragment("one.toml", first) + "\""));
  for (const SitePage& page : pages) {
    for (const char* const outside : {"src=", "url(", "href=\"http", "<link", "@import"})
      EXPECT_THAT(page.text, Not(HasSubstr(outside))) << page.name;
  }
  site.studio.clear();
  EXPECT_THAT(site.pages()[1].text, Not(HasSubstr("studio")));
}

}  // namespace
}  // namespace oblique::report
