// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// Manual pages and shell completion out of the very table that reads the command line.
namespace meridian::manual {

/// A manual page (roff, section 1) of `app`, whose name on the command line is `name`
/// ("meridian stream"); `version` and `see_also` go to its foot. Hidden options are left out.
[[nodiscard]] std::string man_page(const CLI::App& app, const std::string& name,
                                   const std::string& version, const std::string& see_also);

/// Completion of bash for the program `name` with the subcommands of `app`: subcommands, options,
/// file names elsewhere.
[[nodiscard]] std::string bash_completion(const CLI::App& app, const std::string& name);

}  // namespace meridian::manual
