// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "service/programs/cl/interpreter/frame.hpp"

namespace meridian::cl {

/// From the points of a file to W, through everything that the file and its caller put between:
/// the transformation of TRACUT, that of COPY, the shift of TRANS, the frame of MSYS or CSYS as
/// seen from the one in force at the first motion, the ORIGIN that a post-processor takes off, the
/// caller's frame. What the words give is in the unit of the file, W in mm. Proof:
/// tests/unit/cl/frame_test.cpp.
class FrameChain {
 public:
  explicit FrameChain(const std::optional<Frame>& caller);

  enum class Kind : std::uint8_t { kMsys, kCsys };
  void set_frame(const Frame& frame, Kind kind);
  /// TRNTYP/WORLD: the points are in one frame already, and CSYS only says how the part is held.
  void set_world(bool is_world);
  void set_shift(const std::optional<Frame>& shift);         ///< TRANS
  void set_transformation(const std::optional<Frame>& cut);  ///< TRACUT
  void set_copy(const std::optional<Frame>& copy);  ///< COPY; no change that resolve() says
  void set_origin(const Vector3& origin);           ///< ORIGIN

  /// Whether nothing came since the last resolve().
  [[nodiscard]] bool is_resolved() const noexcept { return change_ == Change::kNone; }
  /// Puts what was set in force for the motion that comes. True where points go elsewhere from
  /// here than they did before.
  bool resolve(double to_mm);

  /// Of a point in mm of the file, and of a direction; after resolve().
  [[nodiscard]] Vector3 point(const Vector3& p) const { return is_plain_ ? p : now_.point(p); }
  [[nodiscard]] Vector3 direction(const Vector3& d) const {
    return is_plain_ ? d : now_.direction(d);
  }
  /// +z of the last CSYS in the frame of the points; nothing where there was none.
  [[nodiscard]] const std::optional<Vector3>& csys_axis() const noexcept { return csys_axis_; }

 private:
  /// What came since the last resolve().
  enum class Change : std::uint8_t {
    kNone,
    kByWord,  ///< a word of the file alone
    kByCopy   ///< COPY, with words beside it or without: the change is no news
  };
  void note(Change change) noexcept;
  void follow_csys_axis();
  [[nodiscard]] Frame in_force(double to_mm) const;

  std::optional<Frame> caller_, written_, shift_, copy_, cut_;
  std::optional<Frame> reference_;  ///< in force at the first motion, mm
  Kind kind_ = Kind::kMsys;
  bool is_world_ = false;
  Vector3 origin_ = Vector3::Zero();
  std::optional<Vector3> csys_axis_;
  Change change_ = Change::kByWord;
  Frame now_;
  bool is_plain_ = true;
};

}  // namespace meridian::cl
