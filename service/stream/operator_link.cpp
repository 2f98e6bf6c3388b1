// SPDX-License-Identifier: Apache-2.0
#include "service/stream/operator_link.hpp"

#include <algorithm>
#include <random>
#include <utility>

#include "meridian/rt/state_table.hpp"

namespace meridian::stream {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kRepeat{300};
/// A dry run that was told on just now is in the status by then.
constexpr std::chrono::milliseconds kTold{300};

}  // namespace

std::uint64_t draw_id() {
  std::random_device device;
  const std::uint64_t id = (std::uint64_t{device()} << 32U) | device();
  return id != 0 ? id : 1;
}

OperatorLink::OperatorLink(dds::Participant& participant, std::string operator_name)
    : name_(std::move(operator_name)),
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
  if (!followed_.take(statuses_, status)) return false;
  status_ = status;
  return true;
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
                  " refused: it is for a dry run alone, and the machine tells of none; nothing was "
                  "asked of it"};
}

std::optional<dds::Reply> OperatorLink::ask(Verb verb, double argument, Milliseconds timeout) {
  dds::CommandRequest request;
  request.request = ++request_;
  request.operator_id = operator_id_;
  request.operator_name = name_;
  request.verb = verb;
  request.argument = argument;
  const bool is_for_dry_run = may_be_dry(verb) && argument != 0;
  const auto begin = Clock::now(), end = begin + timeout;
  const auto told = begin + std::min<Clock::duration>(kTold, timeout / 2);
  auto due = begin;
  bool is_quoted = false;
  for (auto now = due; now < end; now = Clock::now()) {
    static_cast<void>(take_statuses());
    const bool may_send = status_ && (!is_for_dry_run || status_->is_dry_run);
    was_matched_ = was_matched_ || commands_.matched_readers() > 0;
    // What was seen when it was said: who is cut off then says nothing about what he sees later.
    if (may_send && was_matched_ && !std::exchange(is_quoted, true)) {
      request.epoch_seen = status_->epoch;
      request.status_seen = status_->status_sequence;
      request.service_id_seen = status_->service_id;
    }
    const bool was_sent = due > begin;
    if (status_ && !may_send && !was_sent && now >= told) return refuse_as_not_dry(request);
    if (now >= due && may_send && commands_.matched_readers() > 0) {
      static_cast<void>(commands_.write(request));
      due = now + kRepeat;
    }
    dds::Reply reply;
    while (replies_.take(reply)) {
      if (reply.operator_id == operator_id_ && reply.request == request_) return reply;
    }
    constexpr Milliseconds kLook{20};
    waitset_.wait(std::min<Clock::duration>(end - now, kLook));
  }
  return std::nullopt;
}

std::optional<State> OperatorLink::wait_for_state(
    const dds::Reply& reply, const std::function<bool(State)>& is_there,
    const std::function<void(const dds::Status&)>& look, Milliseconds timeout) {
  if (is_there(reply.state)) return reply.state;
  const auto begin = Clock::now(), end = begin + timeout;
  // A status that left before the verb took effect may still come in: the first one that counts
  // shows the state of the reply, or comes so late that it must be younger.
  bool counts = false;
  for (auto now = begin; now < end; now = Clock::now()) {
    const auto left = std::chrono::duration_cast<Milliseconds>(end - now);
    if (!wait_for_status(std::max(left, Milliseconds{1}))) continue;
    look(*status_);
    counts = counts || status_->state == reply.state || Clock::now() - begin > kRepeat;
    if (counts && is_there(status_->state)) return status_->state;
  }
  return std::nullopt;
}

}  // namespace meridian::stream
