// SPDX-License-Identifier: Apache-2.0
#include "integration/plant.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <regex>
#include <sstream>
#include <thread>
#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian::test {
namespace {

[[nodiscard]] std::int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

}  // namespace

std::string cl_text(const std::vector<ClBlock>& blocks, std::size_t begin) {
  std::ostringstream text;
  text << std::setprecision(12);
  for (std::size_t i = begin; i < blocks.size(); ++i) {
    const ClBlock& block = blocks[i];
    text << "GOTO/";
    for (const double x : block.tip_mm) text << x << ",";
    text << block.axis[0] << "," << block.axis[1] << "," << block.axis[2] << "\n";
  }
  return text.str();
}

std::string machine_file(const std::string& machine) {
  return std::string(MERIDIAN_SOURCE_DIR) + "/deploy/machines/" + machine + ".toml";
}

Plant::Plant(std::string machine)
    : Plant(std::move(machine), std::make_shared<support::PrivateDomain>()) {}

Plant::Plant(std::string machine, const Plant& other) : Plant(std::move(machine), other.domain_) {}

Plant::Plant(std::string machine, std::shared_ptr<support::PrivateDomain> domain)
    : machine_(std::move(machine)),
      machine_file_(machine_file(machine_)),
      domain_(std::move(domain)),
      folder_(std::filesystem::temp_directory_path() /
              ("meridian-plant-" + this->domain() + "-" + machine_)),
      participant_({.domain = domain_->id(), .machine = machine_}),
      statuses_(participant_),
      commands_(participant_),
      replies_(participant_),
      requests_(participant_),
      batches_(participant_),
      credits_(participant_) {
  std::filesystem::remove_all(folder_);
  std::filesystem::create_directories(folder_);
  change_machine({{"approach_feed_mm_per_min = [0-9]+", "approach_feed_mm_per_min = 12000"},
                  {"transition = \"smooth\"", "transition = \"exact_stop\""}});
}

Plant::~Plant() {
  if (testing::Test::HasFailure()) {
    for (const auto* process : {service_.get(), drives_.get()}) {
      if (process != nullptr) std::printf("%s\n", process->said().c_str());
    }
  }
  service_.reset();
  drives_.reset();
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void Plant::set_cycle_us(int cycle_us) {
  ASSERT_NO_FATAL_FAILURE(
      change_machine({{"cycle_us = [0-9]+", "cycle_us = " + std::to_string(cycle_us)}}));
  ASSERT_EQ(config::load_machine(machine_file_).cycle_ns, 1000 * cycle_us);
}

void Plant::change_machine(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::ostringstream old;
  old << std::ifstream(machine_file_).rdbuf();
  std::string text = old.str();
  for (const auto& [from, to] : changes) {
    ASSERT_TRUE(std::regex_search(text, std::regex(from))) << from;
    text = std::regex_replace(text, std::regex(from), to);
  }
  machine_file_ = (folder_ / "machine.toml").string();
  std::ofstream(machine_file_) << text;
}

Process& Plant::start_service(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"meridiand", "--machine",     machine_file_,   "--domain",
                                        domain(),    "--record",      recording(),     "--state",
                                        state(),     "--best-effort", "--open-network"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  status_.reset();
  service_ = std::make_unique<Process>(arguments, folder_ / "service.log");
  return *service_;
}

Process& Plant::start_drives(const std::vector<std::string>& more, const InputPipe* console) {
  std::vector<std::string> arguments = {"meridian", "drives", "--machine",     machine_file_,
                                        "--domain", domain(), "--open-network"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  if (console != nullptr) arguments.emplace_back("--console");
  drives_ = std::make_unique<Process>(arguments, folder_ / "drives.log", console);
  return *drives_;
}

std::unique_ptr<Process> Plant::another_service() {
  return std::make_unique<Process>(
      std::vector<std::string>{"meridiand", "--machine", machine_file_, "--domain", domain(),
                               "--best-effort", "--open-network"},
      folder_ / "second.log");
}

void Plant::look() {
  dds::Status status;
  if (followed_.take(statuses_, status)) status_ = status;
}

const dds::Status& Plant::status() {
  look();
  (void)eventually([this] {
    look();
    return status_.has_value();
  });
  if (!status_) status_.emplace();
  return *status_;
}

bool Plant::wait_for(State state, milliseconds patience) {
  return eventually([&] { return status().state == state; }, patience);
}

bool Plant::runs_until(const std::function<bool(const dds::Status&)>& condition,
                       milliseconds patience) {
  bool is_so = false;
  (void)eventually(
      [&] {
        is_so = condition(status());
        return is_so || status_->state == State::kFaultStop || status_->state == State::kFault;
      },
      patience);
  return is_so;
}

std::string Plant::standing() {
  const dds::Status& now = status();
  return std::string("machine is ") + name_of(now.state) + ", alarm " +
         std::to_string(static_cast<int>(now.alarm)) + ", block " + std::to_string(now.block) +
         ": " + now.message;
}

std::optional<dds::Reply> Plant::say(Verb verb, double argument) {
  return say_having_seen(verb, status(), argument);
}

std::optional<dds::Reply> Plant::say_having_seen(Verb verb, const dds::Status& seen,
                                                 double argument) {
  if (!eventually(
          [this] { return commands_.matched_readers() > 0 && replies_.matched_writers() > 0; })) {
    return std::nullopt;
  }
  dds::CommandRequest request;
  request.request = ++request_;
  request.operator_id = 4711;
  request.operator_name = "test";
  request.verb = verb;
  request.epoch_seen = seen.epoch;
  request.status_seen = seen.status_sequence;
  request.service_id_seen = seen.service_id;
  request.argument = argument;
  (void)commands_.write(request);
  dds::Reply reply;
  const bool has_reply = eventually([&] {
    while (replies_.take(reply)) {
      if (reply.operator_id == request.operator_id && reply.request == request.request) return true;
    }
    return false;
  });
  return has_reply ? std::optional(reply) : std::nullopt;
}

void Plant::must(Verb verb, double argument, Refusal passing) {
  std::optional<dds::Reply> reply;
  (void)eventually([&] {
    reply = say(verb, argument);
    // Said again: after a stop as soon as a status of after it was seen.
    const bool is_late =
        reply && (reply->refusal == Refusal::kStale || reply->refusal == Refusal::kOvertaken);
    return !reply || (!is_late && reply->refusal != passing);
  });
  ASSERT_TRUE(reply && reply->is_accepted)
      << "verb " << static_cast<int>(verb) << ": " << (reply ? reply->text : "no reply") << "; "
      << standing();
}

bool Plant::enable() {
  // Service and drives start meanwhile, which takes a host that is busy or slow at memory long.
  constexpr milliseconds kPatience(30000);
  // Until feedback is there an enable is refused: ask again.
  return eventually(
             [this] {
               std::this_thread::sleep_for(milliseconds(20));
               const auto reply = say(Verb::kEnable);
               return reply && reply->is_accepted;
             },
             kPatience) &&
         wait_for(State::kReady, kPatience);
}

bool Plant::stream(const std::vector<ClBlock>& blocks,
                   const std::function<bool(const stream::Station&)>& until,
                   milliseconds patience) {
  (void)eventually([this] {
    return requests_.matched_readers() > 0 && batches_.matched_readers() > 0 &&
           credits_.matched_writers() > 0;
  });
  dds::SessionRequest open;
  open.session = 1000 + ++session_;
  open.station = "test";
  open.program = "small program";
  open.block_count = blocks.size();
  station_ = std::make_unique<stream::Station>(open, [blocks, next = std::size_t{0}]() mutable {
    if (next == blocks.size()) return stream::Supply{};
    return stream::Supply{stream::Supply::Kind::kBlock, blocks[next++]};
  });
  return stream_on(until, patience);
}

bool Plant::stream_on(const std::function<bool(const stream::Station&)>& until,
                      milliseconds patience) {
  dds::Batch batch;
  dds::Credit credit;
  const bool has_ended = eventually(
      [&] {
        if (const auto request = station_->due_request(now_ns())) (void)requests_.write(*request);
        while (credits_.take(credit)) station_->on_credit(credit, now_ns());
        while (station_->next_batch(now_ns(), batch)) {
          if (!batches_.write(batch)) station_->on_not_sent();
        }
        look();
        return until(*station_) || station_->is_over();
      },
      patience);
  return has_ended && until(*station_);
}

std::vector<ClBlock> small_program(int blocks, double feed_mm_per_min, double step_mm,
                                   const std::string& machine) {
  const MachineModel model = config::load_machine(machine_file(machine));
  JointVector home{};
  for (int i = 0; i < model.joint_count; ++i) {
    home[static_cast<std::size_t>(i)] = model.joints[static_cast<std::size_t>(i)].home;
  }
  const ToolPose start = forward(model, model.tool_length_mm, home);
  std::vector<ClBlock> program;
  for (int i = 0; i < blocks; ++i) {
    const double angle_rad = units::rad_from_deg(10 + i % 7);
    const double turn_rad = units::rad_from_deg(20 + 1.5 * (i % 11));
    const Vector3 axis(std::sin(angle_rad) * std::cos(turn_rad),
                       std::sin(angle_rad) * std::sin(turn_rad), std::cos(angle_rad));
    const Vector3 tip =
        start.tip + Vector3(step_mm * i, i % 2 == 0 ? 0 : step_mm, -5 + 0.1 * (i % 5));
    ClBlock block;
    block.sequence = static_cast<std::uint64_t>(i);
    block.line = static_cast<std::uint32_t>(i + 1);
    block.kind = i == 0 ? BlockKind::kRapid : BlockKind::kCut;
    block.feed_meaning = i == 0 ? FeedMeaning::kNone : FeedMeaning::kTip;
    block.feed = i == 0 ? 0 : units::per_s_from_per_min(feed_mm_per_min);
    block.tip_mm = to_array(tip);
    block.axis = to_array(axis.normalized());
    program.push_back(block);
  }
  return program;
}

}  // namespace meridian::test
