// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/path/cl_block.hpp"

namespace meridian::surface {

/// Names of the sample parts that this build can make.
[[nodiscard]] std::vector<std::string> sample_names();

/// Writes sample part `name` as a CL file; false where there is none of that name. The same name
/// gives the same bytes. Proof: tests/unit/surface/sample_part_test.cpp.
bool write_sample(std::string_view name, std::ostream& out);

/// What is worth knowing about it: undercut and overcut of `side-milling`; else empty.
[[nodiscard]] std::string sample_report(std::string_view name);

/// `blossom`: a rose of three petals cut into a dome of 100 mm radius, ball-end tool along the
/// normal.
///
/// With signed radius r = R cos 3φ the rose runs through its middle three times straight on, so
/// that a machine with its C axis through the dome's top turns C once slowly by half a turn while
/// the head swings through vertical to 35° either way: simultaneous five-axis motion through the
/// pole. Frame: W at the dome's top, z up. Units: mm.
[[nodiscard]] std::vector<ClBlock> blossom();

}  // namespace meridian::surface
