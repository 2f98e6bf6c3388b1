// SPDX-License-Identifier: Apache-2.0
#include "attack/samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <type_traits>

#include "attack/content.hpp"

namespace attack {
namespace {

/// Puts random bytes everywhere, a NaN here and there, and ends its texts.
template <class Sample>
void spoil(Sample& sample, std::mt19937_64& random) {
  auto* bytes = reinterpret_cast<unsigned char*>(&sample);
  constexpr std::size_t kAtOnce = 2048;  // of long texts the first part is enough
  for (std::size_t i = 0; i < std::min(sizeof sample, kAtOnce); ++i) {
    bytes[i] = static_cast<unsigned char>(random());
  }
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i + 8 <= std::min(sizeof sample, kAtOnce); i += 8) {
    if (random() % 8 == 0) std::memcpy(bytes + i, &nothing, sizeof nothing);
  }
  for_each_text(sample, [&](char* text, std::size_t size) {
    constexpr const char* kHostile[] = {"\n[error] forged line",
                                        "\x1b[2J\x1b]0;owned\x07",
                                        "%s%n",
                                        "\xff\xfe\xc0",
                                        "../../..",
                                        "*"};
    for (std::size_t i = 0; i < size; ++i) text[i] = '\0';
    std::snprintf(text, size, "%s", kHostile[random() % std::size(kHostile)]);
  });
  if constexpr (std::is_same_v<Sample, meridian_wire_Command>) {
    // Whoever stops the machine is obeyed, whatever else he says.
    constexpr std::uint8_t kDisable = 1, kHold = 3, kAbort = 5, kNoVerb = 200;
    const bool is_stop = sample.verb == kDisable || sample.verb == kHold || sample.verb == kAbort;
    if (is_stop) sample.verb = kNoVerb;
  }
  if constexpr (std::is_same_v<Sample, meridian_wire_ClBatch>) {
    if (random() % 2 == 0) sample.count %= 64;
  }
}

template <class Sample>
void make(Sample& sample, Shape shape, const Words& words, std::mt19937_64& random) {
  if (shape == Shape::kMalformed || shape == Shape::kForeign) return spoil(sample, random);
  sample = Sample{};
  fill(sample, words);
}

template <class Sample>
void take_newest(dds_entity_t reader, Sample& newest, bool (*is_wanted)(const Sample&) = nullptr) {
  static Sample sample;
  void* samples[1] = {&sample};
  dds_sample_info_t info;
  while (dds_take(reader, samples, &info, 1, 1) == 1) {
    if (info.valid_data && (is_wanted == nullptr || is_wanted(sample))) newest = sample;
  }
}

}  // namespace

Shape shape_named(std::string_view name) {
  if (name == "well") return Shape::kWell;
  if (name == "malformed") return Shape::kMalformed;
  if (name == "forged") return Shape::kForged;
  if (name == "foreign") return Shape::kForeign;
  std::fprintf(stderr, "attacker: no shape %s\n", std::string(name).c_str());
  std::exit(2);
}

Ears::Ears(const Wire& wire) {
  const auto hear = [&wire](const char* name) {
    return wire.reader(topic_named(name), {.depth = 64});
  };
  readers_ = {hear("status"),   hear("machine"), hear("setpoint"), hear("drive_command"),
              hear("feedback"), hear("command"), hear("reply"),    hear("cl_credit"),
              hear("action"),   hear("jog")};
}

void Ears::listen() {
  const auto is_honest = [this](std::uint64_t id) {
    return heard_.status.service_id == 0 || heard_.status.service_id == id;
  };
  meridian_wire_Status status{};
  take_newest(readers_.status, status);
  if (status.service_id != 0 && is_honest(status.service_id)) heard_.status = status;
  take_newest(readers_.machine, heard_.machine);
  meridian_wire_Setpoint setpoint{};
  take_newest<meridian_wire_Setpoint>(readers_.setpoint, setpoint,
                                      [](const auto& one) { return one.cycle < kMark; });
  if (setpoint.cycle != 0) heard_.setpoint = setpoint;
  meridian_wire_DriveCommand word{};
  take_newest(readers_.drive_command, word);
  if (word.service_id != 0 && is_honest(word.service_id)) heard_.drive_command = word;
  take_newest(readers_.feedback, heard_.feedback);
  // What a forger says in an operator's name is no news to him.
  take_newest<meridian_wire_Command>(readers_.command, heard_.command, [](const auto& one) {
    return !is_own(one.operator_id) && std::string_view(one.operator_name) != kOwnName;
  });
  take_newest<meridian_wire_Reply>(readers_.reply, heard_.reply,
                                   [](const auto& one) { return !is_own(one.operator_id); });
  take_newest(readers_.credit, heard_.credit);
  take_newest(readers_.action, heard_.action);
  take_newest<meridian_wire_Jog>(readers_.jog, heard_.jog,
                                 [](const auto& one) { return !is_own(one.operator_id); });
}

bool Ears::waits_for_status(std::int64_t patience_ns) {
  const std::int64_t end_ns = monotonic_ns() + patience_ns;
  while (heard_.status.service_id == 0 && monotonic_ns() < end_ns) {
    listen();
    sleep_ns(2'000'000);
  }
  return heard_.status.service_id != 0;
}

Maker::Maker(const Topic& topic, Shape shape, std::uint64_t seed, int asked)
    : topic_(topic),
      shape_(shape),
      random_(seed),
      asked_(asked),
      own_id_(kOwnIds | (seed & 0xffffU)),
      memory_(new std::max_align_t[topic.size / sizeof(std::max_align_t) + 1]()) {}

const void* Maker::next(const Heard& heard) {
  const Words words{heard, shape_ == Shape::kForged, ++number_, own_id_, asked_, random_()};
  void* sample = memory_.get();
  const std::string_view name = topic_.name;
  const auto as = [&]<class Sample>(Sample*) {
    make(*static_cast<Sample*>(sample), shape_, words, random_);
  };
  if (name == "cl_batch") as(static_cast<meridian_wire_ClBatch*>(nullptr));
  if (name == "cl_session") as(static_cast<meridian_wire_ClSession*>(nullptr));
  if (name == "cl_credit") as(static_cast<meridian_wire_ClCredit*>(nullptr));
  if (name == "command") as(static_cast<meridian_wire_Command*>(nullptr));
  if (name == "reply") as(static_cast<meridian_wire_Reply*>(nullptr));
  if (name == "jog") as(static_cast<meridian_wire_Jog*>(nullptr));
  if (name == "enabling") as(static_cast<meridian_wire_Enabling*>(nullptr));
  if (name == "setpoint") as(static_cast<meridian_wire_Setpoint*>(nullptr));
  if (name == "drive_command") as(static_cast<meridian_wire_DriveCommand*>(nullptr));
  if (name == "feedback") as(static_cast<meridian_wire_Feedback*>(nullptr));
  if (name == "action") as(static_cast<meridian_wire_Action*>(nullptr));
  if (name == "action_done") as(static_cast<meridian_wire_ActionDone*>(nullptr));
  if (name == "status") as(static_cast<meridian_wire_Status*>(nullptr));
  if (name == "machine") as(static_cast<meridian_wire_Machine*>(nullptr));
  if (name == "latency") as(static_cast<meridian_wire_Latency*>(nullptr));
  return sample;
}

}  // namespace attack
