// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/flight_store.hpp"

#include "meridian/cycle/state_table.hpp"

namespace meridian::telemetry {

void FlightStore::take(const CycleRecord& record) noexcept {
  if (rows_.empty()) return;
  const bool is_faulty = is_fault(record.state);
  const bool begins = is_faulty && !was_faulty_;
  was_faulty_ = is_faulty;
  if (is_frozen()) {
    if (begins) faults_missed_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  if (begins && is_armed_) {
    faults_missed_.fetch_add(1, std::memory_order_relaxed);
    freeze();
    return;
  }
  rows_[count_ % rows_.size()] = {record, newest_};
  if (begins) {
    is_armed_ = true;
    fault_ = count_;
    at_rest_ = 0;
    forget_alarms_before(record.setpoint.cycle);
  }
  ++count_;
  if (!is_armed_) return;
  if (record.state != State::kFaultStop) ++at_rest_;
  if (at_rest_ > tail_ || count_ - fault_ > rows_.size() / 2) freeze();
}

void FlightStore::take(const Event& event, bool is_news) noexcept {
  if (rows_.empty() || is_frozen()) return;
  if (is_news) events_[event_count_++ % kMaxEvents] = event;
  if (event.code != EventCode::kAlarm) return;
  if (!is_armed_) forget_alarms_before(event.cycle);
  if (alarm_count_ == kMaxAlarms) return;
  alarms_[alarm_count_++] = {static_cast<Alarm>(event.a), static_cast<int>(event.b), event.x,
                             event.line, event.cycle};
}

void FlightStore::forget_alarms_before(std::uint64_t cycle) noexcept {
  const auto begin = alarms_.begin(), end = begin + static_cast<std::ptrdiff_t>(alarm_count_);
  const auto left =
      std::remove_if(begin, end, [cycle](const auto& alarm) { return alarm.cycle < cycle; });
  alarm_count_ = static_cast<std::size_t>(left - begin);
}

void FlightStore::finish() noexcept {
  if (is_armed_ && !is_frozen()) freeze();
}

void FlightStore::thaw() noexcept {
  count_ = event_count_ = alarm_count_ = 0;
  is_armed_ = false;
  is_frozen_.store(false, std::memory_order_release);
}

}  // namespace meridian::telemetry
