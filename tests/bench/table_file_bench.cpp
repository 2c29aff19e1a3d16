// SPDX-License-Identifier: MIT
// A table of the width of a walking mechanism's motion, written row by row, against fwrite of the same bytes
// in large blocks. Both end in the system's memory for files; the disk itself is not measured.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <unistd.h>

#include <oblique/text/table_file.h>

#include "figures.h"

namespace oblique::bench {
namespace {

constexpr std::size_t kColumns = 115;
constexpr std::size_t kBlockRows = 1000;

std::filesystem::path scratch_file(const std::string& ending) {
  return std::filesystem::temp_directory_path() / fmt::format("oblique-bench-{}{}", getpid(), ending);
}

/// CPU time of writing `size` bytes, `block` again and again [s].
double time_plain(std::size_t size, const std::vector<double>& block) {
  const std::filesystem::path path = scratch_file("");
  const double begin = cpu_seconds();
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  std::size_t written = 0;
  while (file != nullptr && written < size) {
    const std::size_t bytes = std::min(size - written, block.size() * sizeof(double));
    if (std::fwrite(block.data(), 1, bytes, file) != bytes) break;
    written += bytes;
  }
  if (file != nullptr) std::fclose(file);
  const double seconds = cpu_seconds() - begin;
  std::filesystem::remove(path);
  return written == size ? seconds : NAN;
}

struct Written {
  double seconds = 0;
  std::size_t bytes = 0;
};

/// The same by a TableFile, row by row.
Written time_table(const std::string& ending, std::size_t rows, const std::vector<double>& block) {
  const std::filesystem::path path = scratch_file(ending);
  std::vector<text::TableColumn> columns;
  for (std::size_t c = 0; c < kColumns; ++c) columns.push_back({fmt::format("P{}.x", c), "mm"});
  const double begin = cpu_seconds();
  text::TableFile file(path, std::move(columns), rows);
  for (std::size_t r = 0; r < rows; ++r)
    file.add(std::span(block).subspan(r % kBlockRows * kColumns, kColumns));
  file.finish();
  const double seconds = cpu_seconds() - begin;
  const Written written{seconds, std::filesystem::file_size(path)};
  std::filesystem::remove(path);
  return written;
}

void write_table(benchmark::State& state, const std::string& ending, std::size_t rows, double bound) {
  std::vector<double> block(kBlockRows * kColumns);
  for (std::size_t k = 0; k < block.size(); ++k) block[k] = 1 / (1 + static_cast<double>(k));
  std::vector<double> ratios, ours_times, plain_times;
  Written ours;
  bool ours_first = false;
  for (auto _ : state) {
    ours_first = !ours_first;  // whoever comes second finds pages of memory at hand
    if (ours_first || ours.bytes == 0) ours = time_table(ending, rows, block);
    const double plain = time_plain(ours.bytes, block);
    if (!ours_first) ours = time_table(ending, rows, block);
    state.SetIterationTime(ours.seconds + plain);
    ratios.push_back(ours.seconds / plain);
    ours_times.push_back(ours.seconds);
    plain_times.push_back(plain);
  }
  state.counters["ours_ms"] = 1e3 * median(ours_times);
  state.counters["fwrite_ms"] = 1e3 * median(plain_times);
  state.counters["MB"] = 1e-6 * static_cast<double>(ours.bytes);
  state.counters["ratio"] = median(ratios);
  record({fmt::format("table of 115 columns to {}, over fwrite of its bytes", ending), median(ratios), bound,
          ""});
}

BENCHMARK_CAPTURE(write_table, npy, ".npy", 200'000, 1.5)
    ->Name("table_npy")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(11);
BENCHMARK_CAPTURE(write_table, mat, ".mat", 200'000, 3)
    ->Name("table_mat")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(11);

}  // namespace
}  // namespace oblique::bench
