// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "read_text.hpp"

namespace meridian::cl {

inline constexpr double kTight_mm = 1e-9;

/// A block worked out by hand: R rapid, F feed (mm/min), D dwell (s), S spindle.
struct Want {
  char kind;
  Array3 tip;
  double value = 0;
};

inline void expect_blocks(const std::vector<ClBlock>& got, const std::vector<Want>& want) {
  ASSERT_EQ(got.size(), want.size());
  for (std::size_t i = 0; i < want.size(); ++i) {
    const ClBlock& b = got[i];
    const BlockKind kind = want[i].kind == 'R'   ? BlockKind::kRapid
                           : want[i].kind == 'F' ? BlockKind::kCut
                           : want[i].kind == 'D' ? BlockKind::kDwell
                                                 : BlockKind::kAuxiliary;
    EXPECT_EQ(b.kind, kind) << i;
    if (kind == BlockKind::kCut) {
      EXPECT_NEAR(b.feed * 60, want[i].value, 1e-9) << i;
    }
    if (kind == BlockKind::kDwell) {
      EXPECT_NEAR(b.value, want[i].value, 1e-12) << i;
    }
    if (!is_motion(b.kind)) continue;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(b.tip_mm[k], want[i].tip[k], kTight_mm) << i;
  }
}

/// Blocks behind those of `head`, which moves to the first position.
inline std::vector<ClBlock> holes(const std::string& body, Dialect dialect = Dialect::kUnknown) {
  ClReaderOptions options;
  if (dialect != Dialect::kUnknown) options.dialect = dialect;
  const auto read = read_body("RAPID\nGOTO/0,0,50\n" + body, options);
  EXPECT_EQ(read.error, "");
  std::vector<ClBlock> out;
  for (std::size_t i = 1; i + 1 < read.blocks.size(); ++i) out.push_back(read.blocks[i]);
  return out;
}

}  // namespace meridian::cl
