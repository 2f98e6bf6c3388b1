// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/machine_watch.hpp"

#include <cstdint>
#include <system_error>
#include <utility>

#include "service/machine/file/machine_file.hpp"
#include "service/panel/scene.hpp"
#include "service/panel/status/latency_text.hpp"
#include "service/panel/status/metrics.hpp"
#include "service/protocol/operator/served_model.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::panel {
namespace {

/// Cyclic topics keep so many samples between two statuses: a quarter of a second at 2 kHz.
constexpr int kDepth = 512;
/// A service speaks twenty times a second; one that was silent for so long is gone.
constexpr std::chrono::milliseconds kSilent{1500};
constexpr std::uintmax_t kMaxMeshBytes = 32 << 20;

/// Whether both say the same of the machine; who serves it, and for how long, aside.
[[nodiscard]] bool is_same_machine(const dds::MachineInfo& a, const dds::MachineInfo& b) {
  return a.machine_file == b.machine_file && a.tool_file == b.tool_file &&
         a.frame_rotation == b.frame_rotation && a.frame_origin_mm == b.frame_origin_mm &&
         a.soft_limits == b.soft_limits && a.tool_length_mm == b.tool_length_mm &&
         a.service_id == b.service_id;
}

}  // namespace

MachineWatch::MachineWatch(dds::Participant& participant, Hub& hub, Files files)
    : hub_(hub),
      machines_(participant),
      statuses_(participant, {}, 0, dds::Delivery::kNewest),
      setpoints_(participant, {}, kDepth),
      feedbacks_(participant, {}, kDepth),
      latencies_(participant),
      mesh_folder_(std::move(files.meshes)) {
  try {
    actions_.emplace(participant);
    answers_.emplace(participant);
  } catch (const dds::DdsError&) {
    // Spindle and coolant stay unknown to a panel that may read less.
  }
  if (!files.history.empty()) history_.emplace(std::move(files.history));
}

void MachineWatch::adopt(const dds::MachineInfo& info) {
  {
    const std::lock_guard lock(machine_mutex_);
    machine_ = info;
  }
  motion_.reset();
  model_.reset();
  std::vector<config::Mesh> meshes;
  std::string scene;
  try {
    model_ = std::make_unique<MachineModel>(stream::served_model(info));
    motion_ = std::make_unique<Motion>(*model_);
    const bool has_tools = !info.tool_file.empty();
    if (!mesh_folder_.empty()) meshes = config::parse_meshes(info.machine_file, info.name, *model_);
    scene = describe_scene(stream::whole_model(info),
                           has_tools ? config::parse_tools(info.tool_file, "tools") : ToolTable(),
                           info.soft_limits, meshes);
  } catch (const config::ConfigError&) {
    // Its file does not fit the topic, or another version wrote it: shown without a picture.
    if (!motion_) model_ = std::make_unique<MachineModel>(stream::named_model(info));
  }
  {
    const std::lock_guard lock(machine_mutex_);
    meshes_ = std::move(meshes);
  }
  hub_.publish(Hub::kMachine, machine_text(info, scene));
}

std::optional<std::string> MachineWatch::mesh(std::size_t number) const {
  std::string file;
  {
    const std::lock_guard lock(machine_mutex_);
    if (number >= meshes_.size()) return std::nullopt;
    file = meshes_[number].file;
  }
  std::error_code unknown;
  const auto bytes = std::filesystem::file_size(mesh_folder_ / file, unknown);
  if (unknown || bytes > kMaxMeshBytes) return std::nullopt;
  return text::read_whole(mesh_folder_ / file);
}

std::optional<dds::MachineInfo> MachineWatch::machine() const {
  if (newest_status_ == 0) return std::nullopt;
  const std::lock_guard lock(machine_mutex_);
  return machine_;
}

void MachineWatch::take_machine() {
  dds::MachineInfo info;
  while (machines_.take(info)) {
    if (!info.is_serving) continue;
    if (status_ && info.service_id != status_->service_id) {
      next_ = info;
      continue;
    }
    if (!machine_ || !is_same_machine(*machine_, info)) adopt(info);
  }
}

void MachineWatch::take_motion() {
  std::vector<Setpoint> setpoints;
  dds::SetpointSample sample;
  while (setpoints_.take(sample)) {
    const bool is_its = sample.crc == dds::setpoint_crc(sample.setpoint, status_->service_id);
    if (is_its) setpoints.push_back(sample.setpoint);
  }
  motion_->add(setpoints, status_->tool_length_mm);
  dds::DriveFeedback feedback;
  while (feedbacks_.take(feedback)) {
    motion_->add_feedback(feedback.cycle_seen, feedback.joint_mask, feedback.position);
  }
}

void MachineWatch::take_status() {
  dds::Status status;
  const auto now = Clock::now();
  if (!followed_.take(statuses_, status)) {
    if (status_ && now - heard_ > kSilent) {
      status_.reset();
      newest_status_ = 0;
      hub_.publish(Hub::kFrame, silent_text());
    }
    return;
  }
  heard_ = now;
  status_ = std::move(status);
  newest_status_ = status_->status_sequence;
  if (next_ && next_->service_id == status_->service_id) {
    adopt(*next_);
    next_.reset();
  }
  if (!model_ || !machine_ || machine_->service_id != status_->service_id) return;
  auxiliaries_.follow(*status_);
  if (news_.add(*status_, *model_, std::chrono::system_clock::now())) {
    hub_.publish(Hub::kNews, news_text(news_));
  }
  hub_.publish(Hub::kFrame, next_frame());
}

std::string MachineWatch::next_frame() {
  if (!motion_) return bare_frame_text(*status_, *model_, auxiliaries_);
  take_motion();
  std::string text = frame_text(*status_, *model_, *motion_, auxiliaries_);
  motion_->clear();
  return text;
}

void MachineWatch::take_latency() {
  dds::Latency latency;
  while (latencies_.take(latency)) {
    if (!status_ || latency.service_id != status_->service_id) continue;
    hub_.publish(Hub::kLatency, latency_text(latency, machine_ ? machine_->cycle_ns : 0, budgets_));
    latency_ = latency;
  }
}

void MachineWatch::take_actions() {
  dds::Action action;
  while (actions_ && actions_->take(action)) auxiliaries_.ask(action);
  dds::ActionDone done;
  while (answers_ && answers_->take(done)) auxiliaries_.answer(done);
}

void MachineWatch::take_history() {
  const auto now = Clock::now();
  if (!history_ || now < history_due_) return;
  history_due_ = now + std::chrono::seconds(1);
  bool is_new = false;
  for (NewsItem& item : history_->take()) {
    if (item.source == NewsSource::kMachine && item.time >= began_) continue;
    news_.add(std::move(item));
    is_new = true;
  }
  if (is_new) hub_.publish(Hub::kNews, news_text(news_));
}

void MachineWatch::publish_metrics() {
  const auto now = Clock::now();
  if (!machine_ || now < metrics_due_) return;
  metrics_due_ = now + std::chrono::seconds(1);
  hub_.publish(Hub::kMetrics, metrics_text(*machine_, status_, latency_));
}

void MachineWatch::poll() {
  take_machine();
  take_actions();
  take_history();  // what was before stands before what is said now
  take_status();
  take_latency();
  publish_metrics();
}

}  // namespace meridian::panel
