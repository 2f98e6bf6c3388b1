// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/lease_check.hpp"

#include <algorithm>

namespace meridian::interpolator {

void LeaseCheck::hold(std::int64_t now_ns) noexcept { held_ns_ = now_ns; }

bool LeaseCheck::hear(const Word& word, std::int64_t now_ns) {
  if (word.service_id == 0 || word.served_ns > kLongest_ns) return false;
  auto other = std::find_if(others_.begin(), others_.end(), [&](const Other& known) {
    return known.service_id == word.service_id;
  });
  if (other == others_.end()) {
    if (others_.size() >= kMaxOthers) return false;
    other = others_.insert(others_.end(),
                           Other{.service_id = word.service_id, .beside_since_ns = now_ns});
  }
  other->is_serving = word.is_serving;
  if (!held_ns_ || !word.is_serving) return true;
  const std::int64_t served_ns = std::max<std::int64_t>(word.served_ns, 0);
  other->lead_ns = std::min(other->lead_ns, now_ns - *held_ns_ - served_ns);
  return true;
}

void LeaseCheck::forget(std::uint64_t service_id) {
  std::erase_if(others_, [&](const Other& other) { return other.service_id == service_id; });
}

bool LeaseCheck::yields_to(const Other& other, std::int64_t now_ns,
                           std::uint64_t master) const noexcept {
  if (!other.is_serving) return false;
  if (other.service_id == master) return true;
  if (other.lead_ns < -kSame_ns) return true;
  if (service_id_ < other.service_id) return false;
  return other.lead_ns < kSame_ns ||
         (other.lead_ns < kUnsure_ns && now_ns - other.beside_since_ns > kPatience_ns);
}

void LeaseCheck::check(std::int64_t now_ns, bool may_leave, std::uint64_t master) noexcept {
  if (!held_ns_) return;
  for (Other& other : others_) {
    if (has_stepped_back_ || !other.is_serving) other.beside_since_ns = now_ns;
  }
  const auto is_before_us = [&](const Other& other) {
    return has_stepped_back_ ? other.is_serving || other.service_id < service_id_
                             : yields_to(other, now_ns, master);
  };
  has_stepped_back_ = may_leave && master != service_id_ &&
                      std::any_of(others_.begin(), others_.end(), is_before_us);
  if (!has_stepped_back_) back_since_ns_.reset();
}

LeaseCheck::Word LeaseCheck::word(std::int64_t now_ns) const noexcept {
  return {.service_id = service_id_,
          .is_serving = held_ns_ && !has_stepped_back_,
          .served_ns = held_ns_ ? now_ns - *held_ns_ : 0};
}

bool LeaseCheck::has_to_speak(std::int64_t now_ns) const noexcept {
  if (!held_ns_) return false;
  if (said_serving_ == has_stepped_back_) return true;
  const bool is_alone = std::none_of(others_.begin(), others_.end(),
                                     [](const Other& other) { return other.is_serving; });
  return !is_alone && now_ns - said_ns_ >= kPeriod_ns;
}

void LeaseCheck::on_said(const Word& word, std::int64_t now_ns) noexcept {
  said_serving_ = word.is_serving;
  said_ns_ = now_ns;
  if (has_stepped_back_ && !back_since_ns_) back_since_ns_ = now_ns;
}

std::optional<std::uint64_t> LeaseCheck::keeper(std::int64_t now_ns) const noexcept {
  if (held_ns_ && (!back_since_ns_ || now_ns - *back_since_ns_ < kStepBack_ns)) return std::nullopt;
  const auto keeper = std::find_if(others_.begin(), others_.end(), [&](const Other& other) {
    return other.is_serving || (!held_ns_ && other.service_id < service_id_);
  });
  if (keeper == others_.end()) return std::nullopt;
  return keeper->service_id;
}

}  // namespace meridian::interpolator
