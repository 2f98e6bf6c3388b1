// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "meridian/kinematics/machine_model.hpp"

namespace meridian::soak {

/// Writes a five-axis program near home that the machine can cut: every joint swings at a pace of
/// its own, at most 12 mm or 6 degrees, over a drawn number of blocks (20 to 80) at a drawn feed;
/// a rapid and a dwell between. The same seed gives the same bytes.
void write_sample_program(const MachineModel& model, std::uint64_t seed,
                          const std::filesystem::path& file);

}  // namespace meridian::soak
