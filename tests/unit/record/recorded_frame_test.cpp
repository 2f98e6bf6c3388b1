// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recorded/recorded_frame.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "service/recording/record/file/recorded/operator_events_writer.hpp"

namespace meridian::record {
namespace {

RecordedFrame frame_at(std::uint64_t cycle, int number) {
  RecordedFrame frame;
  frame.cycle = cycle;
  frame.number = static_cast<std::uint8_t>(number);
  frame.origin_mm = {1.0 / 3.0, -2e-7, 1e5};
  frame.rotation = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.0 / 7.0};
  return frame;
}

Event accepted(Verb verb, std::uint64_t cycle) {
  Event event;
  event.code = EventCode::kAccepted;
  event.cycle = cycle;
  event.b = static_cast<std::uint64_t>(verb);
  return event;
}

/// What the writer makes of frames and events in the order of `write`.
template <class Write>
std::string written(Write write) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("meridian-frame-" + std::to_string(::getpid()) + ".events.csv");
  auto writer = OperatorEventsWriter::create(path.string());
  EXPECT_TRUE(writer);
  write(*writer);
  EXPECT_TRUE(writer->close());
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  std::filesystem::remove(path);
  return text.str();
}

TEST(RecordedFrame, ComesBackBitForBit) {
  const RecordedFrame frame = frame_at(17, 54);
  const std::string text = written([&](auto& writer) { EXPECT_TRUE(writer.write(frame)); });
  EXPECT_EQ(find_recorded_frame(text), frame);
}

TEST(RecordedFrame, IsTheOneInForceAtTheFirstStart) {
  const std::string text = written([&](auto& writer) {
    EXPECT_TRUE(writer.write(frame_at(0, 0)));
    EXPECT_TRUE(writer.write(frame_at(100, 2)));
    EXPECT_TRUE(writer.write(accepted(Verb::kStart, 200)));
    EXPECT_TRUE(writer.write(frame_at(300, 3)));
    EXPECT_TRUE(writer.write(accepted(Verb::kStart, 400)));
  });
  EXPECT_EQ(find_recorded_frame(text), frame_at(100, 2));
}

TEST(RecordedFrame, IsTheLastWhereNothingWasStarted) {
  const std::string text = written([&](auto& writer) {
    EXPECT_TRUE(writer.write(frame_at(0, 0)));
    EXPECT_TRUE(writer.write(frame_at(100, 2)));
  });
  EXPECT_EQ(find_recorded_frame(text)->number, 2);
  EXPECT_FALSE(find_recorded_frame("cycle,verb,argument,block,span\n5,start,0\n"));
}

TEST(RecordedFrame, IsNoneWhereARowHoldsAnythingElse) {
  EXPECT_TRUE(read_frame("1,frame,2,0,0,0,1,0,0,0,1,0,0,0,1"));
  for (const char* row :
       {"1,frame,2,0,0,0,1,0,0,0,1,0,0,0", "1,frame,2,0,0,0,1,0,0,0,1,0,0,0,1,5",
        "1,frame,2,nan,0,0,1,0,0,0,1,0,0,0,1", "x,frame,2,0,0,0,1,0,0,0,1,0,0,0,1", "1,hold,0",
        "1,frame,300,0,0,0,1,0,0,0,1,0,0,0,1"}) {
    EXPECT_FALSE(read_frame(row)) << row;
  }
  EXPECT_TRUE(is_frame_row("1,frame,2"));
  EXPECT_FALSE(is_frame_row("1,hold,2"));
}

}  // namespace
}  // namespace meridian::record
