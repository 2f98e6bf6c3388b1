// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <memory>
#include <string>

#include "meridian/drive.h"
#include "meridian/drive.hpp"

namespace drive = meridian::drive;

namespace {

void copy_text(const std::string& text, char* to, std::size_t size) noexcept {
  if (to == nullptr || size == 0) return;
  const std::size_t length = std::min(text.size(), size - 1);
  std::memcpy(to, text.data(), length);
  to[length] = '\0';
}

[[nodiscard]] std::string text_of(const char* text) { return text != nullptr ? text : ""; }

/// C functions as motors.
class CHardware : public drive::Hardware {
 public:
  explicit CHardware(const meridian_drive_hardware& functions) : c_(functions) {}

  [[nodiscard]] drive::Reading read(int axis) noexcept override {
    const drive::Reading usual;
    meridian_drive_reading c{usual.position, usual.velocity, 0, 1, 1, 0, 0};
    c_.read(c_.user, axis, &c);
    return {c.position,      c.velocity,      c.error,         c.has_power != 0,
            c.is_ready != 0, c.is_index != 0, c.index_position};
  }
  void write(int axis, const drive::Output& output) noexcept override {
    const meridian_drive_output c{output.is_on, output.position, output.velocity, output.is_homing,
                                  output.is_reset, output.elapsed_s};
    c_.write(c_.user, axis, &c);
  }
  void exchange(double dt_s) noexcept override {
    if (c_.exchange != nullptr) c_.exchange(c_.user, dt_s);
  }
  [[nodiscard]] bool is_emergency_stop() noexcept override {
    return c_.is_emergency_stop != nullptr && c_.is_emergency_stop(c_.user) != 0;
  }
  [[nodiscard]] bool is_guard_open() noexcept override {
    return c_.is_guard_open != nullptr && c_.is_guard_open(c_.user) != 0;
  }
  [[nodiscard]] drive::Probe probe() noexcept override {
    const int said = c_.probe != nullptr ? c_.probe(c_.user) : 0;
    const bool is_known = said == static_cast<int>(drive::Probe::kFree) ||
                          said == static_cast<int>(drive::Probe::kContact);
    return is_known ? static_cast<drive::Probe>(said) : drive::Probe::kNone;
  }
  [[nodiscard]] drive::HomingStep home(int axis, const drive::HomingView& view) noexcept override {
    if (c_.home == nullptr) return Hardware::home(axis, view);
    const meridian_homing_view seen{view.is_begin, view.target, view.position, view.dt_s};
    meridian_homing_step step{MERIDIAN_HOMING_SEARCHING, view.target, 0, 0};
    c_.home(c_.user, axis, &seen, &step);
    return {static_cast<drive::HomingState>(step.state), step.target, step.velocity, step.shift};
  }
  [[nodiscard]] std::string act(const drive::Action& action) const {
    const meridian_drive_action c{static_cast<int>(action.kind), action.value, action.text.c_str(),
                                  action.line, action.words.c_str()};
    char why[128] = "refused";
    return c_.act(c_.user, &c, why, sizeof why) == 0 ? "" : std::string(why);
  }

 private:
  meridian_drive_hardware c_;
};

[[nodiscard]] drive::Axis axis_of(const meridian_drive_axis& c) {
  drive::Axis axis;
  axis.name = text_of(c.name);
  axis.joint = c.joint;
  axis.is_rotary = c.is_rotary != 0;
  axis.is_endless = c.is_endless != 0;
  axis.travel_min = c.travel_min;
  axis.travel_max = c.travel_max;
  axis.velocity = c.velocity;
  axis.following_error = c.following_error;
  axis.fault_acceleration = c.fault_acceleration;
  axis.homing.method = static_cast<drive::HomingMethod>(c.homing);
  axis.homing.is_referenced = c.is_unreferenced == 0;
  axis.homing.index_position = c.index_position;
  axis.homing.search_velocity = c.search_velocity;
  axis.homing.search_distance = c.search_distance;
  return axis;
}

[[nodiscard]] drive::Options options_of(const meridian_drive_options& c) {
  drive::Options options;
  options.machine_file = text_of(c.machine_file);
  options.machine = text_of(c.machine);
  for (int i = 0; i < c.axis_count; ++i) options.axes.push_back(axis_of(c.axes[i]));
  options.cycle_ns = c.cycle_ns;
  options.machine_joints = c.machine_joints;
  options.bridge_cycles = c.bridge_cycles;
  options.domain = c.domain;
  options.group = c.group;
  options.priority = c.priority;
  options.may_leave_host = c.may_leave_host != 0;
  options.is_beside_others = c.is_beside_others != 0;
  return options;
}

}  // namespace

struct meridian_drives {
  meridian_drives(const meridian_drive_options& options, const meridian_drive_hardware& functions)
      : hardware(functions) {
    drive::Options complete = options_of(options);
    if (functions.act != nullptr) {
      complete.act = [this](const drive::Action& action) { return hardware.act(action); };
    }
    if (functions.report != nullptr) {
      complete.report = [functions](const std::string& text) {
        functions.report(functions.user, text.c_str());
      };
    }
    drives = std::make_unique<drive::Drives>(complete, hardware);
  }

  CHardware hardware;
  std::unique_ptr<drive::Drives> drives;
};

extern "C" {

meridian_drives* meridian_drives_open(const meridian_drive_options* options,
                                      const meridian_drive_hardware* hardware, char* why,
                                      size_t why_size) {
  try {
    if (options == nullptr || hardware == nullptr || hardware->read == nullptr ||
        hardware->write == nullptr) {
      throw drive::DriveError("options, hardware, its read and its write are required");
    }
    return new meridian_drives(*options, *hardware);
  } catch (const std::exception& error) {
    copy_text(error.what(), why, why_size);
    return nullptr;
  }
}

void meridian_drives_close(meridian_drives* drives) { delete drives; }

void meridian_drives_work(meridian_drives* drives, int periods) { drives->drives->work(periods); }

void meridian_drives_run(meridian_drives* drives, const volatile int* is_stopping) {
  drives->drives->run([is_stopping] { return *is_stopping != 0; });
}

int meridian_drives_axis_count(const meridian_drives* drives) {
  return drives->drives->axis_count();
}

int64_t meridian_drives_cycle_ns(const meridian_drives* drives) {
  return drives->drives->cycle_ns();
}

meridian_drive_status meridian_drives_status(const meridian_drives* drives, int axis) {
  const bool is_there = axis >= 0 && axis < drives->drives->axis_count();
  const drive::AxisStatus status = is_there ? drives->drives->status(axis) : drive::AxisStatus{};
  return {status.statusword, status.error,           status.state,
          status.position,   status.following_error, status.is_referenced};
}

}  // extern "C"
