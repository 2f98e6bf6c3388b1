// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/expected.hpp"
#include "service/programs/post/post_options.hpp"

namespace meridian::post {

/// The name that a robot's program has on its controller: `program_name` where it keeps the rules
/// of the language, refused where it does not; else made from the CL file's name `source`, so that
/// it does. A letter first, then letters, digits and underscores: 24 characters in KRL, 32 in RAPID
/// and URScript, 36 capitals in LS (8 where it is made, which older controllers take), and no word
/// of the language. Source: docs/postprocessor.md.
[[nodiscard]] Expected<std::string, PostError> robot_name(const PostOptions& options,
                                                          const std::string& source);

}  // namespace meridian::post
