// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "service/transport/participant.hpp"

namespace meridian::drive {

/// Somebody who reports drives.
struct OtherSource {
  std::uint32_t group = 0, joint_mask = 0;
  std::string name;  ///< where it runs: dds::describe_source()
};

/// Listens for so long whether somebody reports a drive of `joint_mask`. Nothing: nobody, or this
/// identity may not read feedback, and cannot know.
[[nodiscard]] std::optional<OtherSource> find_other_source(dds::Participant& participant,
                                                           std::uint32_t joint_mask,
                                                           std::chrono::milliseconds window);

}  // namespace meridian::drive
