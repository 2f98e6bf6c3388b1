// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/findings.hpp"

#include <algorithm>

#include "service/text/printable.hpp"
#include "service/text/printed.hpp"

namespace meridian::cl {
namespace {

/// The message with every number as one sign: what two alike messages have in common.
std::string without_numbers(const std::string& message) {
  std::string out;
  for (const char c : message) {
    const bool is_digit = (c >= '0' && c <= '9') || c == '.' || c == '-';
    if (!is_digit) out.push_back(c);
    if (is_digit && (out.empty() || out.back() != '#')) out.push_back('#');
  }
  return out;
}

}  // namespace

void Findings::add(const ClError& error) {
  ++refusals_;
  const std::string group = error.group.empty() ? without_numbers(error.message) : error.group;
  const auto at = std::find(groups_.begin(), groups_.end(), group);
  if (at != groups_.end()) {
    Finding& finding = findings_[static_cast<std::size_t>(at - groups_.begin())];
    ++finding.count;
    return;
  }
  if (findings_.size() == kMaxKinds) return;
  groups_.push_back(group);
  findings_.push_back({Finding::Severity::kRefusal, error.line, error.message, error.remedy, 1});
}

void Findings::add(const ClWarning& warning) {
  if (findings_.size() == kMaxKinds) return;
  groups_.emplace_back();
  findings_.push_back(
      {Finding::Severity::kWarning, warning.line, warning.message, {}, warning.count});
}

std::vector<Finding> Findings::sorted() const {
  std::vector<Finding> out = findings_;
  std::stable_sort(out.begin(), out.end(), [](const Finding& a, const Finding& b) {
    return a.line != b.line ? a.line < b.line : a.severity < b.severity;
  });
  return out;
}

std::string to_text(const std::vector<Finding>& findings, const std::string& file) {
  std::string out;
  for (const Finding& f : findings) {
    std::string line = file;
    if (f.line > 0) text::append(line, ":%u", f.line);
    line += f.severity == Finding::Severity::kWarning ? ": warning: " : ": ";
    line += f.message;
    if (f.count > 1) text::append(line, " (%llu places, first here)", text::Count{f.count});
    if (!f.remedy.empty()) line += "; " + f.remedy;
    out += text::printable(line) + "\n";
  }
  return out;
}

std::string to_json(const std::vector<Finding>& findings) {
  std::string out = "[";
  for (const Finding& f : findings) {
    text::append(out,
                 "%s\n  {\"line\": %u, \"severity\": \"%s\", \"count\": %llu, \"message\": %s, ",
                 out.size() > 1 ? "," : "", f.line,
                 f.severity == Finding::Severity::kWarning ? "warning" : "refusal",
                 text::Count{f.count}, text::json_quoted(f.message).c_str());
    text::append(out, "\"remedy\": %s}", text::json_quoted(f.remedy).c_str());
  }
  return out + (findings.empty() ? "]" : "\n]");
}

}  // namespace meridian::cl
