// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "meridian/cycle/drive_state.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/drives/simulated/check/check_rules.hpp"
#include "service/drives/simulated/check/checked_drives.hpp"

namespace meridian::drives {

/// What the service that is played says in a period.
enum class Saying : std::uint8_t {
  kAll,
  kSetpointsTwice,     ///< each comes again at once, the very same
  kLastSetpointAgain,  ///< no new one
  kNoSetpoints,
  kNothing  ///< no service is there
};

/// Plays a service for drives that are checked, a period at a time: says what is set here, and
/// reads the reports. Setpoints have even cycles; odd ones belong to what drives must drop.
class CheckPlayer {
 public:
  static constexpr int kBridge = 20;      ///< lost setpoints that it wants bridged
  static constexpr int kPatience = 3000;  ///< periods for what a drive may take its time for
  static constexpr std::uint64_t kServiceId = 0xC4EC, kOtherId = 0x07E2, kRestartedId = 0x4E57;
  using Also = std::function<void(CheckedDrives&)>;  ///< said after the setpoint of a period

  CheckPlayer(const MachineModel& model, CheckedDrives& drives);

  /// What is said in every period.
  std::array<std::uint16_t, kMaxJoints> words{};
  std::array<std::uint8_t, kMaxJoints> modes{};
  JointVector target{}, velocity{};
  std::uint16_t flags = 0;
  Saying saying = Saying::kAll;

  void tick(const Also& also = {});
  void ticks(int count, const Also& also = {});
  /// Until `is_reached`, at most so many periods; whether it was.
  [[nodiscard]] bool until(const std::function<bool()>& is_reached, int periods);
  void say_word(std::uint16_t word) { words.fill(word); }
  void ask(Wish wish) { drives_.ask(wish); }
  /// The service is gone with everything of it.
  void end_service();
  /// Another service comes, as kRestartedId, and counts from the beginning.
  void restart_service();

  /// A setpoint as this service would send it next, with an odd cycle and `words` made right.
  [[nodiscard]] dds::SetpointSample odd_setpoint() const;
  static void sign(dds::SetpointSample& sample, std::uint64_t service_id = kServiceId);
  /// A command to every drive.
  void command_all(Speaker who, std::uint64_t service_id, std::uint16_t word);

  [[nodiscard]] DriveState state(int drive) const;
  /// All drives that are reported.
  [[nodiscard]] bool are_all(DriveState state) const;
  [[nodiscard]] bool is_any(DriveState state) const;
  [[nodiscard]] bool is_any_reported() const noexcept { return newest.joint_mask != 0; }
  /// The newest setpoint is reported as taken, or one of the last few.
  [[nodiscard]] bool is_heard() const;
  [[nodiscard]] int count() const noexcept { return model_.joint_count; }
  [[nodiscard]] const MachineModel& model() const noexcept { return model_; }
  [[nodiscard]] double dt_s() const noexcept { return dt_s_; }
  /// Targets where the drives stand, without velocity.
  void stand();

  void find(Rule rule, const std::string& seen);  ///< a rule is broken; the first time counts
  dds::DriveFeedback newest;  ///< of all groups together; emergency stop: of any
  bool has_seen_odd = false;  ///< cycle_seen was one of those that are to be dropped
  bool is_disturbed = false;  ///< this program overslept
  std::vector<Finding> findings;

 private:
  void say_claim();  ///< who it is, and for how long drives are to bridge
  void say_commands();
  void say_setpoint();
  void read(const dds::DriveFeedback& report);

  const MachineModel& model_;
  CheckedDrives& drives_;
  double dt_s_;
  std::uint64_t service_id_ = kServiceId, cycle_ = 1000, command_ = 0;
  std::uint32_t stopped_groups_ = 0;  ///< that report the emergency stop
  dds::SetpointSample last_;
  std::int64_t ticks_ = 0, reported_ = 0;
  std::int64_t spoken_ = 0;  ///< periods since the service began to speak
  std::array<std::uint16_t, kMaxJoints> said_words_{};
  std::array<std::uint8_t, kMaxJoints> said_modes_{};
  std::map<std::uint32_t, std::uint64_t> samples_;  ///< newest, by group
  std::vector<dds::DriveFeedback> reports_;
};

/// "8700h", "0Fh".
[[nodiscard]] std::string in_hex(std::uint16_t value);

}  // namespace meridian::drives
