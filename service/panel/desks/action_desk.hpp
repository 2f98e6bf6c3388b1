// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include "service/drives/kit/actions/action_link.hpp"
#include "service/panel/desks/outcome.hpp"
#include "service/panel/serve/hub.hpp"
#include "service/panel/status/awaited_action.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"

namespace meridian::panel {

/// The operator in place of a PLC: shows what the path waits for (tool, spindle, coolant, stop,
/// vendor word) and answers when a person has done it, or could not. For machines where nobody else
/// answers actions.
class ActionDesk {
 public:
  /// `participant` and `hub` must live on. Throws DdsError.
  ActionDesk(dds::Participant& participant, Hub& hub);

  /// Publishes what is to be done now. What somebody else answered, or what no program waits for
  /// any more, is not. One thread.
  void poll(const std::optional<dds::Status>& status);
  /// Answers the action of that id; `is_done` false: it could not be done. Any thread.
  [[nodiscard]] Outcome answer(std::uint64_t id, bool is_done);

 private:
  void publish() const;
  void take();

  Hub& hub_;
  std::mutex mutex_;  ///< of all below
  drive::ActionLink link_;
  std::optional<dds::Reader<dds::ActionDone>> answers_;  ///< nothing: its identity may not read
  AwaitedAction awaited_;
};

}  // namespace meridian::panel
