// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/chunk_work.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../../support/scratch_folder.h"
#include "fake_work.h"

namespace oblique::ensemble {
namespace {

using fake::FakeWork;
using test::bytes_of;
using ::testing::HasSubstr;

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

struct ChunkWorkTest : public ::testing::Test {
  test::ScratchFolder folder;
  FakeWork fake{100};
  ChunkPlace place = chunk_place(1, 4, 100);
  std::filesystem::path file = folder / file_name_of(fake.work.identity, place);
};

TEST_F(ChunkWorkTest, RunsWhatIsNotThere) {
  EXPECT_TRUE(make_chunk(folder.path(), fake.work, place));
  EXPECT_EQ(fake.machines_run, 25U);
  EXPECT_EQ(bytes_of(file), to_bytes(run_chunk(fake.work, place)));
  fake.machines_run = 0;
  EXPECT_FALSE(make_chunk(folder.path(), fake.work, place));
  EXPECT_EQ(fake.machines_run, 0U);
}

TEST_F(ChunkWorkTest, ReplacesWhatIsDamaged) {
  make_chunk(folder.path(), fake.work, place);
  const std::string whole = bytes_of(file);
  for (const std::string& damaged :
       {whole.substr(0, whole.size() - 1), std::string(), whole + "x", std::string("x")}) {
    std::ofstream(file, std::ios::binary) << damaged;
    EXPECT_FALSE(is_done(file, fake.work, place));
    EXPECT_TRUE(make_chunk(folder.path(), fake.work, place));
    EXPECT_EQ(bytes_of(file), whole);
  }
  // A whole chunk of another version under this name.
  FakeWork other(100);
  other.work.identity.version = "0.2.0";
  std::ofstream(file, std::ios::binary) << to_bytes(run_chunk(other.work, place));
  EXPECT_TRUE(make_chunk(folder.path(), fake.work, place));
  EXPECT_EQ(bytes_of(file), whole);
}

TEST_F(ChunkWorkTest, LeavesNothingWhereTheWorkIsBrokenOff) {
  const auto broken_off = [](std::uint64_t done) {
    if (done > 3) throw std::runtime_error("enough");
  };
  EXPECT_THROW(make_chunk(folder.path(), fake.work, place, broken_off), std::runtime_error);
  EXPECT_EQ(files_in(folder.path()), 0U);
  EXPECT_TRUE(make_chunk(folder.path(), fake.work, place));
}

/// Starts the work in a process of its own, which ends with 9 where the work throws.
template <class Work>
pid_t start(const Work& work) {
  const pid_t child = fork();
  if (child != 0) return child;
  try {
    work();
  } catch (...) {
    _exit(9);
  }
  _exit(0);
}

int status_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

// Several that make the same chunk at the same time, each slowly, so that they meet.
TEST_F(ChunkWorkTest, MayBeMadeByManyAtOnce) {
  const auto slowly = [](std::uint64_t) { std::this_thread::sleep_for(std::chrono::microseconds(50)); };
  std::vector<pid_t> children;
  for (int k = 0; k < 4; ++k) {
    children.push_back(start([&] {
      for (int times = 0; times < 20; ++times) {
        make_chunk(folder.path(), fake.work, place, slowly);
        if (times % 5 == 0) std::filesystem::remove(file);
      }
    }));
  }
  for (const pid_t child : children) EXPECT_EQ(status_of(child), 0);
  make_chunk(folder.path(), fake.work, place);
  EXPECT_EQ(bytes_of(file), to_bytes(run_chunk(fake.work, place)));
  EXPECT_EQ(files_in(folder.path()), 1U);
}

// SIGKILL, at whatever time, leaves no file, or the whole one.
TEST_F(ChunkWorkTest, IsWholeOrNotThereAfterAKill) {
  const auto slowly = [](std::uint64_t) { std::this_thread::sleep_for(std::chrono::microseconds(20)); };
  int there = 0;
  for (int k = 0; k < 40; ++k) {
    std::filesystem::remove(file);
    const pid_t child = start([&] { make_chunk(folder.path(), fake.work, place, slowly); });
    std::this_thread::sleep_for(std::chrono::microseconds(150 * k));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (!std::filesystem::exists(file)) continue;
    ++there;
    EXPECT_TRUE(is_done(file, fake.work, place));
  }
  EXPECT_LT(there, 40);  // the first is killed at once
  make_chunk(folder.path(), fake.work, place);
  EXPECT_EQ(bytes_of(file), to_bytes(run_chunk(fake.work, place)));
}

TEST_F(ChunkWorkTest, TellsOfAFullDisk) {
  // A limit of the system in place of a disk: what is beyond it is not written.
  const int status = status_of(start([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{500, 500};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      make_chunk(folder.path(), fake.work, place);
    } catch (const text::ReadError& error) {
      _exit(std::string(error.what()).find("cannot write the file: File too large") != std::string::npos ? 7
                                                                                                         : 8);
    }
    _exit(9);
  }));
  EXPECT_EQ(status, 7);
  EXPECT_EQ(files_in(folder.path()), 0U);
}

std::string finding_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const text::Error& error) {
    return error.what();
  }
  return "none";
}

TEST_F(ChunkWorkTest, TellsOfAFolderThatTakesNoFile) {
  EXPECT_THAT(finding_of([&] { make_chunk(folder / "none", fake.work, place); }),
              HasSubstr("cannot write the file: No such file or directory"));
  EXPECT_EQ(fake.machines_run, 0U);  // nothing was run in vain
  std::ofstream(folder / "file") << "x";
  EXPECT_THAT(finding_of([&] { make_folder(folder / "file"); }),
              ::testing::AllOf(HasSubstr("/file: no folder can be made here: "),
                               HasSubstr("expected a folder for the chunks, which you may write to\n"
                                         "  remedy: name another one, or see to its permissions")));
  EXPECT_THAT(finding_of([&] { make_folder(folder / "file/below"); }),
              HasSubstr("/file/below: no folder can be made here"));
  make_folder(folder / "new/folder");
  make_folder(folder / "new/folder");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "new/folder"));
}

TEST(UsualChunks, HaveAThousandRunsOrAre) {
  EXPECT_EQ(usual_chunks(1), 1U);
  EXPECT_EQ(usual_chunks(1000), 1U);
  EXPECT_EQ(usual_chunks(1001), 2U);
  EXPECT_EQ(usual_chunks(1'000'000), 1000U);
  EXPECT_EQ(usual_chunks(50'000'000), 1000U);
}

}  // namespace
}  // namespace oblique::ensemble
