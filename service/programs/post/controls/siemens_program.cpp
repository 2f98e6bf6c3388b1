// SPDX-License-Identifier: Apache-2.0
// Tool-centre control of Siemens: TRAORI with direction vectors A3= B3= C3=.
#include "service/programs/post/tip_words.hpp"

namespace meridian::post {
namespace {

class SiemensProgram final : public Program {
 public:
  explicit SiemensProgram(const ProgramParts& parts) : parts_(parts), tip_(parts, "", false) {
    has_line_words_ = parts.options.has_line_words;
  }

  [[nodiscard]] BlockMotion motion() const noexcept override { return BlockMotion::kTipAndAxis; }

  void begin(const std::vector<std::string>& notes) override {
    for (const std::string& note : notes) line({"; ", harmless(note)});
    line({"; WORK OFFSET ON THE ORIGIN OF THE PART, ROTARY AXES AT ZERO"});
    block({"TRAFOOF"});
    block({"G17 G710 G40 G90 G94"});
    block({parts_.options.work_offset});
  }

  void retract() override {
    switch_off();
    block({parts_.options.retract ? std::string_view(*parts_.options.retract) : "SUPA G0 Z0 D0"});
  }

  void start(const Target& over) override {
    tip_.forget();
    block({"G0", tip_.rotary(over)});
    block({"G0", tip_.slides(over)});
    block({"D1"});
    block({"TRAORI"});
    block({parts_.options.work_offset});
    block({"ORIWKS ORIVECT"});
    is_on_ = true;
    go(over, false);
  }

  void start_at(const Target& at) override { start(at); }
  void rapid(const Target& to) override { go(to, false); }
  void cut(const Target& to) override { go(to, true); }

  void dwell(double seconds) override { block({"G4 F", fixed(seconds, 3)}); }
  void change_tool(int number) override {
    block({"T", std::to_string(number)});
    block({"M6"});
  }
  void end() override {
    switch_off();
    all_off();
  }

 private:
  void switch_off() {
    if (is_on_) block({"TRAFOOF"});
    is_on_ = false;
  }

  void go(const Target& to, bool is_cut) {
    if (!tip_.is_new(to)) return;
    const std::string tip = tip_.tip(to), axis = tip_.axis(to, {"A3=", "B3=", "C3="});
    block({is_cut ? "G1" : "G0", tip, axis, is_cut ? tip_.feed(to) : ""});
  }

  ProgramParts parts_;
  TipWords tip_;
  bool is_on_ = false;
};

}  // namespace

std::unique_ptr<Program> make_siemens_program(const ProgramParts& parts) {
  return std::make_unique<SiemensProgram>(parts);
}

}  // namespace meridian::post
