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
}

bool Recorder::take(const CycleRecord& record) noexcept {
  if (!writer_) return true;
  if (ring_.try_push(record)) return true;
  rows_lost_.fetch_add(1, std::memory_order_relaxed);
  return false;
}

void Recorder::run() noexcept {
  if (!writer_) return;
  CycleRecord row;
  for (bool is_last = false; !is_last;) {
    is_last = is_stopping_.load();
    while (ring_.try_pop(row)) {
      if (!writer_->write(row)) rows_lost_.fetch_add(1, std::memory_order_relaxed);
    }
    if (!is_last) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  (void)writer_->close();
}

}  // namespace meridian::telemetry
