// SPDX-License-Identifier: Apache-2.0
#include "service/cl/cl_reader.hpp"

#include "service/cl/foreign.hpp"
#include "service/cl/interpreter.hpp"
#include "service/cl/line_source.hpp"
#include "service/cl/statement.hpp"

namespace meridian::cl {

class ClReader::Impl {
 public:
  template <class Input>
  Impl(Input& input, const std::string& name, ClReaderOptions options)
      : lines_(input), statements_(lines_), interpreter_(name, std::move(options)) {}

  Expected<std::optional<ClBlock>, ClError> next() {
    if (error_) return tl::make_unexpected(*error_);
    while (given_ == blocks_.size()) {
      if (done_) return std::optional<ClBlock>{};
      blocks_.clear();
      given_ = 0;
      if (auto read = read_statement(); !read) {
        error_ = std::move(read.error());
        return tl::make_unexpected(*error_);
      }
    }
    return std::optional<ClBlock>{blocks_[given_++]};
  }

  ClSummary& summary() {
    ClSummary& summary = interpreter_.summary();
    summary.bytes = lines_.bytes();
    summary.lines = lines_.line_number();
    summary.comments = statements_.comments();
    return summary;
  }
  const Interpreter& interpreter() const { return interpreter_; }

 private:
  Interpreter::Result read_statement() {
    if (!started_) {
      started_ = true;
      const std::string_view head = lines_.head();
      if (head.find_first_not_of(" \t\r\n\x1a") == std::string_view::npos) {
        return interpreter_.refuse(0, "the file is empty");
      }
      if (const std::string foreign = recognise_foreign(head); !foreign.empty()) {
        return interpreter_.refuse(0, "this is " + foreign + ", not a CL file",
                                   "output APT or CLDATA text from the CAM system");
      }
    }
    switch (statements_.next(statement_)) {
      case StatementReader::Outcome::kStatement: {
        auto taken = interpreter_.take(statement_, blocks_);
        if (taken && interpreter_.is_finished()) done_ = true;
        return taken;
      }
      case StatementReader::Outcome::kEnd:
        done_ = true;
        return interpreter_.finish(lines_.line_number(), lines_.ended_without_newline(), blocks_);
      case StatementReader::Outcome::kCutOff:
        return interpreter_.refuse(statement_.line,
                                   "the file is cut short: it ends inside this statement");
      case StatementReader::Outcome::kBinary:
        return interpreter_.refuse(statements_.line(), "binary data in the text");
      case StatementReader::Outcome::kTooLong:
        return interpreter_.refuse(statements_.line() + 1, "this line or statement is too long",
                                   "lines up to 64 KiB, statements up to 1 MiB");
      case StatementReader::Outcome::kReadError:
        break;
    }
    return interpreter_.refuse(statements_.line(), "the file cannot be read any further");
  }

  LineSource lines_;
  StatementReader statements_;
  Interpreter interpreter_;
  Statement statement_;
  std::vector<ClBlock> blocks_;  ///< of the last statement
  std::size_t given_ = 0;
  bool started_ = false;
  bool done_ = false;
  std::optional<ClError> error_;
};

ClReader::ClReader(std::istream& input, const std::string& name, ClReaderOptions options)
    : impl_(std::make_unique<Impl>(input, name, std::move(options))) {}
ClReader::ClReader(std::string_view text, const std::string& name, ClReaderOptions options)
    : impl_(std::make_unique<Impl>(text, name, std::move(options))) {}
ClReader::~ClReader() = default;
ClReader::ClReader(ClReader&&) noexcept = default;
ClReader& ClReader::operator=(ClReader&&) noexcept = default;

Expected<std::optional<ClBlock>, ClError> ClReader::next() { return impl_->next(); }
const ClSummary& ClReader::summary() const noexcept { return impl_->summary(); }
const std::vector<ClWarning>& ClReader::warnings() const noexcept {
  return impl_->interpreter().warnings();
}

}  // namespace meridian::cl
