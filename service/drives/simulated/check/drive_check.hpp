// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "service/drives/simulated/check/check_player.hpp"

namespace meridian::drives {

struct CheckReport {
  bool has_drives = false;            ///< somebody reported a drive
  std::vector<Finding> findings;      ///< rules that were broken
  std::vector<std::string> unproven;  ///< steps in which this program overslept again and again
};

enum class Operator : std::uint8_t { kAway, kThere };

/// Checks drives by playing the service against them: walks them up, leads them, loses setpoints,
/// sends what they must drop and refuse, and lets another service come. The first linear drive
/// moves by some centimetres towards the middle of its travel. Proof:
/// tests/unit/simulated_drives/drive_check_test.cpp, with one faulty client for every rule.
class DriveCheck {
 public:
  /// `report`: hears what is checked.
  DriveCheck(const MachineModel& model, CheckedDrives& drives,
             std::function<void(const std::string&)> report = {});
  /// The emergency stop is checked where the operator is there to open and close it.
  [[nodiscard]] CheckReport run(Operator operator_is = Operator::kAway);

 private:
  using Spoil = std::function<void(dds::SetpointSample&)>;

  void step(const char* what, const std::function<void()>& body);
  [[nodiscard]] bool rest();     ///< out of faults, off
  [[nodiscard]] bool walk_up();  ///< operation enabled, following where they stand
  void check_states();
  void check_enabling();
  void check_following();
  void check_dropped(Rule rule, Speaker who, const Spoil& spoil, bool counts_cycle = true);
  void check_all_dropped();
  void check_foreign_commands();
  void check_bridge();
  void check_watchdog();
  void check_killed();
  void check_reset();
  void check_refused(Rule rule, std::uint16_t error, const Spoil& spoil);
  void check_all_refused();
  void check_begin();
  void check_homing();
  void check_doubled();
  void check_emergency_stop();
  void check_masters();
  void check_restart();
  void check_stopping_distance(Rule rule, double last, double velocity);
  void check_next_master();
  void speed_up(double to);
  void lead(double velocity);

  CheckPlayer player_;
  std::function<void(const std::string&)> report_;
  CheckReport result_;
  std::size_t mover_ = 0;
  double limit_ = 0;      ///< velocity of the mover, mm/s
  double direction_ = 1;  ///< towards the middle of its travel
};

}  // namespace meridian::drives
