// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <vector>

#include "service/daemon/listeners/lease_check.hpp"

/// Services of one machine that hear of each other only when all of them serve, on a host that
/// pauses them and a network that is late.
namespace meridian::interpolator::rivals {

inline constexpr std::int64_t kMs = 1'000'000, kS = 1000 * kMs, kStep = 10 * kMs;

struct Pause {
  std::int64_t begin = 0, end = 0;
};

/// How long words to another one take: one by one in order, only the newest is kept.
struct Wire {
  std::int64_t min = 0, max = 0;
  struct Late {
    std::int64_t due = 0;
    LeaseCheck::Word word;
  };
  std::deque<Late> in_flight;

  void send(const LeaseCheck::Word& word, std::int64_t now, std::mt19937& engine) {
    std::int64_t due = now + std::uniform_int_distribution(min, max)(engine);
    if (!in_flight.empty()) due = std::max(due, in_flight.back().due);
    in_flight.push_back({due, word});
  }
  [[nodiscard]] std::optional<LeaseCheck::Word> take(std::int64_t now) {
    std::optional<LeaseCheck::Word> newest;
    for (; !in_flight.empty() && in_flight.front().due <= now; in_flight.pop_front()) {
      newest = in_flight.front().word;
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
  void connect(std::int64_t min, std::int64_t max) {
    wires.assign(rivals.size(), std::vector<Wire>(rivals.size(), Wire{min, max, {}}));
    for (Rival& rival : rivals) rival.knows.assign(rivals.size(), false);
  }
  std::int64_t draw(std::int64_t min, std::int64_t max) {
    return std::uniform_int_distribution(min, max)(engine);
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
  [[nodiscard]] std::size_t index_of(const Rival& rival) const {
    return static_cast<std::size_t>(
        std::find_if(rivals.begin(), rivals.end(),
                     [&](const Rival& one) { return one.id == rival.id; }) -
        rivals.begin());
  }
  void say(Rival& rival) {
    rival.said = rival.check.word(rival.clock + now);
    rival.check.on_said(rival.said, rival.clock + now);
    for (std::size_t to = 0; to < rivals.size(); ++to) {
      if (rivals[to].knows[index_of(rival)])
        wires[index_of(rival)][to].send(rival.said, now, engine);
    }
  }
  /// Who hears nothing of another one for its lease forgets it, and gets its newest word where it
  /// is back.
  void meet(Rival& from) {
    const bool is_there =
        from.left < 0 ? !(forgets_the_paused && from.is_paused(now) && from.is_paused(now - kS))
                      : now < from.left + 200 * kMs;
    for (std::size_t to = 0; to < rivals.size(); ++to) {
      if (to == index_of(from) || rivals[to].knows[index_of(from)] == is_there) continue;
      rivals[to].knows[index_of(from)] = is_there;
      Wire& wire = wires[index_of(from)][to];
      wire.in_flight.clear();
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
      if (const auto word = wires[from][index_of(rival)].take(now)) rival.check.hear(*word, time);
    }
    rival.check.check(time, now >= rival.off_from);
    if (rival.check.has_to_speak(time)) say(rival);
    if (rival.check.keeper(time)) rival.left = now;
  }
};

}  // namespace meridian::interpolator::rivals
