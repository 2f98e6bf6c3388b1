// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "meridian/path/cl_block.hpp"

namespace meridian::cl {

/// What the blocks in front of a line leave behind, for a program that begins in its middle: tool,
/// spindle, coolant, and where the tool stands. Vendor words mean what their machine makes of them:
/// they are counted, not repeated. Proof: tests/unit/cl/restart_test.cpp.
class Restart {
 public:
  /// A block that is left out.
  void pass(const ClBlock& block);

  /// The blocks that bring the machine to where it would be: tool, spindle and coolant as far as
  /// they are on, then a rapid to where the block before ended, which the service approaches.
  [[nodiscard]] std::vector<ClBlock> state() const;

  [[nodiscard]] std::uint64_t blocks() const noexcept { return blocks_; }
  /// Line of the first vendor word that was left out; 0: there was none.
  [[nodiscard]] std::uint32_t vendor_line() const noexcept { return vendor_line_; }

 private:
  void pass_action(const ClBlock& block);

  std::uint64_t blocks_ = 0;
  std::uint32_t vendor_line_ = 0;
  std::optional<ClBlock> tool_, spindle_, at_;
  std::vector<ClBlock> coolants_;  ///< that are on, each kind once
};

}  // namespace meridian::cl
