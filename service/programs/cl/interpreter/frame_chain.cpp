// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/interpreter/frame_chain.hpp"

#include <utility>

namespace meridian::cl {
namespace {

Frame in_mm(Frame frame, double to_mm) {
  frame.origin *= to_mm;
  return frame;
}

}  // namespace

FrameChain::FrameChain(const std::optional<Frame>& caller) : caller_(caller) {
  if (!caller_) return;
  now_ = *caller_;
  is_plain_ = is_identity(now_);
}

void FrameChain::note(Change change) noexcept {
  if (change_ != Change::kByCopy) change_ = change;
}

void FrameChain::follow_csys_axis() {
  if (!written_ || kind_ != Kind::kCsys) return;
  csys_axis_ = is_world_ ? Vector3(written_->rotation.col(2)) : Vector3(Vector3::UnitZ());
}

void FrameChain::set_frame(const Frame& frame, Kind kind) {
  written_ = frame;
  kind_ = kind;
  follow_csys_axis();
  note(Change::kByWord);
}

void FrameChain::set_world(bool is_world) {
  is_world_ = is_world;
  follow_csys_axis();
  note(Change::kByWord);
}

void FrameChain::set_shift(const std::optional<Frame>& shift) {
  shift_ = shift;
  note(Change::kByWord);
}

void FrameChain::set_transformation(const std::optional<Frame>& cut) {
  cut_ = cut;
  note(Change::kByWord);
}

void FrameChain::set_copy(const std::optional<Frame>& copy) {
  copy_ = copy;
  note(Change::kByCopy);
}

void FrameChain::set_origin(const Vector3& origin) {
  origin_ = origin;
  note(Change::kByWord);
}

Frame FrameChain::in_force(double to_mm) const {
  if (!written_ || (is_world_ && kind_ == Kind::kCsys)) return {};
  return in_mm(*written_, to_mm);
}

bool FrameChain::resolve(double to_mm) {
  const bool is_of_copy = std::exchange(change_, Change::kNone) == Change::kByCopy;
  const Frame frame = in_force(to_mm);
  const bool is_first = !reference_;
  if (is_first) reference_ = frame;
  Frame moved = relative(*reference_, frame);
  if (is_identity(moved)) moved = Frame{};
  if (shift_) moved = compose(moved, in_mm(*shift_, to_mm));
  if (copy_) moved = compose(moved, in_mm(*copy_, to_mm));
  if (cut_) moved = compose(moved, in_mm(*cut_, to_mm));
  moved.origin -= to_mm * origin_;
  if (caller_) moved = compose(*caller_, moved);
  if (is_identity(relative(now_, moved))) return false;
  now_ = moved;
  is_plain_ = is_identity(now_);
  return !is_first && !is_of_copy;
}

}  // namespace meridian::cl
