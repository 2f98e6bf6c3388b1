// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/doctor/finding.hpp"

#include <algorithm>

#include "service/text/printed.hpp"

namespace meridian::probe {
namespace {

using text::append;
using text::json_quoted;

constexpr const char* kWords[] = {"fine", "note", "BAD"};

[[nodiscard]] const char* word(Health health) noexcept {
  return kWords[static_cast<std::size_t>(health)];
}

[[nodiscard]] auto count(const Findings& findings, Health health) noexcept {
  return std::count_if(findings.begin(), findings.end(),
                       [health](const Finding& one) { return one.health == health; });
}

}  // namespace

bool is_fit(const Findings& findings) noexcept { return count(findings, Health::kBad) == 0; }

std::string to_text(const Findings& findings) {
  std::string out;
  for (const Finding& one : findings) {
    append(out, "%-4s  %-22s %s\n", word(one.health), one.what.c_str(), one.found.c_str());
    if (!one.remedy.empty()) append(out, "      %-22s remedy: %s\n", "", one.remedy.c_str());
  }
  append(out, "%s: %ld bad, %ld worth a note\n",
         is_fit(findings) ? "FIT for real time" : "NOT FIT for real time",
         static_cast<long>(count(findings, Health::kBad)),
         static_cast<long>(count(findings, Health::kNote)));
  return out;
}

std::string to_json(const Findings& findings) {
  std::string out = "{\"fit\": ";
  out += is_fit(findings) ? "true" : "false";
  out += ", \"findings\": [";
  const char* separator = "";
  for (const Finding& one : findings) {
    out += separator;
    out += "\n  {\"what\": " + json_quoted(one.what) +
           ", \"health\": " + json_quoted(word(one.health)) +
           ", \"found\": " + json_quoted(one.found) + ", \"remedy\": " + json_quoted(one.remedy) +
           "}";
    separator = ",";
  }
  return out + "\n]}\n";
}

}  // namespace meridian::probe
