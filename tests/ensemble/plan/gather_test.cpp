// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/gather.h>

#include <algorithm>

#include <fstream>
#include <iterator>
#include <numeric>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/scratch_folder.h"
#include "fake_work.h"

namespace oblique::ensemble {
namespace {

using fake::FakeWork;
using test::bytes_of;
using ::testing::HasSubstr;

struct GatherTest : public ::testing::Test {
  test::ScratchFolder folder;
  FakeWork fake{100};

  GatherTest() { std::filesystem::create_directory(folder / "chunks"); }

  void make(std::uint64_t number, std::uint64_t chunks) const {
    make_chunk(folder / "chunks", fake.work, chunk_place(number, chunks, 100));
  }
  std::filesystem::path file_of(std::uint64_t number, std::uint64_t chunks) const {
    return folder / "chunks" / file_name_of(fake.work.identity, chunk_place(number, chunks, 100));
  }
  Gathering look() const {
    return look_through(folder / "chunks", fake.work.identity, fake.work.runs, fake.work.columns.size());
  }
  std::string table(const std::string& ending) const {
    write_table(look(), fake.work.columns, folder / ("table" + ending));
    return bytes_of(folder / ("table" + ending));
  }
  std::string finding() const {
    try {
      look();
    } catch (const text::Error& error) {
      return error.what();
    }
    return "none";
  }
  static std::vector<std::uint64_t> numbers_of(const std::vector<ChunkPlace>& places) {
    std::vector<std::uint64_t> numbers;
    for (const ChunkPlace& place : places) numbers.push_back(place.number);
    return numbers;
  }
};

// However the ensemble is cut, and in whatever order the chunks are made.
TEST_F(GatherTest, GivesTheBytesOfTheSerialRun) {
  for (const char* ending : {".csv", ".npy", ".json", ".mat"}) {
    // The serial run, by the table alone.
    const Study::Rows serial = fake.work.run(0, 100, {});
    text::TableFile expected(folder / ("serial" + std::string(ending)), fake.work.columns, 100);
    for (const StudyRow& row : serial.rows) expected.add(row.values);
    expected.finish();
    std::mt19937 random(7);
    for (const std::uint64_t chunks : {1U, 2U, 7U, 100U}) {
      std::filesystem::remove_all(folder / "chunks");
      std::filesystem::create_directory(folder / "chunks");
      std::vector<std::uint64_t> order(chunks);
      std::iota(order.begin(), order.end(), 0U);
      std::shuffle(order.begin(), order.end(), random);
      for (const std::uint64_t number : order) make(number, chunks);
      EXPECT_EQ(table(ending), bytes_of(folder / ("serial" + std::string(ending)))) << chunks;
    }
  }
}

TEST_F(GatherTest, CountsWhatRanAndWhatFailed) {
  for (const std::uint64_t k : {0U, 1U, 2U}) make(k, 3);
  const Gathering gathering = look();
  ASSERT_TRUE(gathering.complete());
  EXPECT_EQ(gathering.count().failed, 14U);  // 7, 14 … 98
  EXPECT_EQ(gathering.count().by_cvodes, 14U);
  EXPECT_EQ(gathering.count().in_lanes, 86U);
  ASSERT_EQ(gathering.failures().size(), 14U);
  EXPECT_EQ(gathering.failures()[4].first, 35U);
  EXPECT_EQ(gathering.failures()[4].second, "it \"broke\"\nin two");
  EXPECT_EQ(rows_of(gathering, 2)[2 * 71], 71.0);
}

TEST_F(GatherTest, NamesWhatIsMissing) {
  EXPECT_EQ(look().chunks, 0U);
  EXPECT_FALSE(look().complete());
  for (const std::uint64_t k : {1U, 3U, 4U}) make(k, 6);
  Gathering gathering = look();
  EXPECT_FALSE(gathering.complete());
  EXPECT_EQ(gathering.chunks, 6U);
  EXPECT_EQ(numbers_of(gathering.missing), (std::vector<std::uint64_t>{0, 2, 5}));
  EXPECT_EQ(gathering.runs_there, 17U + 16U + 17U);  // [16, 33), [50, 66), [66, 83)
  for (const std::uint64_t k : {0U, 2U, 5U}) make(k, 6);
  EXPECT_TRUE(look().complete());
}

// An ensemble that was begun in four chunks and gone on with in ten.
TEST_F(GatherTest, TakesChunksOfSeveralCuts) {
  make(0, 4);
  make(2, 4);
  for (const std::uint64_t k : {2U, 3U, 4U, 7U, 8U}) make(k, 10);
  Gathering gathering = look();
  EXPECT_FALSE(gathering.complete());
  EXPECT_EQ(gathering.chunks, 10U);
  EXPECT_EQ(numbers_of(gathering.missing), std::vector<std::uint64_t>{9});
  make(9, 10);
  gathering = look();
  EXPECT_TRUE(gathering.complete());
  const std::vector<double> rows = rows_of(gathering, 2);
  ASSERT_EQ(rows.size(), 200U);
  for (std::size_t k = 0; k < 100; ++k) EXPECT_EQ(rows[2 * k], static_cast<double>(k));
}

TEST_F(GatherTest, CountsADamagedChunkAsMissing) {
  for (const std::uint64_t k : {0U, 1U, 2U}) make(k, 3);
  const std::string whole = bytes_of(file_of(1, 3));
  std::ofstream(file_of(1, 3), std::ios::binary) << whole.substr(0, whole.size() / 2);
  Gathering gathering = look();
  EXPECT_FALSE(gathering.complete());
  EXPECT_EQ(numbers_of(gathering.missing), std::vector<std::uint64_t>{1});
  ASSERT_EQ(gathering.damaged.size(), 1U);
  EXPECT_EQ(gathering.damaged[0].file, file_of(1, 3));
  EXPECT_EQ(gathering.damaged[0].trouble,
            "it is not whole, or was changed: its bytes are not those that were written");
  // All of them: into how many it was cut is still known from their names.
  for (const std::uint64_t k : {0U, 1U, 2U}) std::ofstream(file_of(k, 3), std::ios::binary) << "";
  gathering = look();
  EXPECT_EQ(gathering.chunks, 3U);
  EXPECT_EQ(gathering.missing.size(), 3U);
  for (const std::uint64_t k : {0U, 1U, 2U}) make(k, 3);
  EXPECT_TRUE(look().complete());
}

TEST_F(GatherTest, RefusesWhatDoesNotBelong) {
  make(0, 2);
  struct Case {
    Identity identity;
    const char* says;
  };
  const Identity own = fake.work.identity;
  const std::vector<Case> cases{
      {{"0.2.0", own.plan, own.subject, own.blocks},
       ": this chunk is of version 0.2.0 of the program; expected version 0.1.0, which reads it: "
       "another one may "
       "give other numbers\n  remedy: gather it with the version that made it, or delete it and run the "
       "chunk again"},
      {{own.version, "another", own.subject, own.blocks},
       ": this chunk is of another plan; expected chunks with just the settings and the seed of the plan\n  "
       "remedy: move "
       "this chunk to another folder, or gather those of the plan from one of their own"},
      {{own.version, own.plan, "another", own.blocks},
       ": this chunk is of another diagram or mechanism, or of an earlier state of it"},
      {{own.version, own.plan, own.subject, "another"},
       ": this chunk is of a run with other further blocks"}};
  for (const Case& one : cases) {
    FakeWork other(100);
    other.work.identity = one.identity;
    make_chunk(folder / "chunks", other.work, chunk_place(1, 2, 100));
    const std::filesystem::path file = folder / "chunks" / file_name_of(one.identity, chunk_place(1, 2, 100));
    EXPECT_THAT(finding(), HasSubstr(file.string() + one.says));
    std::filesystem::remove(file);
  }
}

// A thousand chunks of another plan are one finding, and one more of another kind is another.
TEST_F(GatherTest, CountsWhatDoesNotBelong) {
  FakeWork other(100), old(100);
  other.work.identity.plan = "another";
  old.work.identity.version = "0.0.7";
  for (const std::uint64_t k : {0U, 1U, 2U})
    make_chunk(folder / "chunks", other.work, chunk_place(k, 3, 100));
  make_chunk(folder / "chunks", old.work, chunk_place(0, 2, 100));
  const std::string found = finding();
  EXPECT_THAT(found, HasSubstr("this chunk is of another plan, and so are 2 more in the folder; expected"));
  EXPECT_THAT(found, HasSubstr("this chunk is of version 0.0.7 of the program; expected version 0.1.0"));
  EXPECT_EQ(std::count(found.begin(), found.end(), '\n'), 3) << found;  // two findings, each with its remedy
}

TEST_F(GatherTest, KnowsItsOwnBrokenFiles) {
  for (const std::uint64_t k : {0U, 1U}) make(k, 2);
  std::ofstream(file_of(1, 2), std::ios::binary) << "";
  std::ofstream(folder / "chunks/1-of-4-00.chunk") << "";
  std::ofstream(folder / "chunks/notes.chunk") << "hello";
  const Gathering gathering = look();
  EXPECT_EQ(gathering.chunks, 2U);
  ASSERT_EQ(gathering.damaged.size(), 3U);
  for (const Gathering::Damaged& one : gathering.damaged) EXPECT_EQ(one.is_ours, one.file == file_of(1, 2));
}

TEST_F(GatherTest, TellsOfAFolderThatIsNotThere) {
  std::filesystem::remove_all(folder / "chunks");
  EXPECT_THAT(finding(),
              HasSubstr("/chunks: cannot read the chunks here: No such file or directory; expected a folder "
                        "with chunks of the plan"));
}

TEST_F(GatherTest, NoticesAChunkThatChangesMeanwhile) {
  for (const std::uint64_t k : {0U, 1U}) make(k, 2);
  const Gathering gathering = look();
  std::ofstream(file_of(1, 2), std::ios::binary) << "x";
  EXPECT_THROW(write_table(gathering, fake.work.columns, folder / "table.csv"), text::ReadError);
  EXPECT_FALSE(std::filesystem::exists(folder / "table.csv"));
}

}  // namespace
}  // namespace oblique::ensemble
