// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <utility>

#include "service/daemon/supervisor/supervisor.hpp"

/// What enabling devices do, in words: the cycle has held the machine by then where it had to.
namespace meridian::interpolator {

void Supervisor::take_enabling_changes() {
  using Beat = EnablingWatch::Beat;
  EnablingChange change;
  while (ports_.enabling_changes.try_pop(change)) {
    const std::string device = std::string("enabling device of ") + change.name.data();
    switch (change.beat) {
      case Beat::kBegun:
        enabling_devices_[enabling_devices_at_++ % enabling_devices_.size()] = {change.source,
                                                                                change.name.data()};
        notice(device + " is pressed", Notice::Kind::kNews);
        break;
      case Beat::kReleased:
        notice(device + " was released: what moved is held", Notice::Kind::kWarning);
        break;
      case Beat::kLeft:
        notice(device + " has left", Notice::Kind::kNews);
        break;
      case Beat::kNoRoom:
        notice(device + " does not count: there are too many of them", Notice::Kind::kWarning);
        break;
      case Beat::kKnown:
        break;
    }
  }
  const std::uint32_t losses = ports_.enabling.losses();
  if (std::exchange(enabling_losses_, losses) == losses) return;
  const std::uint64_t source = ports_.enabling.lost_source();
  const auto device =
      std::find_if(enabling_devices_.begin(), enabling_devices_.end(),
                   [source](const EnablingDevice& known) { return known.source == source; });
  notice("enabling device of " + (device != enabling_devices_.end() ? device->name : "somebody") +
             " fell silent: what moved is held; press it again, then resume",
         Notice::Kind::kWarning);
}

void Supervisor::report_guard() {
  const bool is_open = ports_.is_guard_open.load(std::memory_order_relaxed);
  if (std::exchange(was_guard_open_, is_open) == is_open) return;
  if (!is_open) return notice("the guard is shut", Notice::Kind::kOver);
  notice(view_.is_dry_run ? "a guard is open; the dry run goes on"
                          : "a guard is open: what moved is held, and only jogging is allowed, "
                            "slowly",
         Notice::Kind::kWarning);
}

/// What finds no room is lost: telemetry is held up by then, and motion is not.
void Supervisor::notice(const std::string& text, Notice::Kind kind) {
  Notice notice{.kind = kind, .text = {}};
  std::memcpy(notice.text.data(), text.data(), std::min(text.size(), notice.text.size() - 1));
  (void)ports_.notices.try_push(notice);
}

}  // namespace meridian::interpolator
