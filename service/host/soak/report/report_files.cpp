// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/report/report_files.hpp"

#include <utility>

#include "service/text/whole_file.hpp"

namespace meridian::soak {
namespace {

[[nodiscard]] std::filesystem::path beside(std::filesystem::path report, const char* ending) {
  return report.empty() ? report : report.replace_extension(ending);
}

[[nodiscard]] std::string refusal(const std::filesystem::path& report, const char* what) {
  return report.string() + ": is the name of " + what + " beside the report, which is JSON; take " +
         beside(report, ".json").string();
}

}  // namespace

std::filesystem::path text_beside(std::filesystem::path report) {
  return beside(std::move(report), ".txt");
}

std::filesystem::path kept_beside(std::filesystem::path report) {
  return beside(std::move(report), ".kept");
}

std::string refusal_to_report(const std::filesystem::path& report,
                              const std::vector<std::string>& read) {
  if (report.empty()) return "";
  const std::filesystem::path text_file = text_beside(report);
  if (report == text_file) return refusal(report, "the text");
  if (report == kept_beside(report)) return refusal(report, "the folder of what is kept");
  return text::refusal_to_write(read, {report.string(), text_file.string()});
}

}  // namespace meridian::soak
