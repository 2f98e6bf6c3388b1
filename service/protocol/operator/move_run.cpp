// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/operator/move_run.hpp"

#include <optional>
#include <string_view>
#include <utility>

#include "meridian/cycle/jog/probing.hpp"
#include "meridian/cycle/state_table.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/protocol/station/source_pump.hpp"
#include "service/protocol/station/station.hpp"
#include "service/protocol/station/station_link.hpp"
#include "service/protocol/steady_ns.hpp"

namespace meridian::stream {
namespace {

constexpr std::chrono::milliseconds kMoveLook{10};
constexpr std::chrono::milliseconds kNoWait{0};

dds::SessionRequest request_of(const MoveOrder& order) {
  dds::SessionRequest request;
  request.session = draw_id();
  request.station = order.station;
  request.program = order.is_probing ? "probe" : "move";
  request.policies = dds::kPolicyMove | dds::kPolicyExactStop;
  request.frame = order.frame;
  request.tools = order.tools;
  request.limits = order.limits;
  if (order.move.joints) {
    request.policies |= dds::kPolicyFirstJoints;
    request.first_joints = *order.move.joints;
  }
  return request;
}

/// One move on its way through a machine.
class MoveRun {
 public:
  MoveRun(dds::Participant& participant, OperatorLink& link, const MoveOrder& order,
          std::chrono::milliseconds timeout)
      : operator_(link),
        order_(order),
        timeout_(timeout),
        request_(request_of(order)),
        text_(program_of(order.move)),
        reader_(std::string_view(text_), "move"),
        station_(request_, [this] { return supply_of(reader_); }),
        wire_(participant, station_) {}

  [[nodiscard]] MoveResult go(const std::atomic<bool>& is_stopping) {
    if (const auto refused = load(is_stopping)) return *refused;
    const dds::Status& status = *operator_.status();
    if (status.joints != order_.joints || status.tool_length_mm != order_.tool_length_mm) {
      return give_up("the machine stands elsewhere by now; look, and say it again");
    }
    const double argument = order_.is_probing ? kStartProbing : 0;
    const auto reply = operator_.ask(Verb::kStart, argument, timeout_);
    if (!reply) return give_up("the machine does not answer the start");
    if (!reply->is_accepted) return give_up(reply->text);
    return follow(is_stopping);
  }

 private:
  /// Until the machine has the whole move and waits for its start; or why it has not.
  [[nodiscard]] std::optional<MoveResult> load(const std::atomic<bool>& is_stopping) {
    const std::int64_t begin_ns = steady_ns();
    const std::int64_t patience_ns = std::chrono::nanoseconds(timeout_).count();
    while (!is_loaded()) {
      look();
      if (station_.state() == StationState::kNoAnswer) return end(MoveEnd::kNoAnswer);
      if (station_.is_over()) return end(MoveEnd::kRefused);
      if (is_stopping.load()) return give_up("interrupted before its start");
      if (steady_ns() - begin_ns > patience_ns) return give_up("the machine does not load it");
    }
    return std::nullopt;
  }

  [[nodiscard]] bool is_loaded() const {
    const auto& status = operator_.status();
    return station_.state() == StationState::kComplete && status &&
           status->session == request_.session && status->state == State::kLoaded;
  }

  [[nodiscard]] MoveResult follow(const std::atomic<bool>& is_stopping) {
    constexpr std::int64_t kPatience_ns = 5'000'000'000;
    std::int64_t heard_ns = steady_ns();
    bool is_aborted = false;
    while (!station_.is_over()) {
      if (look()) heard_ns = steady_ns();
      if (steady_ns() - heard_ns > kPatience_ns) return end(MoveEnd::kNoAnswer);
      if (!is_stopping.load() || is_aborted) continue;
      is_aborted = true;
      (void)operator_.ask(Verb::kAbort, 0, timeout_);
    }
    return end(station_.state() == StationState::kRan ? MoveEnd::kThere : MoveEnd::kStopped);
  }

  /// Sends and hears; whether the service said anything.
  bool look() {
    const bool has_credit = wire_.work(kMoveLook);
    while (wire_.take_status()) continue;  // the operator's link follows them
    return operator_.wait_for_status(kNoWait) || has_credit;
  }

  /// Nothing moved, nor will it: the machine is freed where this move holds it.
  [[nodiscard]] MoveResult give_up(std::string why) {
    wire_.close();
    (void)operator_.wait_for_status(kMoveLook);
    const auto& status = operator_.status();
    if (status && status->session == request_.session) {
      (void)operator_.ask(Verb::kAbort, 0, timeout_);
    }
    return {MoveEnd::kRefused, std::move(why)};
  }

  [[nodiscard]] MoveResult end(MoveEnd how) const { return {how, station_.message()}; }

  OperatorLink& operator_;
  const MoveOrder& order_;
  std::chrono::milliseconds timeout_;
  dds::SessionRequest request_;
  std::string text_;
  cl::ClReader reader_;
  Station station_;
  StationLink wire_;
};

}  // namespace

MoveResult run_move(dds::Participant& participant, OperatorLink& link, const MoveOrder& order,
                    const std::atomic<bool>& is_stopping, std::chrono::milliseconds timeout) {
  MoveRun run(participant, link, order, timeout);
  return run.go(is_stopping);
}

}  // namespace meridian::stream
