// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/planner/smooth_planner.hpp"
#include "service/programs/cl/cl_reader.hpp"

namespace meridian::post {

/// The blocks of a CL file one by one, with those that follow: what the service knows as well
/// before it begins. Context: I/O.
class BlocksAhead {
 public:
  static constexpr std::size_t kAhead = SmoothPlanner::kLookAhead;

  explicit BlocksAhead(cl::ClReader& reader) : reader_(reader) {}

  /// The next block; nothing behind the last one. What is wrong with the file comes in its turn,
  /// behind the blocks before it.
  [[nodiscard]] Expected<std::optional<ClBlock>, cl::ClError> next();

  /// From the block that next() gave on, at most kAhead, no farther than the next tool change:
  /// there the machine begins anew. Valid until next() is called.
  [[nodiscard]] std::span<const ClBlock> ahead() const noexcept;

 private:
  void fill();

  cl::ClReader& reader_;
  std::vector<ClBlock> blocks_;
  std::size_t at_ = 0;  ///< behind the block that next() gave
  std::optional<cl::ClError> error_;
  bool is_whole_ = false;
};

}  // namespace meridian::post
