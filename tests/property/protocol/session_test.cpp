// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "service/protocol/intake_check.hpp"
#include "service/protocol/station/station.hpp"
#include "support/machines.hpp"
#include "support/programs.hpp"

namespace meridian::stream {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

/// What a transport may do to messages, as probabilities per message.
struct Weather {
  double loss = 0, twice = 0, spoilt = 0;
  int max_delay_ms = 1;  ///< every message takes 0 to this: overtaking included
};

/// A transport with bad manners.
template <class Message>
class Channel {
 public:
  Channel(std::mt19937_64& engine, const Weather& weather) : engine_(engine), weather_(weather) {}

  void send(const Message& message, std::int64_t now_ns) {
    if (draw() < weather_.loss) return;
    const int copies = draw() < weather_.twice ? 2 : 1;
    for (int i = 0; i < copies; ++i) {
      const int delay = std::uniform_int_distribution(0, weather_.max_delay_ms)(engine_);
      in_flight_.push_back({now_ns + delay * kMillisecond, message});
    }
  }
  [[nodiscard]] std::vector<Message> arrived(std::int64_t now_ns) {
    std::vector<Message> messages;
    const auto later =
        std::stable_partition(in_flight_.begin(), in_flight_.end(),
                              [&](const Entry& entry) { return entry.due_ns > now_ns; });
    for (auto it = later; it != in_flight_.end(); ++it) messages.push_back(it->message);
    in_flight_.erase(later, in_flight_.end());
    if (weather_.max_delay_ms > 0) std::shuffle(messages.begin(), messages.end(), engine_);
    return messages;
  }
  [[nodiscard]] double draw() { return std::uniform_real_distribution(0.0, 1.0)(engine_); }

 private:
  struct Entry {
    std::int64_t due_ns;
    Message message;
  };
  std::mt19937_64& engine_;
  Weather weather_;
  std::vector<Entry> in_flight_;
};

/// The queue behind the intake: checks that it gets the program in order, every block once.
struct Queue {
  std::size_t slots = 0, queued = 0;
  std::uint64_t taken = 0;
  bool has_end = false;

  void push(const Accepted& accepted) {
    ASSERT_LE(queued + accepted.count, slots) << "credits promised more than there was room";
    queued += accepted.count;
    for (std::size_t i = 0; i < accepted.count; ++i) {
      const ClBlock& block = accepted.blocks[i];
      ASSERT_FALSE(has_end);
      ASSERT_EQ(block.sequence, taken);
      has_end = block.kind == BlockKind::kEnd;
      if (has_end) continue;
      ASSERT_EQ(block.tip_mm, test::good_cut(taken).tip_mm) << "a spoilt block got through";
      ++taken;
    }
  }
};

/// Streams `count` blocks through both ends and such a transport into a queue of `places`.
/// Returns how often the station went back.
std::uint64_t stream_through(std::uint64_t seed, std::uint64_t count, std::size_t slots,
                             const Weather& weather) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 engine(seed);
  const MachineModel model = test::lai_machine();
  IntakeCheck intake(model, {}, 99);
  std::uint64_t next = 0;
  Station station({.session = 5, .station = "cam", .program = "part"}, [&]() -> Supply {
    if (next == count) return {.kind = Supply::Kind::kEnd};
    return {.kind = Supply::Kind::kBlock, .block = test::good_cut(next++)};
  });
  Channel<dds::SessionRequest> requests(engine, weather);
  Channel<dds::Batch> batches(engine, weather);
  Channel<dds::Credit> credits(engine, weather);
  Queue queue{.slots = slots};

  std::int64_t now_ns = 0;
  const auto context = [&] { return IntakeContext{now_ns, queue.slots - queue.queued, {}}; };
  for (; station.state() != StationState::kComplete; now_ns += kMillisecond) {
    const bool is_stuck = now_ns >= 600'000 * kMillisecond || station.is_over();
    if (is_stuck) ADD_FAILURE() << "stuck at " << queue.taken << ": " << station.message();
    if (is_stuck || testing::Test::HasFatalFailure()) return 0;
    if (const auto request = station.due_request(now_ns)) requests.send(*request, now_ns);
    dds::Batch batch;
    for (int i = 0; i < 4 && station.next_batch(now_ns, batch); ++i) {
      if (batches.draw() < weather.spoilt) batch.blocks[0].tip_mm[2] += 1;
      batches.send(batch, now_ns);
    }
    for (const auto& request : requests.arrived(now_ns)) {
      credits.send(intake.on_request(request, context(), 100), now_ns);
    }
    for (const auto& came : batches.arrived(now_ns)) {
      Accepted accepted;
      const auto answer = intake.on_batch(came, context(), accepted);
      if (answer) credits.send(*answer, now_ns);
      queue.push(accepted);
    }
    if (const auto credit = intake.due_credit(context())) credits.send(*credit, now_ns);
    for (const auto& credit : credits.arrived(now_ns)) station.on_credit(credit, now_ns);
    queue.queued -=
        std::min<std::size_t>(queue.queued, std::uniform_int_distribution(0, 60)(engine));
  }
  EXPECT_EQ(queue.taken, count);
  EXPECT_TRUE(queue.has_end);
  EXPECT_EQ(intake.counters().blocks_accepted, count);
  return station.progress().resends;
}

TEST(Session, FairWeatherLosesNothingAndResendsNothing) {
  EXPECT_EQ(stream_through(1, 20'000, 5001, {.max_delay_ms = 0}), 0u);
}

TEST(Session, NothingIsLostAndNothingComesTwiceInAnyWeather) {
  constexpr std::uint64_t kSeed = 20240607;
  RecordProperty("seed", std::to_string(kSeed));
  std::mt19937_64 engine(kSeed);
  std::uint64_t resends = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto up_to = [&](double max) { return std::uniform_real_distribution(0.0, max)(engine); };
    const Weather weather{up_to(0.3), up_to(0.3), up_to(0.2),
                          std::uniform_int_distribution(0, 40)(engine)};
    const std::uint64_t count = std::uniform_int_distribution<std::uint64_t>(1, 1500)(engine);
    const std::size_t slots = std::uniform_int_distribution<std::size_t>(2, 600)(engine);
    resends += stream_through(seed, count, slots, weather);
    if (HasFailure()) return;
  }
  EXPECT_GT(resends, 60u) << "the weather was too fair to show anything";
}

}  // namespace
}  // namespace meridian::stream
