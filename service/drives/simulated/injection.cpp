// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/injection.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"

namespace meridian::drives {
namespace {

using Kind = Injection::Kind;

constexpr std::array<InjectionWord, 21> kWords{{
    {Kind::kFault, "fault", true, 0, nullptr, "the drive reports a fault of its own"},
    {Kind::kBlocked, "blocked", true, 0, nullptr, "its shaft is stuck"},
    {Kind::kSilence, "silence", false, 0, nullptr, "no drive reports any more"},
    {Kind::kEmergency, "emergency", false, 0, nullptr, "the stop input opens"},
    {Kind::kDead, "dead", false, 0, nullptr, "the drives' controller hangs"},
    {Kind::kUnpowered, "unpowered", true, 0, nullptr, "the drive leaves operation without a fault"},
    {Kind::kUnreferenced, "unreferenced", true, 0, nullptr, "the drive has lost its reference"},
    {Kind::kMute, "mute", true, 0, nullptr, "the drive is missing in the reports"},
    {Kind::kFrozen, "frozen", true, 0, nullptr, "it reports the same position for ever"},
    {Kind::kNoNumber, "nan", true, 0, nullptr, "it reports a position that is no number"},
    {Kind::kSpike, "spike", true, 50, "mm or deg", "one report is off by so much"},
    {Kind::kLag, "lag", true, 500, "ms", "it follows with that time constant"},
    {Kind::kDeaf, "deaf", false, 100, "periods", "setpoints do not arrive for so long"},
    {Kind::kLate, "late", false, 100, "periods", "setpoints arrive so late from then on"},
    {Kind::kUnreported, "untold", false, 0, nullptr, "reports name no setpoint that was taken"},
    {Kind::kStale, "stale", false, 10, "periods", "reports arrive so late from then on"},
    {Kind::kDoubled, "doubled", false, 0, nullptr, "every report arrives twice"},
    {Kind::kSwapped, "swapped", false, 0, nullptr, "every other report is overtaken by the next"},
    {Kind::kGuard, "guard", false, 0, nullptr, "a guard of the work space opens"},
    {Kind::kCreep, "creep", true, 5, "mm or deg per second", "the position that it reports creeps"},
    {Kind::kMend, "mend", false, 0, nullptr, "all of that is as it was"},
}};

[[nodiscard]] bool read_number(std::string_view text, double& value) {
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && rest == text.data() + text.size() && std::isfinite(value);
}

/// Cuts what stands behind the last `mark` off `text`; empty where there is none.
[[nodiscard]] std::string_view cut_after(std::string_view& text, char mark) {
  const std::size_t at = text.rfind(mark);
  if (at == std::string_view::npos) return {};
  const std::string_view part = text.substr(at + 1);
  text = text.substr(0, at);
  return part;
}

[[nodiscard]] double inside(const InjectionWord& word, double value, const JointSpec& drive) {
  const bool is_distance = word.kind == Kind::kSpike || word.kind == Kind::kCreep;
  if (is_distance && drive.is_rotary) return units::rad_from_deg(value);
  return word.kind == Kind::kLag ? value * 1e-3 : value;
}

}  // namespace

std::span<const InjectionWord> injection_words() noexcept { return kWords; }

std::string all_injection_words() {
  std::string text;
  for (const InjectionWord& word : kWords) {
    if (!text.empty()) text.append(", ");
    text.append(word.word);
  }
  return text;
}

Expected<Injection, std::string> parse_injection(const std::string& text,
                                                 const MachineModel& model) {
  const auto refuse = [&](const std::string& why) {
    return tl::make_unexpected(std::string("'").append(text).append("': ").append(why));
  };
  std::string_view rest = text;
  const bool has_value = rest.find('=') != std::string_view::npos;
  const std::string_view value = cut_after(rest, '=');
  const bool has_drive = rest.find(':') != std::string_view::npos;
  const std::string_view name = cut_after(rest, ':');
  const bool has_time = rest.find('@') != std::string_view::npos;
  const std::string_view time = cut_after(rest, '@');
  const auto word = std::find_if(kWords.begin(), kWords.end(),
                                 [&](const auto& known) { return rest == known.word; });
  if (word == kWords.end()) return refuse("KIND is one of " + all_injection_words());

  Injection injection{word->kind, 0, 0, word->value};
  if (has_time && !(read_number(time, injection.after_s) && injection.after_s >= 0)) {
    return refuse("after @ stand seconds");
  }
  if (has_drive && !word->has_drive) return refuse(std::string(rest).append(" is of no drive"));
  while (has_drive && injection.drive < model.joint_count &&
         drive_spec(model, injection.drive).name != name) {
    ++injection.drive;
  }
  if (injection.drive == model.joint_count) {
    return refuse("machine " + model.name + " has no drive " + std::string(name));
  }
  if (has_value && word->unit == nullptr)
    return refuse(std::string(rest).append(" takes no value"));
  if (has_value && !(read_number(value, injection.value) && std::abs(injection.value) <= 1e6)) {
    return refuse(std::string("after = stand ") + word->unit);
  }
  const bool is_signed = word->kind == Kind::kSpike || word->kind == Kind::kCreep;
  if (!is_signed && injection.value < 0) return refuse("its value is not negative");
  injection.value = inside(*word, injection.value, drive_spec(model, injection.drive));
  return injection;
}

}  // namespace meridian::drives
