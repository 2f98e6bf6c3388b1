// SPDX-License-Identifier: Apache-2.0
#include <sys/timex.h>

#include <cstdio>

#include "service/host/probe/doctor/doctor.hpp"

namespace meridian::probe {
namespace {

/// The cycle sleeps on the monotonic clock and does not mind; whoever compares logs of hosts does.
[[nodiscard]] Finding time_of_day(const TimeOfDay& now) {
  char found[96];
  if (!now.is_synchronised) {
    return {"time of day", Health::kNote,
            "not synchronised: logs of several hosts do not go together (the cycle sleeps on the "
            "monotonic clock, which nobody sets)",
            "apt install chrony; ptp4l and phc2sys where drives on other hosts need due times"};
  }
  std::snprintf(found, sizeof found, "synchronised, off by %.1f ms at most", 1e3 * now.max_error_s);
  return {"time of day", Health::kFine, found, ""};
}

/// What fires the timer of a processor: its own, or one that all share.
[[nodiscard]] Finding timer_source(const HostFiles& host) {
  const std::string folder = "sys/devices/system/clockevents/";
  Finding out{"timer source", Health::kFine, "not reported by this kernel", ""};
  for (const std::string& event : host.names(folder, "clockevent")) {
    const auto device = host.text(folder + event + "/current_device");
    if (!device || device->empty()) continue;
    if (out.health == Health::kFine) out.found = *device;
    const bool is_shared =
        device->starts_with("hpet") || device->starts_with("pit") || device->starts_with("acpi_pm");
    if (!is_shared) continue;
    out.health = Health::kBad;
    out.found = *device + " for " + event;
    out.remedy =
        "one timer for all processors wakes late: boot without nolapic and lapic=off, with "
        "processor.max_cstate=1 where the processor's own stops in deep sleep";
  }
  return out;
}

[[nodiscard]] Finding timer_migration(const HostFiles& host) {
  const auto migrates = host.number("proc/sys/kernel/timer_migration");
  if (migrates.value_or(0) == 0) {
    return {"timer migration", Health::kFine,
            migrates ? "off: timers fire where they were set" : "not reported by this kernel", ""};
  }
  return {"timer migration", Health::kNote,
          "on: timers of idle processors are taken to others, the cycle's among them",
          "sysctl kernel.timer_migration=0 (in /etc/sysctl.d)"};
}

}  // namespace

TimeOfDay read_time_of_day() {
  timex now{};
  const int state = ::adjtimex(&now);
  return {.is_synchronised = state >= 0 && state != TIME_ERROR && (now.status & STA_UNSYNC) == 0,
          .max_error_s = static_cast<double>(now.maxerror) * 1e-6};
}

Findings examine_clocks(const HostFiles& host, const TimeOfDay& now) {
  return {time_of_day(now), timer_source(host), timer_migration(host)};
}

}  // namespace meridian::probe
