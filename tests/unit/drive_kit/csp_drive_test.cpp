// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "meridian/drive.hpp"
#include "meridian/drive_csp.hpp"
#include "service/drives/kit/csp/cia402.hpp"
#include "service/drives/kit/csp/following_axis.hpp"

namespace meridian::drive {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kCounts = 1000;  // per mm

/// A drive as a fieldbus sees it: frames in, frames out, one period later. It decodes them by hand.
/// Outputs 6040h, 6060h, 607Ah; inputs 603Fh, 6041h, 6061h, 6064h.
struct BusDrive {
  DriveState state = DriveState::kSwitchOnDisabled;
  std::uint16_t controlword = 0, error = 0, bits = 0;
  std::int8_t mode = 8;
  std::int32_t position = 2000, target = 0;

  void take(const std::array<std::uint8_t, 7>& frame) {
    const auto word = static_cast<std::uint16_t>(frame[0] | frame[1] << 8);
    state = next_state(state, word, controlword);
    controlword = word;
    mode = static_cast<std::int8_t>(frame[2]);
    target = static_cast<std::int32_t>(frame[3] | frame[4] << 8 | frame[5] << 16 |
                                       static_cast<std::uint32_t>(frame[6]) << 24);
    if (state == DriveState::kOperationEnabled && mode == 8) position = target;
  }
  [[nodiscard]] std::array<std::uint8_t, 9> give() const {
    const auto word = static_cast<std::uint16_t>(statusword(state) | bits);
    const auto at = static_cast<std::uint32_t>(position);
    const auto byte = [](unsigned value) { return static_cast<std::uint8_t>(value); };
    return {byte(error), byte(error >> 8U), byte(word),      byte(word >> 8U), byte(unsigned(mode)),
            byte(at),    byte(at >> 8U),    byte(at >> 16U), byte(at >> 24U)};
  }
};

[[nodiscard]] CspSpec spec_of_bus() {
  CspSpec spec;
  spec.name = "X";
  spec.outputs = {{0x60400010, {}}, {0x60600008, {}}, {0x607A0020, {}}};
  spec.inputs = {{0x603F0010, {}}, {0x60410010, {}}, {0x60610008, {}}, {0x60640020, {}}};
  spec.counts_per_unit = kCounts;
  spec.farthest_step = 0.5;
  return spec;
}

/// An integrator's hardware: one axis of the library in front of the drive.
struct Bus : Hardware {
  CspDrive csp{spec_of_bus()};
  BusDrive drive;
  std::array<std::uint8_t, 7> out{};
  bool is_cut = false;

  Bus() { (void)read(0); }
  void write(int, const Output& output) noexcept override { csp.write(output, out); }
  void exchange(double) noexcept override {
    if (!is_cut) drive.take(out);
  }
  Reading read(int) noexcept override {
    if (is_cut) return csp.read({});
    const auto in = drive.give();
    return csp.read(in);
  }
  HomingStep home(int, const HomingView& view) noexcept override { return csp.home(view); }
};

class Csp : public testing::Test {
 protected:
  Csp() : axis_(spec(), {.method = HomingMethod::kByDrive, .is_referenced = false}, 2.0) {}
  static JointSpec spec() {
    JointSpec joint;
    joint.limits.velocity = 300;
    joint.limits.following_error = 1;
    joint.limits.fault_acceleration = 5000;
    return joint;
  }
  void period(const AxisInput& input) {
    bus_.write(0, axis_.lead(input, kPeriod_s, 0, bus_));
    bus_.exchange(kPeriod_s);
    axis_.see(bus_.read(0), kPeriod_s);
  }
  void stand(int periods) {
    for (int n = 0; n < periods; ++n) period({});
  }
  void enable() {
    for (const int word : {0x06, 0x07, 0x0F}) {
      axis_.take_controlword(static_cast<std::uint16_t>(word));
    }
    stand(6);
  }
  void setpoint(double position) {
    period({.is_new = true, .is_enabled = true, .position = position, .elapsed_s = kPeriod_s});
  }

  Bus bus_;
  FollowingAxis axis_;
};

TEST_F(Csp, EnablesWithoutAJumpAndFollows) {
  enable();
  EXPECT_EQ(bus_.drive.state, DriveState::kOperationEnabled);
  EXPECT_EQ(drive_state(axis_.statusword()), DriveState::kOperationEnabled);
  EXPECT_EQ(bus_.drive.position, 2000);
  for (int n = 0; n <= 10; ++n) setpoint(2.0 + 0.1 * n);
  EXPECT_EQ(bus_.drive.position, 3000);
  EXPECT_DOUBLE_EQ(axis_.position(), 3.0);
}

TEST_F(Csp, TheTargetStaysWithTheAxisUntilOperationIsEnabled) {
  for (const int word : {0x06, 0x07, 0x0F}) {
    axis_.take_controlword(static_cast<std::uint16_t>(word));
  }
  for (int n = 0; n < 8 && bus_.drive.state != DriveState::kOperationEnabled; ++n) {
    bus_.drive.position += 7;  // a hanging axis that sinks
    period({});
    EXPECT_NEAR(bus_.drive.target, bus_.drive.position, 7);
  }
  EXPECT_EQ(bus_.drive.state, DriveState::kOperationEnabled);
}

TEST_F(Csp, ADriveThatDropsOutIsWithoutPowerAndStaysOff) {
  enable();
  setpoint(2.0);
  bus_.drive.state = DriveState::kSwitchOnDisabled;  // safe torque off
  stand(50);
  EXPECT_EQ(axis_.state(), DriveState::kSwitchOnDisabled);
  EXPECT_NE(bus_.drive.state, DriveState::kOperationEnabled);
  enable();  // the operator
  EXPECT_EQ(bus_.drive.state, DriveState::kOperationEnabled);
}

TEST_F(Csp, AFaultOfTheDriveIsTheAxisFaultAndIsResetByTheOperator) {
  enable();
  setpoint(2.0);
  bus_.drive.state = DriveState::kFault;
  bus_.drive.error = 0x2310;
  stand(20);
  EXPECT_EQ(axis_.state(), DriveState::kFault);
  EXPECT_EQ(axis_.error(), 0x2310);
  bus_.drive.error = 0;
  axis_.take_controlword(0x00);
  axis_.take_controlword(0x80);
  stand(40);
  EXPECT_EQ(axis_.state(), DriveState::kSwitchOnDisabled);
  EXPECT_NE(bus_.drive.state, DriveState::kFault);
}

TEST_F(Csp, AFaultWithoutACodeIsAFault) {
  enable();
  bus_.drive.state = DriveState::kFault;
  stand(2);
  EXPECT_EQ(axis_.error(), 0x1000);
}

TEST_F(Csp, FramesThatDoNotComeBackAreBridgedThenAreAFault) {
  enable();
  setpoint(2.0);
  bus_.is_cut = true;
  for (int n = 0; n < 3; ++n) setpoint(2.0);
  EXPECT_EQ(axis_.error(), 0);
  setpoint(2.0);
  EXPECT_EQ(axis_.error(), 0x7500);
}

TEST_F(Csp, ASearchOfTheDriveRenamesWithoutAJump) {
  enable();
  axis_.take_controlword(0x0F, 6);
  axis_.take_controlword(0x1F, 6);
  bus_.drive.bits = 0x1400;  // the result of a search before
  stand(3);
  EXPECT_EQ(bus_.drive.mode, 6);
  EXPECT_EQ(bus_.drive.controlword, 0x1F);
  bus_.drive.bits = 0;
  for (int n = 0; n < 100; ++n) {
    bus_.drive.position -= 20;
    period({});
    ASSERT_EQ(axis_.state(), DriveState::kOperationEnabled)
        << n << " " << std::hex << axis_.error();
  }
  EXPECT_DOUBLE_EQ(axis_.position(), 0.0);
  bus_.drive.position = 50'000;  // its reference is called 50 mm, before it says so
  stand(2);
  EXPECT_DOUBLE_EQ(axis_.position(), 0.0);
  bus_.drive.bits = 0x1400;
  stand(2);
  EXPECT_TRUE(axis_.is_referenced());
  EXPECT_DOUBLE_EQ(axis_.position(), 50.0);
  EXPECT_EQ(axis_.state(), DriveState::kOperationEnabled);
  axis_.take_controlword(0x0F, 8);
  bus_.drive.bits = 0;
  stand(2);
  setpoint(50.1);
  EXPECT_EQ(bus_.drive.position, 50'100);
}

TEST_F(Csp, ASearchThatFailsIsNoReference) {
  enable();
  axis_.take_controlword(0x0F, 6);
  axis_.take_controlword(0x1F, 6);
  stand(3);
  bus_.drive.bits = 0x2400;
  stand(2);
  EXPECT_FALSE(axis_.is_referenced());
  EXPECT_NE(axis_.statusword() & kStatusHomingError, 0);
}

TEST(CspDrive, SaysNothingBeforeItKnowsWhereTheAxisIs) {
  CspDrive drive(spec_of_bus());
  std::array<std::uint8_t, 7> out{};
  drive.write({.is_on = true, .position = 3}, out);
  EXPECT_EQ(out[0], 0) << "disable voltage";
  EXPECT_TRUE(std::isnan(drive.read({}).position));
}

TEST(CspDrive, AnEndlessAxisGoesOnWhereItsCountsGoRound) {
  CspSpec spec = spec_of_bus();
  spec.is_endless = true;
  CspDrive drive(spec);
  BusDrive bus;
  bus.position = std::numeric_limits<std::int32_t>::max() - 4;
  bus.state = DriveState::kOperationEnabled;
  std::array<std::uint8_t, 7> out{};
  const double begin = drive.read(bus.give()).position;
  drive.write({.is_on = true, .position = begin}, out);
  (void)drive.read(bus.give());
  drive.write({.is_on = true, .position = begin + 0.010}, out);
  bus.take(out);
  EXPECT_LT(bus.position, 0);
  EXPECT_NEAR(drive.read(bus.give()).position, begin + 0.010, 1e-9);
}

TEST(CspDrive, ATargetBeyondTheCountsOrNoNumberNeverWraps) {
  CspDrive drive(spec_of_bus());
  BusDrive bus;
  bus.state = DriveState::kOperationEnabled;
  std::array<std::uint8_t, 7> out{};
  (void)drive.read(bus.give());
  drive.write({.is_on = true, .position = 2}, out);
  (void)drive.read(bus.give());
  drive.write({.is_on = true, .position = 1e9}, out);
  bus.take(out);
  EXPECT_EQ(bus.target, std::numeric_limits<std::int32_t>::max());
  drive.write({.is_on = true, .position = -1e300}, out);
  bus.take(out);
  EXPECT_EQ(bus.target, std::numeric_limits<std::int32_t>::min());
  drive.write({.is_on = true, .position = std::nan("")}, out);
  bus.take(out);
  EXPECT_EQ(bus.target, std::numeric_limits<std::int32_t>::min()) << "where it was led last";
}

[[nodiscard]] std::string refusal(const CspSpec& spec) {
  try {
    const CspDrive drive(spec);
  } catch (const DriveError& error) {
    return error.what();
  }
  return "";
}

TEST(CspDrive, RefusesAMappingThatCspCannotUse) {
  CspSpec spec = spec_of_bus();
  spec.outputs.pop_back();
  EXPECT_EQ(refusal(spec), "X: 607Ah:00 is missing in the outputs");
  spec = spec_of_bus();
  spec.inputs.pop_back();
  EXPECT_EQ(refusal(spec), "X: 6064h:00 is missing in the inputs");
  spec = spec_of_bus();
  spec.outputs.push_back({0x60720010, {}});
  EXPECT_NE(refusal(spec).find("6072h:00 is not driven by CSP; give the value"), std::string::npos);
  spec = spec_of_bus();
  spec.outputs[0].value = 0x0F;
  EXPECT_NE(refusal(spec).find("takes no value"), std::string::npos);
  spec = spec_of_bus();
  spec.counts_per_unit = 0;
  EXPECT_NE(refusal(spec).find("counts_per_unit"), std::string::npos);
  spec = spec_of_bus();
  spec.travel_max = 2.2e6;
  EXPECT_NE(refusal(spec).find("does not fit into 32 bits"), std::string::npos);
  spec = spec_of_bus();
  spec.axis_number = 8;
  EXPECT_NE(refusal(spec).find("axis_number is 8"), std::string::npos);
}

}  // namespace
}  // namespace meridian::drive
