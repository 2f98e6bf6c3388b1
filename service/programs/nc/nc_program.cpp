// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/nc_program.hpp"

#include <algorithm>
#include <array>

#include "service/programs/cl/text/letters.hpp"
#include "service/programs/nc/block.hpp"
#include "service/programs/nc/heidenhain/heidenhain_line.hpp"
#include "service/programs/nc/siemens/siemens_line.hpp"
#include "service/programs/nc/siemens/siemens_names.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr std::size_t kLongestTitle = 80;
constexpr const char* kByForm = "correct the line, or let the CAM system write the program anew";

cl::ClReaderOptions in_capitals(cl::ClReaderOptions options) {
  for (std::string& word : options.allowed_words) {
    for (char& c : word) c = cl::capital(c);
  }
  return options;
}

bool has_control_sign(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) {
    return c < ' ' && c != '\t' && c != '\r' && c != '\f' && c != '\x1a';
  });
}

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, kLongestTitle));
}

/// What a refused line may have said: without it nothing is known of what this line lacks.
bool may_come_of_another(const cl::Refusal& refusal) {
  constexpr std::array<std::string_view, 4> kLacks = {"no G0", "no F", "not known", "not given"};
  return std::find(kLacks.begin(), kLacks.end(), refusal.group) != kLacks.end();
}

}  // namespace

NcProgram::NcProgram(cl::LineSource& lines, std::string name, const cl::ClReaderOptions& options,
                     std::string_view reason, std::shared_ptr<const MachineAxes> machine,
                     NamedTools named_tools)
    : lines_(lines),
      name_(std::move(name)),
      state_(in_capitals(options), std::move(machine), std::move(named_tools)) {
  if (options.dialect == cl::Dialect::kSiemens) {
    state_.modes.language = Language::kSiemens;
    state_.modes.control = Control::kLength;  // D1 is in force with every tool
    state_.modes.orientation.between = Orientation::Between::kGreatCircle;
  }
  if (options.dialect == cl::Dialect::kHeidenhain) {
    state_.modes.language = Language::kHeidenhain;
    state_.modes.control = Control::kLength;  // of the tool that was called
  }
  state_.cl.path.set_max_feed(options.max_feed_mm_per_s);
  cl::ClSummary& summary = state_.cl.summary;
  summary.dialect = state_.cl.dialect.traits().title;
  summary.dialect_reason = reason;
  summary.nc.is_nc = true;
  if (state_.axes) summary.nc.axis_tolerance_rad = state_.axes->axis_tolerance_rad();
}

void NcProgram::warn(std::string_view key, std::uint32_t line, const std::string& message) {
  state_.cl.remarks.warn(key, line, [&message] { return message; });
}

cl::ClError NcProgram::error(std::uint32_t line, const cl::Refusal& refusal) const {
  return {name_,           refusal.line > 0 ? refusal.line : line,
          refusal.message, refusal.remedy.empty() ? kByForm : refusal.remedy,
          refusal.group,   false};
}

cl::ProgramSource::Result NcProgram::read(Blocks& out) {
  std::string_view text;
  switch (lines_.next(text)) {
    case cl::LineSource::Outcome::kLine:
      break;
    case cl::LineSource::Outcome::kEnd:
      return finish(out);
    case cl::LineSource::Outcome::kTooLong:
      return final_error(lines_.line_number() + 1, "this line is too long", "lines up to 64 KiB");
    case cl::LineSource::Outcome::kReadError:
      return final_error(lines_.line_number(), "the file cannot be read any further");
  }
  if (has_control_sign(text)) return final_error(lines_.line_number(), "binary data in the text");
  const std::size_t before = out.size();
  state_.cl.path.give_to(out);
  if (auto done = take(text); !done) {
    out.resize(before);
    state_.cl.path.lose_position();
    const bool is_first = state_.cl.refusals++ == 0;
    if (!is_first && may_come_of_another(done.error())) return {};
    return tl::make_unexpected(error(lines_.line_number(), done.error()));
  }
  if (state_.cl.structure.phase == cl::Structure::Phase::kEnded) return finish(out);
  return {};
}

cl::Outcome NcProgram::take(std::string_view text) {
  const bool is_siemens = state_.modes.language == Language::kSiemens;
  const bool is_klartext = state_.modes.language == Language::kHeidenhain;
  auto done = is_siemens    ? cut_siemens(text, lines_.line_number(), line_, state_.variables)
              : is_klartext ? cut_heidenhain(text, lines_.line_number(), line_, state_.variables)
                            : cut(text, lines_.line_number(), line_);
  if (is_siemens) {
    if (auto named = check_names(line_); !named) return named;
  }
  if (!done) return done;
  take_comments();
  if (line_.is_tape_mark) return take_tape_mark();
  if (line_.words.empty() && line_.names.empty()) return {};
  ++state_.cl.summary.statements;
  if (line_.has_block_delete) {
    state_.cl.remarks.warn("block delete", line_.number, [] {
      return std::string("blocks after / are run, as with the switch for them off");
    });
  }
  return is_klartext ? run_heidenhain(state_, line_) : take_block();
}

void NcProgram::take_comments() {
  cl::ClSummary& summary = state_.cl.summary;
  if (summary.comments == 0 && line_.comments > 0 && summary.program.empty()) {
    summary.program = trimmed(line_.comment);
  }
  summary.comments += line_.comments;
}

/// The first begins the tape, the second ends it.
cl::Outcome NcProgram::take_tape_mark() {
  if (state_.cl.summary.statements > 0) {
    state_.cl.structure.phase = cl::Structure::Phase::kEnded;
  }
  return {};
}

/// False where the program has its number already.
bool NcProgram::take_program_number(const Word& word) {
  if (has_number_) return false;
  has_number_ = true;
  std::string& program = state_.cl.summary.program;
  program = "O" + std::string(word.digits) + (program.empty() ? "" : " ") + program;
  return true;
}

cl::Outcome NcProgram::take_block() {
  const Word* const number = line_.find("O");
  if (number != nullptr && !take_program_number(*number)) {
    return refuse("a second program number: a subprogram or another program",
                  "split the file: one program each", "O");
  }
  return run_block(state_, line_);
}

cl::Outcome NcProgram::check_whole(std::uint32_t last_line) {
  if (state_.cl.summary.statements == 0) return refuse("the file is empty");
  const bool is_ended = state_.cl.structure.phase == cl::Structure::Phase::kEnded;
  if (!is_ended && !state_.cl.options.allow_no_end) {
    return cl::refuse_at(last_line,
                         "the program is cut short: there is no M30, M2, closing % or END PGM",
                         "--allow-no-end takes it as whole");
  }
  if (!state_.cl.path.has_moved() && state_.cl.refusals == 0) {
    return refuse("there is no motion in the program");
  }
  return {};
}

cl::ProgramSource::Result NcProgram::finish(Blocks& out) {
  is_done_ = true;
  state_.cl.path.give_to(out);
  if (auto done = check_whole(lines_.line_number()); !done) {
    return tl::make_unexpected(error(0, done.error()));
  }
  state_.cl.structure.phase = cl::Structure::Phase::kFinished;
  state_.cl.path.act(BlockKind::kEnd, ActionKind::kNone, 0, lines_.line_number());
  return {};
}

}  // namespace meridian::nc
