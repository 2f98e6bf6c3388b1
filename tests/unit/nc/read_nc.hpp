// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "service/machine/file/machine_file.hpp"
#include "service/programs/nc/nc_reader.hpp"
#include "unit/cl/read_text.hpp"

namespace meridian::nc {

using cl::ClReaderOptions;
using cl::ReadText;

[[nodiscard]] inline MachineModel shipped(const std::string& name) {
  return config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/" + name + ".toml");
}

inline constexpr double kTiny = 1e-9;  ///< mm, or of a unit vector

/// Options for NC programs without a machine.
[[nodiscard]] inline ClReaderOptions without_machine() {
  ClReaderOptions options;
  options.dialect = cl::Dialect::kFanuc;
  options.nc = reader_of_programs();
  return options;
}

[[nodiscard]] inline ClReaderOptions on(const MachineModel& model) {
  ClReaderOptions options = without_machine();
  options.nc = reader_of_programs(
      model, ToolTable({{1, model.tool_length_mm, 5}, {2, model.tool_length_mm + 20, 5}}));
  return options;
}

/// A metric program with `body` between its head and M30.
[[nodiscard]] inline ReadText read_nc(std::string_view body,
                                      const ClReaderOptions& options = without_machine()) {
  return cl::read_text("%\nG21 G90 G94 G17\nF600\n" + std::string(body) + "M30\n%\n", options);
}

/// The same options for a program of Siemens words, and for Klartext.
[[nodiscard]] inline ClReaderOptions siemens(ClReaderOptions options = without_machine()) {
  options.dialect = cl::Dialect::kSiemens;
  return options;
}
[[nodiscard]] inline ClReaderOptions klartext(ClReaderOptions options = without_machine()) {
  options.dialect = cl::Dialect::kHeidenhain;
  return options;
}

/// `body` begins in line 4.
[[nodiscard]] inline ReadText read_siemens(std::string_view body,
                                           const ClReaderOptions& options = siemens()) {
  return cl::read_text("; PART\nG17 G710 G40 G90 G94\nF600\n" + std::string(body) + "M30\n",
                       options);
}

/// `body` begins in line 3.
[[nodiscard]] inline ReadText read_klartext(std::string_view body,
                                            const ClReaderOptions& options = klartext()) {
  return cl::read_text(
      "0 BEGIN PGM PART MM\n1 ; NOTE\n" + std::string(body) + "9 END PGM PART MM\n", options);
}

/// Z and kind, "r" rapid or "f" feed, of every motion block after the first.
[[nodiscard]] inline std::string levels_of(const ReadText& read) {
  std::string out;
  const auto motion = read.motion();
  for (std::size_t n = 1; n < motion.size(); ++n) {
    const int z = static_cast<int>(motion[n].tip_mm[2]);
    out += (out.empty() ? "" : " ") + std::to_string(z) +
           (motion[n].kind == BlockKind::kRapid ? "r" : "f");
  }
  return out;
}

const double kHalfRoot = std::sqrt(0.5);

[[nodiscard]] inline Vector3 tip(const ClBlock& block) { return to_vector(block.tip_mm); }
[[nodiscard]] inline Vector3 axis(const ClBlock& block) { return to_vector(block.axis); }

}  // namespace meridian::nc
