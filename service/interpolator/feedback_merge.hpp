// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "meridian/rt/cycle_data.hpp"
#include "service/dds/messages.hpp"
#include "service/dds/reader.hpp"
#include "service/interpolator/ports.hpp"

namespace meridian::interpolator {

/// Makes one picture of what drive groups say. A sample counts only if its sequence is newer than
/// the last of its group and writer: late and repeated samples never look fresh. The picture is as
/// old as its oldest group. A joint that two groups claim belongs to the group that spoke last.
/// Proof: tests/unit/interpolator/feedback_merge_test.cpp.
class FeedbackMerge {
 public:
  /// Takes one sample; false if it is not newer or its mask is absurd, and nothing changed.
  bool take(const dds::DriveFeedback& sample, std::uint64_t source, std::int64_t now_ns) noexcept;

  [[nodiscard]] const Feedback& feedback() const noexcept { return feedback_; }
  [[nodiscard]] const DriveWords& words() const noexcept { return words_; }

 private:
  struct Group {
    std::uint32_t id = 0;
    std::uint64_t source = 0;  ///< 0: place is free
    std::uint64_t sample = 0;
    std::uint64_t cycle_seen = 0;
    std::int64_t arrival_ns = 0;
    std::uint32_t joint_mask = 0;
    bool is_emergency_stop = false;
  };

  [[nodiscard]] Group* find_group(std::uint32_t id) noexcept;
  void merge() noexcept;

  std::array<Group, kMaxJoints> groups_{};
  Feedback feedback_;
  DriveWords words_;
};

/// Listens to the drives on Cyclone's receive thread and puts their newest picture into the ports.
class FeedbackListener {
 public:
  FeedbackListener(dds::Participant& participant, Ports& ports);

 private:
  void on_data(dds::Reader<dds::DriveFeedback>& reader) noexcept;
  void report(std::int64_t now_ns) noexcept;
  void time_round_trip(std::uint64_t cycle, std::int64_t now_ns) noexcept;

  Ports& ports_;
  FeedbackMerge merge_;
  std::uint64_t answered_ = 0;  ///< newest cycle that a drive has answered
  trace::SpanWriter spans_;
  dds::Reader<dds::DriveFeedback> reader_;
};

}  // namespace meridian::interpolator
