// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "meridian/drive_action.hpp"
#include "meridian/drive_axis.hpp"
#include "meridian/drive_hardware.hpp"

/// The library for drives: your motors as the drives of a Meridian machine. Link meridian::drive;
/// docs/drive-library.md is the tutorial. Nothing but the standard library is in these headers.
namespace meridian::drive {

/// Something is wrong at the start; the message says what and how to mend it.
class DriveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Options {
  /// TOML; axes, cycle time and the machine's name are taken from it where they are not given here.
  std::string machine_file;
  std::string machine;            ///< the machine's name: the DDS partition
  std::vector<Axis> axes;         ///< empty: all of the machine file
  std::int64_t cycle_ns = 0;      ///< 0: of the machine file
  int machine_joints = 0;         ///< of the whole machine; 0: of the machine file, else of `axes`
  int bridge_cycles = 0;          ///< until a service says how many; 0: of the machine file, else 3
  std::uint32_t domain = 0;       ///< DDS domain
  std::uint32_t group = 0;        ///< number of these drives, where several programs have some each
  int priority = 65;              ///< SCHED_FIFO, where there is a right to it; 0: none
  bool may_leave_host = false;    ///< start though CYCLONEDDS_URI leads off the host unsecured
  bool is_beside_others = false;  ///< start though somebody else reports these joints
  Act act;                        ///< plays the action peer; empty: somebody else does
  /// News for the operator: states of axes, actions, who was dropped. Called on a thread of the
  /// library. Empty: nobody wants them.
  std::function<void(const std::string&)> report;
};

/// How one axis is.
struct AxisStatus {
  std::uint16_t statusword = 0;  ///< CiA 402, object 6041h
  std::uint16_t error = 0;       ///< object 603Fh
  const char* state = "";        ///< as CiA 402 calls it
  double position = 0;           ///< mm or rad
  double following_error = 0;    ///< mm or rad
  bool is_referenced = false;
};

struct Counts {
  std::uint64_t periods = 0;
  std::uint64_t periods_lost = 0;  ///< of run(), or as work() was called with
  std::uint64_t periods_bridged = 0;
  std::uint64_t setpoints = 0;     ///< taken
  std::uint64_t dropped = 0;       ///< commands and setpoints of others, doubled, late or spoilt
  std::uint64_t reports_lost = 0;  ///< found no room to be sent
};

/// Drives on the wire. It owns topics, types and quality of service, decides which service is
/// obeyed, checks what is sent, bridges lost setpoints and ramps down after the bridge, walks the
/// CiA 402 states, homes, and reports.
///
/// After the constructor, work() makes no heap call, takes no lock, waits for nobody and writes no
/// log: sending and reporting is done by a thread of the library.
/// Proof: tests/unit/drive_kit/drives_test.cpp.
class Drives {
 public:
  /// `hardware` outlives this; it is read once. Throws DriveError.
  Drives(const Options& options, Hardware& hardware);
  ~Drives();
  Drives(const Drives&) = delete;
  Drives& operator=(const Drives&) = delete;

  /// One period; call it once per cycle time, always by one thread. `periods`: more than 1 where
  /// that thread overslept some. RT.
  void work(int periods = 1) noexcept;
  /// Calls work() once per cycle time until `is_stopping`, in phase, with Options::priority.
  void run(const std::atomic<bool>& is_stopping) noexcept;
  /// The same until `is_stopping()`, which may not wait.
  void run(const std::function<bool()>& is_stopping) noexcept;

  [[nodiscard]] int axis_count() const noexcept;
  [[nodiscard]] const Axis& axis(int index) const noexcept;
  [[nodiscard]] std::int64_t cycle_ns() const noexcept;
  /// For the thread that calls work(). RT.
  [[nodiscard]] AxisStatus status(int axis) const noexcept;
  [[nodiscard]] Counts counts() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The axes of a machine file, in drive order. Throws DriveError.
[[nodiscard]] std::vector<Axis> axes_of(const std::string& machine_file);

/// For programs that share a small host with the service: keeps the calling thread, and those that
/// it starts, off the last processor, which the service uses for its cycle. Call it first.
void leave_last_processor() noexcept;

}  // namespace meridian::drive
