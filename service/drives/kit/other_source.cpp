// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/other_source.hpp"

#include <thread>

#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/sources.hpp"

namespace meridian::drive {
namespace {

[[nodiscard]] std::optional<OtherSource> listen(dds::Participant& participant,
                                                std::uint32_t joint_mask,
                                                std::chrono::milliseconds window) {
  constexpr int kDepth = 64;  // samples of several groups do not hide one another
  dds::Reader<dds::DriveFeedback> reader(participant, {}, kDepth);
  const auto end = std::chrono::steady_clock::now() + window;
  dds::DriveFeedback sample;
  dds::SampleInfo info;
  while (std::chrono::steady_clock::now() < end) {
    while (reader.take(sample, info)) {
      if (!info.is_valid || (sample.joint_mask & joint_mask) == 0) continue;
      return OtherSource{sample.drive_group, sample.joint_mask & joint_mask,
                         dds::describe_source(participant, reader.handle(), info.source)};
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return std::nullopt;
}

}  // namespace

std::optional<OtherSource> find_other_source(dds::Participant& participant,
                                             std::uint32_t joint_mask,
                                             std::chrono::milliseconds window) {
  try {
    return listen(participant, joint_mask, window);
  } catch (const dds::DdsError&) {
    return std::nullopt;
  }
}

}  // namespace meridian::drive
