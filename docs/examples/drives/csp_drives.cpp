// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <vector>

#include "meridian/drive.hpp"
#include "meridian/drive_csp.hpp"
using namespace meridian::drive;

/// Stands for your fieldbus master: one frame out and back. Here drives that are always there.
struct Master {
  std::vector<std::uint8_t> out, in;
  bool exchange() noexcept {
    const bool is_on = (out[0] & 0x0F) == 0x0F;
    in[0] = is_on ? 0x37 : 0x31;                 // 6041h
    if (is_on) std::memcpy(&in[3], &out[3], 4);  // 6064h follows 607Ah
    in[2] = out[2];                              // 6061h
    return true;                                 // the working counter is right
  }
};

struct Bus : Hardware {
  explicit Bus(std::size_t axes) {
    CspSpec spec;
    spec.outputs = {{0x60400010, {}}, {0x60600008, {}}, {0x607A0020, {}}};
    spec.inputs = {{0x60410010, {}}, {0x60610008, {}}, {0x60640020, {}}};
    spec.counts_per_unit = counts_per_unit(1'048'576, 1, 1, 1, 10);  // 20 bits, 10 mm a turn
    for (std::size_t i = 0; i < axes; ++i) drives.emplace_back(spec);
    masters.resize(axes);
    for (std::size_t i = 0; i < axes; ++i) {
      masters[i].out.resize(drives[i].output_bytes());
      masters[i].in.resize(drives[i].input_bytes());
    }
    exchange(0);  // a first frame: the library asks at once where the axes are
  }
  void write(int axis, const Output& output) noexcept override {
    const auto i = static_cast<std::size_t>(axis);
    drives[i].write(output, masters[i].out);
  }
  void exchange(double) noexcept override {
    for (Master& master : masters) has_frame = master.exchange();
  }
  Reading read(int axis) noexcept override {
    const auto i = static_cast<std::size_t>(axis);
    if (!has_frame) return drives[i].read({});
    return drives[i].read(masters[i].in);
  }
  std::vector<CspDrive> drives;
  std::vector<Master> masters;
  bool has_frame = false;
};
std::atomic<bool> is_stopping{false};

/// csp_drives MACHINE: every axis of the machine file behind a fieldbus.
int main(int count, char** arguments) try {
  for (int end : {SIGINT, SIGTERM}) std::signal(end, [](int) { is_stopping = true; });
  const Options options{.machine_file = count > 1 ? arguments[1] : "lai.toml"};
  Bus bus(axes_of(options.machine_file).size());
  Drives(options, bus).run(is_stopping);
} catch (const DriveError& error) {
  return std::puts(error.what()), 1;
}
