// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <oblique/mechanism/motion/motion.h>
#include <oblique/report/text_table.h>
#include <oblique/text/diagnostic.h>
#include <oblique/text/table_file.h>

/// What a motion says to people, part by part. Not installed.
namespace oblique::report {

/// The columns of a motion's table: `mechanism::motion_values` and, as words, `status`.
std::vector<text::TableColumn> motion_table_columns(const mechanism::Mechanism& mechanism);

/// The rows of a motion that are shown, evenly spread, and how it fares as a whole: gathered row by row,
/// since a motion may be too long to be held.
class MotionDigest {
 public:
  /// Of a motion of so many positions.
  explicit MotionDigest(std::size_t positions);

  /// The next row: its values, which begin with `mechanism::motion_values`, and its status.
  void add(std::span<const double> values, mechanism::Status status);

  std::size_t positions() const { return positions_; }
  std::size_t open() const { return open_; }
  std::size_t shown() const { return rows_.size(); }

  /// Time, the drives and the coordinates of the moving points, as many columns as may be; and the status.
  Table table(const mechanism::Mechanism& mechanism, std::size_t most_columns) const;

  /// A line each where there are dead centres and positions that cannot be assembled.
  std::string remarks(const text::Vocabulary& vocabulary = text::plain_vocabulary()) const;

 private:
  std::size_t positions_;
  std::vector<std::size_t> chosen_;  ///< numbers of the rows to be shown
  std::vector<std::vector<double>> rows_;
  std::vector<mechanism::Status> statuses_;  ///< of `rows_`
  std::size_t added_ = 0, open_ = 0, dead_centres_ = 0;
};

/// Where the motion meets a limit, a change point or infinity: a line each, eight of them.
std::string events_text(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                        const std::vector<mechanism::MotionEvent>& events);

}  // namespace oblique::report
