// SPDX-License-Identifier: Apache-2.0
#include "fences/shape_fence.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <map>
#include <optional>
#include <regex>
#include <string_view>

#include "fences/code_text.hpp"

namespace meridian::fences {
namespace {

enum class Scope : std::uint8_t {
  kNamespace,
  kClass,
  kFunction,
  kBlock,  ///< of a function: a statement's, or a lambda's
  kOther   ///< what an enum or an initialiser holds
};

bool has_word(const std::string& text, const std::string& words) {
  return std::regex_search(text, std::regex("\\b(" + words + ")\\b"));
}

/// Without what stands in round brackets, and the names of operators.
std::string outside_brackets(const std::string& text) {
  std::string out;
  int depth = 0;
  for (const char c : text) {
    if (c == ')') --depth;
    if (depth == 0) out += c;
    if (c == '(') ++depth;
  }
  return std::regex_replace(out, std::regex("operator[^(]*"), "operator");
}

bool is_name_end(const std::string& head) {
  return !head.empty() &&
         (std::isalnum(static_cast<unsigned char>(head.back())) != 0 || head.back() == '_');
}

/// What the brace behind `head` opens outside of functions.
Scope scope_of_definition(const std::string& head) {
  if (has_word(head, "namespace|extern")) return Scope::kNamespace;
  if (has_word(head, "enum")) return Scope::kOther;
  static const std::regex kAttribute(
      R"(^template\s*<.*?>\s+(?!class|struct|typename)|alignas\([^)]*\)|\[\[.*?\]\])");
  const std::string bare = std::regex_replace(head, kAttribute, "");
  const bool has_brackets = bare.find('(') != std::string::npos;
  if (!has_brackets) return has_word(bare, "class|struct|union") ? Scope::kClass : Scope::kOther;
  const std::string outside = outside_brackets(bare);
  if (outside.find('=') != std::string::npos) return Scope::kOther;
  static const std::regex kMemberList(R"(\)\s*(noexcept\s*)?:[^:])");
  const bool is_member = std::regex_search(outside, kMemberList) && is_name_end(bare);
  return is_member ? Scope::kOther : Scope::kFunction;
}

/// What the brace behind `head` opens inside of a function.
Scope scope_of_statement(const std::string& head) {
  if (has_word(head, "class|struct|union") && head.find('(') == std::string::npos) {
    return Scope::kClass;
  }
  static const std::regex kBlock(
      R"((^|[):\]]|\b(else|do|try|noexcept|mutable)|->\s*[\w:<>&* ]+)$)");
  return std::regex_search(head, kBlock) ? Scope::kBlock : Scope::kOther;
}

/// How many flags a member declaration declares.
int flags_in(const std::string& declaration) {
  static const std::regex kFlags(
      R"(^(?:(?:public|private|protected)\s*:\s*)*(?:mutable\s+)?)"
      R"((?:bool|std::atomic<bool>|std::atomic_bool|std::optional<bool>)\s+([\w\s,={}:]+)$)");
  std::smatch found;
  if (!std::regex_match(declaration, found, kFlags)) return 0;
  const std::string names = found[1];
  return 1 + static_cast<int>(std::count(names.begin(), names.end(), ','));
}

std::string on_one_line(const std::string& text) {
  static const std::regex kBlanks(R"(\s+)");
  const std::string folded = std::regex_replace(text, kBlanks, " ");
  const std::size_t first = folded.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  return folded.substr(first, folded.find_last_not_of(' ') + 1 - first);
}

/// Goes through the code of a file from brace to brace.
class Reader {
 public:
  explicit Reader(const SourceFile& file) : file_(file) {}

  Shapes read() {
    for (const char c : code_of(file_.lines)) {
      if (c == '{') {
        open();
      } else if (c == '}') {
        close();
      } else if (c == ';' && !is_in_brackets()) {
        end_statement();
      } else {
        if (head_.empty() && std::isspace(static_cast<unsigned char>(c)) == 0) head_line_ = line_;
        if (!head_.empty() || std::isspace(static_cast<unsigned char>(c)) == 0) head_ += c;
      }
      if (c == '\n') ++line_;
    }
    return std::move(shapes_);
  }

 private:
  struct Open {
    Scope scope;
    std::string head;
    std::size_t head_line = 0, line = 0;
    int depth = 0;  ///< of a function: the deepest so far
    int flags = 0;  ///< of a class
  };

  [[nodiscard]] bool is_in_brackets() const {
    return std::count(head_.begin(), head_.end(), '(') >
           std::count(head_.begin(), head_.end(), ')');
  }

  [[nodiscard]] bool is_in_function() const {
    return std::any_of(open_.begin(), open_.end(),
                       [](const Open& o) { return o.scope == Scope::kFunction; });
  }

  void open() {
    const std::string head = on_one_line(head_);
    const bool is_in_list = !open_.empty() && open_.back().scope == Scope::kOther;
    const Scope scope = is_in_list         ? scope_in_list(head)
                        : is_in_function() ? scope_of_statement(head)
                                           : scope_of_definition(head);
    open_.push_back({scope, head_, head_.empty() ? line_ : head_line_, line_});
    if (scope == Scope::kFunction || scope == Scope::kBlock) note_depth();
    head_.clear();
  }

  /// A lambda may stand in an initialiser.
  [[nodiscard]] Scope scope_in_list(const std::string& head) const {
    const bool is_lambda = is_in_function() && head.find('[') != std::string::npos;
    return is_lambda ? scope_of_statement(head) : Scope::kOther;
  }

  void note_depth() {
    int depth = 0;
    for (auto at = open_.rbegin(); at != open_.rend(); ++at) {
      if (at->scope == Scope::kFunction || at->scope == Scope::kBlock) ++depth;
      if (at->scope == Scope::kFunction) {
        at->depth = std::max(at->depth, depth);
        return;
      }
    }
  }

  void close() {
    if (open_.empty()) return;
    const Open done = open_.back();
    open_.pop_back();
    head_.clear();
    if (done.scope == Scope::kOther) {
      head_ = done.head + "{}";
      head_line_ = done.head_line;
    }
    if (done.scope == Scope::kFunction) {
      shapes_.functions.push_back({on_one_line(done.head), done.line,
                                   static_cast<int>(line_ - done.line) + 1, done.depth,
                                   has_comment(done, "// Long: "), has_comment(done, "// Deep: ")});
    }
    if (done.scope == Scope::kClass) {
      shapes_.classes.push_back(
          {on_one_line(done.head), done.line, done.flags, has_comment(done, "// Flags: ")});
    }
  }

  void end_statement() {
    if (!open_.empty() && open_.back().scope == Scope::kClass) {
      open_.back().flags += flags_in(on_one_line(head_));
    }
    head_.clear();
  }

  /// Whether a comment inside of `done`, or right above it, begins so.
  [[nodiscard]] bool has_comment(const Open& done, std::string_view begin) const {
    std::size_t first = done.head_line - 1;
    const auto is_comment = [this](std::size_t n) {
      const std::string& text = file_.lines[n];
      const std::size_t at = text.find_first_not_of(' ');
      return at != std::string::npos && text.compare(at, 2, "//") == 0;
    };
    while (first > 0 && is_comment(first - 1)) --first;
    for (std::size_t n = first; n < line_ && n < file_.lines.size(); ++n) {
      if (file_.lines[n].find(begin) != std::string::npos) return true;
    }
    return false;
  }

  const SourceFile& file_;
  Shapes shapes_;
  std::vector<Open> open_;
  std::string head_;  ///< since the last brace or semicolon
  std::size_t head_line_ = 1, line_ = 1;
};

}  // namespace

Shapes read_shapes(const SourceFile& file) { return Reader(file).read(); }

std::vector<Finding> find_large_functions(const std::vector<SourceFile>& files) {
  std::vector<Finding> findings;
  for (const SourceFile& file : files) {
    for (const FunctionShape& function : read_shapes(file).functions) {
      if (function.lines > kMaxFunctionLines && !function.has_long_reason) {
        findings.push_back({file.path, function.line,
                            std::to_string(function.lines) + " lines: " + function.head});
      }
      if (function.depth > kMaxDepth && !function.has_deep_reason) {
        findings.push_back({file.path, function.line,
                            std::to_string(function.depth) + " levels deep: " + function.head});
      }
    }
  }
  return findings;
}

std::vector<Finding> find_flags(const std::vector<SourceFile>& files) {
  std::vector<Finding> findings;
  for (const SourceFile& file : files) {
    for (const ClassShape& shape : read_shapes(file).classes) {
      if (shape.flags <= kMaxFlags || shape.has_reason) continue;
      findings.push_back(
          {file.path, shape.line, std::to_string(shape.flags) + " flags: " + shape.head});
    }
  }
  return findings;
}

std::vector<Finding> find_crowded_folders(const std::vector<SourceFile>& files) {
  std::map<std::string, int> counts;
  for (const SourceFile& file : files) ++counts[file.path.substr(0, file.path.rfind('/'))];
  std::vector<Finding> findings;
  for (const auto& [folder, count] : counts) {
    if (count > kMaxFiles) findings.push_back({folder, 0, std::to_string(count) + " files"});
  }
  return findings;
}

}  // namespace meridian::fences
