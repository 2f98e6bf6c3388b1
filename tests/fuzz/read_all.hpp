// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/programs/cl/cl_reader.hpp"

namespace meridian::fuzz {

/// Reads to the end, past every refusal: every block that comes out has to be sound.
void read_all(cl::ClReader& reader);

}  // namespace meridian::fuzz
