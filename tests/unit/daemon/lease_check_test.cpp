// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/lease_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "support/draws.hpp"

/// Services of one machine that hear of each other only when all of them serve, on a host that
/// pauses them and a network that is late.
namespace meridian::interpolator {
namespace {

constexpr std::int64_t kMs = 1'000'000, kS = 1000 * kMs, kStep = 10 * kMs;

struct Pause {
  std::int64_t begin = 0, end = 0;
};

/// How long words to another one take: one by one in order, only the newest is kept.
struct Wire {
  std::int64_t least = 0, most = 0;
  struct Late {
    std::int64_t due = 0;
    LeaseCheck::Word word;
  };
  std::deque<Late> under_way;

  void send(const LeaseCheck::Word& word, std::int64_t now, std::mt19937& engine) {
    std::int64_t due = now + std::uniform_int_distribution(least, most)(engine);
    if (!under_way.empty()) due = std::max(due, under_way.back().due);
    under_way.push_back({due, word});
  }
  [[nodiscard]] std::optional<LeaseCheck::Word> take(std::int64_t now) {
    std::optional<LeaseCheck::Word> newest;
    for (; !under_way.empty() && under_way.front().due <= now; under_way.pop_front()) {
      newest = under_way.front().word;
    }
    return newest;
  }
};

struct Rival {
  explicit Rival(std::uint64_t service_id) : id(service_id), check(service_id) {}
  std::uint64_t id;
  LeaseCheck check;
  std::int64_t held = 0, clock = 0, next_look = 0, off_from = 0;
  std::int64_t left = -1;  ///< -1: it serves on
  std::vector<Pause> pauses;
  LeaseCheck::Word said{};
  std::vector<bool> knows;  ///< of each: matched

  [[nodiscard]] bool is_paused(std::int64_t now) const {
    return std::any_of(pauses.begin(), pauses.end(),
                       [&](const Pause& pause) { return pause.begin <= now && now < pause.end; });
  }
};

class Rivals {
 public:
  explicit Rivals(std::uint32_t seed) : engine(seed) {}

  Rival& add(std::uint64_t id, std::int64_t held) {
    Rival& rival = rivals.emplace_back(id);
    rival.held = held;
    rival.clock = draw(0, 1'000'000) * kS;
    rival.next_look = held + draw(0, 100) * kMs;
    return rival;
  }
  void connect(std::int64_t least, std::int64_t most) {
    wires.assign(rivals.size(), std::vector<Wire>(rivals.size(), Wire{least, most, {}}));
    for (Rival& rival : rivals) rival.knows.assign(rivals.size(), false);
  }
  std::int64_t draw(std::int64_t least, std::int64_t most) {
    return std::uniform_int_distribution(least, most)(engine);
  }

  /// From where all serve. Returns who is left at the end.
  std::vector<std::uint64_t> run(std::int64_t patience) {
    for (const Rival& rival : rivals) now = std::max(now, rival.held);
    for (Rival& rival : rivals) {
      rival.check.hold(rival.clock + rival.held);
      say(rival);
    }
    for (const std::int64_t end = now + patience; now < end; now += kStep) {
      for (Rival& rival : rivals) meet(rival);
      for (Rival& rival : rivals) look(rival);
    }
    std::vector<std::uint64_t> left;
    for (const Rival& rival : rivals) {
      if (rival.left < 0) left.push_back(rival.id);
    }
    return left;
  }

  std::mt19937 engine;
  std::deque<Rival> rivals;
  std::vector<std::vector<Wire>> wires;
  std::int64_t now = 0;
  bool forgets_the_paused = false;

 private:
  [[nodiscard]] std::size_t place(const Rival& rival) const {
    return static_cast<std::size_t>(
        std::find_if(rivals.begin(), rivals.end(),
                     [&](const Rival& one) { return one.id == rival.id; }) -
        rivals.begin());
  }
  void say(Rival& rival) {
    rival.said = rival.check.word(rival.clock + now);
    rival.check.on_said(rival.said, rival.clock + now);
    for (std::size_t to = 0; to < rivals.size(); ++to) {
      if (rivals[to].knows[place(rival)]) wires[place(rival)][to].send(rival.said, now, engine);
    }
  }
  /// Who hears nothing of another one for its lease forgets it, and gets its newest word where it
  /// is back.
  void meet(Rival& from) {
    const bool is_there =
        from.left < 0 ? !(forgets_the_paused && from.is_paused(now) && from.is_paused(now - kS))
                      : now < from.left + 200 * kMs;
    for (std::size_t to = 0; to < rivals.size(); ++to) {
      if (to == place(from) || rivals[to].knows[place(from)] == is_there) continue;
      rivals[to].knows[place(from)] = is_there;
      Wire& wire = wires[place(from)][to];
      wire.under_way.clear();
      if (is_there) {
        wire.send(from.said, now, engine);
      } else {
        rivals[to].check.forget(from.id);
      }
    }
  }
  void look(Rival& rival) {
    if (rival.left >= 0 || rival.is_paused(now) || now < rival.next_look) return;
    rival.next_look = now + 100 * kMs;
    const std::int64_t time = rival.clock + now;
    for (std::size_t from = 0; from < rivals.size(); ++from) {
      if (const auto word = wires[from][place(rival)].take(now)) rival.check.hear(*word, time);
    }
    rival.check.check(time, now >= rival.off_from);
    if (rival.check.has_to_speak(time)) say(rival);
    if (rival.check.keeper(time)) rival.left = now;
  }
};

TEST(LeaseCheck, LeavesTheMachineToExactlyOneWhateverTheDelaysAndPauses) {
  for (std::uint32_t seed = 0; seed < static_cast<std::uint32_t>(test::draws(4000)); ++seed) {
    Rivals rivals(seed);
    const std::int64_t apart = std::vector<std::int64_t>{0, 200 * kMs, 5 * kS}[seed % 3];
    const int count = seed % 4 == 0 ? 3 : 2;
    for (int n = 1; n <= count; ++n) {
      rivals.add(static_cast<std::uint64_t>(n), 10 * kS + rivals.draw(0, apart / kMs) * kMs);
    }
    const std::int64_t most = rivals.draw(0, 100) * 10 * kMs;
    rivals.connect(0, most);
    for (auto& wires : rivals.wires) {
      for (Wire& wire : wires) {
        wire.least = seed % 5 == 0 ? most : rivals.draw(0, most / kMs) * kMs;
      }
    }
    rivals.forgets_the_paused = seed % 2 == 0;
    for (Rival& rival : rivals.rivals) {
      if (seed % 7 == 0) rival.off_from = 15 * kS + rivals.draw(0, 5000) * kMs;
      for (int n = 0; n < rivals.draw(0, 4); ++n) {
        const std::int64_t begin = 10 * kS + rivals.draw(0, 15'000) * kMs;
        rival.pauses.push_back({begin, begin + rivals.draw(0, 3000) * kMs});
      }
    }
    ASSERT_EQ(rivals.run(35 * kS).size(), 1U) << "seed " << seed;
  }
}

TEST(LeaseCheck, LeavesTheMachineToOneWhereBothWordsCameTooLateToTellWhoServedLonger) {
  Rivals rivals(1);
  rivals.add(2, 0);
  rivals.add(1, 50 * kMs).pauses = {{50 * kMs, 2 * kS}};
  rivals.rivals[0].pauses = {{0, 2 * kS}};
  rivals.connect(100 * kMs, 100 * kMs);
  EXPECT_EQ(rivals.run(10 * kS).size(), 1U);
}

TEST(LeaseCheck, LetsTheOneThatServedLongerKeepTheMachineWhateverItsNumberAndTheirClocks) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Rivals rivals(seed);
    const std::uint64_t older = 1 + seed % 2;
    const std::int64_t most = rivals.draw(0, 1000) * kMs;
    rivals.add(older, 0);
    rivals.add(3 - older, LeaseCheck::kSame_ns + most + rivals.draw(150, 20'000) * kMs);
    rivals.connect(0, most);
    EXPECT_EQ(rivals.run(15 * kS), std::vector{older}) << "seed " << seed;
  }
}

TEST(LeaseCheck, LetsTheOneThatServedMuchLongerKeepTheMachineWhoeverIsPaused) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Rivals rivals(seed);
    const std::uint64_t older = 1 + seed % 2;
    const std::int64_t begin = 10 * kS;
    rivals.add(older, 0);
    rivals.add(3 - older, begin);
    rivals.connect(0, kS);
    for (Rival& rival : rivals.rivals) {
      const std::int64_t from = begin + rivals.draw(0, 3000) * kMs;
      rival.pauses = {{from, from + rivals.draw(0, 3000) * kMs}};
    }
    EXPECT_EQ(rivals.run(20 * kS), std::vector{older}) << "seed " << seed;
  }
}

TEST(LeaseCheck, LetsTheSmallerNumberKeepTheMachineWhereBothServedForAsLong) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Rivals rivals(seed);
    rivals.add(1, seed % 2 * 40 * kMs);
    rivals.add(2, (1 - seed % 2) * 40 * kMs);
    rivals.connect(0, rivals.draw(0, 1000) * kMs);
    EXPECT_EQ(rivals.run(9 * kS), std::vector<std::uint64_t>{1}) << "seed " << seed;
  }
}

TEST(LeaseCheck, KeepsAMachineThatMovesThoughAnotherOneServedLongerAndLeavesItOnceItRests) {
  for (const std::uint64_t older : {1U, 2U}) {
    Rivals rivals(3);
    rivals.add(older, 0);
    Rival& moving = rivals.add(3 - older, 10 * kS);
    moving.off_from = 20 * kS;
    rivals.connect(0, 20 * kMs);
    EXPECT_EQ(rivals.run(15 * kS), std::vector{older});
    EXPECT_GE(moving.left, 20 * kS + LeaseCheck::kStepBack_ns);
  }
}

TEST(LeaseCheck, ServesAgainWhereTheOneThatItGaveWayToIsGone) {
  LeaseCheck check(2);
  check.hold(0);
  check.hear({.service_id = 1, .is_serving = true, .served_ns = 5 * kS}, kS);
  check.check(kS, true);
  EXPECT_FALSE(check.word(kS).is_serving);
  check.on_said(check.word(kS), kS);
  check.hear({.service_id = 1}, 3 * kS);
  check.check(3 * kS, true);
  EXPECT_FALSE(check.keeper(3 * kS));
  EXPECT_FALSE(check.word(3 * kS).is_serving) << "the smaller number goes first";
  check.forget(1);
  check.check(4 * kS, true);
  EXPECT_FALSE(check.keeper(4 * kS));
  EXPECT_TRUE(check.word(4 * kS).is_serving);
  EXPECT_TRUE(check.has_to_speak(4 * kS));
}

TEST(LeaseCheck, BelievesTheLeastDelayedWordOfAnotherOne) {
  LeaseCheck check(1);
  check.hold(0);
  check.hear({.service_id = 2, .is_serving = true, .served_ns = kS + 200 * kMs}, kS);
  check.hear({.service_id = 2, .is_serving = true, .served_ns = kS + 700 * kMs}, 2 * kS);
  check.check(2 * kS, true);
  EXPECT_FALSE(check.word(2 * kS).is_serving);
}

TEST(LeaseCheck, TakesNobodyForOlderWhoCannotSayForHowLongItServed) {
  for (const std::int64_t served : {INT64_MIN, std::int64_t{-1}}) {
    LeaseCheck check(1);
    check.hold(0);
    check.hear({.service_id = 2, .is_serving = true, .served_ns = served}, 10 * kS);
    check.check(10 * kS, true);
    EXPECT_TRUE(check.word(10 * kS).is_serving) << served;
  }
}

TEST(LeaseCheck, TakesWhoServedAlmostAsLongForOneOfTheSameAge) {
  for (const std::int64_t lead : {-LeaseCheck::kSame_ns, LeaseCheck::kSame_ns - 1}) {
    for (const std::uint64_t own : {1U, 3U}) {
      LeaseCheck check(own);
      check.hold(0);
      check.hear({.service_id = 2, .is_serving = true, .served_ns = kS - lead}, kS);
      check.check(kS, true);
      EXPECT_EQ(check.word(kS).is_serving, own < 2) << lead;
    }
  }
}

TEST(LeaseCheck, LeavesNoMachineWhoseDrivesObeyItWhateverOthersClaim) {
  LeaseCheck check(7);
  check.hold(0);
  for (std::int64_t now = kS; now < 20 * kS; now += 100 * kMs) {
    EXPECT_TRUE(check.hear({.service_id = 1, .is_serving = true, .served_ns = 9000 * kS}, now));
    check.check(now, true, 7);
    check.on_said(check.word(now), now);
    ASSERT_TRUE(check.word(now).is_serving) << now;
    ASSERT_FALSE(check.keeper(now)) << now;
  }
}

TEST(LeaseCheck, GivesWayToAYoungerOneThatTheDrivesObeyIfThatServes) {
  for (const bool is_serving : {true, false}) {
    LeaseCheck check(1);
    check.hold(0);
    check.hear({.service_id = 2, .is_serving = is_serving, .served_ns = kS}, 100 * kS);
    check.check(100 * kS, true, 2);
    EXPECT_EQ(check.word(100 * kS).is_serving, !is_serving);
  }
}

TEST(LeaseCheck, ServesAgainAsSoonAsTheDrivesObeyIt) {
  LeaseCheck check(7);
  check.hold(0);
  check.hear({.service_id = 1, .is_serving = true, .served_ns = 9000 * kS}, kS);
  check.check(kS, true);
  check.on_said(check.word(kS), kS);
  EXPECT_FALSE(check.word(kS).is_serving);
  check.check(2 * kS, true, 7);
  EXPECT_TRUE(check.word(2 * kS).is_serving);
  EXPECT_FALSE(check.keeper(10 * kS));
}

TEST(LeaseCheck, LeavesTheMachineToTheOneThatTheDrivesObeyWhoeverServedLonger) {
  for (const std::uint64_t obeyed : {1U, 2U}) {
    LeaseCheck one(1), two(2);
    one.hold(0);
    two.hold(60 * kS);
    std::int64_t now = 100 * kS;
    std::optional<std::uint64_t> left_by_one, left_by_two;
    for (; now < 110 * kS && !left_by_one && !left_by_two; now += 100 * kMs) {
      one.hear(two.word(now), now);
      two.hear(one.word(now), now);
      for (LeaseCheck* const check : {&one, &two}) {
        check->check(now, true, obeyed);
        check->on_said(check->word(now), now);
      }
      left_by_one = one.keeper(now);
      left_by_two = two.keeper(now);
    }
    EXPECT_EQ(left_by_one.has_value(), obeyed == 2);
    EXPECT_EQ(left_by_two.has_value(), obeyed == 1);
  }
}

TEST(LeaseCheck, HearsNothingThatNobodyCanHaveServedNorMoreOthersThanThereAreServices) {
  LeaseCheck check(1000);
  check.hold(0);
  EXPECT_FALSE(check.hear({.service_id = 1, .is_serving = true, .served_ns = INT64_MAX}, kS));
  EXPECT_FALSE(check.hear({.service_id = 1, .is_serving = true, .served_ns = 1LL << 60U}, kS));
  EXPECT_FALSE(check.hear({.service_id = 0, .is_serving = true, .served_ns = kS}, kS));
  std::size_t heard = 0;
  for (std::uint64_t id = 1; id < 1000; ++id) {
    heard += check.hear({.service_id = id, .is_serving = false}, kS) ? 1U : 0U;
  }
  EXPECT_EQ(heard, LeaseCheck::kMaxOthers);
}

TEST(LeaseCheck, GivesNoWayToWhoServesNoMore) {
  LeaseCheck check(3);
  check.hold(0);
  check.hear({.service_id = 2, .is_serving = true, .served_ns = 9 * kS}, kS);
  check.hear({.service_id = 2}, kS);
  check.check(kS, true);
  EXPECT_TRUE(check.word(kS).is_serving);
}

/// An hour of doubt about another one, whose words are late, is none about the next.
TEST(LeaseCheck, WaitsForWordsThatTellAnewWhereverAnotherOneBeginsToServeBesideIt) {
  LeaseCheck check(2);
  check.hold(0);
  const auto late = [](std::int64_t now) {
    return LeaseCheck::Word{.service_id = 1, .is_serving = true, .served_ns = now - kS};
  };
  check.hear({.service_id = 1}, kS);
  check.check(3600 * kS, true);
  check.hear(late(3600 * kS), 3600 * kS);
  check.check(3600 * kS, true);
  EXPECT_TRUE(check.word(3600 * kS).is_serving) << "it may be the later one";
  const std::int64_t over = 3600 * kS + LeaseCheck::kPatience_ns + 1;
  check.check(over, true);
  EXPECT_FALSE(check.word(over).is_serving);
}

TEST(LeaseCheck, LeavesOnlyAsLongBehindItsLastStepBackAsItsWordNeeds) {
  LeaseCheck check(2);
  check.hold(0);
  const auto step_back = [&](std::int64_t now) {
    check.hear({.service_id = 1, .is_serving = true, .served_ns = now + kS}, now);
    check.check(now, true);
    check.on_said(check.word(now), now);
  };
  step_back(kS);
  check.check(2 * kS, false);  // it moves meanwhile: it serves on
  EXPECT_TRUE(check.word(2 * kS).is_serving);
  step_back(10 * kS);
  const std::int64_t last = 10 * kS + LeaseCheck::kStepBack_ns;
  EXPECT_FALSE(check.keeper(last - 1));
  check.on_said(check.word(last - 1), last - 1);  // said again, twice a second
  EXPECT_EQ(check.keeper(last), 1U);
}

TEST(LeaseCheck, SaysNothingAnewWhereItServesAlone) {
  LeaseCheck check(1);
  check.hold(0);
  check.on_said(check.word(0), 0);
  check.hear({.service_id = 2}, kS);
  check.check(10 * kS, true);
  EXPECT_FALSE(check.has_to_speak(10 * kS));
  check.hear({.service_id = 2, .is_serving = true}, 11 * kS);
  EXPECT_TRUE(check.has_to_speak(11 * kS));
}

}  // namespace
}  // namespace meridian::interpolator
