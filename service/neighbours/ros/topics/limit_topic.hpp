// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "service/neighbours/ros/cdr.hpp"
#include "service/neighbours/ros/derived_row.hpp"
#include "service/neighbours/ros/pace.hpp"
#include "service/recording/mcap/writer.hpp"

namespace meridian::ros {

/// `/limit_shares`: the largest share of every limit in the last 40 ms, so that no peak is lost and
/// a file stays small; meridian_msgs/LimitShares. Proof: tests/unit/ros/motion_file_test.cpp.
class LimitTopic {
 public:
  LimitTopic(mcap::Writer& writer, const MachineModel& model);
  /// Writes a message where it is time, and forgets the shares that are in it.
  void write(std::int64_t due_ns, DerivedRow& derived);
  /// Writes what came since the last message, in front of the end.
  void finish(std::int64_t due_ns, DerivedRow& derived);

 private:
  void put(std::int64_t due_ns, DerivedRow& derived);

  mcap::Writer& writer_;
  const MachineModel& model_;
  std::uint16_t channel_;
  Pace pace_{kScreenPeriod_ns};
  bool is_written_ = true;
  Cdr message_;
};

}  // namespace meridian::ros
