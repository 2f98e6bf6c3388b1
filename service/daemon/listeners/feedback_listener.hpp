// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "meridian/cycle/latest_value.hpp"
#include "meridian/cycle/spsc_ring.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/daemon/listeners/feedback_merge.hpp"
#include "service/daemon/listeners/source_reporter.hpp"
#include "service/daemon/ports/ports.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"

namespace meridian::interpolator {

/// Listens to the drives on Cyclone's receive thread and puts their newest picture into the ports.
/// Proof: tests/integration/sources_test.cpp.
class FeedbackListener {
 public:
  FeedbackListener(dds::Participant& participant, const MachineModel& model,
                   std::uint64_t service_id, Ports& ports);

  /// Says who reports drives, who went, who reports what is another one's, and whose drives obey
  /// another service; to be called several times a second, by one thread that may log.
  void report_sources(const SourceReporter::Say& say);
  /// The service that the machine's drives obey, as of the last report_sources(): ours as soon as
  /// one of them does; 0: nobody, or they do not agree.
  [[nodiscard]] std::uint64_t master() const noexcept { return master_; }

 private:
  void on_data(dds::Reader<dds::DriveFeedback>& reader) noexcept;
  void report(std::int64_t now_ns) noexcept;
  void time_round_trip(std::uint64_t cycle, std::int64_t now_ns) noexcept;

  dds::Participant& participant_;
  std::uint64_t service_id_;
  Ports& ports_;
  FeedbackMerge merge_;
  std::uint64_t answered_ = 0;  ///< newest cycle that a drive has answered
  std::int64_t shown_ns_ = 0;   ///< when `sources_` were stored last
  LatestValue<DriveSources> sources_;
  SpscRing<std::uint64_t, 64> gone_;  ///< writers that DDS does not know any more
  SourceReporter reporter_;
  std::uint64_t master_ = 0;
  trace::SpanWriter spans_;
  dds::Reader<dds::DriveFeedback> reader_;
};

}  // namespace meridian::interpolator
