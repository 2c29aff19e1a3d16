// SPDX-License-Identifier: MIT
// The drawings of the shipped diagrams, byte for byte as somebody has looked at them and found them good:
// approved_drawings.txt has a sum for each. Layouts are whole numbers and sizes of letters, so that no
// rounding of a machine shows in them. Where a change is meant, look at what differs and write the sums anew,
// with OBLIQUE_APPROVE=1 in the environment of this test.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/draw/picture/svg.h>
#include <oblique/draw/schematic/diagram_drawing.h>
#include <oblique/text/file.h>

namespace oblique::draw {
namespace {

const std::filesystem::path kSource = OBLIQUE_SOURCE_DIR;
const std::filesystem::path kApproved = kSource / "tests/draw/approved_drawings.txt";

/// The sum of Fowler, Noll and Vo (FNV-1a, 64 bits).
std::string sum_of(const std::string& bytes) {
  std::uint64_t sum = 0xcbf29ce484222325;
  for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  return fmt::format("{:016x}", sum);
}

/// By names without blanks: the file, and how it is drawn.
std::map<std::string, std::string> sums() {
  diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  library.add_directory(kSource / "diagrams/own-blocks/blocks");
  std::map<std::string, std::string> found;
  for (const char* const folder : {"lessons", "historical", "course", "own-blocks"}) {
    for (const auto& entry : std::filesystem::directory_iterator(kSource / "diagrams" / folder)) {
      if (entry.path().extension() != ".toml") continue;
      if (text::read_file(entry.path()).find("\"oblique-diagram/1\"") == std::string::npos) continue;
      const diagram::Diagram diagram = diagram::read_diagram(entry.path());
      const std::string name = fmt::format("{}/{}", folder, entry.path().stem().string());
      found[name] = sum_of(to_svg(draw_diagram(diagram, library)));
      found[name + "+din"] = sum_of(to_svg(draw_diagram(diagram, library, {.symbols = SymbolStyle::din})));
      const std::string open = sum_of(to_svg(draw_diagram(diagram, library, {.depth = 1})));
      if (open != found[name]) found[name + "+open"] = open;
    }
  }
  return found;
}

TEST(ApprovedDrawings, AreWhatIsDrawn) {
  const std::map<std::string, std::string> drawn = sums();
  if (const char* const approve = std::getenv("OBLIQUE_APPROVE"); approve != nullptr && *approve == '1') {
    std::ofstream file(kApproved);
    for (const auto& [name, sum] : drawn) file << name << ' ' << sum << '\n';
  }
  std::map<std::string, std::string> approved;
  std::ifstream file(kApproved);
  for (std::string name, sum; file >> name >> sum;) approved[name] = sum;
  for (const auto& [name, sum] : drawn)
    EXPECT_EQ(approved[name], sum) << name
                                   << " is drawn in another way than approved (see the head of this test)";
  for (const auto& [name, sum] : approved) EXPECT_TRUE(drawn.contains(name)) << name << " is no more";
}

}  // namespace
}  // namespace oblique::draw
