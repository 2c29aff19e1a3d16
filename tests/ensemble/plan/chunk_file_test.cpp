// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/chunk_file.h>

#include <bit>

#include <gtest/gtest.h>

#include "fake_work.h"

namespace oblique::ensemble {
namespace {

Chunk some_chunk() {
  fake::FakeWork fake(100);
  return run_chunk(fake.work, chunk_place(1, 4, 100));
}

std::vector<std::uint64_t> bits_of(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> bits;
  for (const double number : numbers) bits.push_back(std::bit_cast<std::uint64_t>(number));
  return bits;
}

TEST(ChunkFile, ReadsBackToTheSameBits) {
  Chunk chunk = some_chunk();
  // What has no other text than its bits.
  chunk.rows[0] = -0.0;
  chunk.rows[2] = std::numeric_limits<double>::infinity();
  chunk.rows[4] = std::numeric_limits<double>::denorm_min();
  chunk.head.count.warn(31, "it grew from \"nearly\" nothing");
  chunk.head.count.warn(27, "too near");
  chunk.head.count.measured(0.1 / 3);
  const ReadChunk read = parse_chunk(to_bytes(chunk));
  ASSERT_TRUE(read.chunk) << read.trouble;
  EXPECT_EQ(read.chunk->head.count.warned, 2U);
  EXPECT_EQ(read.chunk->head.count.first_warned, std::pair(std::uint64_t{27}, std::string("too near")));
  EXPECT_EQ(read.chunk->head.count.coarse, 1U);
  EXPECT_EQ(read.chunk->head.count.doubt, 0.1 / 3);
  EXPECT_EQ(read.chunk->head.identity, chunk.head.identity);
  EXPECT_EQ(read.chunk->head.place.number, 1U);
  EXPECT_EQ(read.chunk->head.place.chunks, 4U);
  EXPECT_EQ(read.chunk->head.place.first, 25U);
  EXPECT_EQ(read.chunk->head.place.count, 25U);
  EXPECT_EQ(read.chunk->head.columns, chunk.head.columns);
  EXPECT_EQ(read.chunk->head.failures, chunk.head.failures);
  EXPECT_EQ(read.chunk->head.failures.front().first, 28U);
  EXPECT_EQ(read.chunk->head.count.in_lanes, chunk.head.count.in_lanes);
  EXPECT_EQ(read.chunk->head.count.by_cvodes, chunk.head.count.by_cvodes);
  EXPECT_EQ(read.chunk->head.count.failed, 4U);
  EXPECT_EQ(read.chunk->head.count.reasons, chunk.head.count.reasons);
  EXPECT_EQ(bits_of(read.chunk->rows), bits_of(chunk.rows));
}

// Whichever byte is changed, and wherever the file ends.
TEST(ChunkFile, IsNotReadWhereAByteIsAnotherOrMissing) {
  const std::string bytes = to_bytes(some_chunk());
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    std::string changed = bytes;
    changed[k] = static_cast<char>(changed[k] ^ 4);
    EXPECT_FALSE(parse_chunk(changed).chunk) << k;
    EXPECT_FALSE(parse_chunk(bytes.substr(0, k)).chunk) << k;
    EXPECT_FALSE(parse_chunk(bytes.substr(0, k)).trouble.empty());
  }
  EXPECT_FALSE(parse_chunk(bytes + " ").chunk);
}

TEST(ChunkFile, SaysWhatIsWrongWithIt) {
  const std::string bytes = to_bytes(some_chunk());
  EXPECT_EQ(parse_chunk("").trouble, "the file is empty");
  EXPECT_EQ(parse_chunk(bytes.substr(0, 9)).trouble, "it ends in its first line");
  EXPECT_EQ(parse_chunk(bytes.substr(0, 400)).trouble,
            "it is not whole, or was changed: its bytes are not those that were written");
  EXPECT_EQ(parse_chunk("t,x\n1,2\n").trouble, "it is no chunk of an ensemble");
  EXPECT_EQ(parse_chunk("oblique-chunk/2 abc\n").trouble, "it is a chunk in a format of another version");
}

}  // namespace
}  // namespace oblique::ensemble
