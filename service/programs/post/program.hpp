// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/programs/post/axis_words.hpp"
#include "service/programs/post/post_options.hpp"
#include "service/programs/post/subdivide.hpp"

namespace meridian::post {

/// The end of one NC block. Units: mm, rad, s.
struct Target {
  JointVector axes{};  ///< drive coordinates as the words say them
  ToolPose pose{Vector3::Zero(),
                Vector3::UnitZ()};  ///< origin of W, axes parallel to the machine's
  double duration_s = 0;            ///< cuts: what the block takes at its feed
  double feed_mm_per_s = 0;         ///< cuts: of the tip
};

/// An NC program being written, in one dialect: what each step of a CL program is in its words.
/// What cannot be said was refused before. Modal words are written where they change.
class Program {
 public:
  virtual ~Program() = default;

  /// What keeps the first motion from being written; empty: nothing.
  [[nodiscard]] virtual std::string missing() const { return ""; }

  /// Why what was written so far cannot stand; empty: nothing. Asked after every CL block.
  [[nodiscard]] virtual std::string refusal() const { return ""; }

  /// How the controller moves between the targets that it is given.
  [[nodiscard]] virtual BlockMotion motion() const noexcept = 0;

  /// Header and the line that makes every mode known. `notes` become comments.
  virtual void begin(const std::vector<std::string>& notes) = 0;
  /// Takes the tool off the part along Z, from wherever it is. Only with `can_retract`.
  virtual void retract() = 0;
  /// From the retracted position to `over`, which is clear of the part: rotary joints first, Z
  /// last.
  virtual void start(const Target& over) = 0;
  /// Where there is no way to retract: stops for the operator, who sees to it that the machine
  /// stands at `at`, and makes the position known.
  virtual void start_at(const Target& at) = 0;

  virtual void rapid(const Target& to) = 0;
  virtual void cut(const Target& to) = 0;

  virtual void dwell(double seconds) = 0;
  virtual void change_tool(int number) = 0;
  virtual void end() = 0;

  /// In the words of ISO 6983 where a dialect has none of its own.
  virtual void spindle_off();
  virtual void spindle_on(bool is_clockwise, double rev_per_min);
  /// M7, M8, M9 or the machine's own word.
  virtual void coolant(const std::string& word);
  virtual void stop(bool is_optional);

  /// Blocks from here on come from this line of the CL file: their N word where it is wanted.
  void at_line(std::uint32_t cl_line) noexcept { cl_line_ = cl_line; }

  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  [[nodiscard]] std::uint64_t blocks() const noexcept { return blocks_; }

 protected:
  /// One line that is no block: comments, brackets around the program.
  void line(std::initializer_list<std::string_view> parts) {
    for (const std::string_view part : parts) text_.append(part);
    text_ += '\n';
  }
  /// One block, from its parts.
  void block(std::initializer_list<std::string_view> parts) {
    if (has_line_words_ && cl_line_ > 0) {
      text_.append("N").append(std::to_string(cl_line_)).append(" ");
    }
    line(parts);
    ++blocks_;
  }

  /// The end of a program: spindle and coolant off, M30.
  void all_off();

  [[nodiscard]] std::uint32_t cl_line() const noexcept { return cl_line_; }

  bool has_line_words_ = false;

 private:
  std::string text_;
  std::uint64_t blocks_ = 0;
  std::uint32_t cl_line_ = 0;
};

/// What a dialect is made from. The references outlive the program.
struct ProgramParts {
  const MachineModel& model;
  const AxisWords& words;
  const PostOptions& options;
  std::string name;       ///< of the CL file
  int retract_sense = 0;  ///< retract_sense(); joint words
  JointVector zero{};     ///< find_program_zero(); tool-centre words
};

[[nodiscard]] std::unique_ptr<Program> make_joint_program(const ProgramParts& parts);
[[nodiscard]] std::unique_ptr<Program> make_fanuc_program(const ProgramParts& parts);
[[nodiscard]] std::unique_ptr<Program> make_siemens_program(const ProgramParts& parts);
[[nodiscard]] std::unique_ptr<Program> make_heidenhain_program(const ProgramParts& parts);
[[nodiscard]] std::unique_ptr<Program> make_krl_program(const ProgramParts& parts);
[[nodiscard]] std::unique_ptr<Program> make_rapid_program(const ProgramParts& parts);
[[nodiscard]] std::unique_ptr<Program> make_ls_program(const ProgramParts& parts);
[[nodiscard]] std::unique_ptr<Program> make_urscript_program(const ProgramParts& parts);

}  // namespace meridian::post
