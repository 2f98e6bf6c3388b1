// SPDX-License-Identifier: Apache-2.0
#include "meridian/planner/motion_port.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "meridian/planner/motion_ahead.hpp"

namespace meridian {
namespace {

/// Writes windows of an epoch; `sequence` names each piece.
struct Script {
  std::unique_ptr<MotionPort> port = std::make_unique<MotionPort>();
  MotionWriter writer{*port};
  MotionReader reader{*port};
  std::uint64_t paths = 0;
  std::uint16_t epoch = 0;

  void move(std::uint32_t window, std::uint64_t name, bool is_from_rest, bool is_tail = false,
            double duration = 0) {
    PathPiece path;
    path.index = paths;
    path.epoch = epoch;
    path.sequence = name;
    TimePiece time;
    time.window = window;
    time.epoch = epoch;
    time.sequence = name;
    time.path_index = paths++;
    time.is_from_rest = is_from_rest;
    time.is_tail = is_tail;
    time.duration = duration;
    time.v = is_from_rest && !is_tail ? 0 : 1;
    ASSERT_TRUE(writer.stage(path) && writer.stage(time));
  }

  /// Everything that the cycle would run now, by name.
  std::vector<std::uint64_t> run() {
    std::vector<std::uint64_t> names;
    while (reader.advance() != nullptr) {
      EXPECT_EQ(reader.path()->sequence, reader.piece()->sequence);
      names.push_back(reader.piece()->sequence);
    }
    return names;
  }
};

using Names = std::vector<std::uint64_t>;

TEST(MotionPort, ShowsAWindowOnlyWhenItIsPublished) {
  Script script;
  script.move(0, 10, true);
  EXPECT_EQ(script.run(), Names{});
  script.writer.publish();
  EXPECT_EQ(script.run(), Names{10});
}

TEST(MotionPort, ForgetsADiscardedWindow) {
  Script script;
  script.move(0, 10, true);
  script.writer.discard();
  script.paths = 0;
  script.move(0, 11, true);
  script.writer.publish();
  EXPECT_EQ(script.run(), Names{11});
}

TEST(MotionPort, SkipsTheTailWhereTheNextWindowContinues) {
  Script script;
  script.move(0, 10, true);
  script.move(0, 11, true, true);
  script.move(0, 12, true, true);
  script.move(1, 20, false);
  script.writer.publish();
  EXPECT_EQ(script.run(), (Names{10, 20}));
  EXPECT_FALSE(script.writer.tail_entered().has_value());
}

TEST(MotionPort, RunsTheTailWhereTheNextWindowStartsFromRest) {
  Script script;
  script.move(0, 10, true);
  script.move(0, 11, true, true);
  script.move(1, 20, true);
  script.writer.publish();
  EXPECT_EQ(script.run(), (Names{10, 11, 20}));
}

TEST(MotionPort, OnceInATailTakesOnlyAWindowFromRest) {
  Script script;
  script.move(0, 10, true);
  script.move(0, 11, true, true);
  script.move(0, 12, true, true);
  script.writer.publish();
  ASSERT_EQ(script.reader.advance()->sequence, 10U);
  ASSERT_EQ(script.reader.advance()->sequence, 11U);
  EXPECT_EQ(script.writer.tail_entered()->window, 0U);
  script.move(1, 20, false);
  script.move(1, 21, false, true);
  script.move(2, 30, false);
  script.move(3, 40, true);
  script.move(4, 50, false);
  script.writer.publish();
  EXPECT_EQ(script.run(), (Names{12, 40, 50}));
}

TEST(MotionPort, RunsATailThatIsKeptWhateverIsPublishedAndTheWriterSeesItAtOnce) {
  Script script;
  script.move(0, 10, true);
  script.move(0, 11, true, true);
  script.move(0, 12, true, true);
  script.writer.publish();
  ASSERT_EQ(script.reader.advance()->sequence, 10U);
  script.reader.keep_tail(*script.reader.look_ahead(1));
  ASSERT_TRUE(script.writer.tail_entered().has_value());
  EXPECT_EQ(script.writer.tail_entered()->window, 0U);
  script.move(1, 20, false);
  script.move(2, 30, true);
  script.writer.publish();
  EXPECT_EQ(script.reader.find_after_tail(1), 0U);
  EXPECT_EQ(script.run(), (Names{11, 12, 30}));
}

/// A window without a tail, two tails that are skipped, one that is run, and what may follow it.
Script long_script() {
  Script script;
  script.move(0, 10, true);
  script.move(1, 20, false);
  script.move(1, 21, false, true);
  script.move(1, 22, false, true);
  script.move(2, 30, false);
  script.move(2, 31, false, true);
  script.move(3, 40, false);
  script.move(3, 41, false, true);
  script.move(3, 42, false, true);
  script.move(4, 50, true);
  script.writer.publish();
  return script;
}

TEST(MotionPort, TheMotionAheadIsWhatIsRunAsFarAsTheNextRest) {
  Script script = long_script();
  ASSERT_EQ(script.reader.advance()->sequence, 10U);
  MotionAhead ahead(script.reader);
  Names seen;
  const TimePiece* tail = nullptr;
  while (const TimePiece* piece = ahead.next()) {
    seen.push_back(piece->sequence);
    EXPECT_EQ(script.reader.path_of(*piece)->sequence, piece->sequence);
    if (tail == nullptr) tail = ahead.tail();
  }
  ASSERT_NE(tail, nullptr);
  EXPECT_EQ(tail->sequence, 41U);
  EXPECT_EQ(ahead.slots(), 9U) << "of the rest, and of what is skipped on the way";
  seen.push_back(50);  // it starts from rest
  EXPECT_EQ(seen, script.run());
}

TEST(MotionPort, TheMotionAheadOfATailThatIsRunEndsWithIt) {
  Script script = long_script();
  while (script.reader.advance()->sequence != 41) {
  }
  script.move(5, 60, false);
  script.writer.publish();
  MotionAhead ahead(script.reader);
  ASSERT_NE(ahead.next(), nullptr);
  EXPECT_EQ(ahead.tail(), nullptr) << "the cycle is in it";
  EXPECT_EQ(ahead.next(), nullptr);
  EXPECT_EQ(script.reader.path_ahead(1)->sequence, 42U);
  EXPECT_EQ(script.reader.path_ahead(4), nullptr);
}

TEST(MotionPort, KnowsWhetherThePlannerRemembersTheTailOfTheWindowInForce) {
  Script script;
  EXPECT_FALSE(script.reader.is_tail_remembered()) << "nothing is in force";
  script.move(7, 10, true);
  script.writer.publish();
  ASSERT_NE(script.reader.advance(), nullptr);
  for (std::uint32_t after = 0; after < 5; ++after) {
    EXPECT_EQ(script.reader.is_tail_remembered(), after <= 2) << after;
    script.move(8 + after, 20 + after, false);
    script.writer.publish();
  }
}

TEST(MotionPort, DropsWhatBelongsToAnotherEpoch) {
  Script script;
  for (std::uint64_t n = 0; n < 600; ++n) {
    script.move(static_cast<std::uint32_t>(n), n, true);
  }
  script.writer.publish();
  ASSERT_EQ(script.reader.advance()->sequence, 0U);
  script.reader.set_epoch(1);
  EXPECT_EQ(script.reader.piece(), nullptr);
  script.epoch = 1;
  script.paths = 0;
  script.move(0, 1000, true);
  script.writer.publish();
  int calls = 0;
  while (script.reader.advance() == nullptr && calls < 1000) ++calls;
  ASSERT_NE(script.reader.piece(), nullptr);
  EXPECT_EQ(script.reader.piece()->sequence, 1000U);
  EXPECT_EQ(script.reader.path()->sequence, 1000U);
  EXPECT_LE(calls, 2 * 600 / MotionReader::kMaxDrops + 2);
}

TEST(MotionPort, SaysWhenAWindowWouldNotFit) {
  Script script;
  EXPECT_TRUE(script.writer.has_room(2048, 16384));
  EXPECT_FALSE(script.writer.has_room(2049, 1));
  script.move(0, 10, true);
  EXPECT_FALSE(script.writer.has_room(2048, 1));
}

TEST(MotionPort, CountsNothingAsAheadThatATailMadeVoid) {
  Script script;
  script.writer.set_horizon(2);
  script.move(0, 10, true, false, 1);
  script.move(0, 11, true, true, 1);
  script.writer.publish();
  ASSERT_EQ(script.reader.advance()->sequence, 10U);
  ASSERT_EQ(script.reader.advance()->sequence, 11U);
  script.move(1, 20, false, false, 3);  // comes too late: the cycle is in the tail before it
  script.writer.publish();
  EXPECT_EQ(script.run(), Names{});
  EXPECT_FALSE(script.writer.has_room(1, 1));
  script.writer.forget_ahead();
  EXPECT_TRUE(script.writer.has_room(1, 1));
  script.move(2, 30, true, false, 3);
  script.writer.publish();
  EXPECT_FALSE(script.writer.has_room(1, 1));
  EXPECT_EQ(script.run(), Names{30});
  EXPECT_TRUE(script.writer.has_room(1, 1));
}

}  // namespace
}  // namespace meridian
