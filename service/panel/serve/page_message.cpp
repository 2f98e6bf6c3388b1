// SPDX-License-Identifier: Apache-2.0
#include "service/panel/serve/page_message.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "meridian/cycle/jog/jog_tool.hpp"
#include "meridian/cycle/state_table.hpp"
#include "service/text/number.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

/// Beyond these a number is no velocity, distance or override of any machine.
constexpr double kMaxValue = 1e6;
constexpr std::uint64_t kMaxLine = 1ULL << 31U;
constexpr std::uint64_t kMaxId = 1ULL << 53U;

[[nodiscard]] std::optional<double> find_number(const json& from, const char* name) {
  const auto at = from.find(name);
  if (at == from.end() || !at->is_number()) return std::nullopt;
  const double value = at->get<double>();
  if (!(std::abs(value) <= kMaxValue)) return std::nullopt;
  return value;
}

[[nodiscard]] std::optional<std::uint64_t> find_count(const json& from, const char* name) {
  const auto at = from.find(name);
  if (at == from.end() || !at->is_number_unsigned()) return std::nullopt;
  const auto value = at->get<std::uint64_t>();
  return value <= kMaxId ? std::optional(value) : std::nullopt;
}

[[nodiscard]] std::optional<Verb> find_verb(const std::string& name) {
  for (int i = 0; i < kVerbCount; ++i) {
    const auto verb = static_cast<Verb>(i);
    if (name == name_of(verb) && verb != Verb::kJog) return verb;
  }
  return std::nullopt;
}

/// A number of 64 bits, which a page has as text.
[[nodiscard]] std::optional<std::uint64_t> find_long(const json& from, const char* name) {
  const auto at = from.find(name);
  if (at == from.end() || !at->is_string()) return std::nullopt;
  std::uint64_t value = 0;
  const bool is_number = text::read_number(at->get_ref<const std::string&>(), value);
  return is_number ? std::optional(value) : std::nullopt;
}

[[nodiscard]] std::optional<stream::Seen> find_seen(const json& from) {
  const auto at = from.find("seen");
  if (at == from.end() || !at->is_object()) return std::nullopt;
  const auto epoch = find_count(*at, "epoch"), sequence = find_count(*at, "sequence");
  const auto service = find_long(*at, "service");
  constexpr std::uint64_t kMaxEpoch = 65535;
  if (!epoch || *epoch > kMaxEpoch || !sequence) return std::nullopt;
  if (!service) return std::nullopt;
  return stream::Seen{.service_id = *service,
                      .epoch = static_cast<std::uint16_t>(*epoch),
                      .status_sequence = *sequence};
}

[[nodiscard]] std::optional<stream::JogPlan> find_plan(const json& from) {
  const auto joint = find_count(from, "joint");
  const auto velocity = find_number(from, "velocity"), distance = find_number(from, "distance");
  const auto is_tool = from.find("tool");
  if (!joint || !velocity || !distance || *distance < 0) return std::nullopt;
  if (is_tool == from.end() || !is_tool->is_boolean()) return std::nullopt;
  stream::JogPlan plan;
  plan.is_tool = is_tool->get<bool>();
  const int count = plan.is_tool ? kToolAxisCount : kMaxJoints;
  if (*joint >= static_cast<std::uint64_t>(count)) return std::nullopt;
  plan.joint = static_cast<int>(*joint);
  plan.velocity = *velocity;
  plan.distance = *distance;
  plan.time_s = *distance > 0 ? 0 : 1e9;
  return plan;
}

/// What moves nothing and therefore quotes nothing.
[[nodiscard]] std::optional<PageMessage::Kind> find_plain(const std::string& word) {
  using Kind = PageMessage::Kind;
  constexpr std::array<std::pair<const char*, Kind>, 6> kPlain{{{"release", Kind::kRelease},
                                                                {"take_over", Kind::kTakeOver},
                                                                {"check", Kind::kCheck},
                                                                {"load", Kind::kLoad},
                                                                {"unload", Kind::kUnload},
                                                                {"answer", Kind::kAnswer}}};
  for (const auto& [name, kind] : kPlain) {
    if (word == name) return kind;
  }
  return std::nullopt;
}

[[nodiscard]] std::optional<PageMessage> read_plain(const json& from, PageMessage message) {
  if (message.kind == PageMessage::Kind::kCheck) {
    const auto line = find_count(from, "line");
    if (!line || *line > kMaxLine) return std::nullopt;
    message.line = static_cast<std::uint32_t>(*line);
  }
  if (message.kind == PageMessage::Kind::kAnswer) {
    const auto action = find_long(from, "action");
    const auto done = from.find("done");
    if (!action || done == from.end() || !done->is_boolean()) return std::nullopt;
    message.action = *action;
    message.is_done = done->get<bool>();
  }
  return message;
}

}  // namespace

std::optional<PageMessage> read_page_message(std::string_view text) {
  const json from = json::parse(text, nullptr, false);
  if (!from.is_object()) return std::nullopt;
  PageMessage message;
  const auto kind = from.find("do");
  const auto id = find_count(from, "id");
  if (kind == from.end() || !kind->is_string() || !id) return std::nullopt;
  message.id = *id;
  const auto& word = kind->get_ref<const std::string&>();
  if (const auto plain = find_plain(word)) {
    message.kind = *plain;
    return read_plain(from, message);
  }
  const auto seen = find_seen(from);
  if (!seen) return std::nullopt;
  message.seen = *seen;
  if (word == "jog") {
    const auto plan = find_plan(from);
    if (!plan) return std::nullopt;
    message.kind = PageMessage::Kind::kJog;
    message.plan = *plan;
    message.plan.seen = seen;
    return message;
  }
  const auto verb = find_verb(word);
  const auto argument = find_number(from, "argument");
  if (!verb || !argument) return std::nullopt;
  message.verb = *verb;
  message.argument = *argument;
  return message;
}

}  // namespace meridian::panel
