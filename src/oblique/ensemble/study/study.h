// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/ensemble/engine/ensemble.h>
#include <oblique/ensemble/study/plan.h>
#include <oblique/text/table_file.h>

namespace oblique::ensemble {

/// A row of a study: a machine, its varied values, its measures.
struct StudyRow {
  std::uint64_t number = 0;
  std::vector<double> values;  ///< of the columns of the study; measures of a failed run are no numbers
  std::string failure;         ///< why it failed, in a line; else empty
};

/// A plan with its subject read and understood, ready to run.
class Study {
 public:
  /// `text` is that of the subject. Throws an error with all findings, each at its place in the plan.
  Study(const Plan& plan, const std::string& text, const diagram::BlockLibrary& library, int threads);
  ~Study();
  Study(Study&&) noexcept;

  std::uint64_t runs() const;
  /// The varied names first, the measures last.
  const std::vector<text::TableColumn>& columns() const;
  std::size_t n_varied() const;

  /// Runs the machines `first` to `first + count − 1` and gives their rows in order.
  struct Rows {
    std::vector<StudyRow> rows;
    EnsembleCount count;
  };
  Rows run(std::uint64_t first, std::uint64_t count, const Ensemble::Progress& progress = {}) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace oblique::ensemble
