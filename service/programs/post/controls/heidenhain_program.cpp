// SPDX-License-Identifier: Apache-2.0
// Tool-centre control of Heidenhain in Klartext: FUNCTION TCPM, LN with the vector TX TY TZ.
#include <algorithm>
#include <cctype>

#include "service/programs/post/tip_words.hpp"

namespace meridian::post {
namespace {

class HeidenhainProgram final : public Program {
 public:
  explicit HeidenhainProgram(const ProgramParts& parts) : parts_(parts), tip_(parts, "+", true) {
    name_ = harmless(parts.name.substr(0, parts.name.find('.')));
    for (char& c : name_) {
      const auto letter = static_cast<unsigned char>(c);
      c = std::isalnum(letter) != 0 ? static_cast<char>(std::toupper(letter)) : '_';
    }
    if (name_.empty()) name_ = "MERIDIAN";
  }

  [[nodiscard]] BlockMotion motion() const noexcept override { return BlockMotion::kTipAndAxis; }

  void begin(const std::vector<std::string>& notes) override {
    write({"BEGIN PGM ", name_, " MM"});
    for (const std::string& note : notes) write({"; ", harmless(note)});
    write({"; DATUM ON THE ORIGIN OF THE PART, ROTARY AXES AT ZERO"});
    write({"FUNCTION RESET TCPM"});
  }

  void retract() override {
    switch_off();
    write(
        {parts_.options.retract ? std::string_view(*parts_.options.retract) : "L Z+0 R0 FMAX M91"});
  }

  void start(const Target& over) override {
    tip_.forget();
    write({"L", tip_.rotary(over), " R0 FMAX"});
    write({"L", tip_.slides(over), " R0 FMAX"});
    write({"FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR"});
    is_on_ = true;
    go(over, false);
  }

  void start_at(const Target& at) override { start(at); }
  // FMAX holds for its block alone, and F comes back as it was.
  void rapid(const Target& to) override { go(to, false); }
  void cut(const Target& to) override { go(to, true); }

  void dwell(double seconds) override {
    write({"CYCL DEF 9.0 DWELL TIME"});
    write({"CYCL DEF 9.1 DWELL ", fixed(seconds, 3)});
  }
  void spindle_off() override { write({"M5"}); }
  void spindle_on(bool is_clockwise, double rev_per_min) override {
    write({"TOOL CALL S", fixed(rev_per_min, 0)});
    write({is_clockwise ? "M3" : "M4"});
  }
  void coolant(const std::string& word) override { write({word}); }
  void change_tool(int number) override { write({"TOOL CALL ", std::to_string(number), " Z"}); }
  void stop(bool is_optional) override { write({is_optional ? "M1" : "M0"}); }
  void end() override {
    switch_off();
    write({"M5"});
    write({"M9"});
    write({"M30"});
    write({"END PGM ", name_, " MM"});
  }

 private:
  /// A block with its number; every line of Klartext has one.
  void write(std::initializer_list<std::string_view> parts) {
    std::string text = std::to_string(number_++);
    text.append(" ");
    for (const std::string_view part : parts) text.append(part);
    if (parts_.options.has_line_words && cl_line() > 0) {
      text.append(" ; CL ").append(std::to_string(cl_line()));
    }
    block({text});
  }

  void switch_off() {
    if (is_on_) write({"FUNCTION RESET TCPM"});
    is_on_ = false;
  }

  void go(const Target& to, bool is_cut) {
    if (!tip_.is_new(to)) return;
    const std::string tip = tip_.tip(to), axis = tip_.axis(to, {"TX", "TY", "TZ"});
    write({"LN", tip, axis, is_cut ? tip_.feed(to) : " FMAX"});
  }

  ProgramParts parts_;
  TipWords tip_;
  std::string name_;
  std::uint64_t number_ = 0;
  bool is_on_ = false;
};

}  // namespace

std::unique_ptr<Program> make_heidenhain_program(const ProgramParts& parts) {
  return std::make_unique<HeidenhainProgram>(parts);
}

}  // namespace meridian::post
