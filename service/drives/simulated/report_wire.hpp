// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "service/transport/convert/messages.hpp"

namespace meridian::drives {

/// What is wrong with the wire on which reports go: it brings them late, twice, or in another
/// order. Heap calls only while it does. Proof: tests/unit/simulated_drives/report_wire_test.cpp.
class ReportWire {
 public:
  /// Reports arrive so many periods late from now on.
  void delay(double periods) noexcept { delay_periods_ = static_cast<std::int64_t>(periods); }
  void send_twice() noexcept { is_doubled_ = true; }
  /// Every other report is overtaken by the one behind it.
  void swap_neighbours() noexcept { is_swapped_ = true; }

  /// Periods go by.
  void work(int periods) noexcept { now_ += periods; }
  /// A report of this period sets out.
  void put(const dds::DriveFeedback& report) {
    if (is_swapped_ && !waiting_) {
      waiting_ = report;
      return;
    }
    if (is_well() && in_flight_.empty() && !direct_) {
      direct_ = report;
      return;
    }
    set_out(report);
    if (const auto overtaken = std::exchange(waiting_, std::nullopt)) set_out(*overtaken);
  }
  /// A report that arrives now; call until there is none.
  [[nodiscard]] bool arrives(dds::DriveFeedback& report) {
    if (direct_) {
      report = *std::exchange(direct_, std::nullopt);
      return true;
    }
    if (in_flight_.empty() || in_flight_.front().due > now_) return false;
    report = in_flight_.front().report;
    in_flight_.pop_front();
    return true;
  }

 private:
  struct InFlight {
    std::int64_t due;
    dds::DriveFeedback report;
  };
  [[nodiscard]] bool is_well() const noexcept {
    return delay_periods_ == 0 && !is_doubled_ && !is_swapped_;
  }
  void set_out(const dds::DriveFeedback& report) {
    for (int n = 0; n < (is_doubled_ ? 2 : 1); ++n) {
      in_flight_.push_back({now_ + delay_periods_, report});
    }
  }

  std::int64_t now_ = 0, delay_periods_ = 0;
  bool is_doubled_ = false, is_swapped_ = false;
  std::optional<dds::DriveFeedback> waiting_;  ///< for the one behind it
  std::optional<dds::DriveFeedback> direct_;   ///< arrives at once
  std::deque<InFlight> in_flight_;
};

}  // namespace meridian::drives
