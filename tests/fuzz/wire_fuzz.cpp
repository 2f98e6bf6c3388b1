// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>

#include "fuzz/dry_machine.hpp"
#include "fuzz/fuzz_targets.hpp"
#include "fuzz/wire_samples.hpp"
#include "meridian/cycle/state_table.hpp"
#include "service/cli/status_text.hpp"
#include "service/daemon/listeners/feedback_merge.hpp"
#include "service/daemon/listeners/jog_intake.hpp"
#include "service/daemon/listeners/lease_check.hpp"
#include "service/daemon/ports/command_port.hpp"
#include "service/drives/kit/actions/action_words.hpp"
#include "service/drives/simulated/action_peer.hpp"
#include "service/drives/simulated/drive_group.hpp"
#include "service/protocol/freshness.hpp"
#include "service/protocol/intake_check.hpp"
#include "service/protocol/station/station.hpp"
#include "service/transport/convert/convert.hpp"
#include "support/machines.hpp"
#include "support/programs.hpp"

namespace meridian::fuzz {
namespace {

WireChoices& choices() {
  static WireChoices seen;
  return seen;
}

constexpr std::uint64_t kServiceId = 7;

/// Notes that a sample had, or had not, what it may have.
bool choose(WireChoice choice, bool is_there) {
  choices()[choice][is_there ? 1 : 0] = true;
  return is_there;
}

/// Reads bytes from the front; what is missing is zero.
class Supplies {
 public:
  explicit Supplies(Bytes bytes) : bytes_(bytes) {}
  [[nodiscard]] bool is_empty() const { return bytes_.empty(); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void take(T& value) {
    std::memset(&value, 0, sizeof value);
    const std::size_t size = std::min(sizeof value, bytes_.size());
    std::memcpy(&value, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  template <class T>
  [[nodiscard]] T next() {
    T value;
    take(value);
    return value;
  }
  /// A message as it comes off the wire.
  template <class Wire, class Message>
  void read(Message& message) {
    static Wire wire;  // some are larger than a stack should hold
    take(wire);
    dds::from_wire(wire, message);
  }

 private:
  Bytes bytes_;
};

/// Everybody who acts on a sample, with the state that samples before have left.
class Listeners {
 public:
  Listeners()
      : model_(test::lai_machine()),
        intake_(model_, {{1, 100.0}}, kServiceId),
        machine_that_obeys_(model_),
        drives_(model_, {}) {
    lease_.hold(now_ns_);
    dds::SessionRequest open;
    open.session = 1;
    static_cast<void>(intake_.on_request(open, around(), model_.tool_length_mm));
    station_.emplace(open, [next = std::uint64_t{0}]() mutable {
      if (next == 50) return stream::Supply{};
      return stream::Supply{stream::Supply::Kind::kBlock, test::good_cut(next++), {}};
    });
  }

  void take(Supplies& in) {
    now_ns_ += 10'000'000;
    switch (in.next<std::uint8_t>() % kTypes) {
      case kBatch:
        return take_batch(in);
      case kRawBatch:
        return take_raw_batch(in);
      case kSession:
        return take_session(in);
      case kCredit:
        return take_credit(in);
      case kCommand:
        return take_command(in);
      case kReply:
        return take_reply(in);
      case kJog:
        return take_jog(in);
      case kSetpoint:
        return take_setpoint(in);
      case kDriveCommand:
        return take_drive_command(in);
      case kFeedback:
        return take_feedback(in);
      case kAction:
        return take_action(in);
      case kActionDone:
        return in.read<meridian_wire_ActionDone>(done_);
      case kStatus:
        return take_status(in);
      case kMachine:
        return take_machine(in);
      default:
        return take_latency(in);
    }
  }

 private:
  [[nodiscard]] stream::IntakeContext around() const {
    return {.now_ns = now_ns_, .free_slots = 100, .actions = {.is_there = true}};
  }

  /// A few blocks with a CRC that is right, so that the check looks at them.
  void take_batch(Supplies& in) {
    dds::Batch batch;
    batch.session = in.next<std::uint8_t>() % 3;
    batch.first_sequence = in.next<std::uint8_t>();
    batch.count = in.next<std::uint8_t>() % 34;
    batch.is_end = in.next<std::uint8_t>() % 4 == 0;
    const std::size_t given = std::min<std::size_t>(batch.count, 3);
    for (std::size_t i = 0; i < dds::kBatchBlocks; ++i) {
      if (i >= given) {
        batch.blocks[i] = test::good_cut(batch.first_sequence + i);
        continue;
      }
      wire_batch_ = {};
      in.take(wire_batch_.blocks[0]);
      dds::Batch one;
      dds::from_wire(wire_batch_, one);
      batch.blocks[i] = one.blocks[0];
    }
    batch.crc = dds::batch_crc(batch);
    check(batch);
  }
  void take_raw_batch(Supplies& in) {
    dds::Batch batch;
    in.read<meridian_wire_ClBatch>(batch);
    check(batch);
  }
  void check(const dds::Batch& batch) {
    const std::uint64_t before = intake_.next_sequence();
    stream::Accepted accepted;
    static_cast<void>(intake_.on_batch(batch, around(), accepted));
    require(accepted.count <= accepted.blocks.size(), "more blocks than a batch holds");
    for (std::size_t i = 0; i < accepted.count; ++i) {
      const ClBlock& block = accepted.blocks[i];
      require(block.sequence == before + i, "a block out of turn");
      require(block.kind <= BlockKind::kEnd, "a kind of block that is none");
      if (!is_motion(block.kind)) continue;
      require(to_vector(block.tip_mm).allFinite(), "a tip that is no number");
      require(std::abs(to_vector(block.axis).norm() - 1) < 1e-9, "an axis that is no unit vector");
      require(std::isfinite(block.feed), "a feed that is no number");
      require(block.feed > 0 || block.kind != BlockKind::kCut, "a cut without feed");
      if (block.kind != BlockKind::kCut) continue;
      require(block.feed_meaning <= FeedMeaning::kInverseTime, "a feed that means nothing");
      choose(kInverseTime, block.feed_meaning == FeedMeaning::kInverseTime);
      choose(kArc, block.is_arc);
    }
  }
  void take_session(Supplies& in) {
    dds::SessionRequest request;
    in.read<meridian_wire_ClSession>(request);
    request.session %= 4;
    static_cast<void>(intake_.on_request(request, around(), model_.tool_length_mm));
    require(intake_.session() < 4, "a session that nobody opened");
  }
  void take_credit(Supplies& in) {
    dds::Credit credit;
    in.read<meridian_wire_ClCredit>(credit);
    credit.session %= 3;
    station_->on_credit(credit, now_ns_);
    static dds::Batch batch;
    for (int n = 0; n < 4 && station_->next_batch(now_ns_, batch); ++n) {
      require(batch.first_sequence + batch.count <= 50, "blocks that are not in the program");
      require(batch.count <= dds::kBatchBlocks, "more blocks than a batch holds");
    }
  }
  void take_command(Supplies& in) {
    dds::CommandRequest request;
    const unsigned how = in.next<std::uint8_t>();
    const std::uint64_t rest = (how & 0x7FU) % 3, reported = in.next<std::uint8_t>() % 3;
    in.read<meridian_wire_Command>(request);
    times_.published(5, now_ns_, reported);
    const Refusal refusal = stream::check_freshness(request, kServiceId, 1, times_, now_ns_, rest);
    if (static_cast<int>(request.verb) >= kVerbCount) return;  // as the supervisor does
    require(refusal == Refusal::kNone || stream::needs_freshness(request.verb, request.argument),
            "a stop is stale");
    const bool sends_on = request.verb == Verb::kStart || request.verb == Verb::kResume;
    if (refusal == Refusal::kNone && sends_on) {
      require(rest == 0 || (request.status_seen == 5 && reported == rest),
              "sent on from another rest");
      choose(kRest, rest != 0);
    }
    if (refusal != Refusal::kNone) return;
    if (may_be_dry(request.verb)) choose(kForDryRunAlone, request.argument == 1);
    if (port_.stage({++request_, request.verb, request.argument})) {
      asked_[request_ % asked_.size()] = request.operator_id;
    }
    if ((how & 0x80U) == 0) obey();
  }
  /// The cycle takes what waits for it.
  void obey() {
    port_.publish();
    std::uint64_t stopped = 0;
    for (Command command; port_.try_pop(command);) {
      require(!is_stop(command.verb) || stopped < command.request, "stops out of turn");
      if (is_stop(command.verb)) stopped = command.request;
      choose(kOvertakenByStop, !machine_that_obeys_.say(command));
      const bool has_hand = command.verb == Verb::kJog && machine_that_obeys_.is_jogging();
      if (has_hand) {
        hands_.begin(asked_[command.request % asked_.size()], kParticipant, command.request);
      }
    }
    if (!machine_that_obeys_.is_jogging()) hands_.end();
  }
  static constexpr std::uint64_t kParticipant = 4711;
  void take_jog(Supplies& in) {
    dds::Jog jog;
    in.read<meridian_wire_Jog>(jog);
    const auto order = hands_.take(jog, kParticipant, machine_that_obeys_.epoch(),
                                   model_.joint_count, model_.tool_length_mm,
                                   times_.superseded_for(jog.status_seen, now_ns_, 50'000'000));
    if (!choose(kHandOnAJoint, order.has_value())) return;
    require(order->sample == ++orders_, "orders out of turn");
    require(std::isfinite(order->velocity) && order->distance >= 0, "an order without a number");
    require(order->joint < model_.joint_count, "no such joint");
    require(order->dead_man_s > 0 && order->dead_man_s <= kLongestDeadMan_s, "no dead man's time");
    require(order->age_s >= 0, "an order of the future");
    machine_that_obeys_.hold(*order);
    if (!machine_that_obeys_.is_jogging()) hands_.end();
  }
  void take_reply(Supplies& in) {
    dds::Reply reply;
    in.read<meridian_wire_Reply>(reply);
    require(cli::text_of(reply.state) != nullptr, "a state without words");
    choose(kReplyOfDryRun, reply.text.starts_with("dry run: "));
    choose(kReplyWithApproach, reply.text.find("approach to line ") < reply.text.size());
  }
  void take_setpoint(Supplies& in) {
    dds::SetpointSample setpoint;
    in.read<meridian_wire_Setpoint>(setpoint);
    const std::uint64_t before = drives_.setpoints_seen();
    const std::uint64_t sender = 40 + in.next<std::uint8_t>() % 3U;
    // Else no seed gets past the checksum.
    if (sender != 42) setpoint.crc = dds::setpoint_crc(setpoint.setpoint, 1);
    drives_.take(setpoint, sender);
    const bool is_dry = choose(kSetpointOfDryRun, (setpoint.setpoint.flags & kSetpointDry) != 0);
    require(!is_dry || drives_.setpoints_seen() == before, "drives follow a dry run");
    work_drives();
  }
  void take_drive_command(Supplies& in) {
    dds::DriveCommand command;
    in.read<meridian_wire_DriveCommand>(command);
    command.drive %= 8;
    command.service_id %= 3;
    drives_.take(command, 40 + command.service_id);
    drives_.see_master(command.mode != 0);
    work_drives();
  }
  void work_drives() {
    drives_.work(1);
    for (const double x : drives_.feedback().position) {
      require(std::isfinite(x), "a drive whose position is no number");
    }
  }
  void take_feedback(Supplies& in) {
    dds::DriveFeedback sample;
    const unsigned how = in.next<std::uint8_t>();
    const std::uint64_t source = how % 8;
    in.read<meridian_wire_Feedback>(sample);
    if ((how & 0x40U) != 0) merge_.forget(source, now_ns_, (how & 0x20U) != 0);
    static_cast<void>(merge_.take(sample, source, now_ns_, (how & 0x80U) != 0));
    std::uint32_t bound = 0;
    for (const interpolator::DriveSource& slot : merge_.sources().slots) {
      require((bound & slot.bound_mask) == 0, "a joint that two sources have");
      bound |= slot.bound_mask;
    }
    const Feedback& feedback = merge_.feedback();
    require((feedback.joint_mask >> kMaxJoints) == 0, "joints that no machine has");
    require(feedback.joint_mask == 0 || feedback.arrival_ns <= now_ns_, "feedback of the future");
  }
  void take_action(Supplies& in) {
    dds::Action action;
    in.read<meridian_wire_Action>(action);
    require(!drive::describe(action).empty(), "an action without words");
    peer_.take(action, now_ns_);
    const auto answer = peer_.due_answer(now_ns_);
    require(answer && answer->id == action.id, "an answer to another action");
  }
  void take_status(Supplies& in) {
    in.read<meridian_wire_Status>(status_);
    choose(kStatusOfDryRun, status_.is_dry_run);
    choose(kSingleBlock, status_.is_single_block);
    choose(kOptionalStops, status_.stops_at_optional);
    choose(kStatusWithApproach, status_.message.find("approach to line ") != std::string::npos);
    choose(kStatusWithSummary, status_.message.find(" ran to its end") != std::string::npos);
    show();
  }
  void take_machine(Supplies& in) {
    in.read<meridian_wire_Machine>(machine_);
    require(machine_.joint_count <= kMaxJoints, "joints that no machine has");
    machine_.service_id %= 3;
    const auto bridge = drive::bridge_of(machine_, 40 + machine_.service_id % 3);
    if (bridge) drives_.take(*bridge);
    work_drives();
    check_lease();
    show();
  }
  void check_lease() {
    const std::uint64_t other = machine_.service_id;
    lease_.hear({other, machine_.is_serving, machine_.served_ns}, now_ns_);
    lease_.check(now_ns_, machine_.pid % 2 == 0);
    if (lease_.has_to_speak(now_ns_)) lease_.on_said(lease_.word(now_ns_), now_ns_);
    now_ns_ += interpolator::LeaseCheck::kStepBack_ns;
    const auto keeper = lease_.keeper(now_ns_);
    choose(kLeaseLeft, keeper.has_value());
    require(!keeper || *keeper < 3, "left to a service that nobody heard");
    require(!keeper || !lease_.word(now_ns_).is_serving, "left while it is served");
  }
  void show() {
    const std::string words = cli::describe(status_, machine_);
    require(!words.empty(), "a status without words");
    require(!status_.is_dry_run || words.find("dry run: no drive moves") < words.size(),
            "a dry run that nobody sees");
    require(cli::to_json(status_, machine_).back() == '}', "JSON without an end");
  }
  void take_latency(Supplies& in) {
    dds::Latency latency;
    in.read<meridian_wire_Latency>(latency);
    require(latency.histograms.size() <= dds::kMaxHistograms, "more histograms than there are");
  }

  MachineModel model_;
  std::int64_t now_ns_ = 1'000'000'000;
  stream::IntakeCheck intake_;
  std::optional<stream::Station> station_;
  stream::StatusTimes times_;
  DryMachine machine_that_obeys_;
  drives::DriveGroup drives_;
  drives::ActionPeer peer_{0, false};
  interpolator::FeedbackMerge merge_;
  dds::Status status_;
  dds::MachineInfo machine_;
  interpolator::CommandPort port_;
  interpolator::JogIntake hands_{kServiceId};
  interpolator::LeaseCheck lease_{kServiceId};
  std::array<std::uint64_t, 128> asked_{};  ///< who said which request
  std::uint64_t request_ = 0, orders_ = 0;
  dds::ActionDone done_;
  meridian_wire_ClBatch wire_batch_{};
};

}  // namespace

const WireChoices& wire_choices() { return choices(); }

void check_wire(Bytes bytes) {
  Listeners listeners;
  Supplies supplies(bytes);
  for (int n = 0; n < 64 && !supplies.is_empty(); ++n) listeners.take(supplies);
}

}  // namespace meridian::fuzz
