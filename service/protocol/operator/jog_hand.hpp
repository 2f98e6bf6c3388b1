// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "service/protocol/operator/operator_link.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/writer.hpp"

namespace meridian::stream {

/// What a hand does with one joint or the tool. Units: mm or rad, s.
struct JogPlan {
  bool is_tool = false;
  int joint = 0;  ///< of the tool: ToolAxis
  double velocity = 0;
  double time_s = 0;    ///< held for so long; 0: until the distance is behind it
  double distance = 0;  ///< 0: as far as travel reaches
  double dead_man_s = 0.15;
  std::optional<Seen> seen{};  ///< when it was pressed, OperatorLink::ask()
};

enum class JogEnd : std::uint8_t {
  kDone,      ///< time or distance is over, or the caller let go; the machine is at rest
  kRefused,   ///< `text` says why
  kNoAnswer,  ///< the service is silent, or fell silent
  kTakenOff   ///< the machine left Jogging before: `text` is its message
};

struct JogResult {
  JogEnd end = JogEnd::kDone;
  std::string text{};
  double position = 0;  ///< of the joint at the end; of the tool nothing
  bool has_moved = false;
};

/// Holds a joint as long as `plan` says and `is_let_go` is false: says `jog`, then sends its
/// samples at 50 Hz, then waits for the joint to rest. One thread; throws DdsError.
class JogHand {
 public:
  JogHand(dds::Participant& participant, OperatorLink& link) : link_(link), jogs_(participant) {}

  [[nodiscard]] JogResult jog(const JogPlan& plan, const std::atomic<bool>& is_let_go,
                              std::chrono::milliseconds timeout);

 private:
  void send(const JogPlan& plan, std::uint16_t epoch, double velocity);
  enum class Grip : std::uint8_t {
    kKept,      ///< until the hand let go
    kTakenOff,  ///< the machine stopped jogging before
    kLost       ///< nobody says any more what the machine does
  };
  [[nodiscard]] Grip hold(const JogPlan& plan, const dds::Reply& reply,
                          const std::atomic<bool>& is_let_go);
  [[nodiscard]] Grip press(const JogPlan& plan, const dds::Reply& reply,
                           const std::atomic<bool>& is_let_go);
  [[nodiscard]] JogResult wait_for_rest(const JogPlan& plan, bool was_held);

  OperatorLink& link_;
  dds::Writer<dds::Jog> jogs_;
  std::uint64_t sample_ = 0;
};

}  // namespace meridian::stream
