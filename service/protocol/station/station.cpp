// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/station.hpp"

#include <algorithm>
#include <utility>

namespace meridian::stream {

using dds::Verdict;

Station::Station(dds::SessionRequest request, Source source, const StationOptions& options)
    : request_(std::move(request)), source_(std::move(source)), options_(options) {
  request_.request = dds::SessionRequestKind::kOpen;
}

std::optional<dds::SessionRequest> Station::due_request(std::int64_t now_ns) {
  if (is_over()) return std::nullopt;
  if (state_ != StationState::kOpening) {
    if (now_ns - std::max(heard_ns_, asked_ns_) < options_.silence_ns) return std::nullopt;
    asked_ns_ = now_ns;
    asking_ = Asking::kAskedAgain;
    return request_;
  }
  const bool is_asked = asking_ != Asking::kNotAsked;
  if (!is_asked) opened_ns_ = now_ns;
  if (is_asked && now_ns - opened_ns_ >= options_.open_timeout_ns) {
    stop(StationState::kNoAnswer, "no service answers for this machine");
    return std::nullopt;
  }
  if (is_asked && now_ns - asked_ns_ < options_.open_repeat_ns) return std::nullopt;
  asking_ = Asking::kAsked;
  asked_ns_ = now_ns;
  return request_;
}

/// Reads from the source until `wanted` blocks wait from the cursor on, or it has no more.
void Station::fill(std::uint64_t wanted) {
  if (source_state_ == SourceState::kWaiting) source_state_ = SourceState::kReady;
  while (source_state_ == SourceState::kReady && progress_.read < cursor_.sequence + wanted) {
    Supply supply = source_();
    switch (supply.kind) {
      case Supply::Kind::kBlock:
        supply.block.sequence = progress_.read++;
        blocks_.push_back(supply.block);
        break;
      case Supply::Kind::kEnd:
        source_state_ = SourceState::kAtEnd;
        break;
      case Supply::Kind::kWait:
        source_state_ = SourceState::kWaiting;
        break;
      case Supply::Kind::kBad:
        stop(StationState::kBadSource, std::move(supply.text));
        return;
    }
  }
}

/// A small batch waits for more credit, unless nothing under way could bring any, and a short while
/// for more blocks of a source that has none just now.
bool Station::is_worth_sending(std::uint64_t count, std::uint64_t there, std::int64_t now_ns) {
  if (count == dds::kBatchBlocks) return true;
  if (count == 0) return false;
  if (count < there) return cursor_.sequence == acknowledged_;
  if (source_state_ != SourceState::kWaiting) return true;
  if (!gathering_since_ns_) gathering_since_ns_ = now_ns;
  return now_ns - *gathering_since_ns_ >= options_.gather_ns;
}

bool Station::next_batch(std::int64_t now_ns, dds::Batch& batch) {
  if (state_ != StationState::kStreaming || asking_ == Asking::kAskedAgain) return false;
  const bool is_waiting = cursor_.sequence > acknowledged_ || cursor_.is_end_sent;
  if (is_waiting && now_ns - progress_ns_ >= options_.resend_after_ns) {
    ++progress_.resends;
    cursor_ = {acknowledged_, false};
    progress_ns_ = now_ns;
  }
  if (cursor_.is_end_sent) return false;
  const std::uint64_t may_send =
      std::min<std::uint64_t>(granted_end_ - cursor_.sequence, dds::kBatchBlocks);
  fill(dds::kBatchBlocks);
  if (state_ != StationState::kStreaming) return false;
  const std::uint64_t there = progress_.read - cursor_.sequence;
  const std::uint64_t count = std::min(may_send, there);
  const bool is_end = source_state_ == SourceState::kAtEnd && count == there;
  if (!is_end && !is_worth_sending(count, there, now_ns)) return false;

  gathering_since_ns_.reset();
  cursor_before_ = cursor_;
  batch.session = request_.session;
  batch.first_sequence = cursor_.sequence;
  batch.count = static_cast<std::uint32_t>(count);
  batch.is_end = is_end;
  const auto from = blocks_.begin() + static_cast<std::ptrdiff_t>(cursor_.sequence - acknowledged_);
  std::copy_n(from, count, batch.blocks.begin());
  batch.crc = dds::batch_crc(batch);
  if (cursor_.sequence == acknowledged_) progress_ns_ = now_ns;
  cursor_ = {cursor_.sequence + count, is_end};
  ++progress_.batches_sent;
  return true;
}

void Station::on_not_sent() noexcept { cursor_ = cursor_before_; }

void Station::on_credit(const dds::Credit& credit, std::int64_t now_ns) {
  if (credit.session != request_.session || is_over()) return;
  if (service_id_ != 0 && credit.service_id != service_id_) {
    stop(StationState::kRefused, "the service was restarted: the session is lost");
    return;
  }
  if (credit.next_sequence > progress_.read) {
    stop(StationState::kRefused, "the service acknowledges blocks that were never sent");
    return;
  }
  service_id_ = credit.service_id;
  heard_ns_ = now_ns;
  asking_ = Asking::kAnswered;
  credit_ = credit;
  if (!credit.text.empty()) message_ = credit.text;
  if (credit.verdict >= Verdict::kRefusedStation) {
    stop(StationState::kRefused, credit.text);
    return;
  }
  if (state_ == StationState::kOpening) {
    state_ = StationState::kStreaming;
    progress_ns_ = now_ns;
  }
  granted_end_ = std::max(granted_end_, credit.next_sequence + credit.credits);
  if (credit.next_sequence > acknowledged_) {
    const std::uint64_t came = credit.next_sequence - acknowledged_;
    blocks_.erase(blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(came));
    acknowledged_ = credit.next_sequence;
    progress_.acknowledged = acknowledged_;
    progress_ns_ = now_ns;
    cursor_.sequence = std::max(cursor_.sequence, acknowledged_);
  }
  if (credit.verdict == Verdict::kComplete) state_ = StationState::kComplete;
  if (credit.verdict == Verdict::kRan) state_ = StationState::kRan;
  if (credit.verdict != Verdict::kGap || credit.next_sequence != acknowledged_) return;
  const bool is_new = went_back_to_ != acknowledged_;
  if (is_new || now_ns - went_back_ns_ >= options_.gap_quiet_ns) {
    if (cursor_.sequence > acknowledged_ || cursor_.is_end_sent) ++progress_.resends;
    went_back_to_ = acknowledged_;
    cursor_ = {acknowledged_, false};
    went_back_ns_ = now_ns;
  }
}

dds::SessionRequest Station::close_request() const {
  dds::SessionRequest request = request_;
  request.request = dds::SessionRequestKind::kClose;
  return request;
}

void Station::stop(StationState state, std::string text) {
  state_ = state;
  message_ = std::move(text);
}

}  // namespace meridian::stream
