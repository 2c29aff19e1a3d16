// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <oblique/ensemble/study/plan.h>

namespace oblique::ensemble {

/// What is wrong with a plan, or with what is asked of one.
class PlanError : public text::Error {
 public:
  using Error::Error;
};

/// A plan as a file, `oblique-ensemble/1`.
struct PlanFile {
  std::string title;
  std::string version;  ///< of the program that wrote it; empty: it does not say
  Plan plan;
};

/// Reads a plan's text. Paths in it are meant from the folder of `file`, and come joined to that. Throws
/// PlanError with all findings that can be known without the subject, ReadError for broken TOML.
PlanFile parse_plan(std::string_view text, std::string file);
PlanFile read_plan(const std::filesystem::path& path);

/// A plan as text: every key in one order, so that equal plans are equal texts. The path of the subject is
/// written as it would be read from the folder of `path`.
std::string write_plan(const PlanFile& file, const std::filesystem::path& path);

/// "grid", "latin-hypercube", "sobol".
std::string_view sampling_name(Sampling sampling);

}  // namespace oblique::ensemble
