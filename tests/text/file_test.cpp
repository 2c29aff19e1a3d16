// SPDX-License-Identifier: MIT
#include <csignal>
#include <filesystem>
#include <fstream>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/text/document.h>
#include <oblique/text/file.h>
#include <oblique/text/leftover.h>
#include <oblique/text/output_claim.h>

namespace oblique::text {
namespace {

/// A folder of its own for each test, empty at the start and gone at the end.
class File : public ::testing::Test {
 protected:
  File() {
    std::string name = testing::TempDir() + "oblique-file-XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  ~File() override { std::filesystem::remove_all(folder_); }

  std::size_t files() const {
    const std::filesystem::directory_iterator all(folder_);
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }

  std::filesystem::path folder_;
};

TEST_F(File, IsReadBackAsWritten) {
  const std::string text("line\nφ\0\r\n", 10);
  write_file(folder_ / "a.csv", text);
  EXPECT_EQ(read_file(folder_ / "a.csv"), text);
  write_file(folder_ / "a.csv", "");
  EXPECT_EQ(read_file(folder_ / "a.csv"), "");
  EXPECT_EQ(files(), 1U);
}

// Linux gives no first byte of a program's memory: what a damaged disk does, it does at once.
TEST_F(File, ThatCannotBeReadToItsEndIsRefused) {
  try {
    read_file("/proc/self/mem");
    FAIL() << "was read";
  } catch (const ReadError& error) {
    EXPECT_STREQ(error.what(),
                 "/proc/self/mem: cannot read the file: Input/output error\n"
                 "  remedy: it, or the disk that it is on, may be damaged: read a copy");
  }
}

// A device may give bytes for ever.
TEST_F(File, ThatIsTooLongIsRefused) {
  EXPECT_THAT([] { read_file("/dev/zero"); },
              ::testing::ThrowsMessage<ReadError>(
                  "/dev/zero: the file has more than 256 MiB\n  remedy: split it, or leave out rows"));
}

// The system would read the name up to the NUL, and another file.
TEST_F(File, HasNoNulInItsName) {
  write_file(folder_ / "a.csv", "text");
  const std::string name = (folder_ / "a.csv").string();
  EXPECT_THAT([&] { read_file(name + std::string("\0.csv", 5)); },
              ::testing::ThrowsMessage<ReadError>(
                  name + "␀.csv: no file has a NUL character in its name\n  remedy: correct the name"));
}

TEST_F(File, KeepsItsPermissions) {
  write_file(folder_ / "a.csv", "old");
  std::filesystem::permissions(folder_ / "a.csv", std::filesystem::perms(0600));
  write_file(folder_ / "a.csv", "new");
  EXPECT_EQ(std::filesystem::status(folder_ / "a.csv").permissions(), std::filesystem::perms(0600));
}

TEST_F(File, BehindALinkIsReplacedAndTheLinkKept) {
  write_file(folder_ / "a.csv", "old");
  std::filesystem::create_symlink("a.csv", folder_ / "link");
  write_file(folder_ / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link"));
  EXPECT_EQ(read_file(folder_ / "a.csv"), "new");
}

TEST_F(File, BehindALinkThatLedNowhereIsMadeThere) {
  std::filesystem::create_directory(folder_ / "b");
  std::filesystem::create_symlink("b/next", folder_ / "link");
  std::filesystem::create_symlink("../a.csv", folder_ / "b/next");
  write_file(folder_ / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "b/next"));
  EXPECT_EQ(read_file(folder_ / "a.csv"), "new");
}

TEST_F(File, BehindALinkToItselfIsRefused) {
  std::filesystem::create_symlink("link", folder_ / "link");
  EXPECT_THAT([&] { write_file(folder_ / "link", "text"); },
              ::testing::ThrowsMessage<ReadError>(
                  (folder_ / "link").string() + ": cannot write the file: Too many levels of symbolic links\n"
                                                "  remedy: name a file: this link leads back to itself"));
  EXPECT_EQ(files(), 1U);
}

TEST_F(File, AndFolderThatAreLeftOverAreClearedAway) {
  write_file(folder_ / "kept", "text");
  write_file(folder_ / "forgotten", "text");
  std::filesystem::create_directory(folder_ / "scratch");
  write_file(folder_ / "scratch/part", "text");
  Leftover scratch, part;
  scratch.remember((folder_ / "scratch").native());
  part.remember((folder_ / "scratch/part").native());
  {
    Leftover forgotten;
    forgotten.remember((folder_ / "forgotten").native());
  }
  clear_away_leftovers();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "scratch"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "kept"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "forgotten"));
}

TEST_F(File, ThatIsClaimedIsNotReadUntilTheClaimEnds) {
  write_file(folder_ / "a.csv", "text");
  std::filesystem::create_hard_link(folder_ / "a.csv", folder_ / "b.csv");
  {
    const OutputClaim claim(folder_ / "b.csv");
    EXPECT_THAT([&] { read_file(folder_ / "a.csv"); },
                ::testing::ThrowsMessage<ReadError>(
                    (folder_ / "b.csv").string() + ": this file is read, as " + (folder_ / "a.csv").string() +
                    ", and would be replaced\n  remedy: write to another file"));
    EXPECT_THAT([&] { const OutputClaim again(folder_ / "a.csv"); },
                ::testing::ThrowsMessage<ReadError>((folder_ / "a.csv").string() +
                                                    ": two results would go to this file\n"
                                                    "  remedy: name two files"));
  }
  EXPECT_EQ(read_file(folder_ / "a.csv"), "text");
}

TEST_F(File, ThatIsReadIsRecordedAsLongAsTheRecordLives) {
  write_file(folder_ / "a.csv", "text");
  write_file(folder_ / "b.csv", "text");
  std::filesystem::create_symlink("a.csv", folder_ / "link.csv");
  read_file(folder_ / "b.csv");
  std::vector<std::filesystem::path> inputs;
  {
    const InputRecord record;
    read_file(folder_ / "a.csv");
    inputs = record.files();
  }
  EXPECT_EQ(inputs, std::vector<std::filesystem::path>{folder_ / "a.csv"});
  EXPECT_THAT([&] { refuse_output(folder_ / "link.csv", inputs); },
              ::testing::ThrowsMessage<ReadError>(
                  (folder_ / "link.csv").string() + ": this file is read, as " +
                  (folder_ / "a.csv").string() + ", and would be replaced\n  remedy: write to another file"));
  EXPECT_NO_THROW(refuse_output(folder_ / "b.csv", inputs));
  EXPECT_NO_THROW(refuse_output(folder_ / "new.csv", inputs));
}

// A device must be written to and never replaced by a file, which root otherwise could.
TEST_F(File, ThatIsADeviceIsWrittenToAndNotReplaced) {
  std::filesystem::create_symlink("/dev/null", folder_ / "sink");
  write_file(folder_ / "sink", "text");
  EXPECT_TRUE(std::filesystem::is_character_file(folder_ / "sink"));
  std::filesystem::create_symlink("/dev/full", folder_ / "full");
  EXPECT_THAT([&] { write_file(folder_ / "full", "text"); },
              ::testing::ThrowsMessage<ReadError>(
                  (folder_ / "full").string() +
                  ": cannot write the file: No space left on device\n  remedy: make room on "
                  "the disk"));
}

TEST_F(File, IsWrittenWholeOrNotAtAll) {
  write_file(folder_ / "a.csv", "old");
  // A limit on the size of files makes the write fail half-way, for root too.
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  getrlimit(RLIMIT_FSIZE, &old_limit);
  rlimit limit = old_limit;
  limit.rlim_cur = 4096;
  setrlimit(RLIMIT_FSIZE, &limit);
  std::string message = "no error";
  try {
    write_file(folder_ / "a.csv", std::string(100'000, 'x'));
  } catch (const ReadError& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(
      message,
      (folder_ / "a.csv").string() +
          ": cannot write the file: File too large\n  remedy: name a file in a folder that exists and that "
          "you may write to");
  EXPECT_EQ(read_file(folder_ / "a.csv"), "old");
  EXPECT_EQ(files(), 1U) << "no litter";
}

TEST_F(File, InAMissingFolderCannotBeWritten) {
  EXPECT_THAT([&] { write_file(folder_ / "no" / "a.csv", "text"); },
              ::testing::ThrowsMessage<ReadError>(
                  (folder_ / "no" / "a.csv").string() +
                  ": cannot write the file: No such file or directory\n  remedy: name a file "
                  "in a folder that exists and that you may write to"));
}

TEST_F(File, ThatIsAFolderIsNoFile) {
  EXPECT_THAT([&] { write_file(folder_, "text"); },
              ::testing::ThrowsMessage<ReadError>(
                  folder_.string() + ": cannot write the file: Is a directory\n  remedy: name a file in it"));
  EXPECT_THAT([&] { read_file(folder_); },
              ::testing::ThrowsMessage<ReadError>(
                  folder_.string() + ": this is a directory, not a file\n  remedy: name a file in it"));
  EXPECT_TRUE(std::filesystem::is_directory(folder_));
}

TEST_F(File, ThatIsMissingCannotBeRead) {
  EXPECT_THAT([&] { read_document(folder_ / "no.toml"); },
              ::testing::ThrowsMessage<ReadError>(
                  (folder_ / "no.toml").string() +
                  ": cannot open the file: No such file or directory\n  remedy: check the "
                  "spelling and the folder you stand in"));
}

TEST_F(File, ThatIsMissingIsLookedForByItsNeighbours) {
  write_file(folder_ / "lesson.toml", "a = 1");
  const auto remedy = [](const std::filesystem::path& path) {
    try {
      read_file(path);
    } catch (const ReadError& error) {
      const std::string message = error.what();
      return message.substr(message.find("remedy: ") + 8);
    }
    return std::string();
  };
  EXPECT_EQ(remedy(folder_ / "leson.toml"), "did you mean '" + (folder_ / "lesson.toml").string() + "'?");
  EXPECT_EQ(remedy(folder_ / "other-name.toml"), "check the spelling and the folder you stand in");
  EXPECT_EQ(remedy(folder_ / "none" / "lesson.toml"),
            "there is no folder '" + (folder_ / "none").string() +
                "': check its spelling and the folder you stand in");
}

TEST_F(File, ThatMayNotBeReadSaysSo) {
  write_file(folder_ / "a.toml", "a = 1");
  std::filesystem::permissions(folder_ / "a.toml", std::filesystem::perms::none);
  // Root may read everything, so root becomes somebody else for a moment.
  constexpr uid_t kNobody = 65534;
  const uid_t self = geteuid();
  if (self == 0) {
    ASSERT_EQ(seteuid(kNobody), 0);
  }
  std::string message = "no error";
  try {
    read_document(folder_ / "a.toml");
  } catch (const ReadError& error) {
    message = error.what();
  }
  if (self == 0) {
    ASSERT_EQ(seteuid(self), 0);
  }
  EXPECT_EQ(message, (folder_ / "a.toml").string() +
                         ": cannot open the file: Permission denied\n  remedy: check its permissions");
}

TEST_F(File, IsADocumentWithItsPathAsName) {
  write_file(folder_ / "a.toml", "a = 1\n");
  const Document document = read_document(folder_ / "a.toml");
  EXPECT_EQ(document.file, (folder_ / "a.toml").string());
  EXPECT_EQ(document.root.find("a")->number, 1);
}

}  // namespace
}  // namespace oblique::text
