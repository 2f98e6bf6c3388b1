// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "integration/plant.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian::test {

/// A straight cut without an end, sent by a process that reads it from a pipe. It is kept so far
/// ahead of the tool that nothing but the death of the station makes the machine run dry.
class EndlessStation {
 public:
  static constexpr double kFeed_mm_per_s = 200;

  explicit EndlessStation(Plant& plant)
      : plant_(plant),
        process_({"meridian", "stream", "-", "--transition", "smooth", "--domain", plant.domain()},
                 plant.folder() / "station.log", &pipe_) {
    const MachineModel model = config::load_machine(machine_file());
    JointVector home{};
    for (std::size_t i = 0; i < home.size(); ++i) home[i] = model.joints[i].home;
    begin_ = forward(model, model.tool_length_mm, home).tip + Vector3(-300, 0, -5);
    pipe_.write("PARTNO/ENDLESS\nUNITS/MM\nFEDRAT/" + std::to_string(60 * kFeed_mm_per_s) +
                ",MMPM\n");
  }
  /// Writes blocks until `is_enough`; false where that does not come.
  [[nodiscard]] bool feed_until(const std::function<bool()>& is_enough) {
    return eventually([&] { return feed(), is_enough(); }, milliseconds(8000));
  }
  Process& process() { return process_; }
  /// Where block `sequence` ends.
  [[nodiscard]] double x_of(std::uint64_t sequence) const {
    return begin_.x() + kStep_mm * static_cast<double>(sequence);
  }

 private:
  static constexpr double kStep_mm = 0.1;
  /// Blocks: what a smooth plan holds back, and a good second of cutting.
  static constexpr std::uint64_t kAhead = 5000;

  void feed() {
    const dds::Status& status = plant_.status();
    const std::uint64_t cut = status.state == State::kRunning ? status.block : 0;
    std::string text;
    for (; written_ < cut + kAhead; ++written_) {
      text += "GOTO/" + std::to_string(x_of(written_)) + "," + std::to_string(begin_.y()) + "," +
              std::to_string(begin_.z()) + ",0.17364817766693,0,0.98480775301221\n";
    }
    pipe_.write(text);
  }

  Plant& plant_;
  InputPipe pipe_;
  Process process_;
  Vector3 begin_;
  std::uint64_t written_ = 0;
};

}  // namespace meridian::test
