// SPDX-License-Identifier: Apache-2.0
#include "property/protocol/protocol_model.hpp"

#include <algorithm>
#include <utility>

namespace meridian::stream {

void Protocol::deliver(const ToService& message, bool is_spoilt) {
  if (message.is_open) {
    dds::SessionRequest request;
    request.session = message.session;
    request.station = "s";
    answer(intake_->on_request(request, context(), model_->tool_length_mm));
    return;
  }
  dds::Batch batch =
      test::good_batch(message.session, message.first, message.count, message.is_end);
  if (is_spoilt) {
    batch.blocks[0].tip_mm[1] = 1;
    if (variant_ == Variant::kTrustsTheWire) batch.crc = dds::batch_crc(batch);
  }
  const bool is_twice = batch.session == intake_->session() && message.count > 0 &&
                        message.first < intake_->next_sequence();
  Accepted accepted;
  const auto credit = intake_->on_batch(batch, context(), accepted);
  push(accepted, message.session);
  if (variant_ == Variant::kRunsDuplicates && is_twice && accepted.count == 0) {
    accepted.blocks[0] = batch.blocks[0];
    accepted.count = 1;
    push(accepted, message.session);
  }
  answer(credit);
}

void Protocol::push(const Accepted& accepted, std::uint64_t session) {
  if (accepted.count == 0) return;
  if (queue_session_ != session) {
    if (!queue_.empty()) wrong_ = "two programs in one queue";
    queue_session_ = session;
    pushed_ = ran_ = 0;
    has_end_ = false;
  }
  for (std::size_t i = 0; i < accepted.count; ++i) {
    const ClBlock& block = accepted.blocks[i];
    if (has_end_) wrong_ = "a block after the end";
    if (block.sequence != pushed_) wrong_ = "a block is missing or comes twice";
    has_end_ = block.kind == BlockKind::kEnd;
    if (has_end_ && pushed_ != bounds_.blocks) wrong_ = "the program ends too soon";
    if (!has_end_ && block.tip_mm != test::good_cut(block.sequence).tip_mm) {
      wrong_ = "a spoilt block got through";
    }
    ++pushed_;
    queue_.push_back(block.sequence);
  }
  if (queue_.size() > bounds_.slots + kReserve) wrong_ = "more blocks than places";
}

void Protocol::run_block() {
  queue_.erase(queue_.begin());
  ++ran_;
  ran_of_[queue_session_] = ran_;
  if (queue_.empty() && has_end_) {
    answer(intake_->on_program_end(context()));
  }
}

bool Protocol::work_station() {
  if (const auto request = station_->due_request(now_)) {
    send({.session = session_, .is_open = true});
    return true;
  }
  dds::Batch batch;
  if (!station_->next_batch(now_, batch)) return false;
  send({session_, batch.first_sequence, batch.count, false, batch.is_end});
  return true;
}

Protocol::Steps Protocol::steps() const {
  Steps all;
  const auto add = [&](const std::string& name, const auto& change) {
    Protocol next = *this;
    change(next);
    all.push_back({name, std::move(next)});
  };
  {
    Protocol next = *this;
    if (next.work_station()) all.push_back({"station sends", std::move(next)});
  }
  for (std::size_t i = 0; i < messages_.size(); ++i) {
    const ToService message = messages_[i];
    const auto at = static_cast<std::ptrdiff_t>(i);
    const std::string what = message.is_open ? "open " + std::to_string(message.session)
                                             : "batch of " + std::to_string(message.session) +
                                                   " from " + std::to_string(message.first);
    const auto take = [at](Protocol& p) { p.messages_.erase(p.messages_.begin() + at); };
    add(what + " comes", [&](Protocol& p) { p.deliver(message, false); });
    add(what + " is gone", take);
    if (message.count == 0) continue;
    add(what + " comes spoilt", [&](Protocol& p) { p.deliver(message, true); });
  }
  for (std::size_t i = 0; i < credits_.size(); ++i) {
    const auto at = static_cast<std::ptrdiff_t>(i);
    const auto take = [at](Protocol& p) { p.credits_.erase(p.credits_.begin() + at); };
    const dds::Credit credit = credits_[i];
    const std::string what = "credit of " + std::to_string(credit.session) + " at " +
                             std::to_string(credit.next_sequence);
    add(what + " comes", [&](Protocol& p) { p.station_->on_credit(credit, p.now_); });
    add(what + " is gone", take);
  }
  add("time goes on", [](Protocol& p) { p.now_ += kTick; });
  add("credit is repeated", [](Protocol& p) { p.answer(p.intake_->due_credit(p.context())); });
  if (!queue_.empty()) add("a block runs", [](Protocol& p) { p.run_block(); });
  if (bounds_.station_restarts > 0) {
    add("station is killed, another one comes", [](Protocol& p) {
      --p.bounds_.station_restarts;
      p.lost_session_ = p.session_;
      p.start_station();
    });
  }
  if (lost_session_ != 0) {
    add("service sees that the station is gone",
        [](Protocol& p) { p.intake_->on_station_lost(std::exchange(p.lost_session_, 0)); });
  }
  if (bounds_.service_restarts > 0) {
    add("service is killed, another one comes", [](Protocol& p) {
      --p.bounds_.service_restarts;
      p.messages_.clear();
      p.credits_.clear();
      p.start_service();
    });
  }
  if (bounds_.aborts > 0 && intake_->is_held()) {
    add("operator aborts", [](Protocol& p) {
      --p.bounds_.aborts;
      p.clear_queue();
      p.answer(p.intake_->on_queues_emptied("abort", p.context()));
    });
  }
  return all;
}

bool Protocol::comes_to_an_end() const {
  Protocol p = *this;
  for (int round = 0; round < 40 && !p.is_settled(); ++round) {
    if (p.lost_session_ != 0) p.intake_->on_station_lost(std::exchange(p.lost_session_, 0));
    while (!p.messages_.empty()) {
      const ToService message = p.messages_.front();
      p.messages_.erase(p.messages_.begin());
      p.deliver(message, false);
    }
    for (const dds::Credit& credit : std::exchange(p.credits_, {})) {
      p.station_->on_credit(credit, p.now_);
    }
    if (p.newest_) p.station_->on_credit(*p.newest_, p.now_);
    while (!p.queue_.empty()) p.run_block();
    // A machine that waits for a station that never comes back is freed by its operator.
    const bool is_stuck = p.intake_->is_held() && p.intake_->session() != p.session_;
    if (is_stuck && round > 10) p.answer(p.intake_->on_queues_emptied("abort", p.context()));
    p.answer(p.intake_->due_credit(p.context()));
    while (p.work_station()) {
    }
    p.now_ += kTick;
  }
  return p.is_settled();
}

std::string Protocol::complaint() const {
  if (!wrong_.empty()) return wrong_;
  if (station_->state() == StationState::kRan && ran_of_[session_] != bounds_.blocks + 1) {
    return "the station is answered that everything ran, which it did not";
  }
  const std::uint64_t known = station_->credit().service_id;
  const bool is_streaming = station_->state() == StationState::kStreaming;
  if (is_streaming && known != service_id_ && intake_->next_sequence() > 0) {
    return "a restarted service keeps the head of a program";
  }
  if (variant_ == Variant::kRight && !comes_to_an_end())
    return "the wire is good again and the station never comes to an end";
  return "";
}

/// Everything that later behaviour depends on, asked of copies: what station and service would say
/// now and after a while.
std::string Protocol::key() const {
  std::string key;
  const auto add = [&key](auto... values) {
    ((key += std::to_string(static_cast<std::uint64_t>(values)) + ","), ...);
  };
  const auto add_credit = [&](const dds::Credit& credit) {
    add(credit.session, credit.service_id, credit.next_sequence, credit.credits, credit.verdict);
  };
  add(bounds_.station_restarts, bounds_.service_restarts, bounds_.aborts, session_, service_id_,
      lost_session_, queue_session_, pushed_, ran_, has_end_, ran_of_[session_]);
  for (const std::uint64_t sequence : queue_) add(sequence);
  key += '|';
  auto messages = messages_;
  std::sort(messages.begin(), messages.end());
  for (const ToService& m : messages) add(m.session, m.first, m.count, m.is_open, m.is_end);
  key += '|';
  std::vector<std::string> credits;
  for (const dds::Credit& credit : credits_) {
    std::string outer;
    std::swap(outer, key);
    add_credit(credit);
    std::swap(outer, key);
    credits.push_back(outer);
  }
  std::sort(credits.begin(), credits.end());
  for (const std::string& credit : credits) key += credit + ";";
  key += '|';
  if (newest_) add_credit(*newest_);
  key += '|';
  add(station_->state(), station_->progress().acknowledged, station_->credit().service_id,
      Station(*station_).due_request(now_).has_value());
  for (const std::int64_t later : {std::int64_t{0}, kTick}) {
    Station copy = *station_;
    dds::Batch batch;
    while (copy.next_batch(now_ + later, batch))
      add(batch.first_sequence, batch.count, batch.is_end);
    key += ';';
  }
  key += '|';
  IntakeCheck copy = *intake_;
  add(copy.due_credit(context()).has_value());
  IntakeContext later = context();
  later.now_ns += kTick;
  if (const auto credit = IntakeCheck(*intake_).due_credit(later)) add_credit(*credit);
  for (std::uint64_t session = 1; session <= session_; ++session) {
    if (session == intake_->session()) continue;
    Accepted accepted;
    const auto last = copy.on_batch(test::good_batch(session, 0, 1), context(), accepted);
    if (last) add_credit(*last);
  }
  return key + wrong_;
}

}  // namespace meridian::stream
