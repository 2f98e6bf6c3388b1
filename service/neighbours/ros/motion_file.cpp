// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/motion_file.hpp"

#include <cstring>
#include <limits>

namespace meridian::ros {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

}  // namespace

Expected<std::unique_ptr<MotionFile>, record::RecordError> MotionFile::create(
    const std::string& path, const MachineModel& model, const Contents& contents,
    const std::string& origin) {
  auto writer = mcap::Writer::create(path, {.profile = "ros2", .library = "meridian"});
  if (!writer) {
    return tl::make_unexpected(record::RecordError{
        path, 0, std::string("cannot be created: ") + std::strerror(writer.error()),
        "name a file in a folder that exists and is writable"});
  }
  (*writer)->add_metadata("meridian", {{"machine", model.name},
                                       {"recording", origin},
                                       {"cycle_ns", std::to_string(model.cycle_ns)},
                                       {"tool_length_mm", std::to_string(model.tool_length_mm)},
                                       {"units", "m, rad, s"}});
  return std::unique_ptr<MotionFile>(new MotionFile(path, std::move(*writer), model, contents));
}

MotionFile::MotionFile(const std::string& path, std::unique_ptr<mcap::Writer> writer,
                       const MachineModel& model, const Contents& contents)
    : path_(path),
      writer_(std::move(writer)),
      derived_(model),
      joints_(*writer_, model, contents),
      tip_(*writer_),
      cycles_(*writer_, model, contents),
      limits_(*writer_, model),
      transforms_(*writer_, model),
      markers_(*writer_, model, transforms_.frames()),
      events_(*writer_),
      event_rows_(events_, model, contents) {
  if (contents.has_feedback) drives_.emplace(*writer_, model, contents);
}

bool MotionFile::has_time(std::int64_t due_ns) noexcept {
  return due_ns >= 0 && due_ns / kSecond_ns <= std::numeric_limits<std::int32_t>::max();
}

bool MotionFile::write(const record::RecordingRow& row) {
  if (writer_->error_number() != 0) return false;
  derived_.add(row);
  joints_.write(row);
  tip_.write(row.due_ns, derived_.pose());
  cycles_.write(row, derived_);
  limits_.write(row.due_ns, derived_);
  transforms_.write(row.due_ns, row.joints);
  markers_.write(row.due_ns, derived_.pose().tip);
  event_rows_.write(row);
  if (drives_) drives_->write(row);
  ++rows_;
  last_ns_ = row.due_ns;
  return writer_->error_number() == 0;
}

void MotionFile::write_event(std::int64_t time_ns, Level level, const std::string& source,
                             const std::string& text) {
  events_.write(time_ns, level, source, text);
}

std::optional<record::RecordError> MotionFile::close() {
  if (rows_ > 0) {
    limits_.finish(last_ns_, derived_);
    markers_.finish(last_ns_);
  }
  if (writer_->close()) return std::nullopt;
  return record::RecordError{path_, 0, std::strerror(writer_->error_number()),
                             "make room, or name a file on another disk"};
}

}  // namespace meridian::ros
