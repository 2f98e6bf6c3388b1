// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "meridian/cycle/drive_state.hpp"
#include "meridian/kinematics/joints.hpp"

namespace meridian::drive {

/// Reports when a drive has changed its state: "drive X: fault (error 8700h)".
class StateReport {
 public:
  using Report = std::function<void(const std::string&)>;
  /// `report` outlives this.
  StateReport(std::vector<std::string> names, const Report& report)
      : names_(std::move(names)), report_(report) {
    seen_.fill(DriveState::kSwitchOnDisabled);
  }

  /// Drive `index` of the names is in `state` with object 603Fh `error`.
  void look(std::size_t index, DriveState state, std::uint16_t error) {
    if (std::exchange(seen_[index], state) == state) return;
    char words[32] = "";
    if (error != 0) std::snprintf(words, sizeof words, " (error %04Xh)", error);
    report_("drive " + names_[index] + ": " + name_of(state) + words);
  }

 private:
  std::vector<std::string> names_;
  const Report& report_;
  std::array<DriveState, kMaxJoints> seen_;
};

}  // namespace meridian::drive
