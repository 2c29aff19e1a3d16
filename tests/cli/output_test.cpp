// SPDX-License-Identifier: MIT
// No result replaces what it was made from, by whatever name it is called, nor another result.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;

struct Replacement {
  const char* name;
  const char* arguments;
  const char* says;  ///< before the remedy
};

class OutputFiles : public ::testing::Test {
 protected:
  OutputFiles() {
    const std::filesystem::path diagrams = std::filesystem::path(OBLIQUE_SOURCE_DIR) / "diagrams";
    // Any name may end as an output's does.
    for (const char* name : {"m.toml", "m.json", "m.svg", "m.csv", "m.html", "m-pots.csv"})
      std::filesystem::copy_file(diagrams / "mechanisms/four-bar.toml", folder_ / name);
    for (const char* name : {"d.toml", "d.json", "d.svg", "d.csv"})
      std::filesystem::copy_file(diagrams / "lessons/division.toml", folder_ / name);
    std::ofstream(folder_ / "t.csv") << "t,x\n0,1\n1,2\n";
    std::ofstream(folder_ / "t.svg") << "t,x\n0,1\n1,2\n";
    for (const std::string name : {"csv", "svg"}) {
      std::ofstream(folder_ / ("plays-" + name + ".toml"))
          << "format = \"oblique-diagram/1\"\n[blocks]\n"
             "p = { type = \"recording\", data = { file = \"t."
          << name << "\", x = \"t\", y = \"x\" } }\n";
    }
    std::ofstream(folder_ / "path.toml") << "B.x,B.y\n1.05,0\n0,1.05\n-1.05,0\n0,-1.05\n";
    std::filesystem::create_directories(folder_ / "blocks");
    std::ofstream(folder_ / "blocks/own.toml")
        << "format = \"oblique-block/1\"\ntitle = \"Own\"\n[inputs]\nin = { doc = \"in\" }\n"
           "[outputs]\nout = { wire = \"i\", doc = \"out\" }\n[blocks]\ni = { type = \"inverter\", in = "
           "\"in\" }\n";
    std::filesystem::create_symlink("t.csv", folder_ / "link.csv");
    std::filesystem::create_symlink(folder_ / "link.csv", folder_ / "far.csv");
    std::filesystem::create_hard_link(folder_ / "t.csv", folder_ / "hard.csv");
    run_command("oblique run d.toml --save state.toml", folder_.path().string());
  }

  /// Everything that is there: names and bytes.
  std::string contents() const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      if (!entry.is_regular_file()) continue;
      std::ifstream stream(entry.path(), std::ios::binary);
      all.push_back(entry.path().string() + std::string(std::istreambuf_iterator<char>(stream), {}));
    }
    std::sort(all.begin(), all.end());
    std::string text;
    for (const std::string& one : all) text += one;
    return text;
  }

  ScratchFolder folder_;
};

class Replacements : public OutputFiles, public testing::WithParamInterface<Replacement> {};
INSTANTIATE_TEST_SUITE_P(
    Cli, Replacements,
    ::testing::Values(
        Replacement{"ComparedMechanismByTheNumbers", "compare m.json --gain 1e3 -o m.json",
                    "m.json: this file is read, and would be replaced"},
        Replacement{"ComparedMechanismByTheCurves", "compare m.svg --gain 1e3 --plot m.svg",
                    "m.svg: this file is read, and would be replaced"},
        Replacement{"SolvedMechanism", "solve m.csv --positions 5 -o ./m.csv",
                    "./m.csv: this file is read, as m.csv, and would be replaced"},
        Replacement{"DrawnMechanism", "draw m.svg -o blocks/../m.svg",
                    "blocks/../m.svg: this file is read, as m.svg, and would be replaced"},
        Replacement{"AnimatedMechanism", "animate m.html -o m.html",
                    "m.html: this file is read, and would be replaced"},
        Replacement{"ReportedMechanism", "report m.html -o m.html",
                    "m.html: this file is read, and would be replaced"},
        Replacement{"PatchedMechanism", "patch m.toml -o m.toml",
                    "m.toml: this file is read, and would be replaced"},
        Replacement{"PatchedMechanismByASheet", "patch m-pots.csv --machine rat-700 --sheets m",
                    "m-pots.csv: this file is read, and would be replaced"},
        Replacement{"FittedMechanism", "fit m.toml --path path.toml --free AB=0.9..1.1 -o m.toml",
                    "m.toml: this file is read, and would be replaced"},
        Replacement{"PathOfAFit", "fit m.toml --path path.toml --free AB=0.9..1.1 -o path.toml",
                    "path.toml: this file is read, and would be replaced"},
        Replacement{"RunDiagramByItsRows", "run d.csv -o d.csv",
                    "d.csv: this file is read, and would be replaced"},
        Replacement{"RunDiagramByItsCurves", "run d.svg --plot d.svg",
                    "d.svg: this file is read, and would be replaced"},
        Replacement{"RunDiagramByItsState", "run d.toml --save d.toml",
                    "d.toml: this file is read, and would be replaced"},
        Replacement{"StateByTheNextState", "run d.toml --until 5 --from state.toml --save state.toml",
                    "state.toml: this file is read, and would be replaced"},
        Replacement{"CheckedDiagramByItsPoles", "check d.svg --plot d.svg",
                    "d.svg: this file is read, and would be replaced"},
        Replacement{"RescaledDiagram", "check d.toml --rescale -o d.toml",
                    "d.toml: this file is read, and would be replaced"},
        Replacement{"BlockInUse", "--blocks blocks check d.toml --rescale -o blocks/own.toml",
                    "blocks/own.toml: this file is read, and would be replaced"},
        Replacement{"RecordingOfARun", "run plays-csv.toml -o t.csv", "t.csv: this file is read, "},
        Replacement{"RecordingOfADrawing", "run plays-svg.toml --plot t.svg", "t.svg: this file is read, "},
        Replacement{"RecordingBehindALink", "run plays-csv.toml -o link.csv",
                    "link.csv: this file is read, as t.csv, and would be replaced"},
        Replacement{"RecordingBehindTwoLinks", "run plays-csv.toml -o far.csv",
                    "far.csv: this file is read, as t.csv, and would be replaced"},
        Replacement{"RecordingByAHardLink", "run plays-csv.toml -o hard.csv",
                    "hard.csv: this file is read, as t.csv, and would be replaced"},
        Replacement{"InputFromStandardInput", "run /dev/stdin -o d.csv <d.csv",
                    "d.csv: this file is read, as /dev/stdin, and would be replaced"}),
    [](const auto& tested) { return tested.param.name; });

TEST_P(Replacements, OfInputsAreRefused) {
  const std::string before = contents();
  const Outcome outcome =
      run_command(std::string("oblique ") + GetParam().arguments, folder_.path().string());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr(std::string("error: ") + GetParam().says));
  EXPECT_THAT(outcome.err, ::testing::EndsWith("\n  remedy: write to another file\n"));
  EXPECT_EQ(outcome.out, "") << "it worked before it looked";
  EXPECT_TRUE(contents() == before);
}

// Their names end differently, but a name may lead anywhere, also to what is yet to come.
TEST_F(OutputFiles, OfOneResultByAnotherAreRefused) {
  std::filesystem::create_symlink("new.csv", folder_ / "curves.svg");
  const std::string before = contents();
  const Outcome outcome =
      run_command("oblique run d.toml -o new.csv --plot curves.svg", folder_.path().string());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err, "error: curves.svg: two results would go to this file\n  remedy: name two files\n");
  EXPECT_TRUE(contents() == before);
}

// ESC [ 2 J would clear the screen, and other sequences do worse.
TEST_F(OutputFiles, AndTerminalsAreNotCommandedByWhatAFileSays) {
  std::ofstream(folder_ / "e.toml")
      << "format = \"oblique-diagram/1\"\ntitle = \"\\u001b[2J\"\n[run]\nuntil = 1\n[blocks]\n"
         "a = { type = \"constant\", value = 2 }\n[outputs]\n\"x\\u001b[2J\\u0007\" = \"a\"\n";
  std::ofstream(folder_ / "b.toml")
      << "format = \"oblique-diagram/1\"\n[blocks]\n\"b\\u001b[2J\" = { type = \"constant\" }\n";
  for (const char* const arguments :
       {"run e.toml", "run e.toml --plot -", "check e.toml", "run b.toml", "run none\x1b[2J", "r\x1b[2J",
        "run --n\x1b[2J", "run e.toml --columns $'\x1b[2J' -o x.csv"}) {
    const Outcome outcome = run_command(std::string("oblique ") + arguments, folder_.path().string());
    const std::string all = outcome.out + outcome.err;
    EXPECT_THAT(all, HasSubstr("␛[2J")) << arguments;
    EXPECT_EQ(all.find_first_of("\x1b\a"), all.npos) << arguments;
  }
}

}  // namespace
}  // namespace oblique::test
