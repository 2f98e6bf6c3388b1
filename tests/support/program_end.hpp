// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "meridian/path/cl_block.hpp"

namespace meridian::test {

/// Puts the block behind the last that ends a program.
inline void end_program(std::vector<ClBlock>& blocks) {
  ClBlock end;
  end.kind = BlockKind::kEnd;
  end.sequence = blocks.size();
  end.line = 10 * static_cast<std::uint32_t>(end.sequence) + 7;
  blocks.push_back(end);
}

/// Numbers blocks in their order, and ends their program.
inline void number_and_end(std::vector<ClBlock>& blocks) {
  for (std::size_t n = 0; n < blocks.size(); ++n) blocks[n].sequence = n;
  end_program(blocks);
}

}  // namespace meridian::test
