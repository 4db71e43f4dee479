#include "terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "core/text.h"

namespace keyblock::app {
namespace {

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return value ? value : "";
}

bool locale_is_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const std::string_view value = variable(name);
    if (value.empty()) continue;
    for (const char* spelling : {"UTF-8", "utf-8", "UTF8", "utf8"}) {
      if (value.find(spelling) != std::string_view::npos) return true;
    }
    return false;
  }
  return false;
}

int width_of(int file_descriptor) {
  const int wanted = std::atoi(std::string(variable("COLUMNS")).c_str());
  if (wanted > 0) return wanted;
  winsize size{};
  if (::ioctl(file_descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

bool starts_code_point(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
}

}  // namespace

Terminal Terminal::detect(int file_descriptor) {
  const std::string_view type = variable("TERM");
  Terminal terminal;
  terminal.interactive = ::isatty(file_descriptor) == 1 && !type.empty() && type != "dumb";
  terminal.unicode = locale_is_utf8();
  terminal.color = terminal.interactive && variable("NO_COLOR").empty();
  terminal.width = width_of(file_descriptor);
  return terminal;
}

int column_count(std::string_view text) {
  int count = 0;
  for (const char c : text) count += starts_code_point(c) ? 1 : 0;
  return count;
}

std::string one_line(std::string_view text, int columns, bool unicode) {
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    const std::string_view character = text.substr(at, std::max<std::size_t>(length, 1));
    const bool is_shown = length == 1 || (length > 1 && unicode);
    line += is_shown && !is_control(character) ? character : "?";
    at += character.size();
  }
  if (column_count(line) <= columns) return line;
  if (columns < 1) return "";
  std::size_t end = 0;
  for (int kept = 0; end < line.size(); ++end) {
    if (starts_code_point(line[end]) && ++kept == columns) break;
  }
  return line.substr(0, end) + (unicode ? "…" : "~");
}

}  // namespace keyblock::app
