// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "meridian/cycle/spsc_ring.hpp"
#include "meridian/path/path_piece.hpp"
#include "meridian/planner/time_piece.hpp"

/// The motion port: how planned motion gets from the planner thread to the cycle.
///
///     planner ─ MotionWriter ─▶ [paths: where] ─▶ MotionReader ─ cycle
///                             ─▶ [times: when ] ─▶
///                             ◀─ tail entered, window begun, feed override ──
///
/// Windows are published whole. Path pieces are shown before the time pieces that refer to them, so
/// a time piece that the cycle sees always has its path. Every published plan ends at rest: either
/// the window has pieces marked `is_tail` that bring it to rest, or its last piece ends at rest.
namespace meridian {

struct MotionPort {
  SpscRing<PathPiece, 2048> paths;
  SpscRing<TimePiece, 16384> times;
  /// Epoch and window whose tail the cycle entered, or committed to (keep_tail()), last, packed by
  /// MotionReader; 0: none yet.
  std::atomic<std::uint64_t> tail_entered{0};
  /// Epoch and window that the cycle is in or was in last, packed the same way.
  std::atomic<std::uint64_t> window_begun{0};
  /// What the operator asks for, 1 is 100 %.
  std::atomic<double> feed_override{1};
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
static_assert(std::atomic<double>::is_always_lock_free);

/// Names a window of an epoch.
struct WindowName {
  std::uint16_t epoch = 0;
  std::uint32_t window = 0;
};

/// The planner's end of the port. One thread.
class MotionWriter {
 public:
  explicit MotionWriter(MotionPort& port) noexcept : port_(port) {}

  /// Whether that many pieces would fit now, and the plan is not farther ahead than it may be.
  [[nodiscard]] bool has_room(std::size_t paths, std::size_t times) noexcept {
    return port_.paths.count_free_slots() >= paths && port_.times.count_free_slots() >= times &&
           (horizon_s_ == kNoHorizon || ahead_s() < horizon_s_);
  }

  /// From now on there is room only while less than `horizon_s` of plan time lies behind the window
  /// that the cycle is in: what is planned for a new feed override is cut that soon.
  void set_horizon(double horizon_s) noexcept { horizon_s_ = horizon_s; }

  /// Adds a piece to the window being written; the cycle does not see it yet. False if full.
  [[nodiscard]] bool stage(const PathPiece& piece) noexcept { return port_.paths.stage(piece); }
  [[nodiscard]] bool stage(const TimePiece& piece) noexcept {
    if (!port_.times.stage(piece)) return false;
    staged_s_ += piece.duration;
    staged_ = {{piece.epoch, piece.window},
               piece.is_tail ? staged_.end_s : staged_.end_s + piece.duration};
    return true;
  }

  /// Forgets what was staged.
  void discard() noexcept {
    port_.paths.discard_staged();
    port_.times.discard_staged();
    staged_s_ = 0;
    staged_.end_s = newest_.end_s;
  }

  /// Shows the staged window to the cycle.
  void publish() noexcept {
    port_.paths.publish();
    port_.times.publish();
    published_s_ += staged_s_;
    staged_s_ = 0;
    if (staged_.name.epoch != newest_.name.epoch) {  // what was published before is void
      forget_ahead();
    }
    newest_ = ends_[next_end_++ % ends_.size()] = staged_;
  }

  /// Plan time published ever, tails included, s.
  [[nodiscard]] double published_s() const noexcept { return published_s_; }

  /// The newest window whose tail the cycle entered, or committed to (keep_tail()): it will take up
  /// only a window that starts from rest there.
  [[nodiscard]] std::optional<WindowName> tail_entered() const noexcept {
    return unpack(port_.tail_entered.load(std::memory_order_acquire));
  }

  /// The window that the cycle began last. It has passed those before without their tails, but for
  /// the one that tail_entered() names.
  [[nodiscard]] std::optional<WindowName> window_begun() const noexcept {
    return unpack(port_.window_begun.load(std::memory_order_acquire));
  }

  /// What was published and not begun is void: the cycle came to a tail before it.
  void forget_ahead() noexcept {
    first_end_ = next_end_;
    begun_s_ = newest_.end_s;
  }

  /// The feed override that the operator asks for now, 1 is 100 %.
  [[nodiscard]] double feed_override() const noexcept {
    return port_.feed_override.load(std::memory_order_relaxed);
  }

 private:
  static constexpr double kNoHorizon = std::numeric_limits<double>::infinity();

  /// Where a window ends: plan time published ever up to there, tails left out, s.
  struct WindowEnd {
    WindowName name;
    double end_s = 0;
  };

  /// Plan time behind the window that the cycle is in, of the last windows published.
  [[nodiscard]] double ahead_s() noexcept {
    const auto begun = window_begun();
    while (first_end_ != next_end_) {
      const WindowEnd& end = ends_[first_end_ % ends_.size()];
      const bool is_begun =
          begun && begun->epoch == end.name.epoch && end.name.window <= begun->window;
      if (!is_begun && next_end_ - first_end_ <= ends_.size()) break;
      begun_s_ = end.end_s;
      ++first_end_;
    }
    return newest_.end_s - begun_s_;
  }

  [[nodiscard]] static std::optional<WindowName> unpack(std::uint64_t packed) noexcept {
    if (packed == 0) return std::nullopt;
    return WindowName{static_cast<std::uint16_t>(packed >> 32U),
                      static_cast<std::uint32_t>(packed & 0xffffffffU)};
  }

  MotionPort& port_;
  double staged_s_ = 0, published_s_ = 0;
  double horizon_s_ = kNoHorizon;
  std::array<WindowEnd, 256> ends_{};  ///< of windows that the cycle may not have begun
  std::size_t first_end_ = 0, next_end_ = 0;
  WindowEnd staged_, newest_;
  double begun_s_ = 0;  ///< end of the window that the cycle is in
};

/// The cycle's end of the port: the piece in force and the rules that say which one follows.
///
/// * A tail is skipped if a piece of the next window that is not from rest is there when the cycle
///   comes to the tail. Once entered, a tail is run to its end, and later pieces are dropped until
///   a window that starts from rest.
/// * A tail that is kept (keep_tail()) is run whatever is there when the cycle comes to it.
/// * Pieces of another epoch than the one set are dropped.
///
/// RT: cycle; bounded by kMaxDrops per call. Proof: tests/unit/planner/motion_port_test.cpp.
class MotionReader {
 public:
  /// A call drops at most this many pieces and goes on at the next call: an emptied queue never
  /// costs a cycle its deadline.
  static constexpr int kMaxDrops = 128;
  /// Windows published after one from whose tail the planner can still go on: the smooth run keeps
  /// as many open, and the feed planner their cells.
  static constexpr std::uint32_t kRemembered = 2;

  explicit MotionReader(MotionPort& port) noexcept : port_(port) {}

  /// The time piece in force, nullptr if there is none. Valid until advance() or set_epoch().
  [[nodiscard]] const TimePiece* piece() const noexcept { return piece_; }

  /// Where a kMove piece in force runs; otherwise nullptr.
  [[nodiscard]] const PathPiece* path() const noexcept { return path_; }

  /// Puts the piece in force behind and goes to the one that follows; with none in force, takes the
  /// first that may run. Returns piece(): nullptr means that nothing is there (yet).
  const TimePiece* advance() noexcept {
    if (piece_ != nullptr) {
      last_ = {piece_->epoch, piece_->window};
      port_.times.drop(1);
      piece_ = nullptr;
      path_ = nullptr;
    }
    for (int drops = 0; drops < kMaxDrops;) {
      const TimePiece* next = port_.times.peek(0);
      if (next == nullptr) return nullptr;
      if (const std::size_t skipped = count_skipped(*next); skipped > 0) {
        const auto now = std::min<std::size_t>(skipped, kMaxDrops - drops);
        port_.times.drop(now);
        drops += static_cast<int>(now);
        continue;
      }
      if (next->kind == TimeKind::kMove && !find_path(*next, drops)) return nullptr;
      take(*next);
      return piece_;
    }
    return nullptr;
  }

  /// The time piece `i` places behind the one in force (1: the next), whatever the rules say about
  /// it; nullptr if it is not there.
  [[nodiscard]] const TimePiece* look_ahead(std::size_t i) noexcept {
    return port_.times.peek(piece_ != nullptr ? i : i - 1);
  }

  /// Where the kMove piece `piece` ahead runs; nullptr if that is not there. Only while path() is.
  [[nodiscard]] const PathPiece* path_of(const TimePiece& piece) noexcept {
    const PathPiece* path = port_.paths.peek(piece.path_index - path_->index);
    return path != nullptr && path->index == piece.path_index ? path : nullptr;
  }

  /// The path piece `i` places behind path(), whatever the rules say about it; nullptr if it is not
  /// there.
  [[nodiscard]] const PathPiece* path_ahead(std::size_t i) noexcept { return port_.paths.peek(i); }

  /// A tail starts `i` places behind the piece in force. How many places behind it the window
  /// begins that goes on in the tail's place; 0: as it stands now the tail is run.
  [[nodiscard]] std::size_t find_after_tail(std::size_t i) noexcept {
    const std::size_t front = piece_ != nullptr ? 0 : 1;
    const std::size_t after = find_continuation(*port_.times.peek(i - front), i - front);
    return after > 0 ? after + front : 0;
  }

  /// The tail of the window that `piece` is of, ahead or in force, is run whatever is published
  /// meanwhile; nothing happens where it has none. The planner hears of it now, and goes on from
  /// its end.
  void keep_tail(const TimePiece& piece) noexcept {
    kept_tail_ = pack(piece);
    port_.tail_entered.store(kept_tail_, std::memory_order_release);
  }

  /// Whether the planner could go on from the end of the tail of the window in force: it remembers
  /// the cells of the last three windows.
  [[nodiscard]] bool is_tail_remembered() noexcept {
    const std::size_t size = port_.times.size();
    const TimePiece* newest = size > 0 ? port_.times.peek(size - 1) : nullptr;
    return piece_ != nullptr && newest != nullptr && newest->epoch == piece_->epoch &&
           newest->window - piece_->window <= kRemembered;
  }

  /// Only at rest: from now on pieces of `epoch` alone are taken; what the port holds of another is
  /// dropped as advance() comes to it.
  void set_epoch(std::uint16_t epoch) noexcept {
    if (epoch == epoch_) return;
    epoch_ = epoch;
    is_past_tail_ = false;
    if (piece_ != nullptr) port_.times.drop(1);
    piece_ = nullptr;
    path_ = nullptr;
  }
  [[nodiscard]] std::uint16_t epoch() const noexcept { return epoch_; }

  /// Lets the planner know of the operator's feed override.
  void ask_feed(double factor) noexcept {
    port_.feed_override.store(factor, std::memory_order_relaxed);
  }

 private:
  /// How many pieces from `next` on are skipped, those of a tail all at once; 0: it is what
  /// follows.
  [[nodiscard]] std::size_t count_skipped(const TimePiece& next) noexcept {
    if (next.epoch != epoch_) return 1;
    if (next.is_tail) {
      if (is_past_tail_) return next.window == last_.window ? 0 : 1;
      return find_continuation(next, 0);
    }
    return !is_past_tail_ || next.is_from_rest ? 0 : 1;
  }

  /// The place in the ring of the window behind the tail that starts with `tail`, at `place`; 0
  /// where it is not there, starts from rest or may not go on.
  [[nodiscard]] std::size_t find_continuation(const TimePiece& tail,
                                              std::size_t position) noexcept {
    if (pack(tail) == kept_tail_) return 0;
    for (std::size_t i = position + 1;; ++i) {
      const TimePiece* later = port_.times.peek(i);
      if (later == nullptr || later->epoch != epoch_) return 0;
      if (later->window != tail.window) return later->is_from_rest ? 0 : i;
    }
  }

  /// Brings the path that `next` refers to to the front of its ring.
  [[nodiscard]] bool find_path(const TimePiece& next, int& drops) noexcept {
    for (; drops < kMaxDrops; ++drops) {
      const PathPiece* path = port_.paths.peek(0);
      if (path == nullptr) return false;
      if (path->epoch == next.epoch && path->index == next.path_index) {
        path_ = path;
        return true;
      }
      port_.paths.drop(1);
    }
    return false;
  }

  void take(const TimePiece& next) noexcept {
    piece_ = &next;
    if (next.is_tail && !is_past_tail_) {
      is_past_tail_ = true;
      port_.tail_entered.store(pack(next), std::memory_order_release);
    } else if (!next.is_tail) {
      is_past_tail_ = false;
    }
    const std::uint64_t begun = pack(next);
    if (begun != begun_) {
      begun_ = begun;
      port_.window_begun.store(begun, std::memory_order_release);
    }
    last_ = {next.epoch, next.window};
  }

  [[nodiscard]] static std::uint64_t pack(const TimePiece& piece) noexcept {
    return (std::uint64_t{1} << 63U) | (std::uint64_t{piece.epoch} << 32U) | piece.window;
  }

  MotionPort& port_;
  const TimePiece* piece_ = nullptr;
  const PathPiece* path_ = nullptr;
  WindowName last_;
  std::uint64_t begun_ = 0;      ///< what window_begun holds
  std::uint64_t kept_tail_ = 0;  ///< window whose tail is run, packed; 0: none
  std::uint16_t epoch_ = 0;
  bool is_past_tail_ = false;  ///< a tail was entered: only a window from rest may follow
};

}  // namespace meridian
