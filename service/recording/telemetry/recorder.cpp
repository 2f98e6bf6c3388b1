// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/recorder.hpp"

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

namespace meridian::telemetry {

Recorder::Recorder(const std::string& path, const MachineModel& model) : path_(path) {
  if (path.empty()) return;
  auto writer = record::RecordingWriter::create(path, model, record::Links::kRefused);
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
  if (!writer_ || !record::is_replayed(event) || events_.try_push(event)) return;
  events_lost_.fetch_add(1, std::memory_order_relaxed);
}

void Recorder::take(const record::RecordedFrame& frame) noexcept {
  if (!writer_ || frames_.try_push(frame)) return;
  events_lost_.fetch_add(1, std::memory_order_relaxed);
}

void Recorder::take(const record::RecordedTool& tool) noexcept {
  if (!writer_ || tools_.try_push(tool)) return;
  events_lost_.fetch_add(1, std::memory_order_relaxed);
}

void Recorder::take(const record::RecordedLimits& limits) noexcept {
  if (!writer_ || limits_.try_push(limits)) return;
  events_lost_.fetch_add(1, std::memory_order_relaxed);
}

void Recorder::run() noexcept {
  if (!writer_) return;
  // What a service that is killed loses at most, and what the next look adds to it.
  constexpr auto kUnflushed = std::chrono::milliseconds(250);
  auto flushed = std::chrono::steady_clock::now();
  CycleRecord row;
  Event event;
  record::RecordedFrame frame;
  record::RecordedTool tool;
  record::RecordedLimits limits;
  for (bool is_last = false; !is_last;) {
    is_last = is_stopping_.load();
    while (ring_.try_pop(row)) {
      if (!writer_->write(row)) rows_lost_.fetch_add(1, std::memory_order_relaxed);
    }
    while (frames_.try_pop(frame)) {
      if (!events_writer_->write(frame)) events_lost_.fetch_add(1, std::memory_order_relaxed);
    }
    while (tools_.try_pop(tool)) {
      if (!events_writer_->write(tool)) events_lost_.fetch_add(1, std::memory_order_relaxed);
    }
    while (limits_.try_pop(limits)) {
      if (!events_writer_->write(limits)) events_lost_.fetch_add(1, std::memory_order_relaxed);
    }
    while (events_.try_pop(event)) {
      if (!events_writer_->write(event)) events_lost_.fetch_add(1, std::memory_order_relaxed);
    }
    if (events_lost() + events_missed_ > 0) events_writer_->mark_incomplete();
    if (const auto now = std::chrono::steady_clock::now(); now - flushed >= kUnflushed) {
      (void)writer_->flush();
      flushed = now;
    }
    if (!is_last) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const bool has_rows = writer_->close(), has_events = events_writer_->close();
  error_number_ = !has_rows ? writer_->error_number() : events_writer_->error_number();
  if (!has_rows && rows_lost() == 0) rows_lost_ = 1;
  if (!has_events && events_lost() == 0) events_lost_ = 1;
}

std::string Recorder::complaint() const {
  const std::string why =
      error_number_ != 0 ? std::string(": ") + std::strerror(error_number_) : std::string();
  std::string text;
  if (rows_lost() > 0) {
    text = "recording " + path_ + " lacks " + std::to_string(rows_lost()) + " rows or more" + why;
  }
  if (const std::uint64_t events = events_lost() + events_missed_; events > 0) {
    text += (text.empty() ? "" : "; ") + record::operator_events_path(path_) + " lacks " +
            std::to_string(events) + " events or more and cannot be replayed" + why;
  }
  return text;
}

}  // namespace meridian::telemetry
