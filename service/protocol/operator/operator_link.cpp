// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/operator/operator_link.hpp"

#include <algorithm>
#include <random>
#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "service/transport/sources.hpp"

namespace meridian::stream {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kRepeat{300};
/// A dry run that was switched on just now is in the status by then.
constexpr std::chrono::milliseconds kReported{300};
/// Whoever publishes a status for this machine is known by then: discovery, and two statuses.
constexpr std::chrono::milliseconds kEverybodySeen{400};
/// A service that was silent for so long speaks no more.
constexpr std::chrono::milliseconds kSilent{1500};
constexpr std::size_t kMaxServices = 16;

}  // namespace

std::uint64_t draw_id() {
  std::random_device device;
  const std::uint64_t id = (std::uint64_t{device()} << 32U) | device();
  return id != 0 ? id : 1;
}

OperatorLink::OperatorLink(dds::Participant& participant, std::string operator_name)
    : name_(std::move(operator_name)),
      participant_(participant),
      participant_number_(dds::number_of(participant)),
      operator_id_(draw_id()),
      commands_(participant),
      replies_(participant),
      statuses_(participant),
      waitset_(participant) {
  waitset_.attach(replies_);
  waitset_.attach(statuses_);
}

bool OperatorLink::take_statuses() {
  dds::Status status;
  const auto see_it = [this](const dds::Status& any, std::uint64_t source) { see(any, source); };
  const bool has_news = followed_.take(statuses_, status, see_it);
  const auto now = Clock::now();
  std::erase_if(services_, [now](const Service& known) { return now - known.seen > kSilent; });
  if (!has_news) return false;
  status_ = status;
  return true;
}

void OperatorLink::see(const dds::Status& status, std::uint64_t source) {
  const auto known =
      std::find_if(services_.begin(), services_.end(),
                   [source](const Service& service) { return service.source == source; });
  if (known != services_.end()) {
    known->seen = Clock::now();
    known->service_id = status.service_id;
  } else if (services_.size() < kMaxServices) {
    services_.push_back({.source = source,
                         .participant = dds::participant_of(statuses_.handle(), source),
                         .service_id = status.service_id,
                         .seen = Clock::now(),
                         .reply = {}});
  }
}

std::vector<std::string> OperatorLink::services() const {
  std::vector<std::string> names;
  for (const Service& service : services_) {
    names.push_back(dds::describe_source(participant_, statuses_.handle(), service.source));
  }
  return names;
}

void OperatorLink::take_replies(Verb verb) {
  dds::Reply reply;
  dds::SampleInfo info;
  while (replies_.take(reply, info)) {
    const bool is_ours = info.is_valid && reply.operator_id == operator_id_ &&
                         reply.request == request_ && reply.verb == verb &&
                         reply.requester == participant_number_;
    if (!is_ours) continue;
    const std::uint64_t sender = dds::participant_of(replies_.handle(), info.source);
    for (Service& service : services_) {
      const bool is_its = service.participant == sender && service.service_id == reply.service_id;
      if (is_its && !service.reply) service.reply = reply;
    }
  }
}

/// Of a stop the refusal where one refuses it, and none before everybody who speaks has answered.
std::optional<dds::Reply> OperatorLink::answer(Verb verb) const {
  std::optional<dds::Reply> answer;
  bool is_complete = true;
  for (const Service& service : services_) {
    if (!is_stop(verb) && service.source != followed_.source()) continue;
    if (!service.reply) {
      is_complete = false;
    } else if (!answer || !service.reply->is_accepted) {
      answer = service.reply;
    }
  }
  if (!is_stop(verb)) return answer;
  const bool is_everybody_seen = Clock::now() - made_ > kEverybodySeen;
  return is_complete && is_everybody_seen ? answer : std::nullopt;
}

bool OperatorLink::wait_for_status(Milliseconds timeout) {
  const auto end = Clock::now() + timeout;
  while (!take_statuses()) {
    const auto now = Clock::now();
    if (now >= end) return false;
    dds::Reply ignored;
    while (replies_.take(ignored)) {
    }
    waitset_.wait(end - now);
  }
  return true;
}

dds::Reply OperatorLink::refuse_as_not_dry(const dds::CommandRequest& request) const {
  return {.request = request.request,
          .operator_id = operator_id_,
          .service_id = status_->service_id,
          .verb = request.verb,
          .refusal = Refusal::kNotDryRun,
          .state = status_->state,
          .epoch = status_->epoch,
          .text = std::string(name_of(request.verb)) +
                  " refused: it is for a dry run alone, and the machine reports none; nothing was "
                  "asked of it"};
}

std::optional<dds::Reply> OperatorLink::ask(Verb verb, double argument, Milliseconds timeout,
                                            const std::optional<Seen>& seen) {
  dds::CommandRequest request;
  request.verb = verb;
  request.argument = argument;
  return ask(std::move(request), timeout, seen);
}

std::optional<dds::Reply> OperatorLink::ask(const FrameOrder& order, Milliseconds timeout) {
  dds::CommandRequest request;
  request.verb = Verb::kFrame;
  request.frame = order;
  return ask(std::move(request), timeout, std::nullopt);
}

std::optional<dds::Reply> OperatorLink::ask(const LimitsOrder& order, Milliseconds timeout) {
  dds::CommandRequest request;
  request.verb = Verb::kLimits;
  request.limits = order;
  return ask(std::move(request), timeout, std::nullopt);
}

std::optional<dds::Reply> OperatorLink::ask_for_tools(std::string text, std::uint64_t tools_seen,
                                                      Milliseconds timeout) {
  dds::CommandRequest request;
  request.verb = Verb::kTool;
  request.tools_seen = tools_seen;
  request.tool_file = std::move(text);
  return ask(std::move(request), timeout, std::nullopt);
}

std::optional<dds::Reply> OperatorLink::ask(dds::CommandRequest request, Milliseconds timeout,
                                            const std::optional<Seen>& seen) {
  request.request = ++request_;
  request.operator_id = operator_id_;
  request.operator_name = name_;
  const Verb verb = request.verb;
  const double argument = request.argument;
  for (Service& service : services_) service.reply.reset();
  const bool is_for_dry_run = is_said_dry(verb, argument);
  const auto begin = Clock::now(), end = begin + timeout;
  const auto reported_by = begin + std::min<Clock::duration>(kReported, timeout / 2);
  auto due = begin;
  bool is_quoted = false;
  for (auto now = due; now < end; now = Clock::now()) {
    static_cast<void>(take_statuses());
    const bool may_send = is_stop(verb) || (status_ && (!is_for_dry_run || status_->is_dry_run));
    was_matched_ = was_matched_ || commands_.matched_readers() > 0;
    // What was seen when it was said: who is cut off then says nothing about what he sees later.
    if (may_send && was_matched_ && status_ && !std::exchange(is_quoted, true)) {
      request.epoch_seen = seen ? seen->epoch : status_->epoch;
      request.status_seen = seen ? seen->status_sequence : status_->status_sequence;
      request.service_id_seen = seen ? seen->service_id : status_->service_id;
    }
    const bool was_sent = due > begin;
    if (status_ && !may_send && !was_sent && now >= reported_by) return refuse_as_not_dry(request);
    if (now >= due && may_send && commands_.matched_readers() > 0) {
      static_cast<void>(commands_.write(request));
      due = now + kRepeat;
    }
    take_replies(verb);
    if (const auto reply = status_ ? answer(verb) : std::nullopt) return reply;
    constexpr Milliseconds kLook{20};
    waitset_.wait(std::min<Clock::duration>(end - now, kLook));
  }
  return std::nullopt;
}

std::optional<State> OperatorLink::wait_for_state(
    const dds::Reply& reply, const std::function<bool(State)>& is_there,
    const std::function<void(const dds::Status&)>& look, Milliseconds timeout) {
  if (is_there(reply.state)) return reply.state;
  // What came with the reply is no younger than that, and may be of its state already.
  bool counts = take_statuses() && status_->state == reply.state;
  const std::uint64_t seen = status_ ? status_->status_sequence : 0;
  const auto begin = Clock::now(), end = begin + timeout;
  // A status that was made before the verb took effect may still come in, however late where the
  // service is held up: the first one that counts shows the state of the reply, or comes late and
  // behind another one.
  for (auto now = begin; now < end; now = Clock::now()) {
    const auto left = std::chrono::duration_cast<Milliseconds>(end - now);
    if (!wait_for_status(std::max(left, Milliseconds{1}))) continue;
    look(*status_);
    const bool is_of_another = status_->service_id != reply.service_id;
    const bool is_second = is_of_another || status_->status_sequence > seen + 1;
    const bool is_younger = is_second && Clock::now() - begin > kRepeat;
    counts = counts || status_->state == reply.state || is_younger;
    if (counts && is_there(status_->state)) return status_->state;
  }
  return std::nullopt;
}

}  // namespace meridian::stream
