// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "meridian/drive.hpp"
#include "meridian/drive_csp.hpp"
#include "service/drives/kit/csp/csp_homing.hpp"
#include "service/drives/kit/csp/csp_layout.hpp"
#include "service/drives/kit/csp/csp_power.hpp"

namespace meridian::drive {
namespace {

constexpr std::uint16_t kErrorGeneric = 0x1000;        ///< CiA 402: a fault without a code
constexpr std::uint16_t kErrorCommunication = 0x7500;  ///< CiA 402: communication
constexpr int kLostFrames = 3;                         ///< that are bridged
/// 60B8h: probe 1 on, at the zero pulse, positive edge. 60B9h: its value is stored.
constexpr std::int64_t kProbeZeroPulse = 0x15;
constexpr std::uint64_t kProbeStored = 0x02;
constexpr double kLowest = std::numeric_limits<std::int32_t>::min(),
                 kHighest = std::numeric_limits<std::int32_t>::max();

[[noreturn]] void refuse(const CspSpec& spec, const std::string& why) {
  throw DriveError(spec.name + ": " + why);
}

void check(const CspSpec& spec, const CspLayout& outputs, const CspLayout& inputs) {
  constexpr std::array kOutputs{CspObject::kControlword, CspObject::kTargetPosition};
  constexpr std::array kInputs{CspObject::kStatusword, CspObject::kPosition};
  constexpr std::array kDriven{CspObject::kControlword, CspObject::kMode,
                               CspObject::kTargetPosition, CspObject::kVelocityOffset,
                               CspObject::kProbeFunction};
  for (const CspObject object : kOutputs) {
    if (outputs.find(object)) continue;
    refuse(spec, object_name(static_cast<unsigned>(object), 0) + " is missing in the outputs");
  }
  for (const CspObject object : kInputs) {
    if (inputs.find(object)) continue;
    refuse(spec, object_name(static_cast<unsigned>(object), 0) + " is missing in the inputs");
  }
  for (const CspLayout::Entry& entry : outputs.entries()) {
    const bool is_driven =
        entry.subindex == 0 && std::any_of(kDriven.begin(), kDriven.end(), [&](CspObject object) {
          return static_cast<std::uint16_t>(object) == entry.index;
        });
    if (is_driven == !entry.value) continue;
    const std::string object = object_name(entry.index, entry.subindex);
    refuse(spec, is_driven ? object + " is written by the codec and takes no value"
                           : object +
                                 " is not driven by CSP; give the value that is sent, a limit "
                                 "of 0 would stop the drive");
  }
  if (!(std::isfinite(spec.counts_per_unit) && spec.counts_per_unit != 0)) {
    refuse(spec, "counts_per_unit is no number, or 0");
  }
  if (!std::isfinite(spec.velocity_counts_per_unit)) {
    refuse(spec, "velocity_counts_per_unit is no number");
  }
  if (!(spec.farthest_step >= 0 && std::isfinite(spec.farthest_step))) {
    refuse(spec, "farthest_step is negative, or no number");
  }
  for (const double end : {spec.travel_min, spec.travel_max}) {
    const double counts = end * spec.counts_per_unit + static_cast<double>(spec.zero_counts);
    if (spec.is_endless || (counts >= kLowest && counts <= kHighest)) continue;
    refuse(spec, "travel does not fit into 32 bits of counts; lower the resolution of the drive");
  }
}

}  // namespace

struct CspDrive::Impl {
  explicit Impl(const CspSpec& asked)
      : spec(asked),
        outputs(asked.name, asked.outputs, first_index()),
        inputs(asked.name, asked.inputs, first_index()) {
    check(spec, outputs, inputs);
    if (spec.velocity_counts_per_unit == 0) spec.velocity_counts_per_unit = spec.counts_per_unit;
    reading.position = std::numeric_limits<double>::quiet_NaN();
  }

  [[nodiscard]] unsigned first_index() const {
    if (spec.axis_number < 0 || spec.axis_number > 7) {
      refuse(spec, "axis_number is " + std::to_string(spec.axis_number) + ", and must be 0 to 7");
    }
    return 0x800U * static_cast<unsigned>(spec.axis_number);
  }
  [[nodiscard]] double position_of(std::int64_t counts) const noexcept {
    return static_cast<double>(counts - hidden - spec.zero_counts) / spec.counts_per_unit;
  }
  /// Of no number: where it was led last.
  [[nodiscard]] std::int64_t counts_of(double asked) const noexcept {
    if (!std::isfinite(asked)) return target;
    constexpr double kEndless = 4e18;
    const double counts = asked * spec.counts_per_unit;
    const std::int64_t shifted =
        std::llround(std::clamp(counts, -kEndless, kEndless)) + spec.zero_counts + hidden;
    if (spec.is_endless) return shifted;
    return std::clamp(shifted, static_cast<std::int64_t>(kLowest),
                      static_cast<std::int64_t>(kHighest));
  }
  [[nodiscard]] bool shows(std::int64_t wanted,
                           std::span<const std::uint8_t> frame) const noexcept {
    return !mode_display || mode_display.get_signed(frame) == wanted;
  }
  void write(const Output& output, std::span<std::uint8_t> frame) noexcept;
  void see_position(std::span<const std::uint8_t> frame) noexcept;
  void see_homing(std::uint16_t statusword, std::span<const std::uint8_t> frame) noexcept;
  void see_probe(std::span<const std::uint8_t> frame) noexcept;

  CspSpec spec;
  CspLayout outputs, inputs;
  CspField mode = outputs.find(CspObject::kMode),
           mode_display = inputs.find(CspObject::kModeDisplay),
           position = inputs.find(CspObject::kPosition),
           velocity = inputs.find(CspObject::kVelocity),
           error_code = inputs.find(CspObject::kErrorCode),
           probe_function = outputs.find(CspObject::kProbeFunction),
           probe_status = inputs.find(CspObject::kProbeStatus),
           probe_position = inputs.find(CspObject::kProbePosition);
  CspPower power;
  CspHoming homing;
  Reading reading;          ///< the newest
  bool is_known = false;    ///< a frame came
  std::int64_t raw = 0;     ///< 6064h, past the ends of its 32 bits where it is endless
  std::int64_t step = 0;    ///< since the frame before
  std::int64_t hidden = 0;  ///< counts that a search has renamed and home() has not reported
  std::int64_t target = 0;  ///< 607Ah
  bool was_ready = false, is_rearming = true;
  int lost = 0;  ///< frames in a row
};

void CspDrive::Impl::write(const Output& output, std::span<std::uint8_t> frame) noexcept {
  std::fill(frame.begin(), frame.end(), std::uint8_t{0});
  for (const CspLayout::Entry& entry : outputs.entries()) {
    if (entry.value) entry.field.put(frame, *entry.value);
  }
  homing.want(output.is_homing && mode);
  const bool is_on = output.is_on && is_known;
  if (!is_on) was_ready = false;
  std::uint16_t controlword = power.controlword(is_on, output.is_reset);
  const bool is_following = is_on && power.is_enabled() && was_ready && !homing.is_wanted();
  target = is_following ? counts_of(output.position) : raw;
  if (power.is_enabled()) controlword |= homing.controlword_bits();
  if (!is_known) controlword = 0;
  outputs.find(CspObject::kControlword).put(frame, controlword);
  mode.put(frame, homing.is_wanted() ? kModeHoming : kModeCsp);
  outputs.find(CspObject::kTargetPosition).put(frame, target);
  const double feed_forward = output.velocity * spec.velocity_counts_per_unit;
  if (is_following && std::isfinite(feed_forward)) {
    const double counts = std::clamp(feed_forward, kLowest, kHighest);
    outputs.find(CspObject::kVelocityOffset).put(frame, std::llround(counts));
  }
  if (is_on && !is_rearming) probe_function.put(frame, kProbeZeroPulse);
}

void CspDrive::Impl::see_position(std::span<const std::uint8_t> frame) noexcept {
  const std::int64_t now = position.get_signed(frame);
  const std::int64_t before = is_known ? raw : now;
  step = spec.is_endless ? static_cast<std::int32_t>(static_cast<std::uint32_t>(now) -
                                                     static_cast<std::uint32_t>(before))
                         : now - before;
  raw = before + step;
  is_known = true;
}

void CspDrive::Impl::see_homing(std::uint16_t statusword,
                                std::span<const std::uint8_t> frame) noexcept {
  if (!homing.is_wanted()) return;
  homing.see(statusword, power.is_enabled() && shows(kModeHoming, frame));
  const double farthest = spec.farthest_step * std::abs(spec.counts_per_unit);
  const bool is_jump = farthest > 0 && std::abs(static_cast<double>(step)) > farthest;
  if (is_jump || homing.result() == HomingState::kAttained) hidden += step;
}

void CspDrive::Impl::see_probe(std::span<const std::uint8_t> frame) noexcept {
  reading.is_index = false;
  if (!probe_function || !probe_status || !probe_position) return;
  const bool is_stored = (probe_status.get(frame) & kProbeStored) != 0;
  if (is_stored && !is_rearming) {
    const std::int64_t at = probe_position.get_signed(frame);
    const auto back =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(raw) - static_cast<std::uint32_t>(at));
    reading.is_index = true;
    reading.index_position = position_of(raw - back);
  }
  is_rearming = is_stored;
}

CspDrive::CspDrive(const CspSpec& spec) : impl_(std::make_unique<Impl>(spec)) {}
CspDrive::~CspDrive() = default;
CspDrive::CspDrive(CspDrive&&) noexcept = default;
CspDrive& CspDrive::operator=(CspDrive&&) noexcept = default;

std::size_t CspDrive::output_bytes() const noexcept { return impl_->outputs.bytes(); }
std::size_t CspDrive::input_bytes() const noexcept { return impl_->inputs.bytes(); }

void CspDrive::write(const Output& output, std::span<std::uint8_t> frame) noexcept {
  if (frame.size() < output_bytes()) return;
  impl_->write(output, frame.first(output_bytes()));
}

Reading CspDrive::read(std::span<const std::uint8_t> frame) noexcept {
  Impl& my = *impl_;
  if (frame.size() < input_bytes()) {
    my.reading.is_index = false;
    if (++my.lost > kLostFrames) my.reading.error = kErrorCommunication;
    return my.reading;
  }
  my.lost = 0;
  const auto statusword =
      static_cast<std::uint16_t>(my.inputs.find(CspObject::kStatusword).get(frame));
  my.power.see(statusword);
  my.see_position(frame);
  my.see_homing(statusword, frame);
  my.see_probe(frame);
  Reading& reading = my.reading;
  reading.position = my.position_of(my.raw);
  if (my.velocity) {
    reading.velocity =
        static_cast<double>(my.velocity.get_signed(frame)) / my.spec.velocity_counts_per_unit;
  }
  reading.error = 0;
  if (my.power.is_fault()) {
    reading.error = static_cast<std::uint16_t>(my.error_code.get(frame));
    if (reading.error == 0) reading.error = kErrorGeneric;
  }
  reading.has_power = !my.power.has_dropped();
  my.was_ready = my.power.is_enabled() && (my.was_ready || my.shows(kModeCsp, frame));
  reading.is_ready = my.was_ready;
  return reading;
}

HomingStep CspDrive::home(const HomingView& view) noexcept {
  Impl& my = *impl_;
  HomingStep step{HomingState::kSearching, view.position, 0, 0};
  if (!my.mode) {
    step.state = HomingState::kFailed;  // nobody can ask the drive to search
    return step;
  }
  if (view.is_begin) my.homing.want(false);
  my.homing.pass(view.dt_s);
  step.state = my.homing.result();
  if (step.state != HomingState::kAttained) return step;
  step.shift = static_cast<double>(my.hidden) / my.spec.counts_per_unit;
  my.hidden = 0;
  return step;
}

}  // namespace meridian::drive
