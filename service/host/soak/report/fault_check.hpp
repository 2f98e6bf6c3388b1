// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "meridian/cycle/cycle_data.hpp"
#include "service/host/soak/chaos.hpp"
#include "service/host/soak/watch/host_watch.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::soak {

/// Whether `alarm` at `joint` is what drives that suffer `injected` make of it, once they have been
/// enabled for `enabled_s`: of its kind, at its drive, and not before it was due.
[[nodiscard]] bool explains(const Planned& injected, double enabled_s, Alarm alarm,
                            int joint) noexcept;

/// What is seen of a Fault beside the status.
struct Witness {
  std::vector<Stall> stalls{};    ///< of the host, lately
  bool is_watched = true;         ///< false: nobody had the right to see that (HostWatch)
  bool misses_setpoints = false;  ///< a drive says that they stayed away
};

/// Says of every Fault of the machine who caused it: the drives, given a fault; the
/// soak, which changed drives or lost them; the host, where it was seen to take a processor away
/// before the stop for longer than drives bridge or the service waits for them, or where nobody
/// watched it; or nobody.
/// Proof: tests/unit/soak/fault_check_test.cpp.
class FaultCheck {
 public:
  /// `bridge_s`: for so long drives bridge missing setpoints.
  explicit FaultCheck(double bridge_s = 0.05) noexcept : bridge_s_(bridge_s) {}

  enum class Cause { kInjected, kOwnDoing, kHost, kUnwatched, kUnprovoked };

  /// New drives, which nobody has enabled yet, with what they are to suffer. Where the machine was
  /// on, its next Fault is the soak's own doing.
  void begin_drives(const std::optional<Planned>& injected) noexcept;
  /// The drives are gone. Where the machine was on, its next Fault follows from that.
  void lose_drives() noexcept;
  /// The service is gone, and with it what it was about to report.
  void lose_service() noexcept;
  /// Every status in its order, at `now_s`; the cause once for each Fault, as soon as it is known.
  /// A witness may report stalls at any time of the stop, from kStallsOf_ns before it on; those
  /// after the first status of the stop explain nothing.
  [[nodiscard]] std::optional<Cause> see(const dds::Status& status, double now_s,
                                         const Witness& witness) noexcept;
  /// What a report says of the Fault that was checked last: its alarm, and what was planned when.
  [[nodiscard]] std::string describe() const;
  /// Whether the cause of the Fault that is there is known.
  [[nodiscard]] bool is_checked() const noexcept { return is_checked_; }

  /// What the host does acts on the machine within this time.
  static constexpr std::int64_t kStallsOf_ns = 1'000'000'000;
  /// A Fault is reported this long after the begin of its stop at most.
  static constexpr std::int64_t kLongestStop_ns = 10'000'000'000;

 private:
  void listen(const Witness& witness) noexcept;

  double bridge_s_;
  std::optional<Planned> injected_;
  double enabled_s_ = 0, seen_s_ = 0, fault_s_ = 0;
  bool is_on_ = false, is_faulty_ = false, is_checked_ = false, is_own_doing_ = false;
  Alarm alarm_ = Alarm::kNone;  ///< first of the stop that is going on
  int joint_ = 0;
  std::optional<std::int64_t> stop_ns_;  ///< when that stop was first reported, machine's clock
  double away_s_ = 0;                    ///< longest that a processor was away before it
  bool is_watched_ = true, misses_setpoints_ = false;
};

}  // namespace meridian::soak
