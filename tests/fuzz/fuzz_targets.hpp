// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What fuzzing throws bytes at: everything that comes from outside. A target returns whatever the
/// bytes are, or ends the process with what it found.
namespace meridian::fuzz {

using Bytes = std::span<const std::uint8_t>;
using Seeds = std::vector<std::vector<std::uint8_t>>;

/// A CL file of any dialect: every block that comes out is sound, and reading ends.
void read_cl(Bytes bytes);
[[nodiscard]] Seeds cl_seeds();

/// An NC program, on a machine whose axes its words turn.
void read_nc(Bytes bytes);
[[nodiscard]] Seeds nc_seeds();

/// A machine file: refused by name, or a machine whose kinematics hold water.
void read_machine(Bytes bytes);
/// Those that are shipped, from `folder`.
[[nodiscard]] Seeds machine_seeds(const std::string& folder);

/// Samples off the wire, one after the other, each for whoever acts on its type: intake, station,
/// supervisor, drives, feedback, viewer.
void check_wire(Bytes bytes);
[[nodiscard]] Seeds wire_seeds();

struct Target {
  std::string_view name;
  void (*run)(Bytes);
};
inline constexpr Target kTargets[] = {
    {"cl", read_cl}, {"machine", read_machine}, {"wire", check_wire}, {"nc", read_nc}};

/// Ends the process with `what` where `holds` is false.
void require(bool holds, const char* what);

}  // namespace meridian::fuzz
