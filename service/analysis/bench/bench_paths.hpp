// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/path/cl_block.hpp"

/// Tool paths on which five-axis interpolators are compared: short, closed in form, each hard in
/// its own way.
///
///     fan               100 mm straight, the axis sweeps ±30° in its plane, through the pole
///     near_pole         60 mm straight, tilt 15° → 0.1° → 15° while the azimuth turns by 170°
///     near_pole_coarse  the same in 7 points
///     near_pole_rim     the same 350 mm off the C axis, where a turn of C costs the slides dearly
///     dome              spiral on a cap of 60 mm radius, tilt 1..45° along the normal, 5001 points
///     blade             10 zigzag passes along a flank, tilt ±40°, sharp corners
namespace meridian::bench {

inline constexpr double kFeed_mm_per_s = 50;

[[nodiscard]] std::vector<std::string> path_names();

/// The cuts of path `name`, at the feed; empty where there is none of that name. Frame: W.
[[nodiscard]] std::vector<ClBlock> path(std::string_view name, double feed_mm_per_s);

/// The path as a CL file: six decimals of a millimetre, nine of an axis, as a CAM system writes.
/// Proof: tests/unit/bench/bench_test.cpp, tests/corpus/bench_paths_test.cpp.
[[nodiscard]] std::string path_file(std::string_view name, double feed_mm_per_s);

}  // namespace meridian::bench
