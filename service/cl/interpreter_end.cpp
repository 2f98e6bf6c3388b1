// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "service/cl/interpreter.hpp"

namespace meridian::cl {

/// END, FINI. The end block comes last: it waits for FINI or the end of the file, as posts switch
/// spindle and coolant off behind END.
Interpreter::Result Interpreter::take_end(const Statement& s, bool is_fini, Blocks& out) {
  if (arc_.form != ArcForm::kNone) {
    return refuse(arc_.line, "CIRCLE without the GOTO that ends the arc");
  }
  if (!has_moved()) return refuse(s.line, "there is no motion in the file");
  end_told_ = true;
  finished_ = is_fini;
  if (is_fini) emit(block(BlockKind::kEnd, s.line), out);
  return {};
}

/// Behind END the machine may be switched off, and nothing else: the blocks from `before` on.
Interpreter::Result Interpreter::judge_behind_end(const Statement& s, std::size_t before,
                                                  Blocks& out) const {
  const auto first = out.begin() + static_cast<std::ptrdiff_t>(before);
  const bool is_harmless = std::all_of(first, out.end(), [](const ClBlock& b) {
    return b.kind == BlockKind::kEnd || b.action == ActionKind::kSpindleOff ||
           b.action == ActionKind::kCoolantOff;
  });
  if (is_harmless) return {};
  out.erase(first, out.end());
  return refuse(s.line, std::string(s.major) + " behind the end of the program",
                "split the file: one program each");
}

Interpreter::Result Interpreter::finish(std::uint32_t last_line, bool open_end, Blocks& out) {
  if (finished_) return {};
  const auto cut_short = [&](std::uint32_t line, std::string why) {
    return refuse(line, "the file is cut short: " + std::move(why));
  };
  if (arc_.form != ArcForm::kNone) {
    return cut_short(arc_.line, "CIRCLE without the GOTO that ends the arc");
  }
  if (end_told_) {
    emit(block(BlockKind::kEnd, last_line), out);
    return {};
  }
  if (summary_.statements == 0) return refuse(0, "the file is empty");
  if (open_path_line_ != 0) {
    return cut_short(open_path_line_, "this TOOL PATH has no END-OF-PATH");
  }
  if (open_sections_ > 0) {
    return cut_short(last_line, "PPRINT/BEGIN-SECTION without END-SECTION");
  }
  if (!path_closed_ && !sections_closed_ && !options_.allow_no_end) {
    if (promises_end_) {
      return refuse(last_line, "the file is cut short: there is no FINI, END or END-OF-PATH",
                    "--allow-no-end takes it as whole");
    }
    warn_once("no end", last_line, [&] {
      return std::string(std::string("there is no FINI: the list of points is taken as whole") +
                         (open_end ? ", its last line too, although no line end follows" : ""));
    });
  }
  if (!has_moved()) return refuse(0, "there is no motion in the file");
  emit(block(BlockKind::kEnd, last_line), out);
  end_told_ = true;
  return {};
}

}  // namespace meridian::cl
