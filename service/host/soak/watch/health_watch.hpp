// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <map>
#include <string>

#include "service/host/soak/report/soak_report.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"

namespace meridian::soak {

/// Watches a service from outside: memory, files, threads, faults and switches by the kernel's
/// account, latencies by what it publishes. Fills Life and Drift of a report.
class HealthWatch {
 public:
  HealthWatch(dds::Participant& participant, SoakReport& report);

  /// A service was started.
  void begin_life(double now_s);
  /// Once a second while it runs; `status` is the newest of this life, nullptr before the first.
  void look(pid_t service, double now_s, const dds::Status* status);
  /// How late a bare thread of highest priority woke since the last call, on the cycle's processor.
  void take_bare(double now_s, const Histogram& lateness) {
    report_.slices.add(now_s, kBareThread, lateness);
  }
  /// Whether the machine moved in a program, of every status.
  void take_cutting(double now_s, bool is_cutting);

 private:
  void take_latencies(double now_s);

  SoakReport& report_;
  dds::Reader<dds::Latency> latencies_;
  double begin_s_ = 0, drift_s_ = 0;
  std::uint64_t service_id_ = 0;
  /// What this life had measured at the last look, and where the last interval began.
  struct Seen {
    Histogram last, interval;
  };
  std::map<std::string, Seen> seen_;
};

}  // namespace meridian::soak
