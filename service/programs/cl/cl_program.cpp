// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/cl_program.hpp"

namespace meridian::cl {

ClSummary& ClProgram::summary() {
  ClSummary& summary = interpreter_.summary();
  summary.comments = statements_.comments();
  return summary;
}

ProgramSource::Result ClProgram::read(Blocks& out) {
  if (interpreter_.is_repeating()) {
    statements_.read_again(interpreter_.next_repeated(), statement_);
    auto taken = interpreter_.take(statement_, out);
    interpreter_.go_on_repeating();
    return taken;
  }
  switch (statements_.next(statement_)) {
    case StatementReader::Outcome::kStatement: {
      if (const Dialect shown = statements_.take_shown(); shown != Dialect::kUnknown) {
        interpreter_.see(shown, statement_.line, "a comment");
      }
      auto taken = interpreter_.take(statement_, out);
      if (interpreter_.is_finished()) is_done_ = true;
      return taken;
    }
    case StatementReader::Outcome::kEnd:
      is_done_ = true;
      return interpreter_.finish(lines_.line_number(), lines_.ended_without_newline(), out);
    case StatementReader::Outcome::kCutOff:
      return final_error(statement_.line, "the file is cut short: it ends inside this statement");
    case StatementReader::Outcome::kBinary:
      return final_error(statements_.line(), "binary data in the text");
    case StatementReader::Outcome::kTooLong:
      return final_error(statements_.line() + 1, "this line or statement is too long",
                         "lines up to 64 KiB, statements up to 1 MiB");
    case StatementReader::Outcome::kReadError:
      break;
  }
  return final_error(statements_.line(), "the file cannot be read any further");
}

}  // namespace meridian::cl
