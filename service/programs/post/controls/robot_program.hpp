// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "service/programs/post/controls/robot_axes.hpp"
#include "service/programs/post/program.hpp"

namespace meridian::post {

/// One joint move of a robot: every axis evenly, all of them together.
struct RobotMove {
  std::array<double, kRobotAxes> deg{};  ///< J1 first, as the controller shows them
  bool is_first = false;                 ///< from wherever the arm stands: slowly, in no known time
  double seconds = 0;                    ///< how long it takes at the least; 0 for the first
  double full_speed_s = 0;  ///< how long it takes where the slowest axis runs at its `velocity`
};

/// A program of joint moves in a robot's language: what all of them have in common. There is no
/// word for spindle, coolant or a tool change that every robot understands: the program stops, and
/// the operator does what it asks for.
class RobotProgram : public Program {
 public:
  explicit RobotProgram(const ProgramParts& parts);

  [[nodiscard]] BlockMotion motion() const noexcept final { return BlockMotion::kDrives; }
  [[nodiscard]] std::string refusal() const final { return refusal_; }

  void begin(const std::vector<std::string>& notes) final;
  void retract() final {}
  void start(const Target& over) final { start_at(over); }
  void start_at(const Target& at) final;
  void rapid(const Target& to) final { go(to); }
  void cut(const Target& to) final { go(to); }
  void change_tool(int number) final;
  void spindle_off() final;
  void spindle_on(bool is_clockwise, double rev_per_min) final;
  void coolant(const std::string& word) final;
  void stop(bool is_optional) final;

 protected:
  /// Everything before the first statement; `notes` become comments.
  virtual void open(const std::vector<std::string>& notes) = 0;
  /// Stops until the operator goes on; `why` is harmless().
  virtual void halt(const std::string& why) = 0;
  virtual void move(const RobotMove& to) = 0;

  void refuse(const std::string& why) {
    if (refusal_.empty()) refusal_ = why;
  }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const RobotAxes& axes() const noexcept { return axes_; }
  [[nodiscard]] const PostOptions& options() const noexcept { return parts_.options; }

  /// "A1 0.00000,A2 -90.00000": numbers with kRotaryDecimals behind `prefix` and their number.
  [[nodiscard]] std::string numbered(const RobotMove& to, const char* prefix) const;

 private:
  void go(const Target& to);

  ProgramParts parts_;
  RobotAxes axes_;
  std::string name_, refusal_;
  std::optional<std::array<double, kRobotAxes>> at_;  ///< where the arm stands, where it is known
  JointVector drives_{};
};

}  // namespace meridian::post
