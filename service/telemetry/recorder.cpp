// SPDX-License-Identifier: Apache-2.0
#include "service/telemetry/recorder.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

namespace meridian::telemetry {

Recorder::Recorder(const std::string& path, const MachineModel& model) {
  if (path.empty()) return;
  auto writer = record::RecordingWriter::create(path, model);
  if (!writer) throw std::runtime_error(writer.error().text());
  writer_ = std::move(*writer);
  auto events = record::OperatorEventsWriter::create(record::operator_events_path(path));
  if (!events) throw std::runtime_error(events.error().text());
  events_writer_ = std::move(*events);
}

bool Recorder::take(const CycleRecord& record) noexcept {
  if (!writer_) return true;
  if (ring_.try_push(record)) return true;
  rows_lost_.fetch_add(1, std::memory_order_relaxed);
  return false;
}

void Recorder::take(const Event& event) noexcept {
  if (writer_ && event.code == EventCode::kAccepted) (void)events_.try_push(event);
}

void Recorder::run() noexcept {
  if (!writer_) return;
  CycleRecord row;
  Event event;
  for (bool is_last = false; !is_last;) {
    is_last = is_stopping_.load();
    while (ring_.try_pop(row)) {
      if (!writer_->write(row)) rows_lost_.fetch_add(1, std::memory_order_relaxed);
    }
    while (events_.try_pop(event)) (void)events_writer_->write(event);
    if (!is_last) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  (void)writer_->close();
}

}  // namespace meridian::telemetry
