// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "service/machine/file/sections/mesh_file.hpp"
#include "service/panel/motion.hpp"
#include "service/panel/serve/frame.hpp"
#include "service/panel/serve/hub.hpp"
#include "service/panel/serve/news.hpp"
#include "service/panel/status/auxiliaries.hpp"
#include "service/panel/status/history.hpp"
#include "service/panel/status/latency_text.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/followed.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"

namespace meridian::panel {

/// Reads what one machine says on the topics and publishes it to the hub, 25 frames a second. It
/// only reads, and polls: the rate of the setpoints costs no wake-ups. One thread.
class MachineWatch {
 public:
  /// Files beside the topics; an empty path: none.
  struct Files {
    std::filesystem::path history;  ///< audit log of the service
    std::filesystem::path meshes;   ///< folder of the meshes that the machine file names
  };
  /// `hub` and `participant` must live on. Throws DdsError.
  MachineWatch(dds::Participant& participant, Hub& hub, Files files = {});

  /// Takes what came and publishes what is new.
  void poll();

  /// status_sequence of the newest status, for any thread; 0: none.
  [[nodiscard]] std::uint64_t newest_status() const noexcept { return newest_status_; }
  /// The newest status of the followed service; nothing: it is silent.
  [[nodiscard]] const std::optional<dds::Status>& status() const noexcept { return status_; }
  /// The machine as its service reported it last, for any thread; nothing: it is silent.
  [[nodiscard]] std::optional<dds::MachineInfo> machine() const;
  /// The bytes of a mesh of the machine, from 0, for any thread; nothing: there is none.
  [[nodiscard]] std::optional<std::string> mesh(std::size_t number) const;

 private:
  using Clock = std::chrono::steady_clock;

  void take_machine();
  /// What was sent since the status before: the newest one says with which tool.
  void take_motion();
  void take_status();
  /// The frame of the newest status.
  [[nodiscard]] std::string next_frame();
  void take_latency();
  void take_actions();
  /// What the audit log says, once a second: all that it knows of the time before the panel; of
  /// now, what the status does not say.
  void take_history();
  /// What /metrics answers, once a second.
  void publish_metrics();
  /// Builds the model from what the machine topic says of it.
  void adopt(const dds::MachineInfo& info);

  Hub& hub_;
  dds::Reader<dds::MachineInfo> machines_;
  dds::Reader<dds::Status> statuses_;
  dds::Reader<dds::SetpointSample> setpoints_;
  dds::Reader<dds::DriveFeedback> feedbacks_;
  dds::Reader<dds::Latency> latencies_;
  std::optional<dds::Reader<dds::Action>> actions_;      ///< nothing: its identity may not read
  std::optional<dds::Reader<dds::ActionDone>> answers_;  ///< the same
  dds::Followed<dds::Status> followed_;
  mutable std::mutex machine_mutex_;  ///< of machine_ against other threads
  std::filesystem::path mesh_folder_;
  std::vector<config::Mesh> meshes_;  ///< of machine_, under machine_mutex_
  std::optional<dds::MachineInfo> machine_;
  std::optional<dds::MachineInfo> next_;  ///< of a service that is not followed yet
  std::optional<dds::Status> status_;
  std::optional<dds::Latency> latency_;
  std::unique_ptr<MachineModel> model_;  ///< motion_ refers to it; without that, names alone
  std::unique_ptr<Motion> motion_;       ///< nothing: the kinematics are not known
  std::vector<probe::Budget> budgets_ = known_budgets();
  News news_;
  Auxiliaries auxiliaries_;
  std::optional<History> history_;
  std::chrono::system_clock::time_point began_ = std::chrono::system_clock::now();
  Clock::time_point heard_{}, metrics_due_{}, history_due_{};
  std::atomic<std::uint64_t> newest_status_{0};
};

}  // namespace meridian::panel
