// SPDX-License-Identifier: Apache-2.0
// Tool-centre control of Fanuc: G43.4 with rotary words, G43.5 with I J K.
#include "service/programs/post/tip_words.hpp"

namespace meridian::post {
namespace {

class FanucProgram final : public Program {
 public:
  explicit FanucProgram(const ProgramParts& parts)
      : parts_(parts),
        tip_(parts, "", parts.options.has_vectors),
        offset_(parts.options.offset_number) {
    has_line_words_ = parts.options.has_line_words;
  }

  [[nodiscard]] BlockMotion motion() const noexcept override {
    return parts_.options.has_vectors ? BlockMotion::kTipAndAxis : BlockMotion::kTipAndRotary;
  }

  [[nodiscard]] std::string missing() const override {
    return offset_ > 0 ? ""
                       : "no tool is called before the first motion, so that the number of its "
                         "length offset is not known; give it with --offset-number";
  }

  void begin(const std::vector<std::string>& notes) override {
    line({"%"});
    if (parts_.options.program_number > 0) {
      const std::string number = std::to_string(parts_.options.program_number);
      line({"O", std::string(number.size() < 4 ? 4 - number.size() : 0, '0'), number});
    }
    for (const std::string& note : notes) line({"(", harmless(note), ")"});
    line({"(WORK OFFSET ON THE ORIGIN OF THE PART, ROTARY AXES AT ZERO)"});
    block({"G17 G21 G40 G49 G80 G90 G94"});
    block({parts_.options.work_offset});
  }

  void retract() override {
    switch_off();
    if (parts_.options.retract) {
      block({*parts_.options.retract});
    } else {
      block({"G91 G28 Z0."});
    }
    block({"G90"});
  }

  void start(const Target& over) override {
    tip_.forget();
    block({"G0", tip_.rotary(over)});
    block({"G0", tip_.slides(over)});
    block({parts_.options.has_vectors ? "G43.5 H" : "G43.4 H", std::to_string(offset_)});
    is_on_ = true;
    go(over, false);
  }

  void start_at(const Target& at) override { start(at); }
  void rapid(const Target& to) override { go(to, false); }
  void cut(const Target& to) override { go(to, true); }

  void dwell(double seconds) override { block({"G4 X", fixed(seconds, 3)}); }
  void change_tool(int number) override {
    block({"T", std::to_string(number), " M6"});
    offset_ = number;
  }
  void end() override {
    switch_off();
    all_off();
    line({"%"});
  }

 private:
  void switch_off() {
    if (is_on_) block({"G49"});
    is_on_ = false;
  }

  void go(const Target& to, bool is_cut) {
    const char* const code = is_cut ? "G1" : "G0";
    if (parts_.options.has_vectors) {
      if (!tip_.is_new(to)) return;
      const std::string tip = tip_.tip(to), axis = tip_.axis(to, {"I", "J", "K"});
      return block({code, tip, axis, is_cut ? tip_.feed(to) : ""});
    }
    const std::string tip = tip_.tip(to), rotary = tip_.rotary(to);
    if (tip.empty() && rotary.empty()) return;
    block({code, tip, rotary, is_cut ? tip_.feed(to) : ""});
  }

  ProgramParts parts_;
  TipWords tip_;
  int offset_;
  bool is_on_ = false;
};

}  // namespace

std::unique_ptr<Program> make_fanuc_program(const ProgramParts& parts) {
  return std::make_unique<FanucProgram>(parts);
}

}  // namespace meridian::post
