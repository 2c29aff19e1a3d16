// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>

namespace oblique::mechanism {

/// A good four-bar, one key a line, in which the tests replace a line.
inline const std::string kFourBar = R"(format = "oblique-mechanism/1"
[units]
length = "m"
[frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5, marks = { M = [1.75, 1] } }
CD = { points = ["C", "D"], length = 3 }
[drives]
crank = { turns = "AB", about = "A", speed = "1 rad/s", start = "0 deg" }
[sketch]
C = [3.5, 2.9]
)";
/// Its line of the drive.
inline const std::string kCrank =
    R"(crank = { turns = "AB", about = "A", speed = "1 rad/s", start = "0 deg" })";

/// The four-bar with another line in the place of one.
inline std::string with(const std::string& line, const std::string& replacement) {
  std::string text = kFourBar;
  const std::size_t at = text.find(line);
  EXPECT_NE(at, std::string::npos) << line;
  return text.replace(at, line.size(), replacement);
}

/// What the reader says about a text; empty where it reads it.
inline std::string message(const std::string& text) {
  try {
    parse_mechanism(text, "bad.toml");
    return {};
  } catch (const MechanismError& error) {
    EXPECT_EQ(error.kind(), MechanismError::Kind::file);
    return error.what();
  }
}

}  // namespace oblique::mechanism
