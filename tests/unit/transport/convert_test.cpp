// SPDX-License-Identifier: Apache-2.0
#include "service/transport/convert/convert.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace meridian::dds {
namespace {

constexpr unsigned kSeed = 20240817;

/// Fills every byte of a wire struct, so that a field that is not converted shows.
template <class Wire>
Wire noise(unsigned seed) {
  std::mt19937 engine(seed);
  Wire wire{};
  auto* bytes = reinterpret_cast<unsigned char*>(&wire);
  for (std::size_t i = 0; i < sizeof wire; ++i) {
    // Small printable values: valid bools are mended below, doubles stay finite, texts have no end.
    bytes[i] = static_cast<unsigned char>('A' + engine() % 26);
  }
  return wire;
}

template <class Message, class Wire>
Wire there_and_back(const Wire& wire) {
  Message message;
  from_wire(wire, message);
  Wire back;
  std::memset(&back, 0, sizeof back);
  to_wire(message, back);
  return back;
}

TEST(Convert, CarriesEveryFieldOfASetpoint) {
  const auto wire = noise<meridian_wire_Setpoint>(kSeed);
  const auto back = there_and_back<SetpointSample>(wire);
  EXPECT_EQ(std::memcmp(&wire, &back, 124), 0);
}

TEST(Convert, CarriesEveryFieldOfABatch) {
  auto wire = noise<meridian_wire_ClBatch>(kSeed);
  wire.is_end = 1;
  for (auto& block : wire.blocks) block.is_arc = 1;
  const auto back = there_and_back<Batch>(wire);
  EXPECT_EQ(back.session, wire.session);
  EXPECT_EQ(back.first_sequence, wire.first_sequence);
  EXPECT_EQ(back.count, wire.count);
  EXPECT_EQ(back.is_end, 1);
  EXPECT_EQ(back.crc32c, wire.crc32c);
  EXPECT_EQ(std::memcmp(wire.blocks, back.blocks, sizeof wire.blocks), 0);
}

TEST(Convert, CarriesEveryFieldOfFeedbackAndDriveCommand) {
  auto feedback = noise<meridian_wire_Feedback>(kSeed);
  feedback.is_emergency_stop = 1;
  const auto back = there_and_back<DriveFeedback>(feedback);
  EXPECT_EQ(std::memcmp(&feedback, &back, offsetof(meridian_wire_Feedback, mode_display) + 6), 0);
  const auto command = noise<meridian_wire_DriveCommand>(kSeed);
  const auto command_back = there_and_back<DriveCommand>(command);
  EXPECT_EQ(command.drive, command_back.drive);
  EXPECT_EQ(command.controlword, command_back.controlword);
  EXPECT_EQ(command.mode, command_back.mode);
  EXPECT_EQ(command.epoch, command_back.epoch);
  EXPECT_EQ(command.service_id, command_back.service_id);
  EXPECT_EQ(command.sample, command_back.sample);
}

TEST(Convert, CarriesStopInputAndGuardInOneOctet) {
  for (const std::uint8_t octet : std::initializer_list<std::uint8_t>{0, 1, 2, 3}) {
    meridian_wire_Feedback wire{};
    wire.is_emergency_stop = octet;
    DriveFeedback feedback;
    from_wire(wire, feedback);
    EXPECT_EQ(feedback.is_emergency_stop, (octet & 1) != 0);
    EXPECT_EQ(feedback.is_guard_open, (octet & 2) != 0);
    EXPECT_EQ(there_and_back<DriveFeedback>(wire).is_emergency_stop, octet);
  }
  meridian_wire_Feedback other{};
  other.is_emergency_stop = 4;
  DriveFeedback feedback;
  from_wire(other, feedback);
  EXPECT_TRUE(feedback.is_emergency_stop) << "what is not known stops";
}

/// How many bytes of a noisy wire struct do not come back: those of flags (made 0 or 1), of text
/// ends and of padding. A field that is not carried adds its own.
template <class Message, class Wire>
int lost_bytes() {
  const auto wire = noise<Wire>(kSeed);
  const auto back = there_and_back<Message>(wire);
  const auto* before = reinterpret_cast<const unsigned char*>(&wire);
  const auto* after = reinterpret_cast<const unsigned char*>(&back);
  int lost = 0;
  for (std::size_t i = 0; i < sizeof wire; ++i) lost += before[i] != after[i] ? 1 : 0;
  return lost;
}

TEST(Convert, CarriesEveryFieldOfMessagesWithTexts) {
  EXPECT_EQ((lost_bytes<SessionRequest, meridian_wire_ClSession>()), 18);  // 15 padding, 3 texts
  EXPECT_EQ((lost_bytes<Credit, meridian_wire_ClCredit>()), 4);            // 3 padding, 1 text
  EXPECT_EQ((lost_bytes<CommandRequest, meridian_wire_Command>()), 25);    // 21 padding, 4 texts
  EXPECT_EQ((lost_bytes<Reply, meridian_wire_Reply>()), 4);            // 2 padding, 1 flag, 1 text
  EXPECT_EQ((lost_bytes<Jog, meridian_wire_Jog>()), 4);                // padding
  EXPECT_EQ((lost_bytes<Action, meridian_wire_Action>()), 4);          // 3 padding, 1 text
  EXPECT_EQ((lost_bytes<ActionDone, meridian_wire_ActionDone>()), 9);  // 7 padding, 1 flag, 1 text
  EXPECT_EQ((lost_bytes<Status, meridian_wire_Status>()), 29);  // 21 padding, 5 flags, 3 texts
  EXPECT_EQ((lost_bytes<MachineInfo, meridian_wire_Machine>()),
            615);  // 25 padding, 2 flags, 16 clamped counts, 8 texts; per joint or drive 4 padding,
                   // 2 flags, 1 text; per work frame 7 padding, 1 text; of soft limits the mask
                   // and the pairs of two joints that it leaves out; per keep-out box 4 padding,
                   // 1 text
}

TEST(Convert, CarriesTheWorkFramesThatThereAre) {
  MachineInfo info;
  info.work_frames.resize(2);
  info.work_frames[0].number = 3;
  info.work_frames[1] = {.number = 54, .name = {"vice"}, .origin_mm = {1, 2, 3}};
  static meridian_wire_Machine wire;
  to_wire(info, wire);
  MachineInfo back;
  from_wire(wire, back);
  EXPECT_EQ(back.work_frames, info.work_frames);
  wire.work_frame_count = 1000;
  from_wire(wire, back);
  EXPECT_EQ(back.work_frames.size(), std::size_t{WorkFrames::kMax});
}

TEST(Convert, CarriesTheSoftLimitsThatThereAre) {
  MachineInfo info;
  info.soft_limits.put(0, -1.5, 2);
  info.soft_limits.put(5, 0, 1.0 / 3);
  KeepOutBox box;
  box.name = {"vice"};
  box.joints = 0b101;
  box.min = {1, 0, -5};
  box.max = {1.0 / 3.0 + 1, 0, 5};
  info.soft_limits.put(box);
  info.soft_limits.put(TipBox{true, {-1, -2, -3}, {1, 2, 1.0 / 3}});
  static meridian_wire_Machine wire;
  to_wire(info, wire);
  EXPECT_EQ(wire.soft_limits_mask, 0x21U);
  MachineInfo back;
  from_wire(wire, back);
  EXPECT_EQ(back.soft_limits, info.soft_limits);
  wire.keep_out_count = 1000;
  from_wire(wire, back);
  EXPECT_EQ(back.soft_limits.keep_out().boxes().size(), std::size_t{KeepOut::kMax});
}

TEST(Convert, CutsLongTextsAndEndsEndlessOnes) {
  Credit credit;
  credit.text = std::string(1000, 'x');
  meridian_wire_ClCredit wire;
  to_wire(credit, wire);
  EXPECT_EQ(std::strlen(wire.text), 191U);
  Credit back;
  std::memset(wire.text, 'y', sizeof wire.text);
  from_wire(wire, back);
  EXPECT_EQ(back.text, std::string(sizeof wire.text, 'y'));
}

TEST(Convert, LetsNoControlCharacterIn) {
  const char forged[] = "cam\n2026-01-01 00:00:00 info ended\x1b[2J";
  const std::string escaped = "cam\\n2026-01-01 00:00:00 info ended\\x1B[2J";
  const auto read = [&](auto wire, auto message, auto field, auto text) {
    std::strcpy(field(wire), forged);
    from_wire(wire, message);
    EXPECT_EQ(text(message), escaped);
  };
  read(
      meridian_wire_ClSession{}, SessionRequest{}, [](auto& w) { return w.station; },
      [](auto& m) { return m.station; });
  read(
      meridian_wire_ClSession{}, SessionRequest{}, [](auto& w) { return w.program; },
      [](auto& m) { return m.program; });
  read(
      meridian_wire_Command{}, CommandRequest{}, [](auto& w) { return w.operator_name; },
      [](auto& m) { return m.operator_name; });
  read(
      meridian_wire_Machine{}, MachineInfo{}, [](auto& w) { return w.name; },
      [](auto& m) { return m.name; });
  read(
      meridian_wire_ActionDone{}, ActionDone{}, [](auto& w) { return w.text; },
      [](auto& m) { return m.text; });
  read(
      meridian_wire_Status{}, Status{}, [](auto& w) { return w.message; },
      [](auto& m) { return m.message; });
  read(
      meridian_wire_ClCredit{}, Credit{}, [](auto& w) { return w.text; },
      [](auto& m) { return m.text; });
  meridian_wire_Machine machine{};
  std::strcpy(machine.machine_file, "[machine]\nname = 1\n");
  MachineInfo info;
  from_wire(machine, info);
  EXPECT_EQ(info.machine_file, "[machine]\nname = 1\n") << "a file's lines stay";
}

TEST(Convert, ReadsNoMoreOfHistogramsThanIsThere) {
  meridian_wire_Latency wire{};
  wire.count = 1;
  for (const char* text : {"", ":", "7", "7:", "7:3 x", "7:3 99999:4", "7:3 8"}) {
    std::strcpy(wire.histograms[0].buckets, text);
    Latency back;
    from_wire(wire, back);
    EXPECT_LE(back.histograms[0].histogram.count(), 3U) << text;
  }
}

TEST(Convert, KeepsLatencySnapshotsAndTheirNumberInBounds) {
  Latency latency;
  latency.histograms.resize(kMaxHistograms + 3);
  latency.histograms[1].name = "wake-up lateness";
  Histogram& sent = latency.histograms[1].histogram;
  for (std::int64_t value_ns = 1; value_ns < 30'000'000; value_ns += 1 + value_ns / 3) {
    sent.record(value_ns);
    sent.record(900);
  }
  meridian_wire_Latency wire;
  to_wire(latency, wire);
  wire.count = 1000;
  Latency back;
  from_wire(wire, back);
  ASSERT_EQ(back.histograms.size(), kMaxHistograms);
  EXPECT_EQ(back.histograms[1].name, "wake-up lateness");
  const Histogram& got = back.histograms[1].histogram;
  for (std::size_t i = 0; i < Histogram::kBuckets; ++i) EXPECT_EQ(got.bucket(i), sent.bucket(i));
  EXPECT_EQ(got.count(), sent.count());
  EXPECT_EQ(got.max_ns(), sent.max_ns());
  EXPECT_EQ(got.mean_ns(), sent.mean_ns());
}

}  // namespace
}  // namespace meridian::dds
