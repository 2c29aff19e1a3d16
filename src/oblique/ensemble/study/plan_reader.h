// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <oblique/ensemble/study/combinations.h>
#include <oblique/ensemble/study/measure_program.h>
#include <oblique/ensemble/study/plan.h>
#include <oblique/ensemble/study/scatter.h>
#include <oblique/ensemble/study/subject.h>

// Of this stage; not installed.
namespace oblique::ensemble {

/// A column that measures take: an output of the machines, or one of the exact motion.
struct MeasuredColumn {
  std::string name;
  std::size_t output = 0;
  std::string exact;  ///< "B.x"; empty: an output
};

/// A plan whose names and expressions are understood.
struct Understood {
  std::unique_ptr<Subject> subject;
  bool mechanism = false;
  std::uint64_t seed = 1;
  Combinations combinations;

  // of the varied names
  std::vector<std::string> names, units;
  std::vector<double> lowest, highest, usual;
  std::vector<bool> logarithmic;

  std::vector<diagram::BlockFigure> scatters;

  std::vector<std::string> measure_names;
  std::vector<MeasureProgram> measures;
  std::vector<MeasuredColumn> measured;  ///< their columns behind the time
  bool asks_for_errors = false;          ///< they take the errors of the motion
};

/// Throws StudyError with all findings, and what reading and flattening the subject throws.
Understood understand(const Plan& plan, const std::string& text, const diagram::BlockLibrary& library);

}  // namespace oblique::ensemble
