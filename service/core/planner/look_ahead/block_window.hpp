// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "meridian/path/cl_block.hpp"
#include "meridian/planner/feed_mark.hpp"
#include "service/core/path/index_ring.hpp"
#include "service/core/planner/route/route_look_ahead.hpp"
#include "service/core/planner/singular/pole/pole_look_ahead.hpp"

namespace meridian {

/// The blocks of a program about the one that is planned next, and what follows from them for
/// routes behind the pole.
///
///      planned, the last kKept        wait, at most kWaiting
///     ├────────────────────────────┼───────────────────────────┤
///            ▲ question: followed ──▶ until settled, kWaiting blocks on, or the end
///
/// What is told depends on the blocks alone, but where look_no_further() was called: that is
/// marked. Fixed store. Context: planner thread.
class BlockWindow : public PoleLookAhead {
 public:
  static constexpr std::size_t kWaiting = 2048;

  /// `is_used`: else it has no room, and nothing is asked.
  BlockWindow(const MachineModel& model, bool is_used);

  /// A program begins; the path that is cut may lie off the programmed one by `slack`.
  void begin(const LookAheadSlack& slack) noexcept;
  /// No block comes any more.
  void end() noexcept { is_whole_ = true; }
  /// From now on looks that are told there go on over as many blocks. `marks` must stay.
  void replay(std::span<const FeedMark> marks) noexcept { marks_ = marks; }

  [[nodiscard]] std::size_t waiting() const noexcept {
    return static_cast<std::size_t>(blocks_.end_index() - next_);
  }
  [[nodiscard]] const ClBlock& front() const noexcept { return blocks_[next_]; }
  /// The first `count` blocks that were pushed, at most kWaiting; empty where they are all planned.
  /// Nothing is to be kept in front of them.
  [[nodiscard]] std::span<const ClBlock> first(std::size_t count) const noexcept {
    const bool is_there = next_ < static_cast<std::int64_t>(count);
    return is_there ? std::span(&blocks_[0], count) : std::span<const ClBlock>{};
  }
  /// Only where less than kWaiting wait.
  void push(const ClBlock& block) noexcept { blocks_.push_over_oldest(block); }
  void pop() noexcept { ++next_; }
  /// `block` was planned without having to wait; none waits.
  void keep(const ClBlock& block) noexcept;
  /// Block `sequence`, if it is there and may wait again with all behind it; else nullptr.
  [[nodiscard]] const ClBlock* find(std::uint64_t sequence) const noexcept;
  /// The last block ahead of `sequence` that moves the tool; nullptr: it is not there.
  [[nodiscard]] const ClBlock* find_motion_ahead(std::uint64_t sequence) const noexcept;
  /// Block `sequence`, which find() gives, and those behind it wait again.
  void go_back_to(std::uint64_t sequence) noexcept;

  void ask(const Start& start, std::span<const RouteAhead> routes) noexcept override;
  [[nodiscard]] bool look() noexcept override;
  [[nodiscard]] std::span<const RouteAhead> routes() const noexcept override {
    return look_.routes();
  }
  [[nodiscard]] bool is_cut_short() const noexcept override {
    return !look_.is_settled() && look_.followed() >= max_followed_;
  }
  /// Whether a question waits for blocks.
  [[nodiscard]] bool is_missing() noexcept { return questions_ > 0 && !look(); }
  /// How many there were.
  [[nodiscard]] std::uint64_t questions() const noexcept { return questions_; }
  /// The question is answered with the blocks that are there: what has to be told of it.
  [[nodiscard]] std::optional<FeedMark> look_no_further() noexcept;

 private:
  static constexpr std::int64_t kKept = 2047;
  static constexpr std::size_t kReported = 64;
  /// One of those that wait may be the block at whose end the routes start.
  static constexpr int kMaxFollowed = kWaiting - 1;

  /// Where block `sequence` is, or else the oldest one kept behind it.
  [[nodiscard]] std::int64_t find_first(std::uint64_t sequence) const noexcept;
  /// FeedMark::looked_at of a look at `sequence`, if one was told; else 0.
  [[nodiscard]] std::uint64_t reported_for(std::uint64_t sequence) const noexcept;
  /// `block` from where the routes start.
  [[nodiscard]] ClBlock rest_of(ClBlock block) const noexcept;

  bool is_used_;
  IndexRing<ClBlock> blocks_;
  std::int64_t next_ = 0;  ///< that is planned next
  bool is_whole_ = false;
  LookAheadSlack slack_;
  RouteLookAhead look_;
  std::span<const FeedMark> marks_;
  std::uint64_t questions_ = 0;
  Start asked_;
  std::int64_t follows_ = 0;
  int max_followed_ = 0;          ///< that are followed
  IndexRing<FeedMark> reported_;  ///< what is asked again is answered the same
};

}  // namespace meridian
