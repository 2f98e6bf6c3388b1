// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/topics/limit_topic.hpp"

#include "service/neighbours/ros/message_types.hpp"
#include "service/neighbours/ros/units.hpp"

namespace meridian::ros {

LimitTopic::LimitTopic(mcap::Writer& writer, const MachineModel& model)
    : writer_(writer),
      model_(model),
      channel_(add_topic(writer, "/limit_shares", limit_shares_type(model))) {}

void LimitTopic::write(std::int64_t due_ns, DerivedRow& derived) {
  is_written_ = pace_.is_due(due_ns);
  if (is_written_) put(due_ns, derived);
}

void LimitTopic::finish(std::int64_t due_ns, DerivedRow& derived) {
  if (!is_written_) put(due_ns, derived);
  is_written_ = true;
}

void LimitTopic::put(std::int64_t due_ns, DerivedRow& derived) {
  message_.begin().put_header(due_ns, "");
  for (int i = 0; i < limited_count(model_); ++i) {
    for (const double share : derived.shares()[static_cast<std::size_t>(i)]) {
      message_.put(rounded_float(share, kSharePlaces));
    }
  }
  derived.forget_shares();
  (void)writer_.write(channel_, static_cast<std::uint64_t>(due_ns), message_.bytes());
}

}  // namespace meridian::ros
