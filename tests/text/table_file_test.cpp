// SPDX-License-Identifier: MIT
// What files of tables have in common, whatever their format.
#include <oblique/text/table_file.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <limits>
#include <sstream>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <nlohmann/json.hpp>

#include <oblique/text/csv.h>
#include <oblique/text/file.h>

#include "table_reading.h"

namespace oblique::text {
namespace {

using test::Folder;
using test::kInfinity;
using test::kNan;
using test::named;
using test::read_csv;
using test::read_json;
using test::read_mat;
using test::read_npy;
using test::ReadTable;
using test::written;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Format {
  const char* ending;
  ReadTable (*read)(const std::string&);
  bool knows_infinity;
};

void PrintTo(const Format& format, std::ostream* out) {
  *out << format.ending;
}

const std::vector<Format> kFormats{{".csv", read_csv, true},
                                   {".npy", read_npy, true},
                                   {".mat", read_mat, true},
                                   {".json", read_json, false}};

std::vector<std::uint64_t> bits_of(const std::vector<double>& values) {
  std::vector<std::uint64_t> bits;
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  return bits;
}

class TableFormats : public ::testing::TestWithParam<Format> {};
INSTANTIATE_TEST_SUITE_P(TableFile, TableFormats, ::testing::ValuesIn(kFormats),
                         [](const auto& tested) { return std::string(tested.param.ending + 1); });

TEST_P(TableFormats, ReadBackToTheSameBits) {
  const std::vector<double> values{0.0,    -0.0,    0.1,       1.0 / 3,  -2e-300, 5e-324,
                                   1e16,   1e15,    1e308,     123456.0, 2.0 / 3, 1.7976931348623157e308,
                                   1e-308, 9.9e-15, 1 + 2e-16, 4e22,     -1e23,   0.30000000000000004};
  const ReadTable table = GetParam().read(written(GetParam().ending, named({"t", "x", "y"}), values));
  EXPECT_THAT(table.names, ElementsAre("t", "x", "y"));
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> expected;
    for (std::size_t k = c; k < values.size(); k += 3) expected.push_back(values[k]);
    EXPECT_EQ(bits_of(table.columns.at(c)), bits_of(expected));
  }
}

TEST_P(TableFormats, KeepWhatIsNoNumber) {
  const ReadTable table =
      GetParam().read(written(GetParam().ending, named({"a", "b", "c"}), {kNan, kInfinity, -kInfinity}));
  EXPECT_TRUE(std::isnan(table.columns.at(0).at(0)));
  if (GetParam().knows_infinity) {
    EXPECT_EQ(table.columns.at(1).at(0), kInfinity);
    EXPECT_EQ(table.columns.at(2).at(0), -kInfinity);
  } else {
    EXPECT_TRUE(std::isnan(table.columns.at(1).at(0)));
  }
}

TEST_P(TableFormats, MayHaveNoRows) {
  const ReadTable table = GetParam().read(written(GetParam().ending, named({"t", "x"}), {}));
  EXPECT_THAT(table.names, ElementsAre("t", "x"));
  for (const auto& column : table.columns) EXPECT_THAT(column, IsEmpty());
}

// Blocks of every size against buffers of every kind: row by row, a prime number of rows, all at once; the
// value tells its place.
TEST_P(TableFormats, AreTheSameHoweverTheRowsCome) {
  constexpr std::size_t kRows = 12'007, kColumns = 117;
  std::vector<std::string> names;
  for (std::size_t c = 0; c < kColumns; ++c) names.push_back("c" + std::to_string(c));
  std::vector<double> values(kRows * kColumns);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = static_cast<double>(k);
  const std::string row_by_row = written(GetParam().ending, named(names), values, 1);
  for (const std::size_t block_rows : {std::size_t{211}, kRows})
    EXPECT_TRUE(written(GetParam().ending, named(names), values, block_rows) == row_by_row);
  const ReadTable table = GetParam().read(row_by_row);
  ASSERT_EQ(table.columns.size(), kColumns);
  for (std::size_t c = 0; c < kColumns; ++c) {
    ASSERT_EQ(table.columns[c].size(), kRows);
    for (std::size_t r = 0; r < kRows; ++r)
      ASSERT_EQ(table.columns[c][r], static_cast<double>(r * kColumns + c));
  }
}

TEST_P(TableFormats, LeaveNothingBehindWhereTheyAreNotFinished) {
  const Folder folder;
  const auto path = folder / (std::string("a") + GetParam().ending);
  { TableFile file(path, named({"t"}), 2); }
  EXPECT_THAT(folder.files(), IsEmpty());
  write_file(path, "old");
  {
    TableFile file(path, named({"t"}), 2);
    file.add(std::array{1.0});
    EXPECT_THROW(file.finish(), std::logic_error);
  }
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(folder.files().size(), 1U);
}

TEST_P(TableFormats, LeaveNothingBehindWhereTheProgramIsKilled) {
  const Folder folder;
  const int unnamed = open((folder / ".").c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (unnamed < 0) GTEST_SKIP() << "this file system knows no files without a name";
  close(unnamed);
  const pid_t child = fork();
  if (child == 0) {
    TableFile file(folder / (std::string("a") + GetParam().ending), named({"t"}), 1'000'000);
    file.add(std::vector<double>(900'000));
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_THAT(folder.files(), IsEmpty());
}

TEST_P(TableFormats, LeaveNothingBehindWhereTheDiskIsFull) {
  const Folder folder;
  const auto path = folder / (std::string("a") + GetParam().ending);
  write_file(path, "old");
  // A limit on the size of files makes the write fail half-way, for root too.
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  getrlimit(RLIMIT_FSIZE, &old_limit);
  rlimit limit = old_limit;
  limit.rlim_cur = 1024 * 1024;
  setrlimit(RLIMIT_FSIZE, &limit);
  std::string message = "no error";
  try {
    TableFile file(path, named({"t"}), 1'000'000);
    for (int block = 0; block < 1000; ++block) file.add(std::vector<double>(1000, 1.0 / 3));
    file.finish();
  } catch (const ReadError& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, HasSubstr(": cannot write the file: File too large"));
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(folder.files().size(), 1U);
}

TEST_P(TableFormats, SayThatADeviceIsFull) {
  const Folder folder;
  const auto path = folder / (std::string("full") + GetParam().ending);
  std::filesystem::create_symlink("/dev/full", path);
  EXPECT_THAT(
      [&] {
        TableFile file(path, named({"t"}), 1);
        file.add(std::array{1.0});
        file.finish();
      },
      ::testing::ThrowsMessage<ReadError>(
          path.string() +
          ": cannot write the file: No space left on device\n  remedy: make room on the disk"));
  EXPECT_TRUE(std::filesystem::is_character_file(path));
}

TEST_P(TableFormats, SayThatAFolderIsMissing) {
  const Folder folder;
  const auto path = folder / "no" / (std::string("a") + GetParam().ending);
  EXPECT_THAT([&] { TableFile(path, named({"t"}), 1); },
              ::testing::ThrowsMessage<ReadError>(
                  path.string() + ": cannot write the file: No such file or directory\n  remedy: name a file "
                                  "in a folder that exists and that you may write to"));
}

TEST_P(TableFormats, RefuseWhatIsNoRow) {
  const Folder folder;
  TableFile file(folder / (std::string("a") + GetParam().ending), named({"t", "x"}), 2);
  EXPECT_THROW(file.add(std::array{1.0, 2.0, 3.0}), std::logic_error);
  EXPECT_THROW(file.add(std::vector<double>(6)), std::logic_error);
  file.add(std::vector<double>(4));
  EXPECT_THROW(file.add(std::vector<double>(2)), std::logic_error);
}

RC_GTEST_PROP(TableFile, KeepsTheBitsOfAnyNumberInAnyFormat, ()) {
  const auto bits = *rc::gen::container<std::vector<std::uint64_t>>(8, rc::gen::arbitrary<std::uint64_t>());
  std::vector<double> values;
  for (const std::uint64_t pattern : bits) values.push_back(std::bit_cast<double>(pattern));
  for (const Format& format : kFormats) {
    const ReadTable table = format.read(written(format.ending, named({"a", "b"}), values));
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double read = table.columns.at(k % 2).at(k / 2);
      if (std::isfinite(values[k])) RC_ASSERT(std::bit_cast<std::uint64_t>(read) == bits[k]);
      if (std::isnan(values[k])) RC_ASSERT(std::isnan(read));
    }
  }
}

TEST(TableFile, OfAnUnknownKindNamesTheKnownOnes) {
  EXPECT_THAT(
      [&] { TableFile("no/such/x.xls", named({"t"}), 1); },
      ::testing::ThrowsMessage<ReadError>("no/such/x.xls: cannot write a '.xls' file; expected a name "
                                          "that ends in .csv, .npy, .mat or .json"));
  EXPECT_THAT(
      [&] { TableFile("table", named({"t"}), 1); },
      ::testing::ThrowsMessage<ReadError>("table: the name of this file has no ending; expected a name "
                                          "that ends in .csv, .npy, .mat or .json"));
}

TEST(TableFile, MayBeAPipeButForMat) {
  const Folder folder;
  for (const Format& format : kFormats) {
    const auto path = folder / (std::string("pipe") + format.ending);
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    const int reader = open(path.c_str(), O_RDWR | O_NONBLOCK);  // both ends, so that nobody waits
    const auto write = [&] {
      TableFile file(path, named({"t"}), 1);
      file.add(std::array{0.5});
      file.finish();
    };
    if (std::string(format.ending) == ".mat") {
      EXPECT_THAT(write, ::testing::ThrowsMessage<ReadError>(
                             path.string() + ": cannot write the file: Illegal seek\n  remedy: name a file "
                                             "on a disk: this format is not written in one pass"));
    } else {
      write();
      std::string bytes(4096, '\0');
      bytes.resize(static_cast<std::size_t>(read(reader, bytes.data(), bytes.size())));
      EXPECT_EQ(bytes, written(format.ending, named({"t"}), {0.5}));
    }
    close(reader);
  }
}

}  // namespace
}  // namespace oblique::text
