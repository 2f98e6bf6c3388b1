// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/source_pump.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

namespace meridian::stream {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPatience = std::chrono::seconds(10);

/// A pipe whose writer is the test.
class Pipe {
 public:
  Pipe() { EXPECT_EQ(::pipe(ends_.data()), 0); }
  ~Pipe() {
    ::close(ends_[0]);
    close();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void write(const std::string& text) {
    ASSERT_EQ(::write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void close() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }
  [[nodiscard]] int reader() const { return ends_[0]; }

 private:
  std::array<int, 2> ends_{-1, -1};
};

class Pump : public testing::Test {
 protected:
  SourcePump& start() {
    return pump_.emplace(pipe.reader(), "standard input", cl::ClReaderOptions{},
                         [this] { ++wakes; });
  }
  /// Takes until there is something else than "wait", or patience is out.
  Supply next() {
    const auto end = Clock::now() + kPatience;
    Supply supply = pump_->take();
    while (supply.kind == Supply::Kind::kWait && Clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      supply = pump_->take();
    }
    return supply;
  }

  Pipe pipe;
  std::atomic<int> wakes{0};
  std::optional<SourcePump> pump_;
};

const char* const kHead = "PARTNO/SLOW\nUNITS/MM\nFEDRAT/600,MMPM\n";

TEST_F(Pump, GivesEveryBlockAsSoonAsItsLineIsWritten) {
  start();
  pipe.write(kHead);
  for (int i = 0; i < 5; ++i) {
    pipe.write("GOTO/" + std::to_string(i) + ",0,0,0,0,1\n");
    const Supply supply = next();
    ASSERT_EQ(supply.kind, Supply::Kind::kBlock) << i;
    EXPECT_EQ(supply.block.tip_mm[0], i);
  }
  EXPECT_EQ(pump_->take().kind, Supply::Kind::kWait) << "the writer has no more yet";
  pipe.write("FINI\n");
  pipe.close();
  while (next().kind == Supply::Kind::kBlock) continue;
  EXPECT_EQ(pump_->take().kind, Supply::Kind::kWait);
  EXPECT_GE(wakes, 6);
}

TEST_F(Pump, EndsTheSourceWithTheText) {
  start();
  pipe.write(kHead + std::string("GOTO/0,0,0,0,0,1\nFINI\n"));
  pipe.close();
  Supply supply = next();
  EXPECT_EQ(supply.kind, Supply::Kind::kBlock);
  while (supply.kind == Supply::Kind::kBlock) supply = next();
  EXPECT_EQ(supply.kind, Supply::Kind::kEnd);
}

TEST_F(Pump, SaysWhatIsWrongWithTheTextByNameAndLine) {
  start();
  pipe.write(kHead + std::string("GOTO/0,zero,0,0,0,1\n"));
  const Supply supply = next();
  ASSERT_EQ(supply.kind, Supply::Kind::kBad);
  EXPECT_NE(supply.text.find("standard input:4: "), std::string::npos) << supply.text;
}

TEST_F(Pump, HandsOutWhatIsOddAboutTheTextOnce) {
  start();
  pipe.write("PARTNO/ODD\nUNITS/INCHES\nFEDRAT/600,MMPM\nGOTO/0,0,0,0,0,1\nUNITS/MM\nGOTO/1,0,0\n");
  pipe.close();
  while (next().kind == Supply::Kind::kBlock) continue;
  const auto warnings = pump_->take_warnings();
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings.back().line, 5U);
  EXPECT_TRUE(pump_->take_warnings().empty());
}

TEST_F(Pump, DoesNotWaitForAWriterThatSleepsWhenItIsToEnd) {
  start();
  pipe.write(kHead);
  const auto asked = Clock::now();
  pump_.reset();
  EXPECT_LT(Clock::now() - asked, kPatience);
}

TEST_F(Pump, LetsTheWriterWaitWhereNobodyTakes) {
  start();
  constexpr std::size_t kBlocks = 60'000;  // a megabyte: more than pipe, buffers and queue hold
  std::string text = kHead;
  for (std::size_t i = 0; i < kBlocks; ++i) text += "GOTO/0,0,0,0,0,1\n";
  text += "FINI\n";
  std::atomic<bool> is_written{false};
  std::thread writer([&] {
    for (std::size_t at = 0; at < text.size(); at += 4096) pipe.write(text.substr(at, 4096));
    is_written = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_FALSE(is_written);
  std::size_t taken = 0;
  while (next().kind == Supply::Kind::kBlock) ++taken;
  EXPECT_GE(taken, kBlocks);
  writer.join();
}

}  // namespace
}  // namespace meridian::stream
