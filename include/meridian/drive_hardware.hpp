// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

/// What somebody who connects motors supplies to the library for drives (docs/drive-library.md).
/// Units: mm or rad, and s. Nothing but the standard library.
namespace meridian::drive {

/// What one axis is to do until the next period.
struct Output {
  bool is_on = false;   ///< power stage on, brake released; false: the brake holds
  double position = 0;  ///< to stand here at the end of the period
  double velocity = 0;  ///< of the position, for feed-forward
  bool is_homing =
      false;              ///< HomingMethod::kByDrive: the drive searches, `position` is as it reads
  bool is_reset = false;  ///< the operator resets a fault: clear your own
  /// From the position before to this one by the service's clock: setpoints come unevenly, two in
  /// one period or none. Who interpolates goes by this, not by the period.
  double elapsed_s = 0;
};

/// What one axis reports in one period.
struct Reading {
  double position = 0;
  /// Not a number: the library takes the difference of positions.
  double velocity = std::numeric_limits<double>::quiet_NaN();
  std::uint16_t error = 0;    ///< CiA 402, object 603Fh; 0: no fault
  bool has_power = true;      ///< false: no power stage can be on
  bool is_ready = true;       ///< false: the power stage that was switched on is not on yet
  bool is_index = false;      ///< HomingMethod::kByIndex: the index pulse came in this period
  double index_position = 0;  ///< where `position` was when it came
};

/// What a touch probe says whose signal the drives read.
enum class Probe : std::uint8_t {
  kNone,    ///< none is connected
  kFree,    ///< it touches nothing
  kContact  ///< its stylus is deflected
};

enum class HomingState : std::uint8_t { kSearching, kAttained, kFailed };

/// What a search for the reference begins a period with.
struct HomingView {
  bool is_begin = false;  ///< the first period of this search
  double target = 0;      ///< to which the axis was led last
  double position = 0;    ///< where it stands
  double dt_s = 0;
};

/// Where a search leads the axis.
struct HomingStep {
  HomingState state = HomingState::kSearching;
  double target = 0;    ///< HomingMethod::kByCallback: to be led to, before `shift`
  double velocity = 0;  ///< of the target
  /// Added to what positions are called from now on; read() then adds it too.
  double shift = 0;
};

/// The motors. Every function is called by the thread that works the drives, once a period, and may
/// not wait. In each period come write() of all axes, exchange(), read() of all axes, the inputs.
class Hardware {
 public:
  virtual ~Hardware() = default;

  /// Required: where axis `axis` is, and what is wrong with it.
  [[nodiscard]] virtual Reading read(int axis) noexcept = 0;
  /// Required: what axis `axis` is to do.
  virtual void write(int axis, const Output& output) noexcept = 0;

  /// The cyclic frame of a fieldbus. `dt_s`: length of the period, of several where some were lost.
  virtual void exchange(double dt_s) noexcept { static_cast<void>(dt_s); }
  /// Whether the stop input is open.
  [[nodiscard]] virtual bool is_emergency_stop() noexcept { return false; }
  /// Whether a guard of the work space is open; where nobody says so it is shut.
  [[nodiscard]] virtual bool is_guard_open() noexcept { return false; }
  /// The touch probe, of the same instant as the positions that read() gives.
  [[nodiscard]] virtual Probe probe() noexcept { return Probe::kNone; }
  /// One period of a search: HomingMethod::kByDrive and kByCallback. Who does not override it finds
  /// no reference.
  [[nodiscard]] virtual HomingStep home(int axis, const HomingView& view) noexcept {
    static_cast<void>(axis);
    return {HomingState::kFailed, view.target, 0, 0};
  }

 protected:
  Hardware() = default;
  Hardware(const Hardware&) = default;
  Hardware& operator=(const Hardware&) = default;
};

}  // namespace meridian::drive
