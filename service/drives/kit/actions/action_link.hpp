// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"

namespace meridian::drive {

/// The action peer's end of the wire.
class ActionLink {
 public:
  explicit ActionLink(dds::Participant& participant) : reader_(participant), writer_(participant) {}

  /// The next action that somebody is to do; false: none.
  [[nodiscard]] bool take(dds::Action& action) { return reader_.take(action); }
  void answer(const dds::ActionDone& done) { static_cast<void>(writer_.write(done)); }

 private:
  dds::Reader<dds::Action> reader_;
  dds::Writer<dds::ActionDone> writer_;
};

}  // namespace meridian::drive
