// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/recovery.hpp"

#include <spdlog/fmt/fmt.h>

namespace meridian::telemetry {
namespace {

/// Whether two checksums say that what they are of differs; 0 is not known.
[[nodiscard]] bool differ(std::uint64_t a, std::uint64_t b) noexcept {
  return a != 0 && b != 0 && a != b;
}

[[nodiscard]] std::string or_none(const char* options) {
  return *options == '\0' ? "none" : std::string("'") + options + "'";
}

}  // namespace

bool is_same_program(const JournalEntry& last, const std::string& program,
                     std::uint64_t file_checksum) noexcept {
  if (last.file_checksum != 0 && file_checksum != 0) return last.file_checksum == file_checksum;
  return program == last.program.data();
}

std::string refusal_to_go_on(const JournalEntry& last, const dds::SessionRequest& request,
                             const CutSetup& setup) {
  const bool is_meant = (request.policies & dds::kPolicyChanged) != 0;
  if (request.from_line == 0 || is_meant || !is_unfinished(last)) return "";
  const char* const name = last.program.data();
  constexpr const char* kRemedy = "; go on with what was begun, or say --changed if it is meant";
  const bool has_name = request.program == name;
  if (has_name && differ(last.file_checksum, request.file_checksum)) {
    return fmt::format("{:.80} is another file than the one that is cut up to line {}{}", name,
                       last.next_line, kRemedy);
  }
  if (!is_same_program(last, request.program, request.file_checksum)) return "";
  if (request.options != last.options.data()) {
    return fmt::format("{:.40} was begun with options {:.40}, not {:.40}{}", name,
                       or_none(last.options.data()), or_none(request.options.c_str()), kRemedy);
  }
  if (differ(last.setup.frame, setup.frame)) {
    return fmt::format("the workpiece's frame is not the one in which {:.60} was begun{}", name,
                       kRemedy);
  }
  return "";
}

std::string remark_on(const JournalEntry& last, const dds::SessionRequest& request,
                      const CutSetup& setup) {
  const bool is_move = (request.policies & dds::kPolicyMove) != 0;
  if (is_move || !is_unfinished(last)) return "";
  const char* const name = last.program.data();
  const bool is_same = is_same_program(last, request.program, request.file_checksum);
  if (!is_same || request.from_line == 0) {
    return fmt::format(
        "{:.60} is not finished: its start drops that from the journal (it is gone on "
        "with by --from-line {})",
        name, last.next_line);
  }
  if (request.from_line > last.next_line) {
    return fmt::format("lines {} to {} of {:.60} are passed over, they are not cut", last.next_line,
                       request.from_line - 1, name);
  }
  if (differ(last.setup.machine, setup.machine)) {
    return fmt::format("the machine file is another one than when {:.60} was begun", name);
  }
  if (differ(last.setup.tools, setup.tools)) {
    return fmt::format("the tool table is another one than when {:.60} was begun", name);
  }
  return "";
}

}  // namespace meridian::telemetry
