// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cmath>
#include <limits>

#include <oblique/ensemble/plan/chunk_work.h>

namespace oblique::ensemble::fake {

/// An ensemble whose machines are known beforehand: machine k has the values k and sin k, and every one that
/// is divisible by seven but the first fails.
struct FakeWork {
  std::atomic<std::uint64_t> machines_run = 0;
  ChunkWork work;

  explicit FakeWork(std::uint64_t runs) {
    work.identity = {"0.1.0", "plan", "subject", "blocks"};
    work.runs = runs;
    work.columns = {{"k", {}, {}}, {"sine", {}, {}}};
    work.run = [this](std::uint64_t first, std::uint64_t count, const Ensemble::Progress& progress) {
      Study::Rows rows;
      for (std::uint64_t k = first; k < first + count; ++k) {
        StudyRow row{k, {static_cast<double>(k), std::sin(static_cast<double>(k))}, {}};
        if (fails(k)) {
          row.values[1] = std::numeric_limits<double>::quiet_NaN();
          row.failure = "it \"broke\"\nin two";
          ++rows.count.failed;
          ++rows.count.reasons["it failed"];
        }
        ++(fails(k) ? rows.count.by_cvodes : rows.count.in_lanes);
        rows.rows.push_back(std::move(row));
        ++machines_run;
        if (progress) progress(k - first + 1);
      }
      return rows;
    };
  }

  static bool fails(std::uint64_t k) { return k > 0 && k % 7 == 0; }
};

}  // namespace oblique::ensemble::fake
