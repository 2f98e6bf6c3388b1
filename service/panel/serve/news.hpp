// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::panel {

enum class Severity : std::uint8_t { kNews, kWarning, kAlarm };

/// Whose message it is.
enum class NewsSource : std::uint8_t { kMachine, kOperator, kStation };

/// One line of what the machine said, or of what was asked of it.
struct NewsItem {
  std::uint64_t number = 0;  ///< from 1 on
  std::chrono::system_clock::time_point time;
  Severity severity = Severity::kNews;
  NewsSource source = NewsSource::kMachine;
  std::string text;
};

/// The alarm in force in words: joint, remedy, line, and the block of the program that ran.
[[nodiscard]] std::string alarm_text(const dds::Status& status, const MachineModel& model);

/// What the machine said since the panel began, and what a history adds, newest last: a page that
/// is loaded again shows it all. At most kKept items; one thread. Proof:
/// tests/panel/panel_unit_test.cpp.
class News {
 public:
  static constexpr std::size_t kKept = 200;

  /// Looks at the next status; true where it says something new.
  bool add(const dds::Status& status, const MachineModel& model,
           std::chrono::system_clock::time_point now);
  /// Adds what was heard otherwise.
  void add(NewsItem item);

  [[nodiscard]] const std::deque<NewsItem>& items() const noexcept { return items_; }

 private:
  void push(Severity severity, const std::string& text, std::chrono::system_clock::time_point now);

  std::deque<NewsItem> items_;
  std::uint64_t count_ = 0, service_id_ = 0, periods_lost_ = 0;
  Alarm alarm_ = Alarm::kNone;
  std::string message_;
  bool has_status_ = false;
};

}  // namespace meridian::panel
