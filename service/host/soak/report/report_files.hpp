// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// What a soak writes beside its report: FOLDER/NAME.json and
///
///     NAME.txt   the same as text
///     NAME.kept  a folder: logs, flights and recordings of what was wrong
namespace meridian::soak {

/// Of no report: nothing.
[[nodiscard]] std::filesystem::path text_beside(std::filesystem::path report);
[[nodiscard]] std::filesystem::path kept_beside(std::filesystem::path report);

/// Why a soak that reads the files `read` may not report to `report`: one of what it writes would
/// lie over another, or over what it reads. A line that names the file; empty: it may.
/// Proof: tests/unit/soak/report_files_test.cpp.
[[nodiscard]] std::string refusal_to_report(const std::filesystem::path& report,
                                            const std::vector<std::string>& read);

}  // namespace meridian::soak
