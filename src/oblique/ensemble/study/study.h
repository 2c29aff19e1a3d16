// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/ensemble/engine/ensemble.h>
#include <oblique/ensemble/study/plan.h>
#include <oblique/text/table_file.h>

namespace oblique::ensemble {

/// Thrown for a plan that makes no sense.
class StudyError : public text::Error {
 public:
  using text::Error::Error;
};

/// A row of a study: a machine, its varied values, its measures.
struct StudyRow {
  std::uint64_t number = 0;
  std::vector<double> values;  ///< of the columns of the study; measures of a failed run are no numbers
  std::string failure;         ///< why it failed, in a line; else empty
};

/// A plan with its subject read and understood, ready to run.
class Study {
 public:
  /// `text` is that of the subject; `library` must outlive the study. Throws StudyError with all findings,
  /// each at its place in the plan, and what reading and flattening the subject throws.
  Study(const Plan& plan, const std::string& text, const diagram::BlockLibrary& library, int threads);
  ~Study();
  Study(Study&&) noexcept;

  const std::string& title() const;  ///< of the subject
  /// So many machines. Of a grid each combination has one, or where elements scatter `Plan::runs`, one after
  /// the other; else there are `Plan::runs` altogether.
  std::uint64_t runs() const;
  /// The varied names first, the measures last.
  const std::vector<text::TableColumn>& columns() const;
  std::size_t n_varied() const;
  /// Whether a varied name's values are a range on a logarithmic scale.
  bool is_logarithmic(std::size_t varied) const;
  /// So many parameters are drawn by each machine.
  std::size_t n_drawn() const;
  /// With which each machine is run.
  const solve::RunOptions& run_options() const;

  /// Runs the machines `first` to `first + count − 1` and gives their rows in order. Where `interrupted` says
  /// so, only those that were done; it is asked before every machine.
  struct Rows {
    std::vector<StudyRow> rows;
    EnsembleCount count;
  };
  Rows run(std::uint64_t first, std::uint64_t count, const Ensemble::Progress& progress = {},
           const std::function<bool()>& interrupted = {}) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace oblique::ensemble
