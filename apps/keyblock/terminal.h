#pragma once
#include <string>
#include <string_view>

namespace keyblock::app {

/// What may be written to where the progress goes.
struct Terminal {
  bool interactive = false;  ///< lines can be redrawn; false for a pipe, a file, or TERM=dumb
  bool unicode = false;      ///< the locale is UTF-8
  bool color = false;        ///< off with NO_COLOR (https://no-color.org)
  int width = 80;            ///< columns

  /// As the environment and the file descriptor say: COLUMNS, else the window's size; LC_ALL, LC_CTYPE, LANG;
  /// TERM; NO_COLOR.
  static Terminal detect(int file_descriptor);
};

/// Number of code points of UTF-8 text.
int column_count(std::string_view text);

/// `text` made fit for one line of a terminal: no control characters, only ASCII unless `unicode`, and at
/// most `columns` code points; what is cut off ends in … (or ~).
std::string one_line(std::string_view text, int columns, bool unicode);

}  // namespace keyblock::app
