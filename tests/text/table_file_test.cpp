// SPDX-License-Identifier: MIT
// Tables are read back by small readers of their own, written from the published formats.
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
#include <oblique/text/document.h>

namespace oblique {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What a reader found: the names and the values of each column.
struct ReadTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
};

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number number{};
  if (at + sizeof(number) > bytes.size()) throw std::runtime_error("the file ends in a number");
  std::memcpy(&number, bytes.data() + at, sizeof(number));
  return number;
}

/// Reads a file of NumPy with fields of doubles, as numpy.lib.format describes it.
ReadTable read_npy(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(0, 6), "\x93NUMPY");
  const int version = bytes.at(6);
  EXPECT_EQ(bytes.at(7), '\0');
  const std::size_t length_size = version == 1 ? 2 : 4;
  const std::size_t length =
      version == 1 ? number_at<std::uint16_t>(bytes, 8) : number_at<std::uint32_t>(bytes, 8);
  const std::size_t data = 8 + length_size + length;
  EXPECT_EQ(data % 64, 0U);
  EXPECT_EQ(bytes.at(data - 1), '\n');
  const std::string header = bytes.substr(8 + length_size, length);
  EXPECT_THAT(header, StartsWith("{'descr': [('"));
  EXPECT_THAT(header, HasSubstr("], 'fortran_order': False, 'shape': ("));
  ReadTable table;
  const std::string separator = ", '<f8')";
  for (std::size_t at = header.find("('"); at != std::string::npos && at < header.find("], 'fortran");) {
    std::string name;  // of a string of Python
    for (at += 2; header.at(at) != '\''; ++at) {
      if (header[at] == '\\' && header.at(++at) == 'x') {
        name += static_cast<char>(std::stoi(header.substr(at + 1, 2), nullptr, 16));
        at += 2;
      } else {
        name += header[at];
      }
    }
    EXPECT_EQ(header.substr(at + 1, separator.size()), separator);
    table.names.push_back(name);
    at = header.find("('", at);
  }
  const std::size_t rows = std::stoul(header.substr(header.find("'shape': (") + 10));
  table.columns.assign(table.names.size(), std::vector<double>(rows));
  EXPECT_EQ(bytes.size(), data + rows * table.names.size() * 8);
  std::size_t at = data;
  for (std::size_t r = 0; r < rows; ++r) {
    for (auto& column : table.columns) {
      column[r] = number_at<double>(bytes, at);
      at += 8;
    }
  }
  return table;
}

/// Reads a MAT-file of level 4 with full real matrices of doubles.
ReadTable read_mat(const std::string& bytes) {
  ReadTable table;
  std::size_t at = 0;
  while (at < bytes.size()) {
    EXPECT_EQ(number_at<std::int32_t>(bytes, at), 0) << "little endian, double, full matrix";
    const auto rows = static_cast<std::size_t>(number_at<std::int32_t>(bytes, at + 4));
    EXPECT_EQ(number_at<std::int32_t>(bytes, at + 8), 1) << "columns";
    EXPECT_EQ(number_at<std::int32_t>(bytes, at + 12), 0) << "no imaginary part";
    const auto length = static_cast<std::size_t>(number_at<std::int32_t>(bytes, at + 16));
    table.names.push_back(bytes.substr(at + 20, length - 1));
    EXPECT_EQ(bytes.at(at + 20 + length - 1), '\0');
    at += 20 + length;
    auto& column = table.columns.emplace_back(rows);
    for (double& value : column) {
      value = number_at<double>(bytes, at);
      at += 8;
    }
  }
  return table;
}

ReadTable read_json(const std::string& bytes) {
  const auto json = nlohmann::json::parse(bytes);
  EXPECT_EQ(json.size(), 2U);
  ReadTable table;
  for (const auto& column : json.at("columns")) table.names.push_back(column.at("name"));
  table.columns.resize(table.names.size());
  for (const auto& row : json.at("rows")) {
    EXPECT_EQ(row.size(), table.names.size());
    for (std::size_t c = 0; c < row.size(); ++c)
      table.columns[c].push_back(row[c].is_null() ? kNan : row[c].get<double>());
  }
  return table;
}

/// Cells of a CSV file without quotes; an empty one is NaN.
ReadTable read_csv(const std::string& bytes) {
  ReadTable table;
  std::istringstream lines(bytes);
  std::string line;
  const auto cells = [&] {
    std::vector<std::string> found(1);
    for (const char c : line) {
      if (c == ',')
        found.emplace_back();
      else
        found.back() += c;
    }
    return found;
  };
  std::getline(lines, line);
  table.names = cells();
  table.columns.resize(table.names.size());
  while (std::getline(lines, line)) {
    const auto row = cells();
    EXPECT_EQ(row.size(), table.names.size());
    for (std::size_t c = 0; c < row.size(); ++c)
      table.columns[c].push_back(row[c].empty() ? kNan : std::strtod(row[c].c_str(), nullptr));
  }
  return table;
}

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

/// A folder of its own, empty at the start and gone at the end.
class Folder {
 public:
  Folder() {
    std::string name = testing::TempDir() + "oblique-table-XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.push_back(entry.path().filename().string());
    return names;
  }

 private:
  std::filesystem::path path_;
};

std::vector<TableColumn> named(const std::vector<std::string>& names) {
  std::vector<TableColumn> columns;
  for (const std::string& name : names) columns.push_back({name});
  return columns;
}

/// The bytes of the file of a table, its rows added in blocks of `block_rows`.
std::string written(const std::string& ending, const std::vector<TableColumn>& columns,
                    const std::vector<double>& values, std::size_t block_rows = 1) {
  const Folder folder;
  const auto path = folder / ("table" + ending);
  TableFile file(path, columns, values.size() / columns.size());
  for (std::span<const double> left(values); !left.empty();) {
    const std::size_t taken = std::min(left.size(), block_rows * columns.size());
    file.add(left.first(taken));
    left = left.subspan(taken);
  }
  file.finish();
  EXPECT_THAT(folder.files(), ElementsAre("table" + ending));
  return read_file(path);
}

std::vector<std::uint64_t> bits_of(const std::vector<double>& values) {
  std::vector<std::uint64_t> bits;
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  return bits;
}

class TableFormats : public testing::TestWithParam<Format> {};
INSTANTIATE_TEST_SUITE_P(TableFile, TableFormats, testing::ValuesIn(kFormats),
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
      testing::ThrowsMessage<ReadError>(
          path.string() +
          ": cannot write the file: No space left on device\n  remedy: make room on the disk"));
  EXPECT_TRUE(std::filesystem::is_character_file(path));
}

TEST_P(TableFormats, SayThatAFolderIsMissing) {
  const Folder folder;
  const auto path = folder / "no" / (std::string("a") + GetParam().ending);
  EXPECT_THAT([&] { TableFile(path, named({"t"}), 1); },
              testing::ThrowsMessage<ReadError>(
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
  EXPECT_THAT([&] { TableFile("no/such/x.xls", named({"t"}), 1); },
              testing::ThrowsMessage<ReadError>("no/such/x.xls: cannot write a '.xls' file; expected a name "
                                                "that ends in .csv, .npy, .mat or .json"));
  EXPECT_THAT([&] { TableFile("table", named({"t"}), 1); },
              testing::ThrowsMessage<ReadError>("table: the name of this file has no ending; expected a name "
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
      EXPECT_THAT(write, testing::ThrowsMessage<ReadError>(
                             path.string() +
                             ": cannot write the file: Illegal seek\n  remedy: name a file on a disk: this "
                             "kind is not written from its start to its end"));
    } else {
      write();
      std::string bytes(4096, '\0');
      bytes.resize(static_cast<std::size_t>(read(reader, bytes.data(), bytes.size())));
      EXPECT_EQ(bytes, written(format.ending, named({"t"}), {0.5}));
    }
    close(reader);
  }
}

TEST(CsvFile, HasALineOfNamesAndALineARow) {
  EXPECT_EQ(written(".csv", {{"t", "s"}, {"C.x", "mm"}}, {0.0, 1.5, 0.1, -2e-300}),
            "t,C.x\n0,1.5\n0.1,-2e-300\n");
}

TEST(CsvFile, QuotesNamesAsRfc4180Says) {
  EXPECT_EQ(written(".csv", named({"a,b", "say \"x\"", "two\nlines", "plain name"}), {}),
            "\"a,b\",\"say \"\"x\"\"\",\"two\nlines\",plain name\n");
}

TEST(CsvFile, LeavesCellsEmptyAndWritesWords) {
  EXPECT_EQ(written(".csv", {{"x"}, {"status", "", {"ok", "dead-centre", "open"}}},
                    {1, 0, 2, 1, kNan, 2, kNan, kNan, 3, 7, 4, 0.5, 5, -1}),
            "x,status\n1,ok\n2,dead-centre\n,open\n,\n3,7\n4,0.5\n5,-1\n");
}

TEST(CsvFile, IsReadByOurOwnReader) {
  const CsvTable table = parse_csv(written(".csv", named({"t", "P.x"}), {0.1, 1e300, 0.2, -5e-324}), "t.csv");
  EXPECT_THAT(table.names, ElementsAre("t", "P.x"));
  EXPECT_THAT(table.columns[1], ElementsAre(1e300, -5e-324));
}

TEST(JsonFile, NamesColumnsWithUnitsAndThenRows) {
  EXPECT_EQ(written(".json", {{"t", "s"}, {"a\"\\\n", "mm"}, {"status", "", {"ok", "open"}}},
                    {0, 1.5, 0, -0.0, kNan, 1}),
            "{\"columns\": [{\"name\": \"t\", \"unit\": \"s\"}, {\"name\": \"a\\\"\\\\\\u000a\", \"unit\": "
            "\"mm\"}, {\"name\": \"status\", \"unit\": \"\"}],\n"
            "\"rows\": [\n[0, 1.5, \"ok\"],\n[-0.0, null, \"open\"]\n]}\n");
  EXPECT_EQ(nlohmann::json::parse(written(".json", named({"φ"}), {}))["columns"][0]["name"], "φ");
}

// The first 80 bytes of what numpy.save wrote for a table of these two fields and three rows (NumPy 1.24).
TEST(NpyFile, BeginsAsNumPyItselfWritesIt) {
  const std::string bytes = written(".npy", named({"t", "P5.x"}), {0, 1, 2, 3, 4, 5});
  const std::string header =
      "{'descr': [('t', '<f8'), ('P5.x', '<f8')], 'fortran_order': False, 'shape': (3,), }";
  EXPECT_EQ(bytes.substr(0, 10), std::string("\x93NUMPY\x01\x00\x76\x00", 10));
  EXPECT_EQ(bytes.substr(10, 0x76), header + std::string(0x76 - 1 - header.size(), ' ') + "\n");
  EXPECT_EQ(bytes.size(), 128U + 6 * 8);
}

TEST(NpyFile, KeepsAnyNameAndTellsEqualOnesApart) {
  const std::string bytes = written(".npy", named({"it's", "a\\b", "tab\t", "x", "x", "x_1", "class"}), {});
  EXPECT_EQ(bytes.at(6), 1);
  EXPECT_THAT(read_npy(bytes).names, ElementsAre("it's", "a\\b", "tab\t", "x", "x_1", "x_1_1", "class"));
}

TEST(NpyFile, TakesANewerVersionForOtherLettersAndManyColumns) {
  const std::string greek = written(".npy", named({"φ", "t"}), {1, 2});
  EXPECT_EQ(greek.at(6), 3);
  EXPECT_THAT(read_npy(greek).names, ElementsAre("φ", "t"));
  std::vector<std::string> names;
  for (int k = 0; k < 5000; ++k) names.push_back("column" + std::to_string(k));
  const std::string wide = written(".npy", named(names), std::vector<double>(5000, 1.5));
  EXPECT_EQ(wide.at(6), 2);
  EXPECT_EQ(read_npy(wide).names, names);
}

TEST(MatFile, HasTheBytesOfTheFormat) {
  using namespace std::string_literals;
  const std::string header = "\0\0\0\0\x02\0\0\0\x01\0\0\0\0\0\0\0"s;
  EXPECT_EQ(written(".mat", named({"t", "P.x"}), {1, -2, 0.5, kInfinity}),
            header + "\x02\0\0\0t\0"s + "\0\0\0\0\0\0\xF0\x3F\0\0\0\0\0\0\xE0\x3F"s + header +
                "\x04\0\0\0P_x\0"s + "\0\0\0\0\0\0\0\xC0\0\0\0\0\0\0\xF0\x7F"s);
}

TEST(MatFile, NamesVariablesAsMatlabAllows) {
  const auto names = [](const std::vector<std::string>& all) {
    return read_mat(written(".mat", named(all), {})).names;
  };
  EXPECT_THAT(names({"P5.x", "end", "2nd", "_a", "until", "φ̇", "", "a b"}),
              ElementsAre("P5_x", "xEnd", "x2nd", "x_a", "xUntil", "x__", "x", "a_b"));
  EXPECT_THAT(names({"P.x", "P_x", "P:x", "P_x_1"}), ElementsAre("P_x_2", "P_x", "P_x_3", "P_x_1"))
      << "good names stay";
  const std::string sixty(60, 'a');
  EXPECT_THAT(names({sixty + ".bcd", sixty + ".bce", sixty + "_bc"}),
              ElementsAre(sixty + "__1", sixty + "__2", sixty + "_bc"));
}

TEST(MatFile, SaysThatItCanHoldNoMore) {
  const Folder folder;
  EXPECT_THAT([&] { TableFile(folder / "a.mat", named({"t"}), 3'000'000'000); },
              testing::ThrowsMessage<ReadError>(
                  "the table is too long for a .mat file; expected 2147483647 rows at most\n  remedy: write "
                  ".npy"));
  EXPECT_THAT(folder.files(), IsEmpty());
}

}  // namespace
}  // namespace oblique
