// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "meridian/path/cl_block.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::stream {

enum class StationState : std::uint8_t {
  kOpening,    ///< asked for the machine, no answer yet
  kStreaming,  ///< sends blocks as credits come
  kComplete,   ///< everything is in the service, end mark included
  kRan,        ///< the machine executed the program to its end
  kRefused,    ///< the service said no; message() says why
  kNoAnswer,   ///< nobody answered the open
  kBadSource   ///< the source of blocks failed; message() says why
};

/// What a source of blocks hands out next.
struct Supply {
  enum class Kind : std::uint8_t {
    kBlock,  ///< `block` is the next one
    kEnd,    ///< there are no more
    kWait,   ///< nothing now, ask again later (a pipe that is still open)
    kBad     ///< `text` says what is wrong with the file
  };
  Kind kind = Kind::kEnd;
  ClBlock block{};
  std::string text{};
};
using Source = std::function<Supply()>;

struct StationOptions {
  std::int64_t open_repeat_ns = 500'000'000;
  std::int64_t open_timeout_ns = 5'000'000'000;
  std::int64_t silence_ns = 1'000'000'000;     ///< of the service, which repeats itself: ask again
  std::int64_t resend_after_ns = 500'000'000;  ///< no progress for so long: send again
  std::int64_t gap_quiet_ns = 50'000'000;      ///< at least so long between two resends for one gap
  std::int64_t gather_ns = 5'000'000;  ///< a source that waits fills a small batch for so long
};

/// For progress bars.
struct StationProgress {
  std::uint64_t read = 0;          ///< blocks taken from the source
  std::uint64_t acknowledged = 0;  ///< blocks that the service has
  std::uint64_t resends = 0;       ///< how often it went back
  std::uint64_t batches_sent = 0;
};

/// The CAM station's end of the session protocol: takes blocks from a source, numbers them, sends
/// them in batches as far as credits reach, goes back to the last good sequence when the service
/// asks or stays silent. A state machine of one thread; time is an argument. It keeps only the
/// blocks that are not acknowledged yet. Protocol: docs/interface.md.
/// Proof: tests/unit/protocol/station_test.cpp, tests/property/protocol/session_test.cpp.
class Station {
 public:
  Station(dds::SessionRequest request, Source source, const StationOptions& options = {});

  /// Returns the request that is to be sent now, if any: the open and its repetitions. Once open it
  /// is repeated where the service fell silent: one that was restarted answers with its own name.
  /// Until the answer nothing is sent, so that a restarted service does not keep half a program.
  [[nodiscard]] std::optional<dds::SessionRequest> due_request(std::int64_t now_ns);
  /// Fills the next batch that may be sent now; false where there is none.
  [[nodiscard]] bool next_batch(std::int64_t now_ns, dds::Batch& batch);
  /// Whether a small batch is due StationOptions::gather_ns after its first block, not at an event.
  [[nodiscard]] bool is_gathering() const noexcept { return gathering_since_ns_.has_value(); }
  /// The batch of the last next_batch() could not be written: it is due again.
  void on_not_sent() noexcept;
  void on_credit(const dds::Credit& credit, std::int64_t now_ns);

  /// The request that gives the machine back.
  [[nodiscard]] dds::SessionRequest close_request() const;

  [[nodiscard]] StationState state() const noexcept { return state_; }
  /// What the service said last, or why the station stopped.
  [[nodiscard]] const std::string& message() const noexcept { return message_; }
  [[nodiscard]] const dds::Credit& credit() const noexcept { return credit_; }
  [[nodiscard]] const StationProgress& progress() const noexcept { return progress_; }
  [[nodiscard]] bool is_over() const noexcept { return state_ > StationState::kComplete; }

 private:
  /// What is known of the source.
  enum class SourceState : std::uint8_t {
    kReady,
    kWaiting,  ///< it had nothing when asked last
    kAtEnd     ///< it has no more
  };
  /// The open, and its repetitions once the session is open.
  enum class Asking : std::uint8_t {
    kNotAsked,
    kAsked,  ///< and not answered yet
    kAnswered,
    kAskedAgain  ///< the service fell silent: until it answers nothing is sent
  };
  /// What is sent next.
  struct Cursor {
    std::uint64_t sequence = 0;
    bool is_end_sent = false;  ///< the end mark went out after `sequence` got to the end
  };

  void fill(std::uint64_t wanted);
  [[nodiscard]] bool is_worth_sending(std::uint64_t count, std::uint64_t there,
                                      std::int64_t now_ns);
  void stop(StationState state, std::string text);

  dds::SessionRequest request_;
  Source source_;
  StationOptions options_;
  StationState state_ = StationState::kOpening;
  std::string message_;
  dds::Credit credit_;
  StationProgress progress_;

  std::deque<ClBlock> blocks_;  ///< read and not acknowledged, from sequence `acknowledged_`
  std::uint64_t acknowledged_ = 0;
  Cursor cursor_;
  Cursor cursor_before_;           ///< of the newest batch, for on_not_sent()
  std::uint64_t granted_end_ = 0;  ///< sequences below it may be sent
  SourceState source_state_ = SourceState::kReady;
  std::optional<std::int64_t> gathering_since_ns_;  ///< when a small batch was first held back
  std::uint64_t service_id_ = 0;
  std::int64_t opened_ns_ = 0, asked_ns_ = 0, heard_ns_ = 0, progress_ns_ = 0, went_back_ns_ = 0;
  std::uint64_t went_back_to_ = ~std::uint64_t{0};
  Asking asking_ = Asking::kNotAsked;
};

}  // namespace meridian::stream
