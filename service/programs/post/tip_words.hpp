// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "meridian/units.hpp"
#include "service/programs/post/controls/nc_text.hpp"
#include "service/programs/post/program.hpp"

namespace meridian::post {

inline constexpr int kVectorDecimals = 7;  ///< of a tool axis: 0.02 arc seconds

/// What the dialects with tool-centre control share: words of the tip, of the rotary joints before
/// it is on, and of the feed in mm/min, each where it changes.
class TipWords {
 public:
  /// `plus` is what stands before a number that is not negative. `has_all`: tip and axis are
  /// written whole in every block, for controllers that say nothing of what is left out.
  TipWords(const ProgramParts& parts, std::string plus, bool has_all)
      : parts_(parts), plus_(std::move(plus)), has_all_(has_all) {}

  /// Whether the block to `to` would say anything new.
  [[nodiscard]] bool is_new(const Target& to) const {
    for (int k = 0; k < 3; ++k) {
      if (tip_[k] != rounded(to.pose.tip[k], kLinearDecimals)) return true;
    }
    return axis_ != rounded_axis(to);
  }

  /// Nothing is known any more: every word is written again.
  void forget() {
    tip_ = {};
    joints_ = {};
    axis_ = {};
    feed_.clear();
  }

  /// " X.. Y.. Z.." of the tip.
  [[nodiscard]] std::string tip(const Target& to) {
    constexpr std::array kAddresses = {"X", "Y", "Z"};
    std::string out;
    for (int k = 0; k < 3; ++k) {
      const double value = rounded(to.pose.tip[k], kLinearDecimals);
      if (tip_[k] == value && !has_all_) continue;
      tip_[k] = value;
      append(out, kAddresses[k], value, kLinearDecimals);
    }
    return out;
  }

  /// " A.. C.." of the rotary joints.
  [[nodiscard]] std::string rotary(const Target& to) {
    std::string out;
    for (int i = 0; i < parts_.words.count(); ++i) {
      if (!parts_.words.is_rotary(i)) continue;
      const double value = parts_.words.value(i, to.axes[i]);
      if (joints_[i] == value) continue;
      joints_[i] = value;
      std::string address = parts_.words.address(i);
      if (address.size() > 1) address += "=";
      append(out, address, value, kRotaryDecimals);
    }
    return out;
  }

  /// " X.. Y.." where the joints stand, counted from the program zero: before tool-centre control.
  [[nodiscard]] std::string slides(const Target& to) const {
    std::string out;
    for (const char* const address : {"X", "Y"}) {
      const int i = parts_.words.find(address);
      append(out, address, parts_.words.value(i, to.axes[i] - parts_.zero[i]), kLinearDecimals);
    }
    return out;
  }

  /// " I.. J.. K.." of the tool axis under any three addresses; all three or, unchanged, none.
  [[nodiscard]] std::string axis(const Target& to, const std::array<const char*, 3>& addresses) {
    const std::array<double, 3> value = rounded_axis(to);
    if (axis_ == value && !has_all_) return "";
    axis_ = value;
    std::string out;
    for (int k = 0; k < 3; ++k) append(out, addresses[k], value[k], kVectorDecimals);
    return out;
  }

  /// " F.." in mm/min, never above the feed meant. Only for a block that is written.
  [[nodiscard]] std::string feed(const Target& to) {
    std::string text = fixed_down(units::per_min_from_per_s(to.feed_mm_per_s), 3);
    if (text == feed_) return "";
    feed_ = text;
    return text.insert(0, " F");
  }

 private:
  void append(std::string& out, std::string_view address, double value, int decimals) const {
    out.append(" ").append(address);
    if (!(value < 0)) out.append(plus_);
    out.append(fixed(value, decimals));
  }

  [[nodiscard]] static std::array<double, 3> rounded_axis(const Target& to) {
    std::array<double, 3> value{};
    for (int k = 0; k < 3; ++k) value[k] = rounded(to.pose.axis[k], kVectorDecimals);
    return value;
  }

  const ProgramParts parts_;
  std::string plus_;
  bool has_all_;
  std::array<std::optional<double>, 3> tip_;
  std::array<std::optional<double>, kMaxJoints> joints_;
  std::optional<std::array<double, 3>> axis_;
  std::string feed_;
};

}  // namespace meridian::post
