// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "integration/set_up_plant.hpp"

namespace meridian::test {

/// Three operators, who ask for a work frame, a tool table and soft limits. Done, they change
/// nothing that moves: a row that is not in force, `tools` as they are, and travel that no test
/// needs. Failures are those of GoogleTest.
class SetUpWords {
 public:
  SetUpWords(Plant& plant, std::string tools)
      : plant_(plant),
        tools_(std::move(tools)),
        anna_(plant, 101),
        bert_(plant, 102),
        carl_(plant, 103) {}

  /// In Off or Ready, one after the other: all are accepted, and published.
  void expect_accepted();
  /// At any other moment, all at once: each is refused for what the machine does, nothing changes.
  void expect_refused();

 private:
  [[nodiscard]] static FrameOrder frame() { return order_of(FrameWord::kSet, 7, 12.5, "fault"); }
  [[nodiscard]] static LimitsOrder limits() { return {LimitsWord::kSet, 0, -599, 599}; }

  Plant& plant_;
  std::string tools_;
  SetUpOperator anna_, bert_, carl_;
};

}  // namespace meridian::test
