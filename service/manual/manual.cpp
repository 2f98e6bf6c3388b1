// SPDX-License-Identifier: Apache-2.0
#include "service/manual/manual.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

namespace meridian::manual {
namespace {

/// Text as roff takes it: a dot or quote at the begin of a line is no request, a dash is a dash.
[[nodiscard]] std::string escaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins_line = i == 0 || text[i - 1] == '\n';
    if (begins_line && (text[i] == '.' || text[i] == '\'')) out += "\\&";
    if (text[i] == '\\') {
      out += "\\e";
    } else if (text[i] == '-') {
      out += "\\-";
    } else {
      out += text[i];
    }
  }
  return out;
}

[[nodiscard]] std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

[[nodiscard]] bool is_shown(const CLI::Option& option) { return !option.get_group().empty(); }

/// "meridian stream" -> "meridian-stream".
[[nodiscard]] std::string page_name(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

void append_option(std::string& out, const CLI::Option& option) {
  const bool takes_value = option.get_items_expected_max() > 0;
  out += ".TP\n.B " + escaped(option.get_name(option.get_positional(), true));
  if (takes_value && !option.get_positional()) out += " " + escaped(option.get_type_name());
  out += "\n" + escaped(option.get_description());
  const std::string standard = option.get_default_str();
  if (!standard.empty()) out += " (default: " + escaped(standard) + ")";
  if (option.get_required()) out += " (required)";
  out += "\n";
}

[[nodiscard]] std::vector<const CLI::App*> subcommands_of(const CLI::App& app) {
  std::vector<const CLI::App*> all;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!sub->get_group().empty()) all.push_back(sub);
  }
  return all;
}

/// Every long and short name of the options of `app`, separated by blanks.
[[nodiscard]] std::string option_words(const CLI::App& app) {
  std::string words;
  for (const CLI::Option* option : app.get_options()) {
    if (!is_shown(*option)) continue;
    for (const std::string& name : option->get_lnames()) words += " --" + name;
    for (const std::string& name : option->get_snames()) words += " -" + name;
  }
  return words.empty() ? words : words.substr(1);
}

}  // namespace

std::string man_page(const CLI::App& app, const std::string& name, const std::string& version,
                     const std::string& see_also) {
  const std::string description = app.get_description();
  const std::string headline = description.substr(0, description.find_first_of(".:;\n"));
  std::string out = ".TH " + upper(page_name(name)) + " 1 \"\" \"meridian " + version +
                    "\" \"Meridian\"\n.SH NAME\n" + escaped(page_name(name)) + " \\- " +
                    escaped(headline) + "\n.SH SYNOPSIS\n.B " + escaped(name) + "\n";
  const auto subcommands = subcommands_of(app);
  out += "[OPTIONS]";
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) out += " " + escaped(option->get_name(true));
  }
  if (!subcommands.empty()) out += " SUBCOMMAND ...";
  out += "\n.SH DESCRIPTION\n" + escaped(description) + "\n";
  if (!subcommands.empty()) {
    out += ".SH SUBCOMMANDS\n";
    for (const CLI::App* sub : subcommands) {
      out += ".TP\n.B " + escaped(sub->get_name()) + "\n" + escaped(sub->get_description()) + "\n";
    }
  }
  out += ".SH OPTIONS\n";
  for (const CLI::Option* option : app.get_options()) {
    if (is_shown(*option)) append_option(out, *option);
  }
  if (!app.get_footer().empty()) out += ".SH EXIT STATUS\n" + escaped(app.get_footer()) + "\n";
  return out + ".SH SEE ALSO\n" + escaped(see_also) + "\n";
}

std::string bash_completion(const CLI::App& app, const std::string& name) {
  std::string commands, cases;
  for (const CLI::App* sub : subcommands_of(app)) {
    commands += (commands.empty() ? "" : " ") + sub->get_name();
    cases += "    " + sub->get_name() + ") words=\"" + option_words(*sub) + "\" ;;\n";
  }
  return "# bash completion of " + name + ", made from its command table\n_" + name +
         "() {\n  local words word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]}\n"
         "  COMPREPLY=()\n  case $command in\n" +
         cases + "    *) words=\"" + option_words(app) +
         "\" ;;\n  esac\n  if [ \"$COMP_CWORD\" -eq 1 ]; then words=\"" + commands +
         " $words\"; fi\n  if [ \"$COMP_CWORD\" -eq 1 ] || [[ $word == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n  fi\n}\n"
         "complete -o default -F _" +
         name + " " + name + "\n";
}

}  // namespace meridian::manual
