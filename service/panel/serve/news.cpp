// SPDX-License-Identifier: Apache-2.0
#include "service/panel/serve/news.hpp"

#include <utility>

#include "service/recording/telemetry/words.hpp"

namespace meridian::panel {

std::string alarm_text(const dds::Status& status, const MachineModel& model) {
  std::string text = telemetry::describe(status.alarm, status.alarm_joint, status.alarm_value,
                                         status.alarm_line, model);
  if (status.alarm_line > 0) text += ", block " + std::to_string(status.block);
  return text;
}

void News::push(Severity severity, const std::string& text,
                std::chrono::system_clock::time_point now) {
  add({0, now, severity, NewsSource::kMachine, text});
}

void News::add(NewsItem item) {
  item.number = ++count_;
  items_.push_back(std::move(item));
  if (items_.size() > kKept) items_.pop_front();
}

bool News::add(const dds::Status& status, const MachineModel& model,
               std::chrono::system_clock::time_point now) {
  const std::uint64_t before = count_;
  if (has_status_ && status.service_id != service_id_) {
    push(Severity::kWarning, "the service was started anew", now);
    alarm_ = Alarm::kNone;
    message_.clear();
  }
  if (status.alarm != alarm_ && status.alarm != Alarm::kNone) {
    push(Severity::kAlarm, alarm_text(status, model), now);
  }
  if (status.message != message_ && !status.message.empty()) {
    push(status.alarm != Alarm::kNone ? Severity::kWarning : Severity::kNews, status.message, now);
  }
  const bool has_lost =
      has_status_ && status.service_id == service_id_ && status.periods_lost > periods_lost_;
  // Drives bridge a few; a row of them is worth a line, every one by itself is not.
  if (has_lost && status.periods_lost - periods_lost_ > 3) {
    push(Severity::kWarning,
         std::to_string(status.periods_lost - periods_lost_) +
             " periods lost at once: the host stalled (meridian doctor says why)",
         now);
  }
  has_status_ = true;
  service_id_ = status.service_id;
  periods_lost_ = status.periods_lost;
  alarm_ = status.alarm;
  message_ = status.message;
  return count_ != before;
}

}  // namespace meridian::panel
