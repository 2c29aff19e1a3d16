// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <oblique/report/atlas/published_check.h>
#include <oblique/report/expectation_check.h>
#include <oblique/report/text_table.h>

namespace oblique::report {

/// A diagram that was run, with all that is known of what it should give.
struct Programme {
  std::string name;  ///< that of its file, without the ending
  std::string text;  ///< of its file
  diagram::Diagram diagram;
  solve::Run run;  ///< with rows enough for its curves
  std::vector<PublishedResult> results;
  std::vector<ExpectationResult> expected;  ///< of `[expect]`
};

/// The diagrams below a folder that say where they were published, by their paths; other files are passed
/// over. Throws ReadError where there is none, and as `parse_diagram` does.
std::vector<std::filesystem::path> programmes_in(const std::filesystem::path& folder);

/// Reads and runs a diagram, whose file has this text. Throws as reading, flattening, assembly and runs do.
Programme run_programme(const std::filesystem::path& file, std::string text,
                        const diagram::BlockLibrary& library);

/// A row for each published value: programme, value, published with its uncertainty, computed, and the
/// difference over the uncertainty, marked where it is above 1: "explained" where the file says why.
Table agreement_table(const std::vector<Programme>& programmes);

/// "12 programmes, 30 published values: 27 agree, 2 differ and are explained, 1 differs", and how many are
/// held against a picture or composed here.
std::string agreement_summary(const std::vector<Programme>& programmes);

/// Whether every value agrees, or its file says why not.
bool all_known(const std::vector<Programme>& programmes);

}  // namespace oblique::report
