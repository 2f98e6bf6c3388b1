// SPDX-License-Identifier: Apache-2.0
// Joint words in RS-274, feed in inverse time.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/programs/post/controls/nc_text.hpp"
#include "service/programs/post/program.hpp"

namespace meridian::post {
namespace {

constexpr int kInverseDecimals = 3;
constexpr double kMaxInverse_per_min = 99999.999;  // what controllers take; faster is slowed

class JointProgram final : public Program {
 public:
  explicit JointProgram(const ProgramParts& parts) : parts_(parts) {
    has_line_words_ = parts.options.has_line_words;
  }

  [[nodiscard]] BlockMotion motion() const noexcept override { return BlockMotion::kDrives; }

  void begin(const std::vector<std::string>& notes) override {
    line({"%"});
    for (const std::string& note : notes) comment(note);
    comment("JOINT WORDS - THE WORK OFFSET HOLDS THE ZEROS OF THE JOINTS");
    if (has_stage(parts_.model)) {
      const ActuatorStage& stage = parts_.model.stage;
      comment(parts_.words.address(stage.linear_joint) + " AND " +
              parts_.words.address(stage.rotary_joint) +
              " ARE THE SLIDERS OF A STAGE - NEVER MOVE ONE ALONE");
      comment("RAPIDS MUST RUN STRAIGHT");
    }
    comment("TOOL LENGTH IS IN THEM - ROTARY WORDS COUNT ON THROUGH TURNS");
    block({"G17 G21 G40 G49 G80 G90 G94"});
    block({parts_.options.work_offset});
  }

  void retract() override {
    forget();
    if (parts_.options.retract) {
      block({*parts_.options.retract});
      block({"G90"});
      return;
    }
    const int z = parts_.words.find("Z");
    const JointLimits& limits = drive_spec(parts_.model, z).limits;
    const double top = parts_.retract_sense > 0 ? limits.travel_max : limits.travel_min;
    Target up;
    up.axes[z] = top;
    go("G0", up, 1U << static_cast<unsigned>(z), "");
  }

  void start(const Target& over) override {
    const int z = parts_.words.find("Z");
    const unsigned all = (1U << static_cast<unsigned>(parts_.words.count())) - 1U;
    const unsigned last = z >= 0 ? 1U << static_cast<unsigned>(z) : 0;
    forget();
    const double feed = parts_.options.rapid_feed_mm_per_s;
    if (has_stage(parts_.model) && feed > 0) {  // no G0: it might run the sliders one by one
      std::string word = " F";
      word += fixed_down(units::per_min_from_per_s(feed), 3);
      block({"G94"});
      go("G1", over, all & ~last, word);
      if (last != 0) go("G1", over, last, "");
    } else {
      go("G0", over, all & ~last, "");
      if (last != 0) go("G0", over, last, "");
    }
    block({"G93"});
  }

  void start_at(const Target& at) override {
    forget();
    comment("THE MACHINE MUST STAND WHERE THE NEXT BLOCK SAYS");
    block({"M0"});
    go("G0", at, kAll, "");
    block({"G93"});
  }

  void rapid(const Target& to) override { go("G0", to, kAll, ""); }

  void cut(const Target& to) override {
    const double per_min = std::min(units::kMinute_s / to.duration_s, kMaxInverse_per_min);
    std::string feed = " F";
    feed += fixed_down(per_min, kInverseDecimals);
    go("G1", to, kAll, feed);
  }

  void dwell(double seconds) override { block({"G4 P", fixed(seconds, 3)}); }
  void change_tool(int number) override { block({"T", std::to_string(number), " M6"}); }
  void end() override {
    block({"G94"});
    all_off();
    line({"%"});
  }

 private:
  static constexpr unsigned kAll = ~0U;

  void comment(const std::string& text) { line({"(", harmless(text), ")"}); }
  void forget() { written_ = {}; }

  /// One block to `to` with the words of `axes` (bits) that changed; none where none did.
  void go(std::string_view code, const Target& to, unsigned axes, std::string_view feed) {
    std::string words;
    for (int i = 0; i < parts_.words.count(); ++i) {
      if ((axes >> static_cast<unsigned>(i) & 1U) == 0) continue;
      const double value = parts_.words.value(i, to.axes[i]);
      if (written_[i] == value) continue;
      written_[i] = value;
      words.append(" ").append(parts_.words.word(i, value));
    }
    if (!words.empty()) block({code, words, feed});
  }

  ProgramParts parts_;
  std::array<std::optional<double>, kMaxJoints> written_;
};

}  // namespace

std::unique_ptr<Program> make_joint_program(const ProgramParts& parts) {
  return std::make_unique<JointProgram>(parts);
}

}  // namespace meridian::post
