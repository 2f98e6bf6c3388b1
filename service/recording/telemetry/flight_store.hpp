// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "meridian/cycle/cycle_data.hpp"
#include "service/recording/record/flight/flight_row.hpp"

namespace meridian::telemetry {

/// The last rows of a run in fixed memory, which freeze where the machine came to rest behind a
/// fault. At most half of them are from after the begin of the fault, however long the stop took;
/// so the rest is from before it, if the run was that long since the begin or the last thaw(). A
/// second fault while the first is still being kept freezes it and counts as missed. One thread
/// puts in (take, finish), another takes out: what is frozen is the reader's until thaw(), and
/// meanwhile nothing is kept. Proof: tests/unit/telemetry/flight_store_test.cpp.
class FlightStore {
 public:
  static constexpr std::size_t kMaxAlarms = 8, kMaxEvents = 256;

  /// `rows` 0: nothing is kept. So many rows as `tail` are kept after the stop.
  FlightStore(std::size_t rows, std::size_t tail) : rows_(rows), tail_(tail) {}

  /// Putting in. The newest report goes with every row that follows.
  void take(const record::DriveReport& report) noexcept { newest_ = report; }
  void take(const CycleRecord& record) noexcept;
  /// Alarms from the fault's first cycle on go with the rows (one that brings no FaultStop is no
  /// fault); of all `is_news` events the newest are kept.
  void take(const Event& event, bool is_news) noexcept;
  /// No more rows come: a fault that is going on is frozen as it is.
  void finish() noexcept;

  /// Taking out, while it is frozen.
  [[nodiscard]] bool is_frozen() const noexcept {
    return is_frozen_.load(std::memory_order_acquire);
  }
  /// Rows that there is room for.
  [[nodiscard]] std::size_t room() const noexcept { return rows_.size(); }
  [[nodiscard]] std::size_t size() const noexcept { return std::min(count_, rows_.size()); }
  /// Row `i`, 0 the oldest.
  [[nodiscard]] const record::FlightRow& row(std::size_t i) const noexcept {
    return rows_[(count_ - size() + i) % rows_.size()];
  }
  /// The row in which the fault was first seen.
  [[nodiscard]] const record::FlightRow& fault() const noexcept {
    return rows_[fault_ % rows_.size()];
  }
  /// In the order in which they were reported; the first one is the cause.
  [[nodiscard]] std::size_t alarm_count() const noexcept { return alarm_count_; }
  [[nodiscard]] const record::ReportedAlarm& alarm(std::size_t i) const noexcept {
    return alarms_[i];
  }
  [[nodiscard]] std::size_t event_count() const noexcept {
    return std::min(event_count_, kMaxEvents);
  }
  [[nodiscard]] const Event& event(std::size_t i) const noexcept {
    return events_[(event_count_ - event_count() + i) % kMaxEvents];
  }
  /// Gives the store back, empty.
  void thaw() noexcept;

  /// Faults that came while it was frozen or kept one before, ever. Any thread.
  [[nodiscard]] std::uint64_t faults_missed() const noexcept { return faults_missed_; }

 private:
  void forget_alarms_before(std::uint64_t cycle) noexcept;
  void freeze() noexcept { is_frozen_.store(true, std::memory_order_release); }

  std::vector<record::FlightRow> rows_;
  std::size_t tail_, count_ = 0, fault_ = 0, at_rest_ = 0;
  bool is_armed_ = false;  ///< a fault is going on
  std::array<record::ReportedAlarm, kMaxAlarms> alarms_{};
  std::size_t alarm_count_ = 0;
  std::array<Event, kMaxEvents> events_{};
  std::size_t event_count_ = 0;
  /// Of who puts in, frozen or not.
  record::DriveReport newest_;
  bool was_faulty_ = false;

  std::atomic<bool> is_frozen_{false};
  std::atomic<std::uint64_t> faults_missed_{0};
};

}  // namespace meridian::telemetry
