// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/blocks_ahead.hpp"

#include <algorithm>

namespace meridian::post {

void BlocksAhead::fill() {
  if (is_whole_ || blocks_.size() - at_ > kAhead) return;
  blocks_.erase(blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(at_));
  at_ = 0;
  while (!is_whole_ && blocks_.size() < 2 * kAhead) {
    auto block = reader_.next();
    if (!block) error_ = block.error();
    is_whole_ = !block || !*block;
    if (is_whole_) return;
    blocks_.push_back(**block);
  }
}

Expected<std::optional<ClBlock>, cl::ClError> BlocksAhead::next() {
  fill();
  if (at_ < blocks_.size()) return blocks_[at_++];
  if (error_) return tl::make_unexpected(*error_);
  return std::nullopt;
}

std::span<const ClBlock> BlocksAhead::ahead() const noexcept {
  if (at_ == 0) return {};
  const std::span from = std::span(blocks_).subspan(at_ - 1);
  const std::span near = from.first(std::min(from.size(), kAhead));
  const auto change = std::find_if(near.begin() + 1, near.end(), [](const ClBlock& block) {
    return block.kind == BlockKind::kTool;
  });
  return near.first(static_cast<std::size_t>(change - near.begin()));
}

}  // namespace meridian::post
