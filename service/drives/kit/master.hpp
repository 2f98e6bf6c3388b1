// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace meridian::drive {

/// A service as drives know it: the DDS participant of its writers and the id that it says it has.
struct Master {
  std::uint64_t participant = 0;  ///< dds::participant_of(); 0: not known
  std::uint64_t service_id = 0;   ///< 0: none
  bool operator==(const Master&) const = default;
};

/// Whom the drives obey. They pin the participant of the first drive_command and keep to it while
/// that participant is there, whatever id others quote. They are free again when it is gone (its
/// writer is not matched any more: it ended, or its lease ran out) and every drive is off; a
/// participant that comes back before that is their master as before.
/// Proof: tests/unit/drive_kit/master_test.cpp, over all transitions.
class MasterPin {
 public:
  enum class State : std::uint8_t {
    kFree,    ///< nobody: drives are off, and follow no setpoint
    kPinned,  ///< the master is there
    kGone     ///< the master is gone, and drives are not off yet
  };

  /// Whether a drive_command of `sender` is obeyed. Where the drives are free, it pins its sender.
  [[nodiscard]] bool obeys(const Master& sender) noexcept {
    if (sender.participant == 0 || sender.service_id == 0) return false;
    if (state_ == State::kFree) master_ = sender;
    if (sender != master_) return false;
    state_ = State::kPinned;
    return true;
  }
  /// Whether setpoints of that participant are the master's.
  [[nodiscard]] bool is_master(std::uint64_t participant) const noexcept {
    return state_ != State::kFree && participant == master_.participant;
  }
  /// Once a period: whether DDS still knows the master, and whether every drive is off.
  void work(bool is_master_there, bool are_drives_off) noexcept {
    if (state_ == State::kFree) return;
    if (is_master_there) {
      state_ = State::kPinned;
    } else if (!are_drives_off) {
      state_ = State::kGone;
    } else {
      state_ = State::kFree;
      master_ = {};
    }
  }

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] const Master& master() const noexcept { return master_; }  ///< kFree: nobody

 private:
  State state_ = State::kFree;
  Master master_;
};

/// Why something that was sent to the drives changes nothing.
enum class Drop : std::uint8_t {
  kNone,             ///< it was taken
  kNoMaster,         ///< a setpoint before the first drive_command
  kForeignCommand,   ///< drive_command of somebody who is not the master
  kForeignSetpoint,  ///< setpoint of somebody who is not the master
  kChecksum,         ///< setpoint that was corrupted, or made for another service
  kOutOfOrder,       ///< setpoint that is not newer than the last: doubled or overtaken
  kStale,            ///< setpoint that the wire held back for longer than drives bridge
  kImplausible       ///< drive_command of no service or to no drive of this machine
};
inline constexpr std::size_t kDropKinds = 8;

/// "drive commands of others" and the like, for reports.
[[nodiscard]] constexpr const char* name_of(Drop kind) noexcept {
  constexpr std::array<const char*, kDropKinds> kNames{"taken",
                                                       "setpoints without a master",
                                                       "drive commands of others",
                                                       "setpoints of others",
                                                       "setpoints with a bad checksum",
                                                       "setpoints doubled or out of order",
                                                       "setpoints that came too late",
                                                       "implausible drive commands"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// How many were dropped, by kind.
class DropCounts {
 public:
  void count(Drop kind, std::uint64_t times = 1) noexcept {
    counts_[static_cast<std::size_t>(kind)] += times;
  }
  [[nodiscard]] std::uint64_t operator[](Drop kind) const noexcept {
    return counts_[static_cast<std::size_t>(kind)];
  }

 private:
  std::array<std::uint64_t, kDropKinds> counts_{};
};

}  // namespace meridian::drive
