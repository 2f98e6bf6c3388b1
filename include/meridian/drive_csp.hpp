// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "meridian/drive_hardware.hpp"

/// Process data of CiA 402 drives in cyclic synchronous position mode (CSP), for programs that
/// bring a fieldbus master of their own: EtherCAT, CANopen, POWERLINK. docs/drive-library.md.
namespace meridian::drive {

/// One entry of a PDO mapping (objects 1600h to 17FFh and 1A00h to 1BFFh).
struct PdoEntry {
  /// As the mapping object has it: index, subindex and length in bits, 607A0020h for 607Ah:00 of 32
  /// bits. Index 0 is padding.
  std::uint32_t mapping = 0;
  /// What is sent in an output that the codec does not drive (6072h, 607Fh, 60FEh ...).
  std::optional<std::int64_t> value;
};

/// What the codec has to know of one drive. Units: mm or rad, s; counts are the drive's numbers.
struct CspSpec {
  std::string name;               ///< of the axis, for messages
  std::vector<PdoEntry> outputs;  ///< to the drive, in the order of the frame
  std::vector<PdoEntry> inputs;   ///< from the drive, in the order of the frame
  int axis_number = 0;            ///< of a drive of several axes: 800h is added to 6xxxh for each
  /// Counts of 607Ah and 6064h per mm or rad; negative where the motor counts against the axis.
  double counts_per_unit = 0;
  /// Counts of 606Ch and 60B1h per mm/s or rad/s; 0: as `counts_per_unit`.
  double velocity_counts_per_unit = 0;
  std::int64_t zero_counts = 0;           ///< what the drive counts where the axis is at 0
  bool is_endless = false;                ///< counts go round at the end of their 32 bits
  double travel_min = 0, travel_max = 0;  ///< has to fit into the counts; not endless
  /// HomingMethod::kByDrive: the axis moves no farther in one period, so that more than this is a
  /// new name for where it is. 0: any distance is taken for motion.
  double farthest_step = 0;
};

/// Counts of one unit (mm, or rad of a rotary axis), by the objects of the drive: `increments` per
/// `encoder_turns` of the encoder (608Fh:01, :02), `motor_turns` per `shaft_turns` (6091h:01, :02),
/// and the feed of one turn of the shaft (mm; of a rotary axis what it turns by, rad).
/// Throws DriveError.
[[nodiscard]] double counts_per_unit(std::uint32_t increments, std::uint32_t encoder_turns,
                                     std::uint32_t motor_turns, std::uint32_t shaft_turns,
                                     double feed_per_shaft_turn);

/// Counts of one unit of a drive that scales by itself: the value of its object 60A8h (position) or
/// 60A9h (velocity). Metres, radians, degrees and turns with a power of ten; velocities per second
/// or minute. Throws DriveError for another unit, and for turns of a linear axis.
[[nodiscard]] double counts_per_si_unit(std::uint32_t si_unit, bool is_rotary);

/// One drive in CSP mode behind somebody's fieldbus: what the library for drives wants becomes the
/// output process data, the input process data what the library reads. It walks the drive's own
/// states by 6040h and 6041h, sends 8 or 6 in 6060h, leads 607Ah after 6064h until operation is
/// enabled so that enabling never jumps, and resets faults. A drive that leaves operation enabled
/// by itself is reported without power: it does not start again until it was switched off.
///
/// In each period write(), the frame, read(). After the constructor nothing allocates. RT.
/// Source: CiA 402-2 and -3 (IEC 61800-7-201), CiA 303-2. Proof:
/// tests/unit/drive_kit/csp_*_test.cpp.
class CspDrive {
 public:
  /// Throws DriveError: a mapping without a word that CSP needs, of wrong length or twice, an
  /// output without a value, a scale that is none, travel that does not fit.
  explicit CspDrive(const CspSpec& spec);
  ~CspDrive();
  CspDrive(CspDrive&&) noexcept;
  CspDrive& operator=(CspDrive&&) noexcept;

  [[nodiscard]] std::size_t output_bytes() const noexcept;
  [[nodiscard]] std::size_t input_bytes() const noexcept;

  /// Fills the first output_bytes() of `frame`; a shorter one is left alone.
  void write(const Output& output, std::span<std::uint8_t> frame) noexcept;
  /// What the drive says. An empty `frame` is one that did not come back: the last position, and
  /// from the fourth in a row on error 7500h. Before the first one the position is no number.
  [[nodiscard]] Reading read(std::span<const std::uint8_t> frame) noexcept;
  /// For Hardware::home() with HomingMethod::kByDrive: mode 6, and what came of it.
  [[nodiscard]] HomingStep home(const HomingView& view) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meridian::drive
