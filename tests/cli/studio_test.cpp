// SPDX-License-Identifier: MIT
// `studio` puts a file into the page. What the page then does with it is tested in a browser (tests/studio).
#include <cstdlib>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "verbs.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kBefore = "<html><script type=\"application/json\" id=\"opening\">";
constexpr const char* kAfter = "</script><script>run()</script></html>\n";

class Studio : public Verbs {
 protected:
  Studio() {
    write("page.html", std::string(kBefore) + R"({"name": "old"})" + kAfter);
    setenv("OBLIQUE_STUDIO", file("page.html").c_str(), 1);
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
  }
  ~Studio() override { unsetenv("OBLIQUE_STUDIO"); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }
  /// What the written page opens with.
  nlohmann::json opening(const std::string& name) const {
    const std::string page = bytes_of(name);
    const std::size_t begin = std::string(kBefore).size();
    EXPECT_TRUE(page.starts_with(kBefore));
    EXPECT_TRUE(page.ends_with(kAfter));
    const std::string inside = page.substr(begin, page.size() - begin - std::string(kAfter).size());
    EXPECT_EQ(inside.find('<'), std::string::npos);  // no text of a file ends the element
    return nlohmann::json::parse(inside);
  }
};

TEST_F(Studio, PutsAFileInsideWithWhatItNames) {
  write("wind.csv", "t,v\n0,1\n1,2\n");
  const std::string text = R"toml(format = "oblique-diagram/1"
title = "</script><script>alert(1)</script> — ü"
[run]
until = 1
[blocks]
a = { type = "recording", data = { file = "wind.csv", x = "t", y = "v" } }
[outputs]
a = "a"
)toml";
  write("a.toml", text);
  const Outcome outcome = oblique("--blocks diagrams/own-blocks/blocks studio " + file("a.toml") +
                                  " --stay -o " + file("out.html"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("wrote " + file("out.html")));
  const nlohmann::json opening = this->opening("out.html");
  EXPECT_EQ(opening["name"], "a.toml");
  EXPECT_EQ(opening["text"], text);
  ASSERT_EQ(opening["files"].size(), 1U);
  EXPECT_EQ(opening["files"][0]["name"], "wind.csv");
  EXPECT_EQ(opening["files"][0]["text"], "t,v\n0,1\n1,2\n");
  EXPECT_EQ(opening["blocks"][0]["name"], "bouncing-ball");
  EXPECT_THAT(opening["blocks"][0]["text"].get<std::string>(), HasSubstr("oblique-block/1"));
}

TEST_F(Studio, WithoutAFileThePageIsAsItWasBuilt) {
  const Outcome outcome = oblique("studio -o " + file("out.html"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(bytes_of("out.html"), bytes_of("page.html"));
  EXPECT_THAT(outcome.err, HasSubstr("there is no desktop to open it on: open it in a browser"));
}

TEST_F(Studio, GoesIntoTheCacheByItsName) {
  setenv("XDG_CACHE_HOME", file("cache").c_str(), 1);
  const Outcome outcome = oblique("studio diagrams/mechanisms/four-bar.toml --stay");
  unsetenv("XDG_CACHE_HOME");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(opening("cache/oblique/studio/four-bar.html")["name"], "four-bar.toml");
}

TEST_F(Studio, RefusesWhatItCannotPutInside) {
  const auto refusal = [&](const std::string& arguments) {
    const Outcome outcome = oblique("studio " + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_FALSE(std::filesystem::exists(file("out.html")));
    return outcome.err;
  };
  const std::string out = " --stay -o " + file("out.html");
  write("no.toml", "format = \"something\"\n");
  EXPECT_THAT(refusal(file("no.toml") + out), HasSubstr("this is neither a diagram nor a mechanism"));
  EXPECT_THAT(refusal(file("nobody.toml") + out), HasSubstr("nobody.toml"));
  EXPECT_THAT(refusal("diagrams/lessons/circle.toml --stay -o " + file("out.pdf")), HasSubstr(".html"));
  write("no.html", "<html></html>");
  setenv("OBLIQUE_STUDIO", file("no.html").c_str(), 1);
  EXPECT_THAT(refusal("diagrams/lessons/circle.toml" + out), HasSubstr("this is no page of the studio"));
  setenv("OBLIQUE_STUDIO", file("nowhere.html").c_str(), 1);
  EXPECT_THAT(refusal("diagrams/lessons/circle.toml" + out), HasSubstr("nowhere.html"));
}

}  // namespace
}  // namespace oblique::test
