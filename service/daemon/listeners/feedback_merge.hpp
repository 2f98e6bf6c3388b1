// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/cycle/cycle_data.hpp"
#include "service/daemon/ports/drive_sources.hpp"
#include "service/daemon/ports/ports.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::interpolator {

/// Makes one picture of what drive groups say. A source is a writer and the group that it writes
/// of; its sample counts only if its sequence is newer than the last one's: late and repeated
/// samples never look fresh. The picture is as old as its oldest source.
///
/// A joint is bound to the source that reported it first. It is handed over to another one that
/// reports it where the machine is Off or in Fault and the first has been silent, or does not
/// report it any more; until then what others say of it is passed over, and while both speak it is
/// contested. The stop input of every source counts, whatever else is taken from it, until DDS says
/// that its writer is gone. One that has nothing but a stop input is missed like a drive when it
/// falls silent; one whose joints this machine has not is not. The probe of every source that is
/// missed counts: it is in contact as soon as one says so.
///
/// A guard is open as soon as any source says so, whatever else is taken from it. A source that
/// once said so has a guard: where it is silent, or gone, that is open, until it speaks again or
/// another writer does for its group. Proof: tests/unit/daemon/feedback_merge_test.cpp,
/// tests/unit/daemon/feedback_guard_test.cpp.
class FeedbackMerge {
 public:
  /// Where both speak within it, sources contest a joint; who says nothing for longer is silent.
  static constexpr std::int64_t kSilence_ns = 200'000'000;

  /// `service_id`: ours, which drives are to obey; 0: whomever.
  explicit FeedbackMerge(std::uint32_t joints = (1U << kMaxJoints) - 1,
                         std::uint64_t service_id = 0) noexcept
      : joints_(joints), service_id_(service_id) {}

  /// Takes one sample; false if it is not newer or its mask is absurd, and nothing changed.
  /// `may_hand_over`: the machine is Off or in Fault.
  bool take(const dds::DriveFeedback& sample, std::uint64_t writer, std::int64_t now_ns,
            bool may_hand_over = false) noexcept;
  /// DDS says that nobody is behind `writer` any more. Where the machine is on, drives and stop
  /// inputs that it goes by stay missed.
  void forget(std::uint64_t writer, std::int64_t now_ns, bool is_off) noexcept;

  [[nodiscard]] const Feedback& feedback() const noexcept { return feedback_; }
  [[nodiscard]] const DriveWords& words() const noexcept { return words_; }
  [[nodiscard]] const DriveSources& sources() const noexcept { return sources_; }

 private:
  /// The place of this source, a free one, or one whose source is silent and takes part in nothing.
  [[nodiscard]] DriveSource* find_slot(std::uint64_t writer, std::uint32_t group,
                                       std::int64_t now_ns) noexcept;
  [[nodiscard]] DriveSource* find_lost_guard(std::int64_t now_ns) noexcept;
  void bind(DriveSource& source, std::int64_t now_ns, bool may_hand_over) noexcept;
  /// A guard of the group of `source` whose writer is silent is its from now on.
  void take_guard(DriveSource& source, std::int64_t now_ns) noexcept;
  void take_joints(const dds::DriveFeedback& sample, std::uint32_t joints) noexcept;
  void merge(std::int64_t now_ns) noexcept;
  void merge_inputs(const DriveSource& source, std::int64_t now_ns) noexcept;

  std::uint32_t joints_;  ///< of the machine
  std::uint64_t service_id_;
  DriveSources sources_;
  std::int64_t stopped_ns_ = 0;  ///< when one without a place said last that its stop input is open
  std::int64_t opened_ns_ = 0;   ///< the same of its guard
  bool is_guard_lost_ = false;   ///< one is gone that there was no place for any more
  Feedback feedback_;
  DriveWords words_;
};

}  // namespace meridian::interpolator
