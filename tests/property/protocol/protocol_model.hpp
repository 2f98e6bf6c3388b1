// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "service/protocol/intake_check.hpp"
#include "service/protocol/station/station.hpp"
#include "support/explore.hpp"
#include "support/machines.hpp"
#include "support/programs.hpp"

/// The session and credit protocol as a finite machine: the real Station and the real IntakeCheck,
/// a small program, a small queue, and a wire that may lose, double, spoil and overtake. Time goes
/// on in steps after which every repetition is due. What is under way to or from a service that is
/// killed is lost with it: readers that come later get nothing of it, and a station takes what came
/// before it asks again.
namespace meridian::stream {

/// Protocols that are wrong on purpose, for the check of the check.
enum class Variant : std::uint8_t {
  kRight,
  kCountsSlotsTwice,  ///< the service grants more places than its queue has
  kTrustsTheWire,     ///< the service does not look at the CRC
  kRunsDuplicates     ///< the service takes what comes again
};

/// How small the machine is, and how often what is rare may happen: so that it is finite.
struct Bounds {
  std::uint64_t blocks = 2;                    ///< of the program, besides its end
  std::size_t slots = 2;                       ///< of the queue, as the check knows them
  std::size_t to_service = 2, to_station = 1;  ///< messages under way; one more is lost
  int station_restarts = 0, service_restarts = 0, aborts = 0;
};

inline constexpr std::size_t kReserve =
    2;  ///< places that the check does not know of, as in intake
inline constexpr std::int64_t kTick = 1'000'000'000;

struct ToService {
  std::uint64_t session = 0, first = 0;
  std::uint32_t count = 0;
  bool is_open = false, is_end = false;
  auto operator<=>(const ToService&) const = default;
};

class Protocol {
 public:
  using Steps = std::vector<test::Step<Protocol>>;

  Protocol(const MachineModel& model, Variant variant, const Bounds& bounds)
      : model_(&model), variant_(variant), bounds_(bounds) {
    start_service();
    start_station();
  }

  [[nodiscard]] Steps steps() const;
  [[nodiscard]] std::string key() const;
  /// What is wrong with this state; empty: nothing.
  [[nodiscard]] std::string complaint() const;

 private:
  void start_service() {
    intake_.emplace(*model_, ToolLengths{}, ++service_id_);
    newest_.reset();
    clear_queue();
  }
  void start_station() {
    dds::SessionRequest request;
    request.session = ++session_;
    newest_.reset();
    request.station = "s";
    const auto supply = [next = std::uint64_t{0}, count = bounds_.blocks]() mutable {
      if (next == count) return Supply{};
      return Supply{Supply::Kind::kBlock, test::good_cut(next++), {}};
    };
    station_.emplace(request, supply,
                     StationOptions{.open_repeat_ns = kTick,
                                    .open_timeout_ns = INT64_MAX / 2,
                                    .silence_ns = kTick,
                                    .resend_after_ns = kTick,
                                    .gap_quiet_ns = 0,
                                    .gather_ns = 0});
  }
  void clear_queue() {
    queue_.clear();
    queue_session_ = pushed_ = ran_ = 0;
    has_end_ = false;
  }
  [[nodiscard]] IntakeContext context() const {
    const std::size_t slots =
        variant_ == Variant::kCountsSlotsTwice ? 2 * bounds_.slots : bounds_.slots;
    const std::size_t used = std::min(queue_.size(), slots);
    return {.now_ns = now_, .free_slots = slots - used, .actions = {}};
  }
  void answer(const std::optional<dds::Credit>& credit) {
    if (!credit) return;
    const std::uint64_t known = station_ ? station_->credit().service_id : 0;
    const bool is_same = known == 0 || known == credit->service_id;
    if (is_same && credit->verdict == dds::Verdict::kBeyondCredit)
      wrong_ = "an honest station is refused";
    if (credits_.size() < bounds_.to_station) credits_.push_back(*credit);
    if (credit->session == session_) newest_ = *credit;
  }
  void send(const ToService& message) {
    if (messages_.size() < bounds_.to_service) messages_.push_back(message);
  }
  void deliver(const ToService& message, bool is_spoilt);
  void push(const Accepted& accepted, std::uint64_t session);
  void run_block();
  /// What the station does by itself; false: nothing just now.
  bool work_station();
  /// Everything goes well from here on: whether the station comes to an end.
  [[nodiscard]] bool comes_to_an_end() const;
  [[nodiscard]] bool is_settled() const {
    return station_->is_over() ||
           (station_->state() == StationState::kComplete && !intake_->is_held());
  }

  const MachineModel* model_;
  Variant variant_;
  Bounds bounds_;
  std::optional<Station> station_;
  std::optional<IntakeCheck> intake_;
  std::uint64_t session_ = 0, service_id_ = 0, lost_session_ = 0;
  std::vector<ToService> messages_;
  std::vector<dds::Credit> credits_;
  std::optional<dds::Credit> newest_;  ///< DDS keeps the newest credit and gives it in the end
  std::vector<std::uint64_t> queue_;   ///< sequences
  std::uint64_t queue_session_ = 0;    ///< whose blocks were pushed last
  std::uint64_t pushed_ = 0, ran_ = 0;
  bool has_end_ = false;
  std::array<std::uint64_t, 4> ran_of_{};  ///< blocks that ran of each session, end included
  std::int64_t now_ = kTick;
  std::string wrong_;
};

}  // namespace meridian::stream
