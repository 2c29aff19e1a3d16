// SPDX-License-Identifier: MIT
// Files that pick assembly modes, held by the modes that they are then found to pick.
#include <oblique/synthesis/mode_choice.h>

#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/solver/kinematics.h>
#include <oblique/text/file.h>

namespace oblique::synthesis {
namespace {

using ::testing::HasSubstr;

/// All modes of all groups at the start.
std::vector<mechanism::GroupModes> modes_of(const mechanism::Mechanism& mechanism) {
  mechanism::Structure structure = mechanism::find_groups(mechanism);
  mechanism::choose_some_modes(mechanism, structure);
  const mechanism::Configuration start = mechanism::start_configuration(mechanism, structure);
  std::vector<mechanism::DriveState> drives;
  mechanism::DriveClock clock(mechanism);
  drives.resize(mechanism.drives.size());
  clock.at(0, drives);
  return mechanism::assembly_modes(mechanism, structure, drives, start);
}

class EveryMechanism : public ::testing::TestWithParam<std::string> {};

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms"))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}
INSTANTIATE_TEST_SUITE_P(Modes, EveryMechanism, ::testing::ValuesIn(all_names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// The motion of the file that comes out begins in the mode that was asked for. At least one mode of each
// group can be chosen: the one that the file has.
TEST_P(EveryMechanism, BeginsInTheModeThatIsChosen) {
  const std::string text =
      text::read_file(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + GetParam() + ".toml");
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, "m.toml");
  for (const mechanism::GroupModes& group : modes_of(mechanism)) {
    if (group.modes.size() < 2) continue;
    int chosen = 0;
    for (const mechanism::AssemblyMode& mode : group.modes) {
      const ModeChoice choice = choose_mode(text, mechanism, mode);
      if (!choice.text) {
        EXPECT_FALSE(mode.selected);
        EXPECT_NE(choice.why, "");
        continue;
      }
      ++chosen;
      const mechanism::Mechanism again = mechanism::parse_mechanism(*choice.text, "m.toml");
      const mechanism::Configuration start =
          mechanism::solve_motion(again, std::vector<double>{0}).configurations.front();
      for (std::size_t k = 0; k < mode.points.size(); ++k) {
        EXPECT_LT((start.points[mode.points[k]].position - mode.positions[k]).norm(),
                  1e-7 * mechanism.largest_length());
      }
    }
    EXPECT_GE(chosen, 1);
  }
}

constexpr const char* kFourBar = R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5 }
CD = { points = ["C", "D"], length = 3 }   # the rocker
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)";

// B at (1, 0): C = (1 + x, ±y) with x = (3.5² + 3² − 3²)/6 …: by the law of cosines over BD = 3.
TEST(ModeChoice, WritesASketchIntoAFileThatHasNone) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(kFourBar, "m.toml");
  const auto groups = modes_of(mechanism);
  const auto dyad =
      std::find_if(groups.begin(), groups.end(), [](const auto& g) { return g.modes.size() == 2; });
  ASSERT_NE(dyad, groups.end());
  const double x = 1 + 3.5 * 3.5 / 6, y = std::sqrt(3.5 * 3.5 - (x - 1) * (x - 1));
  for (const mechanism::AssemblyMode& mode : dyad->modes) {
    const ModeChoice choice = choose_mode(kFourBar, mechanism, mode);
    ASSERT_TRUE(choice.text);
    const std::size_t c = mechanism.find_point("C").value();
    EXPECT_NEAR(choice.start.points[c].position.x(), x, 1e-12);
    EXPECT_NEAR(std::abs(choice.start.points[c].position.y()), y, 1e-12);
    EXPECT_TRUE(choice.text->starts_with(kFourBar));
    EXPECT_THAT(*choice.text,
                HasSubstr(mode.positions.front().y() > 0 ? "[sketch]\nC = [3.04167, 2.84282]\n"
                                                         : "[sketch]\nC = [3.04167, -2.84282]\n"));
  }
}

}  // namespace
}  // namespace oblique::synthesis
