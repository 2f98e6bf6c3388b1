// SPDX-License-Identifier: Apache-2.0
#include "service/recording/mcap/writer.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>

#include "support/mcap_reading.hpp"
#include "support/text_file.hpp"

namespace meridian::mcap {
namespace {

using test::read_mcap;
using test::read_text;
using test::TextFile;

[[nodiscard]] std::string hex(std::string_view bytes) {
  std::string out;
  for (const char byte : bytes) {
    char two[3];
    std::snprintf(two, sizeof two, "%02X", static_cast<unsigned char>(byte));
    out += two;
  }
  return out;
}

[[nodiscard]] std::string without_spaces(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c != ' ' && c != '\n') out.push_back(c);
  }
  return out;
}

/// A file with channels /a and /b, whose messages are texts of 19 bytes: 50 with what is around.
class TwoTopics {
 public:
  explicit TwoTopics(const std::string& path, WriterSettings settings = {})
      : writer_(std::move(*Writer::create(path, settings))) {
    const std::uint16_t schema = writer_->add_schema("Text", "", "");
    a_ = writer_->add_channel(schema, "/a", "text");
    b_ = writer_->add_channel(schema, "/b", "text");
  }
  bool write_a(std::uint64_t time_ns) { return writer_->write(a_, time_ns, text_of(time_ns)); }
  bool write_b(std::uint64_t time_ns) { return writer_->write(b_, time_ns, text_of(time_ns)); }
  [[nodiscard]] Writer& writer() { return *writer_; }
  [[nodiscard]] static std::string text_of(std::uint64_t time_ns) {
    char text[20];
    std::snprintf(text, sizeof text, "%019llu", static_cast<unsigned long long>(time_ns));
    return text;
  }

 private:
  std::unique_ptr<Writer> writer_;
  std::uint16_t a_ = 0, b_ = 0;
};

/// The records of one message, byte by byte as the format's specification has them; the three sums
/// were computed by zlib.
constexpr std::string_view kSmallFile =
    "894D434150300D0A "                                                  // magic, 8 bytes
    "01 0A00000000000000 01000000 70 01000000 6C "                       // header "p", "l": to 27
    "03 1100000000000000 0100 01000000 53 01000000 65 01000000 74 "      // schema: to 53
    "04 1300000000000000 0000 0100 02000000 2F74 01000000 78 00000000 "  // channel: to 81
    "06 4900000000000000 0500000000000000 0500000000000000 2100000000000000 3E4380B4 00000000 "
    "2100000000000000 "                                                          // chunk: to 163
    "05 1800000000000000 0000 00000000 0500000000000000 0500000000000000 6162 "  // its message
    "07 1600000000000000 0000 10000000 0500000000000000 0000000000000000 "       // index: to 194
    "0F 0400000000000000 FB62D62B "                                              // end: to 207
    "03 1100000000000000 0100 01000000 53 01000000 65 01000000 74 "              // to 233
    "04 1300000000000000 0000 0100 02000000 2F74 01000000 78 00000000 "          // to 261
    "0B 3800000000000000 0100000000000000 0100 01000000 00000000 00000000 01000000 "
    "0500000000000000 0500000000000000 0A000000 0000 0100000000000000 "  // statistics: to 326
    "08 4A00000000000000 0500000000000000 0500000000000000 5100000000000000 5200000000000000 "
    "0A000000 0000 A300000000000000 1F00000000000000 00000000 2100000000000000 "
    "2100000000000000 "  // chunk index: to 409
    "0E 1100000000000000 03 CF00000000000000 1A00000000000000 "
    "0E 1100000000000000 04 E900000000000000 1C00000000000000 "
    "0E 1100000000000000 0B 0501000000000000 4100000000000000 "
    "0E 1100000000000000 08 4601000000000000 5300000000000000 "  // summary offsets: to 513
    "02 1400000000000000 CF00000000000000 9901000000000000 339610AC "
    "894D434150300D0A";

TEST(McapWriter, WritesASmallFileAsItIsWorkedOutByHand) {
  const TextFile file("", ".mcap");
  auto writer = Writer::create(file.path(),
                               {.profile = "p", .library = "l", .compression = Compression::kNone});
  ASSERT_TRUE(writer.has_value());
  const std::uint16_t schema = (*writer)->add_schema("S", "e", "t");
  const std::uint16_t channel = (*writer)->add_channel(schema, "/t", "x");
  EXPECT_TRUE((*writer)->write(channel, 5, "ab"));
  EXPECT_TRUE((*writer)->close());
  EXPECT_EQ(hex(read_text(file.path())), without_spaces(kSmallFile));
  EXPECT_EQ((*writer)->size(), without_spaces(kSmallFile).size() / 2);
}

TEST(McapWriter, EndsAChunkWithTheMessageThatFillsIt) {
  const TextFile file("", ".mcap");
  TwoTopics topics(file.path(), {.compression = Compression::kNone, .chunk_bytes = 150});
  for (std::uint64_t time = 0; time < 7; ++time) EXPECT_TRUE(topics.write_a(time));
  EXPECT_TRUE(topics.writer().close());
  EXPECT_EQ(read_mcap(read_text(file.path())).chunks, (std::vector<std::size_t>{3, 3, 1}));

  TwoTopics next(file.path(), {.compression = Compression::kNone, .chunk_bytes = 151});
  for (std::uint64_t time = 0; time < 8; ++time) EXPECT_TRUE(next.write_a(time));
  EXPECT_TRUE(next.writer().close());
  EXPECT_EQ(read_mcap(read_text(file.path())).chunks, (std::vector<std::size_t>{4, 4}));
}

TEST(McapWriter, GivesBackEveryMessageOfEveryChannelPackedOrNot) {
  for (const Compression compression : {Compression::kNone, Compression::kZstd}) {
    const TextFile file("", ".mcap");
    TwoTopics topics(file.path(), {.compression = compression, .chunk_bytes = 2000});
    for (std::uint64_t time = 0; time < 1000; ++time) {
      EXPECT_TRUE(time % 3 == 0 ? topics.write_b(time) : topics.write_a(time));
    }
    EXPECT_TRUE(topics.writer().close());
    const auto content = read_mcap(read_text(file.path()));
    EXPECT_TRUE(content.has_end && content.is_sound);
    ASSERT_EQ(content.messages.size(), 1000U);
    std::map<std::string, std::uint32_t> sequence;
    for (std::uint64_t time = 0; time < 1000; ++time) {
      const auto& message = content.messages[time];
      EXPECT_EQ(message.topic, time % 3 == 0 ? "/b" : "/a");
      EXPECT_EQ(message.sequence, sequence[message.topic]++);
      EXPECT_EQ(message.time_ns, time);
      EXPECT_EQ(message.data, TwoTopics::text_of(time));
    }
  }
}

TEST(McapWriter, PacksWhatRepeatsItself) {
  const TextFile plain("", ".mcap"), packed("", ".mcap");
  for (const auto* file : {&plain, &packed}) {
    TwoTopics topics(file->path(),
                     {.compression = file == &packed ? Compression::kZstd : Compression::kNone});
    for (std::uint64_t time = 0; time < 10'000; ++time) EXPECT_TRUE(topics.write_a(time));
    EXPECT_TRUE(topics.writer().close());
  }
  // 16 bytes a message stay as they are: its place in the index.
  EXPECT_LT(std::filesystem::file_size(packed.path()) - 160'000,
            (std::filesystem::file_size(plain.path()) - 160'000) / 4);
}

TEST(McapWriter, LeavesAReadablePrefixWhereverItsProcessEnds) {
  const TextFile file("", ".mcap");
  TwoTopics topics(file.path(), {.chunk_bytes = 500});
  for (std::uint64_t time = 0; time < 95; ++time) EXPECT_TRUE(topics.write_a(time));
  // Nothing was closed: what the system has is what a killed process leaves.
  const std::string left = read_text(file.path());
  const auto content = read_mcap(left);
  EXPECT_FALSE(content.has_end);
  EXPECT_TRUE(content.is_sound);
  EXPECT_EQ(content.messages.size(), 90U) << "all but those of the chunk that was not full";
  for (std::size_t length = 8; length < left.size(); ++length) {
    const auto part = read_mcap(std::string_view(left).substr(0, length));
    ASSERT_TRUE(part.is_sound) << length;
    ASSERT_EQ(part.messages.size() % 10, 0U) << length;
  }
}

TEST(McapWriter, HandsOverAChunkThatIsNotFullWhenAsked) {
  const TextFile file("", ".mcap");
  TwoTopics topics(file.path());
  EXPECT_TRUE(topics.write_a(1));
  EXPECT_TRUE(read_mcap(read_text(file.path())).messages.empty());
  EXPECT_TRUE(topics.writer().end_chunk());
  EXPECT_EQ(read_mcap(read_text(file.path())).messages.size(), 1U);
  EXPECT_TRUE(topics.writer().end_chunk()) << "nothing waits";
  EXPECT_TRUE(topics.writer().close());
  EXPECT_EQ(read_mcap(read_text(file.path())).chunks.size(), 1U);
}

TEST(McapWriter, ClosesAFileWithoutMessages) {
  const TextFile file("", ".mcap");
  TwoTopics topics(file.path());
  topics.writer().add_metadata("meridian", {{"machine", "lai"}});
  EXPECT_TRUE(topics.writer().close());
  const auto content = read_mcap(read_text(file.path()));
  EXPECT_TRUE(content.has_end);
  EXPECT_TRUE(content.chunks.empty());
  EXPECT_EQ(content.metadata.at("machine"), "lai");
  EXPECT_FALSE(topics.write_a(1)) << "it is closed";
}

TEST(McapWriter, SaysWhyAFileCannotBeCreated) {
  const auto writer = Writer::create("/nowhere/at-all.mcap", {});
  ASSERT_FALSE(writer.has_value());
  EXPECT_EQ(writer.error(), ENOENT);
}

TEST(McapWriter, SaysThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  TwoTopics topics("/dev/full", {.chunk_bytes = 100});
  EXPECT_FALSE(topics.write_a(1) && topics.write_a(2) && topics.write_a(3));
  EXPECT_EQ(topics.writer().error_number(), ENOSPC);
  EXPECT_FALSE(topics.writer().close());
}

}  // namespace
}  // namespace meridian::mcap
