// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/topics/event_topic.hpp"

#include "meridian/cycle/state_table.hpp"
#include "service/neighbours/ros/message_types.hpp"

namespace meridian::ros {

Level level_of(State state) noexcept { return is_fault(state) ? Level::kError : Level::kInfo; }

EventTopic::EventTopic(mcap::Writer& writer)
    : writer_(writer), channel_(add_topic(writer, "/events", log_type())) {}

void EventTopic::write(std::int64_t time_ns, Level level, std::string_view source,
                       std::string_view text, std::uint32_t line) {
  message_.begin().put_time(time_ns).put(static_cast<std::uint8_t>(level));
  message_.put(source).put(text).put("").put("").put(line);
  ++count_;
  (void)writer_.write(channel_, static_cast<std::uint64_t>(time_ns), message_.bytes());
}

}  // namespace meridian::ros
