#include <fmt/format.h>

#include <string>
#include <string_view>

#include "command_tree.h"

namespace keyblock::app {
namespace {

/// Text of a line of roff.
std::string roff(std::string_view text) {
  std::string escaped;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
    begins_line = c == '\n';
  }
  return escaped;
}

/// What is set in by two blanks is shown as it is.
std::string paragraphs(const std::string& text) {
  std::string out;
  bool example = false;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    const std::string line = text.substr(from, to - from);
    from = to + 1;
    const bool is_example = line.starts_with("  ");
    if (is_example != example) out += is_example ? ".nf\n" : ".fi\n";
    example = is_example;
    out += line.empty() ? ".PP\n" : roff(line) + "\n";
  }
  return out + (example ? ".fi\n" : "");
}

std::string options_of(const CommandNode& node) {
  std::string text;
  for (const CommandOption& option : node.options) {
    std::string names;
    for (const std::string& name : option.names)
      names += (names.empty() ? "\\fB" : "\\fR, \\fB") + roff(name);
    text += ".TP\n" + names + "\\fR";
    if (!option.value.empty() && !option.is_argument) text += " \\fI" + roff(option.value) + "\\fR";
    text += "\n" + roff(option.meaning) + "\n";
  }
  return text;
}

std::string command_text(const CommandNode& node) {
  std::string text = ".SS keyblock " + roff(node.name) + "\n" + roff(node.meaning) + ".\n" + options_of(node);
  if (!node.footer.empty()) text += ".PP\n" + paragraphs(node.footer);
  for (const CommandNode& command : node.commands) text += command_text(command);
  return text;
}

}  // namespace

std::string manual_page(const CommandNode& program, const std::string& version) {
  std::string text = fmt::format(".TH KEYBLOCK 1 \"\" \"keyblock {}\" \"User Commands\"\n", roff(version));
  text += ".SH NAME\nkeyblock \\- jointed rock under earthquakes, by discontinuous deformation analysis\n";
  text += ".SH SYNOPSIS\n.B keyblock\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n";
  text += ".SH DESCRIPTION\n" + roff(program.meaning) + "\n" + options_of(program);
  text += ".SH COMMANDS\n";
  for (const CommandNode& command : program.commands) text += command_text(command);
  text += ".SH EXAMPLES\n" + paragraphs(program.footer);
  return text;
}

}  // namespace keyblock::app
