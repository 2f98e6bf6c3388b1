// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/cl_reader.hpp"

#include <utility>

#include "service/programs/cl/cl_program.hpp"
#include "service/programs/cl/foreign.hpp"
#include "service/programs/cl/interpreter/restart.hpp"
#include "service/programs/cl/text/line_source.hpp"

namespace meridian::cl {

class ClReader::Impl {
 public:
  template <class Input>
  Impl(Input& input, const std::string& name, ClReaderOptions options)
      : lines_(input),
        name_(name),
        options_(std::move(options)),
        first_line_(options_.first_line),
        program_(std::make_unique<ClProgram>(lines_, name_, options_)) {}

  Expected<std::optional<ClBlock>, ClError> next() {
    if (const auto line = std::exchange(first_line_, 0); line > 0) {
      if (auto begun = restart(line); !begun) return tl::make_unexpected(begun.error());
    }
    if (restored_given_ < restored_.size()) return numbered(restored_[restored_given_++]);
    auto block = read_block();
    if (!block || !*block) return block;
    return numbered(**block);
  }

 private:
  /// Which part of the text is read next.
  enum class Stage : std::uint8_t { kHead, kStatements, kEnd };

  /// Reads up to `first_line`, which is wanted; what leads there is in restored_ then.
  ProgramSource::Result restart(std::uint32_t first_line) {
    Restart before;
    for (;;) {
      auto block = read_block();
      if (!block) return tl::make_unexpected(block.error());
      if (!*block || (*block)->kind == BlockKind::kEnd) {
        ProgramSource::Result refusal =
            final_error(first_line, "the program has no block from this line on to begin with");
        error_ = refusal.error();
        return refusal;
      }
      if ((*block)->line >= first_line) {
        restored_ = before.state();
        restored_.push_back(**block);
        break;
      }
      before.pass(**block);
    }
    if (before.vendor_line() > 0) {
      program_->warn("restart", before.vendor_line(),
                     "vendor words in front of the first line are not repeated; see "
                     "that the machine is as they would leave it");
    }
    return {};
  }

  [[nodiscard]] std::optional<ClBlock> numbered(ClBlock block) {
    block.sequence = sequence_++;
    return block;
  }

  Expected<std::optional<ClBlock>, ClError> read_block() {
    if (error_) return tl::make_unexpected(*error_);
    while (given_ == blocks_.size()) {
      if (stage_ == Stage::kEnd) return std::optional<ClBlock>{};
      blocks_.clear();
      given_ = 0;
      if (auto read = read_statement(); !read) {
        error_ = std::move(read.error());
        return tl::make_unexpected(*error_);
      }
    }
    return std::optional<ClBlock>{blocks_[given_++]};
  }

 public:
  bool go_on() {
    if (!error_ || error_->is_final) return false;
    error_.reset();
    return true;
  }

  ClSummary& summary() {
    ClSummary& summary = program_->summary();
    summary.bytes = lines_.bytes();
    summary.lines = lines_.line_number();
    return summary;
  }
  const ProgramSource& program() const { return *program_; }

 private:
  /// What ends the reading of the file, whatever else may be wrong in it.
  tl::unexpected<ClError> final_error(std::uint32_t line, const std::string& message,
                                      const std::string& remedy = {}) const {
    ClError error = program_->error(line, {message, remedy, {}, 0});
    error.is_final = true;
    return tl::make_unexpected(std::move(error));
  }

  /// Which language the text is in, by its head and by what the caller said.
  ProgramSource::Result begin() {
    Recognised what = recognise_foreign(lines_.head());
    while (!what.is_certain && lines_.read_on()) what = recognise_foreign(lines_.head());
    if (lines_.head().find_first_not_of(" \t\r\n\x1a") == std::string_view::npos) {
      return final_error(0, "the file is empty");
    }
    const bool is_reported = options_.dialect && is_nc(*options_.dialect);
    const bool is_text = what.foreign.empty() || what.is_nc;
    const bool is_shown = what.program != Dialect::kUnknown && !options_.dialect;
    if (options_.nc && is_text && (is_reported || is_shown)) {
      if (!is_reported) options_.dialect = what.program;
      program_ = options_.nc(lines_, name_, options_, is_reported ? "--dialect" : what.shown_by);
      return {};
    }
    if (what.foreign.empty()) return {};
    return final_error(0, "this is " + what.foreign + ", not a CL file", remedy_of(what));
  }

  [[nodiscard]] std::string remedy_of(const Recognised& what) const {
    const std::string by_cam = "output APT or CLDATA text from the CAM system";
    if (!what.is_nc || !options_.nc) return by_cam;
    const bool is_fanuc = !what.like_fanuc.empty();
    return (is_fanuc ? "--dialect fanuc reads it where " + what.like_fanuc + " is a word of Fanuc's"
                     : std::string("--dialect fanuc, siemens or heidenhain reads NC programs of "
                                   "their words")) +
           "; else " + by_cam;
  }

  ProgramSource::Result read_statement() {
    if (stage_ == Stage::kHead) {
      stage_ = Stage::kStatements;
      if (auto begun = begin(); !begun) return begun;
    }
    auto done = program_->read(blocks_);
    if (program_->is_done()) stage_ = Stage::kEnd;
    return done;
  }

  LineSource lines_;
  std::string name_;
  ClReaderOptions options_;
  std::uint32_t first_line_ = 0;  ///< to restart at; 0: none, or done
  std::unique_ptr<ProgramSource> program_;
  std::vector<ClBlock> blocks_;  ///< of the last statement
  std::size_t given_ = 0;
  std::vector<ClBlock> restored_;  ///< what a restart begins with
  std::size_t restored_given_ = 0;
  std::uint64_t sequence_ = 0;
  Stage stage_ = Stage::kHead;
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
bool ClReader::go_on() { return impl_->go_on(); }
const ClSummary& ClReader::summary() const noexcept { return impl_->summary(); }
const std::vector<ClWarning>& ClReader::warnings() const noexcept {
  return impl_->program().warnings();
}

}  // namespace meridian::cl
